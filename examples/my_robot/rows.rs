//! Numbers in the lines of a file, as spreadsheets, numpy and people write them.

use std::{ops::RangeInclusive, path::Path};

/// The numbers of each line, with the line's name. Empty lines, lines that begin with # and a heading are passed over.
pub fn rows(
    path: &Path,
    count: RangeInclusive<usize>,
    what: &str,
) -> Result<Vec<(String, Vec<f64>)>, String> {
    let file = path.display();
    let text = std::fs::read_to_string(path).map_err(|e| format!("cannot read {file} ({e}); check it"))?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
    let lines = text.lines().zip(1..).map(|(line, number)| (bare(line), number));
    let mut rows = Vec::new();
    let mut is_first = true;
    for (line, number) in lines.filter(|(line, _)| !(line.trim().is_empty() || line.starts_with('#'))) {
        let name = format!("line {number} of {file}");
        let columns = columns(line);
        if std::mem::take(&mut is_first) && is_heading(&columns) {
            if let Some(column) = misplaced(&columns, what) {
                return Err(format!(
                    "{name}, a heading, has '{}' in column {}; write {what}",
                    columns[column],
                    column + 1
                ));
            }
            continue;
        }
        let mut row = Vec::new();
        for (column, word) in (1..).zip(&columns) {
            row.push(word.parse().map_err(|_| match word.is_empty() {
                true => format!("{name} has nothing in column {column}; write {what}"),
                false => format!("{name} has '{word}' in column {column}; write {what}"),
            })?);
        }
        if !count.contains(&row.len()) {
            return Err(format!("{name} has {} columns; write {what}", row.len()));
        }
        rows.push((name, row));
    }
    Ok(rows)
}

/// The line without the brackets in which numpy prints matrices, and the comma between them.
fn bare(line: &str) -> &str {
    let inside = line.trim_matches([' ', '\r']);
    let inside = inside.strip_suffix("],").unwrap_or(inside);
    if inside.starts_with('[') || inside.ends_with(']') {
        inside.trim_matches(['[', ']', ' '])
    } else {
        inside
    }
}

/// The words between commas, or semicolons, or tabs, empty ones too; without any of these, the words between spaces.
fn columns(line: &str) -> Vec<&str> {
    match [',', ';', '\t'].into_iter().find(|&mark| line.contains(mark)) {
        Some(mark) => line.split(mark).map(str::trim).collect(),
        None => line.split_whitespace().collect(),
    }
}

/// Names of columns: words without a digit, none of which can be read as a number or is missing.
fn is_heading(columns: &[&str]) -> bool {
    let is_name = |word: &&str| word.contains(char::is_alphabetic) && word.parse::<f64>().is_err();
    columns.iter().all(is_name) && !columns.iter().any(|word| word.contains(char::is_numeric))
}

/// The column of a heading that names x, y or z where another one is read.
fn misplaced(columns: &[&str], what: &str) -> Option<usize> {
    let axis = |word: &str| ["x", "y", "z"].iter().position(|axis| axis.eq_ignore_ascii_case(word));
    let first = what.split(',').position(|word| word == "x").unwrap_or(0);
    (0..columns.len()).find(|&column| axis(columns[column]).is_some_and(|axis| first + axis != column))
}
