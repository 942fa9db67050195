//! Reads points from lines of text, as spreadsheets, numpy, ParaView and people write them.

use super::{Centreline, Format};
use crate::text::{from_utf16, lines, shown};
use crate::{Frame, MeshFileError, Options, read_file};
use std::path::Path;

/// The columns of a centreline, and of many shapes, for error messages.
const POINTS: &str = "x,y,z or x,y,z,radius";
const SHAPES: &str = "shape,x,y,z or shape,x,y,z,radius";

/// The numbers of a text, line by line.
struct Table {
    /// The line number and the names of the columns, if the file has them, in lower case and
    /// without units.
    heading: Option<(usize, Vec<String>)>,
    /// The line number and the numbers of each line.
    rows: Vec<(usize, Vec<f64>)>,
}

/// What is wrong with a line.
struct Fault {
    line: usize,
    problem: String,
}

impl Fault {
    fn named(self, file: &Path, expected: &'static str) -> MeshFileError {
        MeshFileError::Line {
            file: file.to_owned(),
            line: self.line,
            problem: self.problem,
            expected,
        }
    }
}

fn fault<T>(line: usize, problem: String) -> Result<T, Fault> {
    Err(Fault { line, problem })
}

/// Returns the numbers of each line of a text file.
///
/// Empty lines, lines that begin with # and a heading are skipped. Columns are separated by
/// semicolons, tabs, commas or spaces, and may be quoted.
///
/// `expected` names the columns to write, for the error message.
///
/// # Errors
/// The file cannot be read, a line has another number of columns than `COLUMNS`, or a word is not a
/// number.
pub fn load_table<const COLUMNS: usize>(
    path: impl AsRef<Path>,
    expected: &'static str,
    options: &Options,
) -> Result<Vec<[f64; COLUMNS]>, MeshFileError> {
    let path = path.as_ref();
    table_from_bytes(path, &read_file(path, options)?, expected)
}

/// Same as [`load_table`], for the content of a file with this name.
///
/// # Errors
/// As [`load_table`].
pub fn table_from_bytes<const COLUMNS: usize>(
    path: impl AsRef<Path>,
    bytes: &[u8],
    expected: &'static str,
) -> Result<Vec<[f64; COLUMNS]>, MeshFileError> {
    let numbers = |(line, row): (usize, Vec<f64>)| {
        let problem = format!("has {} columns", row.len());
        row.try_into().map_err(|_| Fault { line, problem })
    };
    let rows = parse(bytes).and_then(|table| table.rows.into_iter().map(numbers).collect());
    rows.map_err(|fault| fault.named(path.as_ref(), expected))
}

/// Reads many robots from a text file with lines of shape,x,y,z and optionally the radius of the
/// segment that begins there. Consecutive lines with the same shape number are one robot.
///
/// # Errors
/// As [`load_table`]; or some lines of a robot have a radius and others have none.
pub fn load_shapes(
    path: impl AsRef<Path>,
    options: &Options,
) -> Result<Vec<(f64, Centreline)>, MeshFileError> {
    let path = path.as_ref();
    options.check_scale()?;
    let mut shapes = read(path, &read_file(path, options)?, 1, SHAPES, options)?;
    // Points that are not finite are left to the robot's constructor: one bad shape does not fail
    // the others.
    for (_, shape) in &mut shapes {
        shape.points.iter_mut().flatten().for_each(|x| *x *= options.scale);
    }
    Ok(shapes)
}

/// Reads one robot.
pub fn centreline(
    path: &Path,
    bytes: &[u8],
    options: &Options,
) -> Result<Centreline, MeshFileError> {
    let mut robots = read(path, bytes, 0, POINTS, options)?;
    let (_, mut robot) = robots.swap_remove(0);
    options.scale_all(path, &mut robot.points)?;
    Ok(robot)
}

/// Returns the robots of a table before their points are scaled. Coordinates begin in the column
/// `first` unless the heading states otherwise.
fn read(
    path: &Path,
    bytes: &[u8],
    first: usize,
    expected: &'static str,
    options: &Options,
) -> Result<Vec<(f64, Centreline)>, MeshFileError> {
    let named = |fault: Fault| fault.named(path, expected);
    let table = parse(bytes).map_err(named)?;
    let columns = Columns::of(&table, first).map_err(named)?;
    if table.rows.is_empty() {
        let (file, format, reason) =
            (path.to_owned(), Format::Table.name(), format!("it has no points; write {expected}"));
        return Err(MeshFileError::Broken { file, format, reason });
    }
    let mut robots = Vec::new();
    let shape = |row: &[f64]| row[columns.shape];
    for rows in
        table.rows.chunk_by(|(_, a), (_, b)| first == 0 || shape(a).to_bits() == shape(b).to_bits())
    {
        let points = rows.iter().map(|(_, row)| columns.axes.map(|axis| row[axis])).collect();
        let radii = columns.radii(rows).map_err(named)?;
        let radii =
            radii.map(|radii| radii.into_iter().map(|radius| radius * options.scale).collect());
        let robot = Centreline {
            points,
            radii,
            frame: columns.frame,
            states_unit: false,
            skipped_points: 0,
        };
        robots.push((shape(&rows[0].1), robot));
    }
    Ok(robots)
}

/// The columns of the coordinates and of the radius, and the frame that the coordinates' names
/// state.
struct Columns {
    axes: [usize; 3],
    radius: Option<usize>,
    /// The factor of the numbers in the column of the radius: 1/2 for diameters.
    factor: f64,
    /// The column of the number of the shape, in a table of shapes.
    shape: usize,
    frame: Option<Frame>,
}

impl Columns {
    fn of(table: &Table, first: usize) -> Result<Self, Fault> {
        let plain = [first, first + 1, first + 2];
        let columns =
            Self { axes: plain, radius: Some(first + 3), factor: 1.0, shape: 0, frame: None };
        let Some((line, heading)) = &table.heading else {
            return Self::check(table, columns, first + 4);
        };
        let named = |name: &str| heading.iter().position(|own| own == name);
        let stated = named_axes(heading).filter(|(axes, _)| axes.iter().all(|&axis| axis >= first));
        let (axes, frame) = stated.unwrap_or((plain, None));
        if stated.is_none() {
            for (column, axis) in axes.into_iter().zip(['x', 'y', 'z']) {
                // A heading of fewer columns is refused where a line has fewer.
                if let Some(name) = heading.get(column)
                    && !(name.starts_with(axis) || name.ends_with(axis))
                {
                    let column = column + 1;
                    let problem = format!("has '{}' in column {column}, not {axis}", shown(name));
                    return fault(*line, problem);
                }
            }
        }
        let is_free = |column: &usize| !axes.contains(column);
        let own = |&(name, factor): &(&str, f64)| Some((named(name).filter(is_free)?, factor));
        let (radius, factor) = RADIUS.iter().find_map(own).unzip();
        let shape = named("shape").filter(|_| first > 0).unwrap_or(0);
        let factor = factor.unwrap_or(1.0);
        Self::check(table, Self { axes, radius, factor, shape, frame }, heading.len())
    }

    /// Checks that every line has the coordinates and the shape, and no column without a name.
    fn check(table: &Table, columns: Self, most: usize) -> Result<Self, Fault> {
        let last = columns.axes.into_iter().fold(columns.shape, usize::max);
        for (line, row) in &table.rows {
            if row.len() <= last || (table.heading.is_none() && row.len() > most) {
                return fault(*line, format!("has {} columns", row.len()));
            }
            if row.len() > most {
                return fault(
                    *line,
                    format!("has {} columns, but the heading names {most}", row.len()),
                );
            }
        }
        Ok(columns)
    }

    /// Returns the radius of the segment that begins at each point but the last, if the file has
    /// radii.
    fn radii(&self, rows: &[(usize, Vec<f64>)]) -> Result<Option<Vec<f64>>, Fault> {
        let Some(column) = self.radius else { return Ok(None) };
        let of = |(_, row): &(usize, Vec<f64>)| row.get(column).map(|number| number * self.factor);
        let Some((last, others)) = rows.split_last() else { return Ok(None) };
        if rows.iter().all(|row| of(row).is_none()) {
            return Ok(None);
        }
        // No segment begins at the last point, but an invalid radius there indicates a mistake.
        if let Some(unused) = of(last)
            && !(0.0..f64::INFINITY).contains(&unused)
        {
            return fault(last.0, format!("says that the radius of the last point is {unused}"));
        }
        let radius = |row: &(usize, Vec<f64>)| match of(row) {
            Some(radius) => Ok(radius),
            None => fault(row.0, "has no radius, but other lines have".into()),
        };
        others.iter().map(radius).collect::<Result<_, _>>().map(Some)
    }
}

/// The names of a column of radii, VMTK's included, or of diameters, and the factor to radii.
const RADIUS: [(&str, f64); 7] = [
    ("radius", 1.0),
    ("radii", 1.0),
    ("rad", 1.0),
    ("r", 1.0),
    ("maximuminscribedsphereradius", 1.0),
    ("diameter", 0.5),
    ("diameters", 0.5),
];
/// Names of the coordinates that may be in any columns, and the frame that they state. ParaView
/// writes `Points:0`; other programs write `Points_0` for it.
const NAMED_AXES: [([&str; 3], Option<Frame>); 5] = [
    (["points:0", "points:1", "points:2"], None),
    (["points_0", "points_1", "points_2"], None),
    (["r", "a", "s"], Some(Frame::Ras)),
    (["l", "p", "s"], Some(Frame::Lps)),
    (["x", "y", "z"], None),
];

/// Returns the columns of the coordinates and the frame that their names state.
fn named_axes(names: &[String]) -> Option<([usize; 3], Option<Frame>)> {
    let named = |name: &str| names.iter().position(|own| own == name);
    NAMED_AXES.into_iter().find_map(|(axes, frame)| match axes.map(named) {
        [Some(x), Some(y), Some(z)] => Some(([x, y, z], frame)),
        _ => None,
    })
}

fn parse(bytes: &[u8]) -> Result<Table, Fault> {
    let mut table = Table { heading: None, rows: Vec::new() };
    let mut is_first = true;
    for (line, text) in lines(&from_utf16(bytes)) {
        let text = bare(&text);
        if text.trim().is_empty() || text.starts_with('#') {
            continue;
        }
        let columns = columns(text);
        if std::mem::take(&mut is_first)
            && let names = columns.iter().map(|word| name(word)).collect::<Vec<_>>()
            && is_heading(&columns, &names)
        {
            if let Some(column) = misplaced(&names) {
                return fault(
                    line,
                    format!("has '{}' in column {}", shown(columns[column]), column + 1),
                );
            }
            table.heading = Some((line, names));
            continue;
        }
        let mut row = Vec::new();
        for (column, word) in (1..).zip(&columns) {
            let wrong = || match word.is_empty() {
                true => format!("has nothing in column {column}"),
                false => format!("has '{}' in column {column}", shown(word)),
            };
            row.push(number(word).ok_or_else(|| Fault { line, problem: wrong() })?);
        }
        table.rows.push((line, row));
    }
    Ok(table)
}

/// Returns the line without the brackets and the comma in which numpy prints matrices.
fn bare(line: &str) -> &str {
    let inside = line.trim_matches([' ', '\r']);
    let inside = inside.strip_suffix("],").unwrap_or(inside);
    if inside.starts_with('[') || inside.ends_with(']') {
        inside.trim_matches(['[', ']', ' '])
    } else {
        inside
    }
}

/// The characters that separate columns, the first that a line has.
const MARKS: [char; 3] = [';', '\t', ','];

/// Splits a line at semicolons if it has any, else at tabs, else at commas; empty words count.
/// Without any of these, splits at spaces. Quoted text is not split.
fn columns(line: &str) -> Vec<&str> {
    let mut is_quoted = false;
    let is_outside = |&(_, c): &(usize, char)| {
        is_quoted ^= c == '"';
        !is_quoted && (c.is_whitespace() || MARKS.contains(&c))
    };
    // The separators outside quotes.
    let outside: Vec<_> = line.char_indices().filter(is_outside).collect();
    let split = |is_mark: &dyn Fn(char) -> bool| -> Vec<&str> {
        let mut from = 0;
        let marks = outside.iter().filter(|(_, c)| is_mark(*c));
        let ends = marks.map(|&(end, c)| [end, end + c.len_utf8()]).chain([[line.len(); 2]]);
        ends.map(|[end, next]| {
            let word = &line[std::mem::replace(&mut from, next)..end];
            word.trim().trim_matches('"').trim()
        })
        .collect()
    };
    let has = |mark: char| outside.iter().any(|(_, c)| *c == mark);
    // With both tabs and commas, commas are decimal commas only if the words between tabs are
    // numbers.
    let is_decimal = || split(&|c| c == '\t').into_iter().all(|word| number(word).is_some());
    let is_mark = |mark: char| has(mark) && (mark != '\t' || !has(',') || is_decimal());
    match MARKS.into_iter().find(|&mark| is_mark(mark)) {
        Some(mark) => split(&|c| c == mark),
        None => split(&char::is_whitespace).into_iter().filter(|word| !word.is_empty()).collect(),
    }
}

/// Parses a number with a decimal point or comma.
fn number(word: &str) -> Option<f64> {
    let is_comma = word.matches(',').count() == 1 && !word.contains('.');
    if is_comma { word.replace(',', ".").parse().ok() } else { word.parse().ok() }
}

/// Returns a name in lower case, without its unit.
fn name(word: &str) -> String {
    let bare = word.split(['[', '(']).next().unwrap_or_default().trim().to_lowercase();
    ["_mm", "_m", " mm"].iter().find_map(|unit| bare.strip_suffix(unit)).unwrap_or(&bare).to_owned()
}

/// Returns whether a line is a heading: names of three coordinates; or words without a digit, none
/// of which is a number or missing.
fn is_heading(columns: &[&str], names: &[String]) -> bool {
    let is_name = |word: &&str| word.contains(char::is_alphabetic) && number(word).is_none();
    let has_digit = || names.iter().any(|name| name.contains(char::is_numeric));
    named_axes(names).is_some() || columns.iter().all(is_name) && !has_digit()
}

/// Returns the column of a heading that names x, y or z out of order. Without an x, y and z belong
/// to the first columns, or those after a column of shapes.
fn misplaced(names: &[String]) -> Option<usize> {
    let axis = |name: &str| ["x", "y", "z"].iter().position(|axis| *axis == name);
    let plain = usize::from(names.first().is_some_and(|name| name == "shape"));
    let first = names.iter().position(|name| name == "x").unwrap_or(plain);
    (0..names.len()).find(|&column| axis(&names[column]).is_some_and(|axis| first + axis != column))
}
