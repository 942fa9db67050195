//! Reads VTK's legacy files with PolyData or unstructured cells, in text or big-endian binary, of
//! any version. Cells are counts and points, or since version 5.1 an array of offsets and an array
//! of points.

use super::poly_data::PolyData;
use crate::mesh::Frame;
use crate::text::{frame_named, no_number, noted_frame, shown};

/// The rest of the file.
struct Reader<'a> {
    bytes: &'a [u8],
    /// The last byte of each line: a carriage return if the first line ends with it alone.
    line_end: u8,
    is_binary: bool,
}

impl<'a> Reader<'a> {
    fn line(&mut self) -> Option<&'a str> {
        if self.bytes.is_empty() {
            return None;
        }
        let is_end = |&byte: &u8| byte == self.line_end;
        let end = self.bytes.iter().position(is_end).unwrap_or(self.bytes.len());
        let line = &self.bytes[..end];
        self.bytes = self.bytes.get(end + 1..).unwrap_or_default();
        Some(std::str::from_utf8(line).unwrap_or(NO_TEXT).trim())
    }

    /// Returns the words of the next line that is not empty.
    fn words(&mut self) -> Vec<&'a str> {
        loop {
            match self.line().map(words) {
                Some(words) if words.is_empty() => {}
                words => return words.unwrap_or_default(),
            }
        }
    }

    fn word(&mut self) -> Result<&'a str, String> {
        let from = self.bytes.iter().position(|byte| !byte.is_ascii_whitespace()).ok_or(SHORT)?;
        let rest = &self.bytes[from..];
        let end = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        self.bytes = &rest[end..];
        std::str::from_utf8(&rest[..end])
            .map_err(|_| "it has no text where a number should be".into())
    }

    /// Returns `count` numbers of this type. Memory is allocated only for numbers that exist.
    fn numbers(&mut self, count: usize, kind: Kind) -> Result<Vec<f64>, String> {
        if !self.is_binary {
            let number =
                |word: &str| word.parse().map_err(|_| format!("it has {}", no_number(word)));
            return (0..count).map(|_| self.word().and_then(number)).collect();
        }
        let own = self.take(count, kind.size)?;
        let wide =
            |bytes: &[u8]| bytes.iter().fold(0_u64, |number, &byte| number << 8 | u64::from(byte));
        let number = |bytes: &[u8]| {
            let bits = wide(bytes);
            match (kind.class, kind.size) {
                (Class::Float, 4) => f64::from(f32::from_bits(bits as u32)),
                (Class::Float, _) => f64::from_bits(bits),
                (Class::Signed, 1) => f64::from(bits as i8),
                (Class::Signed, 2) => f64::from(bits as i16),
                (Class::Signed, 4) => f64::from(bits as i32),
                (Class::Signed, _) => bits as i64 as f64,
                (Class::Unsigned, _) => bits as f64,
            }
        };
        Ok(own.chunks_exact(kind.size).map(number).collect())
    }

    fn take(&mut self, count: usize, size: usize) -> Result<&'a [u8], String> {
        let length =
            count.checked_mul(size).filter(|&length| length <= self.bytes.len()).ok_or(SHORT)?;
        let (own, rest) = self.bytes.split_at(length);
        self.bytes = rest;
        Ok(own)
    }

    fn indices(&mut self, count: usize, kind: Kind) -> Result<Vec<u64>, String> {
        let index = |number: f64| {
            // Above 2^53 consecutive integers are no longer distinct.
            let is_index = number >= 0.0 && number.fract() == 0.0 && number < 9e15;
            is_index
                .then_some(number as u64)
                .ok_or_else(|| format!("{number} is no number of a point"))
        };
        self.numbers(count, kind)?.into_iter().map(index).collect()
    }

    /// Returns the type with the size that this machine's file uses: of the sizes that the type has
    /// on different machines, the first one for which `fits` accepts the bytes after `count`
    /// numbers.
    fn sized(
        &self,
        count: usize,
        name: &str,
        fits: impl Fn(&[u8]) -> bool,
    ) -> Result<Kind, String> {
        let (class, sizes) = Kind::named(name)?;
        let is_it = |size: usize| {
            let after = count.checked_mul(size).and_then(|length| self.bytes.get(length..));
            after.is_some_and(|after| fits(after.trim_ascii_start()))
        };
        let size =
            sizes.iter().copied().find(|&size| sizes.len() == 1 || !self.is_binary || is_it(size));
        Ok(Kind { class, size: size.unwrap_or(sizes[0]) })
    }

    /// Returns the cells of a section, each as its points. `first` and `second` are the numbers in
    /// its head: cells and numbers, or offsets and points.
    fn cells(&mut self, first: usize, second: usize) -> Result<Vec<Vec<u64>>, String> {
        let before = self.bytes;
        let ["OFFSETS", name] = self.line().map(words).unwrap_or_default()[..] else {
            self.bytes = before;
            let all = self.indices(second, Kind { class: Class::Signed, size: 4 })?;
            let (mut rest, mut cells) = (&all[..], Vec::new());
            while let Some((&count, others)) = rest.split_first() {
                let count = usize::try_from(count)
                    .ok()
                    .filter(|&count| count <= others.len())
                    .ok_or(SHORT)?;
                let (own, next) = others.split_at(count);
                cells.push(own.to_vec());
                rest = next;
            }
            if cells.len() != first {
                return Err(format!("a section counts {first} cells, but has {}", cells.len()));
            }
            return Ok(cells);
        };
        const NEXT: &str = "CONNECTIVITY";
        let kind = self.sized(first, name, |after| after.starts_with(NEXT.as_bytes()))?;
        let offsets = self.indices(first, kind)?;
        let points = match self.words()[..] {
            [NEXT, own] if own == name => self.indices(second, kind)?,
            [NEXT, own] => {
                let kind = self.sized(second, own, is_head)?;
                self.indices(second, kind)?
            }
            _ => return Err("its OFFSETS are not followed by CONNECTIVITY".into()),
        };
        let ends = [offsets.first(), offsets.last()].map(|end| end.copied().unwrap_or_default());
        if ends != [0, points.len() as u64] {
            return Err("its OFFSETS do not fit its CONNECTIVITY".into());
        }
        let cell = |ends: &[u64]| {
            let [from, to] =
                [ends[0], ends[1]].map(|end| usize::try_from(end).unwrap_or(usize::MAX));
            points
                .get(from..to)
                .map(<[u64]>::to_vec)
                .ok_or_else(|| "its OFFSETS do not fit its CONNECTIVITY".to_owned())
        };
        offsets.windows(2).map(cell).collect()
    }

    /// Skips the arrays of a field. Returns the frame that 3D Slicer writes in one of them.
    fn field(&mut self, arrays: usize) -> Result<Option<Frame>, String> {
        let mut frame = None;
        for _ in 0..arrays {
            let mut head = self.words();
            while head.first() == Some(&"METADATA") {
                self.metadata();
                head = self.words();
            }
            let [name, components, tuples, kind] = head[..] else {
                return Err(format!(
                    "a field has '{}' where an array should begin",
                    shown(&head.join(" "))
                ));
            };
            let count = |word: &str| {
                word.parse::<usize>()
                    .map_err(|_| format!("the array '{}' has {}", shown(name), no_number(word)))
            };
            let count = count(components)?.checked_mul(count(tuples)?).ok_or(SHORT)?;
            match kind.to_ascii_lowercase().as_str() {
                "string" | "utf8_string" => {
                    for _ in 0..count {
                        let text = self.text()?;
                        if name == "SPACE" {
                            frame = frame.or(frame_named(text));
                        }
                    }
                }
                "bit" if self.is_binary => drop(self.take(count.div_ceil(8), 1)?),
                _ if self.is_binary => {
                    let kind = self.sized(count, kind, is_head)?;
                    self.take(count, kind.size)?;
                }
                _ => drop(self.numbers(count, Kind { class: Class::Float, size: 8 })?),
            }
        }
        Ok(frame)
    }

    /// Returns a text of an array: a line, or its length and its bytes. The first two bits state
    /// the number of bytes of the length.
    fn text(&mut self) -> Result<&'a [u8], String> {
        if !self.is_binary {
            return Ok(self.line().ok_or(SHORT)?.as_bytes());
        }
        let &first = self.bytes.first().ok_or(SHORT)?;
        let size = [8, 4, 2, 1][usize::from(first >> 6)];
        let wide =
            self.take(1, size)?.iter().fold(0_u64, |number, &byte| number << 8 | u64::from(byte));
        let length = wide & !(3 << (8 * size - 2));
        self.take(usize::try_from(length).map_err(|_| SHORT)?, 1)
    }

    /// Skips to the next empty line, or to the next section if the line is missing.
    fn metadata(&mut self) {
        while !starts_cells(self.bytes) && self.line().is_some_and(|line| !line.is_empty()) {}
    }
}

#[derive(Clone, Copy)]
enum Class {
    Float,
    Signed,
    Unsigned,
}

/// The type of numbers, with its size in bytes.
#[derive(Clone, Copy)]
struct Kind {
    class: Class,
    size: usize,
}

impl Kind {
    /// Returns a type by its name, with the sizes that it has on different machines.
    fn named(name: &str) -> Result<(Class, &'static [usize]), String> {
        Ok(match name.to_ascii_lowercase().as_str() {
            "char" | "signed_char" | "vtktypeint8" => (Class::Signed, &[1]),
            "unsigned_char" | "vtktypeuint8" => (Class::Unsigned, &[1]),
            "short" | "vtktypeint16" => (Class::Signed, &[2]),
            "unsigned_short" | "vtktypeuint16" => (Class::Unsigned, &[2]),
            "int" | "vtktypeint32" => (Class::Signed, &[4]),
            "unsigned_int" | "vtktypeuint32" => (Class::Unsigned, &[4]),
            "vtktypeint64" | "long_long" => (Class::Signed, &[8]),
            "vtktypeuint64" | "unsigned_long_long" => (Class::Unsigned, &[8]),
            "long" | "vtkidtype" => (Class::Signed, &[8, 4]),
            "unsigned_long" => (Class::Unsigned, &[8, 4]),
            "float" => (Class::Float, &[4]),
            "double" => (Class::Float, &[8]),
            _ => return Err(format!("its numbers of type '{}' cannot be read", shown(name))),
        })
    }
}

/// The number of sections with points or cells.
const GEOMETRY: usize = 6;

/// The sections of a file, those with points or cells first.
const SECTIONS: [&str; 12] = [
    "POINTS",
    "LINES",
    "POLYGONS",
    "TRIANGLE_STRIPS",
    "CELLS",
    "CELL_TYPES",
    "VERTICES",
    "METADATA",
    "FIELD",
    "POINT_DATA",
    "CELL_DATA",
    "DATASET",
];

/// Returns whether the head of a section or of an array follows, or the end of the file.
fn is_head(after: &[u8]) -> bool {
    let line = after.split(|byte| b"\r\n".contains(byte)).next().unwrap_or_default();
    let Ok(line) = std::str::from_utf8(line) else { return false };
    match words(line)[..] {
        [] => after.is_empty(),
        [_, components, tuples, kind]
            if components.parse::<usize>().is_ok() && tuples.parse::<usize>().is_ok() =>
        {
            ["string", "utf8_string", "bit"].contains(&kind.to_ascii_lowercase().as_str())
                || Kind::named(kind).is_ok()
        }
        [first, ..] => SECTIONS.contains(&first.to_ascii_uppercase().as_str()),
    }
}

/// Returns whether the head of a section of points or cells follows.
fn starts_cells(after: &[u8]) -> bool {
    let is_it = |name: &&str| {
        after.get(..name.len()).is_some_and(|word| word.eq_ignore_ascii_case(name.as_bytes()))
    };
    let Some(name) = SECTIONS[..GEOMETRY].iter().find(|name| is_it(name)) else { return false };
    let line = after[name.len()..].split(|byte| b"\r\n".contains(byte)).next();
    let Ok(line) = std::str::from_utf8(line.unwrap_or_default()) else { return false };
    let words = words(line);
    line.starts_with([' ', '\t'])
        && (1..=2).contains(&words.len())
        && words[0].parse::<usize>().is_ok()
}

fn words(line: &str) -> Vec<&str> {
    line.split_whitespace().collect()
}

pub fn read(bytes: &[u8]) -> Result<PolyData, String> {
    let first_end = bytes.iter().position(|byte| b"\r\n".contains(byte)).unwrap_or(bytes.len());
    let is_alone =
        bytes[first_end..].first() == Some(&b'\r') && bytes.get(first_end + 1) != Some(&b'\n');
    let line_end = if is_alone { b'\r' } else { b'\n' };
    let mut file = Reader { bytes, line_end, is_binary: false };
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
    let mut cells = None;
    while let Some(line) = file.line() {
        let words = words(line);
        let twice = || Err(format!("it has '{}', but another section of this kind", shown(line)));
        let number = |place: usize| -> Result<usize, String> {
            let word = words
                .get(place)
                .ok_or_else(|| format!("'{}' ends where a number should be", shown(line)))?;
            word.parse().map_err(|_| {
                format!("'{}' has '{}' where a number should be", shown(line), shown(word))
            })
        };
        match words.first().map(|word| word.to_ascii_uppercase()).as_deref() {
            None => {}
            Some("DATASET") => {
                let kind = words.get(1).copied().unwrap_or_default();
                if !["POLYDATA", "UNSTRUCTURED_GRID"].contains(&kind.to_ascii_uppercase().as_str())
                {
                    return Err(
                        "it holds no PolyData; export the centreline or the surface as PolyData"
                            .into(),
                    );
                }
            }
            Some("POINTS" | "LINES" | "POLYGONS" | "TRIANGLE_STRIPS" | "CELLS" | "CELL_TYPES")
                if words.len() > 3 =>
            {
                return Err(format!("it has '{}', which is no head of a section", shown(line)));
            }
            Some("POINTS") if !found.points.is_empty() => return twice(),
            Some("POINTS") => {
                let count = number(1)?.checked_mul(3).ok_or(SHORT)?;
                let kind = file.sized(count, words.get(2).copied().unwrap_or("float"), is_head)?;
                let numbers = file.numbers(count, kind)?;
                found.points = numbers.as_chunks().0.to_vec();
            }
            Some("LINES") => found.lines.extend(file.cells(number(1)?, number(2)?)?),
            Some("POLYGONS") => found.polygons.extend(file.cells(number(1)?, number(2)?)?),
            Some("TRIANGLE_STRIPS") => found.strips.extend(file.cells(number(1)?, number(2)?)?),
            Some("VERTICES") => drop(file.cells(number(1)?, number(2)?)?),
            Some("CELLS") if cells.is_some() => return twice(),
            Some("CELLS") => cells = Some(file.cells(number(1)?, number(2)?)?),
            Some("CELL_TYPES") => {
                let types = file.numbers(number(1)?, Kind { class: Class::Signed, size: 4 })?;
                sort(&mut found, cells.take().unwrap_or_default(), &types)?;
            }
            Some("METADATA") => file.metadata(),
            Some("FIELD") => found.frame = found.frame.or(file.field(number(2)?)?),
            // The rest are data of the points and cells.
            Some("POINT_DATA" | "CELL_DATA") => {
                let rest = file.bytes;
                let after_end = |(at, byte): (usize, &u8)| b"\r\n".contains(byte).then_some(at + 1);
                let mut starts = rest.iter().enumerate().filter_map(after_end);
                if starts_cells(rest) || starts.any(|start| starts_cells(&rest[start..])) {
                    return Err("it has points or cells after their data; sort its sections".into());
                }
                break;
            }
            Some(_) => {
                return Err(format!("it has '{}' where a section should begin", shown(line)));
            }
        }
    }
    if cells.is_some() {
        return Err("its CELLS have no CELL_TYPES".into());
    }
    found.frame = found.frame.or(noted_frame(bytes));
    Ok(found)
}

/// Adds the cells of an unstructured grid by their types.
fn sort(found: &mut PolyData, cells: Vec<Vec<u64>>, types: &[f64]) -> Result<(), String> {
    if cells.len() != types.len() {
        return Err(format!("it has {} cells, but {} types of cells", cells.len(), types.len()));
    }
    for (cell, &kind) in cells.into_iter().zip(types) {
        let wrong = |what: &str| {
            Err(format!("it has cells of type {kind}, which {what}; extract the surface"))
        };
        // A fraction is no type.
        match if kind.fract() == 0.0 { kind as u8 } else { 0 } {
            // Vertices.
            1 | 2 => {}
            3 | 4 => found.lines.push(cell),
            6 => found.strips.push(cell),
            5 | 7 | 9 => found.polygons.push(cell),
            // A pixel: row by row instead of around.
            8 => match cell[..] {
                [a, b, c, d] => found.polygons.push(vec![a, b, d, c]),
                _ => return wrong("have 4 points"),
            },
            _ => return wrong("are no surface"),
        }
    }
    Ok(())
}

const SHORT: &str = "it is shorter than it says";
/// Stands for a line of bytes that are no text.
const NO_TEXT: &str = "bytes";
