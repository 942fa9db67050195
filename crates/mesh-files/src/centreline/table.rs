//! Reads points from lines of text, as spreadsheets, numpy, ParaView and people write them.
//!
//! # Several lines in a file
//! The points of a centreline's file are split
//! 1. by the first column that numbers lines, if two numbers occur, and one of them twice;
//! 2. by the first column of robots or times, if two occur, and each of them twice on average: the
//!    times of single points are no lines;
//! 3. at empty lines and repeated headings, unless each part is one point;
//! 4. at a step back: a point that repeats an earlier one, after a step of more than twice the mean
//!    step since. No robot returns to its own point by such a step, but the next branch of a tree
//!    begins where an earlier one does.

use super::format::Format;
use super::heading::{Columns, Fault, Heading, Name, fault, has_coordinates, is_units, names};
use super::lines::Centreline;
use crate::doubts::sharp_turns;
use crate::text::{from_utf16, lines, shown};
use crate::{Frame, MeshFileError, Options, read_file};
use std::collections::{HashMap, HashSet};
use std::path::Path;

/// The columns of a centreline, and of many shapes, for error messages.
const POINTS: &str = "x,y,z or x,y,z,radius";
const SHAPES: &str = "shape,x,y,z or shape,x,y,z,radius";

/// The maximum number of columns of a line.
const MOST_COLUMNS: usize = 4096;

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
    let mut rows = Vec::new();
    let mut add = |line: usize, words: &[&str]| -> Result<(), Fault> {
        let mut row = [0.0; COLUMNS];
        for (column, _) in words.iter().enumerate() {
            let number = cell(line, words, column)?;
            row.get_mut(column).into_iter().for_each(|own| *own = number);
        }
        if words.len() != COLUMNS {
            return fault(line, format!("has {} columns", words.len()));
        }
        rows.push(row);
        Ok(())
    };
    let mut is_first = true;
    let read = each_line(&from_utf16(bytes), &mut |line, text| {
        let Text::Row(text) = text else { return Ok(()) };
        let words = columns(line, text, None)?;
        let is_heading = std::mem::take(&mut is_first) && heading(line, &words).is_some();
        if is_heading { Ok(()) } else { add(line, &words) }
    });
    read.map(|()| rows).map_err(|fault| fault.named(path.as_ref(), expected))
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
    let Table { columns, rows, .. } = read(path, &read_file(path, options)?, 1, SHAPES, options)?;
    let robots = rows.chunk_by(|a, b| a.shape.to_bits() == b.shape.to_bits());
    let mut numbers = HashSet::new();
    let shapes = robots.map(|rows| {
        let mut line = columns.centreline(rows, options.scale)?;
        // Points that are not finite are left to the robot's constructor: one bad shape does not
        // fail the others.
        line.points.iter_mut().flatten().for_each(|x| *x *= options.scale);
        line.doubts.extend(sharp_turns(&line.points));
        if !numbers.insert(rows[0].shape.to_bits()) {
            line.doubts.push(format!(
                "line {} begins a shape whose number stands before another shape too; each of \
                 them is read as a robot of its own",
                rows[0].line
            ));
        }
        Ok((rows[0].shape, line))
    });
    shapes.collect::<Result<_, Fault>>().map_err(|fault| fault.named(path, SHAPES))
}

/// Reads the robots of a file, before their points are scaled.
pub fn centrelines(
    path: &Path,
    bytes: &[u8],
    options: &Options,
) -> Result<Vec<Centreline>, MeshFileError> {
    let mut table = read(path, bytes, 0, POINTS, options)?;
    let ends = table.split();
    let starts = [0].into_iter().chain(ends.iter().copied());
    table.columns.doubts.extend(table.counts_lines());
    let lines = starts
        .zip(&ends)
        .map(|(start, &end)| table.columns.centreline(&table.rows[start..end], options.scale));
    lines.collect::<Result<_, Fault>>().map_err(|fault| fault.named(path, POINTS))
}

/// Returns the points of a file. `first` is 1 in a table of shapes, 0 otherwise.
fn read(
    path: &Path,
    bytes: &[u8],
    first: usize,
    expected: &'static str,
    options: &Options,
) -> Result<Table, MeshFileError> {
    let named = |fault: Fault| fault.named(path, expected);
    let Some(table) = parse(bytes, first).map_err(named)? else {
        let (file, format, reason) =
            (path.to_owned(), Format::Table.name(), format!("it has no points; write {expected}"));
        return Err(MeshFileError::Broken { file, format, reason });
    };
    if table.columns.states_radius_only() && options.scale != 1.0 {
        let problem = format!(
            "names the unit of the radius, but not that of the coordinates, so the scale {} is ambiguous",
            options.scale
        );
        return Err(named(Fault { line: table.columns.line, problem }));
    }
    Ok(table)
}

/// The points of a table.
struct Table {
    columns: Columns,
    rows: Vec<Row>,
    /// Numbers for the words in each of `columns.lines` and `columns.times`, row by row.
    words: Vec<u32>,
}

struct Row {
    /// The line of the file, counted from 1.
    line: u32,
    /// The part of the file between empty lines; then the line of the robot.
    part: u32,
    /// The number of the shape, in a table of shapes.
    shape: f64,
    point: [f64; 3],
    /// Whether the point has a position.
    is_defined: bool,
    radius: Option<f64>,
}

/// Returns the points of a file, if it has any.
fn parse(bytes: &[u8], first: usize) -> Result<Option<Table>, Fault> {
    let mut table: Option<Table> = None;
    // The heading, the separator of its columns, and the last comment that names coordinates.
    let (mut named, mut mark): (Option<(Heading, String)>, _) = (None, None);
    let mut comment = None;
    let (mut frame, mut part, mut is_apart) = (None, 0, false);
    let mut known = HashMap::new();
    each_line(&from_utf16(bytes), &mut |line, text| {
        let text = match text {
            Text::Empty => {
                is_apart = true;
                return Ok(());
            }
            Text::Comment(text) => {
                frame = frame.or_else(|| noted_frame(text));
                if table.is_none() {
                    let words = columns(line, text, None)?;
                    let named = heading(line, &words).filter(|it| has_coordinates(&it.names));
                    comment = named.or(comment.take());
                }
                return Ok(());
            }
            Text::Row(text) => text,
        };
        // The heading again begins another part.
        if table.is_some() && named.as_ref().is_some_and(|(_, heading)| heading == text) {
            is_apart = true;
            return Ok(());
        }
        let words = columns(line, text, mark)?;
        if table.is_none() {
            match &mut named {
                None => {
                    if let Some(heading) = heading(line, &words) {
                        mark = separator(text);
                        named = Some((heading, text.to_owned()));
                        return Ok(());
                    }
                }
                Some((heading, _)) if is_units(&words) => {
                    for (name, word) in heading.names.iter_mut().zip(&words) {
                        if let Err(own) = name.set_unit(word) {
                            let (own, word) = (shown(own), shown(word));
                            return fault(line, format!("has the unit '{word}' below '{own}'"));
                        }
                    }
                    return Ok(());
                }
                Some(_) => {}
            }
            // A row may lack the last column, the radius. Names with units are no prose.
            let fits = |heading: &Heading| {
                let count = heading.names.len();
                (words.len()..=words.len() + 1).contains(&count)
                    || heading.names.iter().any(Name::has_unit)
            };
            let heading = named.as_ref().map(|(heading, _)| heading);
            let columns = match heading.or(comment.as_ref().filter(|comment| fits(comment))) {
                Some(heading) => Columns::named(heading, first)?,
                None => Columns::plain(first),
            };
            table = Some(Table { columns, rows: Vec::new(), words: Vec::new() });
        }
        let Some(table) = &mut table else { return Ok(()) };
        part += u32::from(std::mem::take(&mut is_apart) && !table.rows.is_empty());
        let row = table.columns.row(line, &words)?;
        table.rows.push(Row { part, ..row });
        for &column in table.columns.lines.iter().chain(&table.columns.times) {
            let next = known.len() as u32;
            let word = words.get(column).copied().unwrap_or_default().to_owned();
            table.words.push(*known.entry((column, word)).or_insert(next));
        }
        Ok(())
    })?;
    // A heading alone may be wrong, too.
    if let (None, Some((heading, _))) = (&table, &named) {
        Columns::named(heading, first)?;
    }
    Ok(table.map(|mut table| {
        table.columns.frame = table.columns.frame.or(frame);
        table
    }))
}

impl Columns {
    /// Reads a line. Columns that are not needed may contain any text.
    fn row(&self, line: usize, words: &[&str]) -> Result<Row, Fault> {
        let count = words.len();
        let is_defined = match self.defined.map(|column| words.get(column).copied().unwrap_or("")) {
            None | Some("1" | "true" | "True") => true,
            Some("0" | "false" | "False") => false,
            Some(other) => {
                let other = shown(other);
                return fault(line, format!("has '{other}' in the column 'defined', not 0 or 1"));
            }
        };
        let is_needed = |column: &usize| {
            !self.has_heading
                || self.shape == Some(*column)
                || is_defined && (self.axes.contains(column) || self.radius == Some(*column))
        };
        for column in (0..count).filter(is_needed) {
            cell(line, words, column)?;
        }
        if count <= self.last() || !self.has_heading && count > self.most {
            return fault(line, format!("has {count} columns"));
        }
        if count > self.most {
            let most = self.most;
            return fault(line, format!("has {count} columns, but the heading names {most}"));
        }
        let shape = self.shape.map_or(Ok(0.0), |column| cell(line, words, column))?;
        let (mut point, mut radius) = ([0.0; 3], None);
        if is_defined {
            for (x, column) in point.iter_mut().zip(self.axes) {
                *x = self.coordinate(cell(line, words, column)?);
            }
            if let Some(column) = self.radius.filter(|column| *column < count) {
                radius = Some(self.radius_of(cell(line, words, column)?));
            }
        }
        Ok(Row { line: line as u32, part: 0, shape, point, is_defined, radius })
    }

    /// Returns a robot before its points are scaled.
    fn centreline(&self, rows: &[Row], scale: f64) -> Result<Centreline, Fault> {
        let set = || rows.iter().filter(|row| row.is_defined);
        let radii = radii(&set().collect::<Vec<_>>())?;
        Ok(Centreline {
            points: set().map(|row| row.point).collect(),
            radii: radii.map(|radii| radii.into_iter().map(|radius| radius * scale).collect()),
            frame: self.frame,
            states_unit: self.states_unit(),
            skipped_points: rows.len() - set().count(),
            doubts: self.doubts.clone(),
        })
    }
}

/// Returns the radius of the segment that begins at each point but the last, if the file has radii.
fn radii(rows: &[&Row]) -> Result<Option<Vec<f64>>, Fault> {
    let Some((last, others)) = rows.split_last() else { return Ok(None) };
    if rows.iter().all(|row| row.radius.is_none()) {
        return Ok(None);
    }
    // No segment begins at the last point, but an invalid radius there indicates a mistake.
    if let Some(unused) = last.radius
        && !(0.0..f64::INFINITY).contains(&unused)
    {
        let problem = format!("says that the radius of the last point is {unused}");
        return fault(last.line as usize, problem);
    }
    let radius = |row: &&Row| match row.radius {
        Some(radius) => Ok(radius),
        None => fault(row.line as usize, "has no radius, but other lines have".into()),
    };
    others.iter().map(radius).collect::<Result<_, _>>().map(Some)
}

impl Table {
    /// Returns a doubt if the first of four columns without a heading counts the lines, so that z
    /// is read as the radius. A straight robot of constant radius may have such an x.
    fn counts_lines(&self) -> Option<String> {
        let Self { columns, rows, .. } = self;
        let first = rows.first().filter(|_| !columns.has_heading && rows.len() > 2)?;
        let counts = [0.0, 1.0].contains(&first.point[0])
            && rows.windows(2).all(|pair| pair[1].point[0] - pair[0].point[0] == 1.0)
            && rows.windows(2).any(|pair| pair[0].radius != pair[1].radius);
        counts.then(|| {
            format!(
                "the first column counts the lines, but the columns are read as {POINTS}; leave \
                 out the numbers, or write a heading"
            )
        })
    }

    /// Sorts the rows by the lines of the file. Returns the end of each line.
    fn split(&mut self) -> Vec<usize> {
        let count = self.rows.len();
        let is_number = |different: usize| (2..count).contains(&different);
        let (lines, each) =
            (self.columns.lines.len(), self.columns.lines.len() + self.columns.times.len());
        let numbers = (0..each).find_map(|column| {
            let own = || self.words.iter().skip(column).step_by(each);
            let different = own().collect::<HashSet<_>>().len();
            let is_time = column >= lines;
            (is_number(different) && !(is_time && 2 * different > count))
                .then(|| own().copied().collect::<Vec<_>>())
        });
        let has_parts = self.rows.last().is_some_and(|row| is_number(row.part as usize + 1));
        let mut lines = HashMap::new();
        for (index, row) in self.rows.iter_mut().enumerate() {
            let part = if has_parts { row.part } else { 0 };
            let number = numbers.as_ref().map_or(0, |numbers| numbers[index]);
            let next = lines.len() as u32;
            row.part = *lines.entry((part, number)).or_insert(next);
        }
        self.rows.sort_by_key(|row| row.part);
        let mut ends = Vec::new();
        for line in self.rows.chunk_by(|a, b| a.part == b.part) {
            let start = ends.last().copied().unwrap_or(0);
            ends.extend(steps_back(line).into_iter().map(|end| start + end));
            ends.push(start + line.len());
        }
        ends
    }
}

/// Returns the indices of points that repeat an earlier point after a long step.
fn steps_back(rows: &[Row]) -> Vec<usize> {
    let mut found = Vec::new();
    // The last one at each place, counted without those that are not defined, and the way to it.
    let mut places = HashMap::new();
    let (mut way, mut before) = (0.0, None);
    let defined = rows.iter().enumerate().filter(|(_, row)| row.is_defined);
    for (count, (index, row)) in defined.enumerate() {
        let place = row.point.map(|x| (x + 0.0).to_bits());
        let step = before.map_or(0.0, |before: [f64; 3]| {
            let away = [0, 1, 2].map(|axis| row.point[axis] - before[axis]);
            away.iter().fold(0.0, |length: f64, x| length.hypot(*x))
        });
        if let Some(&(earlier, start)) = places.get(&place)
            && count > earlier + 1
            && step * (count - 1 - earlier) as f64 > LONG * (way - start)
        {
            found.push(index);
        }
        way += step;
        places.insert(place, (count, way));
        before = Some(row.point);
    }
    found
}

/// A step back is longer than this times the mean step. The steps of a robot that ends at its
/// beginning are about equal; the first step of a branch of three points is about twice the mean.
const LONG: f64 = 2.0;

/// A line of a text file.
enum Text<'a> {
    Empty,
    /// The text behind the mark of a comment.
    Comment(&'a str),
    Row(&'a str),
}

fn each_line(
    bytes: &[u8],
    see: &mut dyn FnMut(usize, Text<'_>) -> Result<(), Fault>,
) -> Result<(), Fault> {
    for (line, text) in lines(bytes) {
        let text = bare(&text);
        let text = match text.strip_prefix('#') {
            Some(comment) => Text::Comment(comment.trim_start_matches(['#', ' '])),
            None if text.trim().is_empty() => Text::Empty,
            None => Text::Row(text),
        };
        see(line, text)?;
    }
    Ok(())
}

/// Returns the frame that 3D Slicer notes in a comment, as in `CoordinateSystem = LPS`.
fn noted_frame(comment: &str) -> Option<Frame> {
    let (name, value) = comment.split_once('=')?;
    let is_frame = name.trim().eq_ignore_ascii_case("CoordinateSystem");
    match value.trim() {
        "LPS" | "1" if is_frame => Some(Frame::Lps),
        "RAS" | "0" if is_frame => Some(Frame::Ras),
        _ => None,
    }
}

/// Returns the line without the brackets and the comma in which numpy prints matrices.
fn bare(line: &str) -> &str {
    let inside = line.trim_matches([' ', '\r']);
    let inside = inside.strip_suffix("],").unwrap_or(inside);
    let bare = inside.trim_matches(['[', ']', ' ']);
    // More brackets enclose units.
    if bare.contains('[') { inside } else { bare }
}

/// The characters that separate columns, the first that a line has.
const MARKS: [char; 3] = [';', '\t', ','];

/// Returns the characters outside quotes.
fn outside(line: &str) -> impl Iterator<Item = (usize, char)> {
    let mut is_quoted = false;
    line.char_indices().filter(move |&(_, c)| {
        is_quoted ^= c == '"';
        !is_quoted
    })
}

fn has(line: &str, mark: char) -> bool {
    outside(line).any(|(_, c)| c == mark)
}

/// Returns the words between marks, or between spaces. Empty words count between marks.
fn split(line: &str, mark: Option<char>) -> impl Iterator<Item = &str> {
    let is_mark = move |c: char| mark.map_or(c.is_whitespace(), |mark| c == mark);
    let marks = outside(line).filter(move |&(_, c)| is_mark(c));
    let ends = marks.map(|(end, c)| [end, end + c.len_utf8()]).chain([[line.len(); 2]]);
    let mut from = 0;
    let words = ends.map(move |[end, next]| {
        let word = &line[std::mem::replace(&mut from, next)..end];
        word.trim().trim_matches('"').trim()
    });
    words.filter(move |word| mark.is_some() || !word.is_empty())
}

/// Returns the character that separates the columns of a line: a semicolon, else a tab, else a
/// comma; `None` for spaces. With both tabs and commas, commas are decimal commas only if the words
/// between tabs are numbers.
fn separator(line: &str) -> Option<char> {
    let is_decimal = || split(line, Some('\t')).all(|word| number(word).is_some());
    let is_mark = |mark: char| has(line, mark) && (mark != '\t' || !has(line, ',') || is_decimal());
    MARKS.into_iter().find(|&mark| is_mark(mark))
}

/// Returns the words of a line. `mark` is the separator of the heading.
fn columns(line: usize, text: &str, mark: Option<char>) -> Result<Vec<&str>, Fault> {
    let mark = mark.filter(|&mark| has(text, mark)).or_else(|| separator(text));
    let words: Vec<_> = split(text, mark).take(MOST_COLUMNS + 1).collect();
    if words.len() > MOST_COLUMNS {
        return fault(line, format!("has more than {MOST_COLUMNS} columns"));
    }
    Ok(words)
}

/// Returns the number in a column.
fn cell(line: usize, words: &[&str], column: usize) -> Result<f64, Fault> {
    let word = words.get(column).copied().unwrap_or_default();
    let wrong = || match word.is_empty() {
        true => format!("has nothing in column {}", column + 1),
        false => format!("has '{}' in column {}", shown(word), column + 1),
    };
    number(word).ok_or_else(|| Fault { line, problem: wrong() })
}

/// Parses a number with a decimal point or comma.
fn number(word: &str) -> Option<f64> {
    let is_comma = word.matches(',').count() == 1 && !word.contains('.');
    if is_comma { word.replace(',', ".").parse().ok() } else { word.parse().ok() }
}

/// Returns the heading in a line: names of three coordinates; or words without a digit, none of
/// which is a number or missing.
fn heading(line: usize, words: &[&str]) -> Option<Heading> {
    let is_name = |word: &&str| word.contains(char::is_alphabetic) && number(word).is_none();
    let names = names(words);
    let is_heading =
        has_coordinates(&names) || words.iter().all(is_name) && !names.iter().any(Name::has_digit);
    is_heading.then_some(Heading { line, names })
}
