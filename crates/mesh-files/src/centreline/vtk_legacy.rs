//! VTK's legacy files with PolyData, in text or binary (whose numbers are big-endian), of any version: lines are counts
//! and points, or since 5.1 an array of offsets and one of points.

use super::{Lines, PolyData};
use crate::text::{noted_frame, shown};

/// What is left of the file.
struct Reader<'a> {
    bytes: &'a [u8],
    is_binary: bool,
}

impl<'a> Reader<'a> {
    fn line(&mut self) -> Option<&'a str> {
        if self.bytes.is_empty() {
            return None;
        }
        let end = self.bytes.iter().position(|&byte| byte == b'\n').unwrap_or(self.bytes.len());
        let line = &self.bytes[..end];
        self.bytes = self.bytes.get(end + 1..).unwrap_or_default();
        Some(std::str::from_utf8(line).unwrap_or("").trim())
    }

    fn word(&mut self) -> Result<&'a str, String> {
        let from = self.bytes.iter().position(|byte| !byte.is_ascii_whitespace()).ok_or(SHORT)?;
        let rest = &self.bytes[from..];
        let end = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        self.bytes = &rest[end..];
        std::str::from_utf8(&rest[..end]).map_err(|_| "it has no text where a number should be".into())
    }

    /// So many numbers of this type. Nothing is kept for numbers that are not there.
    fn numbers(&mut self, count: usize, kind: &str) -> Result<Vec<f64>, String> {
        let size = match kind.to_ascii_lowercase().as_str() {
            "char" | "unsigned_char" => 1,
            "short" | "unsigned_short" => 2,
            "int" | "unsigned_int" | "float" => 4,
            // Programs disagree about longs, and VTK writes vtktypeint64 instead.
            "double" | "vtktypeint64" | "vtkidtype" => 8,
            _ => return Err(format!("its numbers of type '{}' cannot be read", shown(kind))),
        };
        if !self.is_binary {
            let number = |word: &str| {
                word.parse().map_err(|_| format!("it has '{}' where a number should be", shown(word)))
            };
            return (0..count).map(|_| self.word().and_then(number)).collect();
        }
        let length = count.checked_mul(size).filter(|&length| length <= self.bytes.len()).ok_or(SHORT)?;
        let (own, rest) = self.bytes.split_at(length);
        self.bytes = rest;
        let wide = |bytes: &[u8]| bytes.iter().fold(0_u64, |number, &byte| number << 8 | u64::from(byte));
        let number = |bytes: &[u8]| {
            let bits = wide(bytes);
            match kind.to_ascii_lowercase().as_str() {
                "float" => f64::from(f32::from_bits(bits as u32)),
                "double" => f64::from_bits(bits),
                "char" => f64::from(bits as i8),
                "short" => f64::from(bits as i16),
                "int" => f64::from(bits as i32),
                _ => bits as f64,
            }
        };
        Ok(own.chunks_exact(size).map(number).collect())
    }

    fn indices(&mut self, count: usize, kind: &str) -> Result<Vec<u64>, String> {
        let index = |number: f64| {
            // Above 2^53 no number is the next of another.
            let is_index = number >= 0.0 && number.fract() == 0.0 && number < 9e15;
            is_index.then_some(number as u64).ok_or_else(|| format!("{number} is no number of a point"))
        };
        self.numbers(count, kind)?.into_iter().map(index).collect()
    }

    /// The cells of a section, each by its points.
    fn cells(&mut self, first: usize, second: usize) -> Result<Vec<Vec<u64>>, String> {
        let before = self.bytes;
        let Some(["OFFSETS", kind]) =
            self.line().map(words).as_deref().and_then(|words| words.first_chunk::<2>().copied())
        else {
            self.bytes = before;
            let all = self.indices(second, "int")?;
            let (mut rest, mut cells) = (&all[..], Vec::new());
            while let Some((&count, others)) = rest.split_first() {
                let count =
                    usize::try_from(count).ok().filter(|&count| count <= others.len()).ok_or(SHORT)?;
                let (own, next) = others.split_at(count);
                cells.push(own.to_vec());
                rest = next;
            }
            return Ok(cells);
        };
        let offsets = self.indices(first, kind)?;
        let mut head = self.line().map(words);
        if head.as_ref().is_some_and(Vec::is_empty) {
            head = self.line().map(words);
        }
        let Some(["CONNECTIVITY", kind]) =
            head.as_deref().and_then(|words| words.first_chunk::<2>().copied())
        else {
            return Err("its OFFSETS are not followed by CONNECTIVITY".into());
        };
        let points = self.indices(second, kind)?;
        let cell = |ends: &[u64]| {
            let [from, to] = [ends[0], ends[1]].map(|end| usize::try_from(end).unwrap_or(usize::MAX));
            points
                .get(from..to)
                .map(<[u64]>::to_vec)
                .ok_or_else(|| "its OFFSETS do not fit its CONNECTIVITY".to_owned())
        };
        offsets.windows(2).map(cell).collect()
    }
}

fn words(line: &str) -> Vec<&str> {
    line.split_whitespace().collect()
}

pub fn read(bytes: &[u8]) -> Result<Lines, String> {
    let mut file = Reader { bytes, is_binary: false };
    if !file.line().is_some_and(|line| line.starts_with("# vtk DataFile")) {
        return Err("it does not begin with '# vtk DataFile'".into());
    }
    let _title = file.line();
    match file.line().map(str::to_ascii_uppercase).as_deref() {
        Some("ASCII") => {}
        Some("BINARY") => file.is_binary = true,
        _ => return Err("its third line is neither ASCII nor BINARY".into()),
    }
    let mut found = PolyData::default();
    while let Some(line) = file.line() {
        let words = words(line);
        let number = |place: usize| -> Result<usize, String> {
            let word =
                words.get(place).ok_or_else(|| format!("'{}' ends where a number should be", shown(line)))?;
            word.parse()
                .map_err(|_| format!("'{}' has '{}' where a number should be", shown(line), shown(word)))
        };
        match words.first().map(|word| word.to_ascii_uppercase()).as_deref() {
            None => {}
            Some("DATASET") if words.get(1).is_some_and(|kind| kind.eq_ignore_ascii_case("POLYDATA")) => {}
            Some("DATASET") => return Err("it holds no PolyData; export the centreline as PolyData".into()),
            Some("POINTS") => {
                let count = number(1)?.checked_mul(3).ok_or(SHORT)?;
                let numbers = file.numbers(count, words.get(2).copied().unwrap_or("float"))?;
                found.points = numbers.as_chunks().0.to_vec();
            }
            Some("LINES") => found.lines.extend(file.cells(number(1)?, number(2)?)?),
            Some("VERTICES" | "POLYGONS" | "TRIANGLE_STRIPS") => drop(file.cells(number(1)?, number(2)?)?),
            Some("METADATA") => while file.line().is_some_and(|line| !line.is_empty()) {},
            // What follows belongs to the points and cells.
            Some("POINT_DATA" | "CELL_DATA" | "FIELD") => break,
            Some(_) => return Err(format!("it has '{}' where a section should begin", shown(line))),
        }
    }
    Ok(Lines { lines: found.resolve()?, frame: noted_frame(bytes) })
}

const SHORT: &str = "it is shorter than it says";
