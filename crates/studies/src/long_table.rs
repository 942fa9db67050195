//! A table that is too long for a page: the page keeps the rows that a reader wants, a file beside
//! it has them all.

use std::fs;
use std::path::Path;

/// Writes all of a Markdown table to a file of comma-separated values, and returns the table with
/// those rows alone whose cells `is_shown` picks.
///
/// # Errors
/// The file cannot be written.
pub fn write(
    table: &str,
    file: &Path,
    is_shown: impl Fn(&[&str]) -> bool,
) -> Result<String, String> {
    let directory = file.parent().unwrap_or(Path::new("."));
    fs::create_dir_all(directory).and_then(|()| fs::write(file, csv(table))).map_err(|error| {
        format!("cannot write {} ({error}); choose another --out", file.display())
    })?;
    Ok(shown(table, is_shown))
}

/// The table with its head, and those rows alone whose cells `is_shown` picks.
pub fn shown(table: &str, is_shown: impl Fn(&[&str]) -> bool) -> String {
    let is_kept = |(index, line): &(usize, &str)| *index < 2 || is_shown(&cells(line));
    table.lines().enumerate().filter(is_kept).map(|(_, line)| format!("{line}\n")).collect()
}

/// The table as comma-separated values. Heads of a group, such as `f32: worst | gross`, each get
/// the group's name, and a unit that ends every cell of a column goes to its head.
pub fn csv(table: &str) -> String {
    let mut lines = table.lines().map(cells);
    let Some(head) = lines.next() else { return String::new() };
    let rows: Vec<_> = lines.skip(1).collect();
    let mut text = vec![Vec::new(); 1 + rows.len()];
    let mut group = "";
    for (column, name) in head.into_iter().enumerate() {
        group = name.split_once(": ").map_or(group, |(group, _)| group);
        let is_alone = group.is_empty() || name.contains(": ");
        let name = if is_alone { name.to_owned() } else { format!("{group}: {name}") };
        let cells: Vec<_> =
            rows.iter().map(|row| row.get(column).copied().unwrap_or_default()).collect();
        let is_of =
            |unit: &&str| cells.iter().all(|cell| cell.is_empty() || number(cell, unit).is_some());
        let unit = ["us", "mm"].into_iter().find(is_of);
        text[0].push(quoted(&unit.map_or(name.clone(), |unit| format!("{name} ({unit})"))));
        for (line, cell) in text[1..].iter_mut().zip(cells) {
            line.push(quoted(unit.and_then(|unit| number(cell, unit)).unwrap_or(cell)));
        }
    }
    text.into_iter().map(|line| line.join(",") + "\n").collect()
}

/// The number before this unit.
fn number<'a>(cell: &'a str, unit: &str) -> Option<&'a str> {
    let number = cell.strip_suffix(unit)?.trim_end();
    number.parse::<f64>().is_ok().then_some(number)
}

fn cells(line: &str) -> Vec<&str> {
    let line = line.strip_prefix('|').unwrap_or(line);
    line.strip_suffix('|').unwrap_or(line).split('|').map(str::trim).collect()
}

/// A cell with a comma stands in quotation marks.
fn quoted(cell: &str) -> String {
    if cell.contains([',', '"']) {
        format!("\"{}\"", cell.replace('"', "\"\""))
    } else {
        cell.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: &str = "| model | within | first: worst | least |\n|---|---|---|---|\n\
                         | caps, fitted | 0.1 mm | 5.2 us | 100 us |\n| spheres | 1 mm | 7 us |  |\n";

    #[test]
    fn the_page_keeps_its_rows_and_the_file_has_all() {
        let short = shown(TABLE, |cells| cells[0] == "spheres");
        assert_eq!(
            short,
            "| model | within | first: worst | least |\n|---|---|---|---|\n| spheres | 1 mm | 7 us |  |\n"
        );
        let expected = "model,within (mm),first: worst (us),first: least (us)\n\"caps, fitted\",0.1,5.2,100\nspheres,1,7,\n";
        assert_eq!(csv(TABLE), expected);
    }

    #[test]
    fn a_column_of_words_keeps_them() {
        let table = "| way | size |\n|---|---|\n| as us | 2 mm |\n| them | wide |\n";
        assert_eq!(csv(table), "way,size\nas us,2 mm\nthem,wide\n");
    }
}
