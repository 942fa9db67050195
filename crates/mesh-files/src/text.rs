//! The lines of a text file, and the format that a file's first bytes indicate.

use crate::Frame;
use std::borrow::Cow;

/// Returns the bytes without a byte order mark.
pub fn without_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)
}

/// Converts UTF-16, which a byte order mark states, to UTF-8. Other bytes stay as they are.
#[cfg(feature = "centrelines")]
pub fn from_utf16(bytes: &[u8]) -> Cow<'_, [u8]> {
    let (read, own): (fn([u8; 2]) -> u16, _) = match bytes {
        [0xff, 0xfe, own @ ..] => (u16::from_le_bytes, own),
        [0xfe, 0xff, own @ ..] => (u16::from_be_bytes, own),
        _ => return bytes.into(),
    };
    let units = own.as_chunks().0.iter().copied().map(read);
    let text = char::decode_utf16(units).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER));
    text.collect::<String>().into_bytes().into()
}

/// The ends of lines. Programs that translate the ends of lines twice write the first one.
const ENDS: [&[u8]; 4] = [b"\r\r\n", b"\r\n", b"\n", b"\r"];

/// Returns the lines with their numbers, counted from 1. The ends of lines may differ in a file.
pub fn lines(bytes: &[u8]) -> impl Iterator<Item = (usize, Cow<'_, str>)> {
    let mut rest = without_mark(bytes);
    (1..).map_while(move |number| {
        if rest.is_empty() {
            return None;
        }
        let end = rest.iter().position(|byte| b"\r\n".contains(byte)).unwrap_or(rest.len());
        let (line, after) = rest.split_at(end);
        rest = ENDS.iter().find_map(|end| after.strip_prefix(*end)).unwrap_or_default();
        Some((number, String::from_utf8_lossy(line)))
    })
}

/// Parses a coordinate.
pub fn number(word: Option<&str>, line: usize) -> Result<f64, String> {
    let word = word.ok_or_else(|| format!("line {line} ends where a number should be"))?;
    word.parse().map_err(|_| format!("line {line} has {}", no_number(word)))
}

/// Returns the message for a word that is not a number.
pub fn no_number(word: &str) -> String {
    let remedy = if word.contains(',') { "; write decimals with a point" } else { "" };
    format!("'{}' where a number should be{remedy}", shown(word))
}

/// Returns a word as a message can show it: short, and on one line.
pub fn shown(word: &str) -> String {
    let printable = |c: char| if c.is_control() { '?' } else { c };
    let short: String = word.chars().take(20).map(printable).collect();
    if short.len() < word.len() { short + "..." } else { short }
}

/// Returns the format that the first bytes indicate, if any; the file's name is ignored.
pub fn looks_like(bytes: &[u8]) -> Option<&'static str> {
    let start = without_mark(bytes);
    let start = &start[..start.len().min(4096)];
    if start.starts_with(b"NRRD000") {
        return Some("NRRD");
    }
    if start.starts_with(b"PK\x03\x04") {
        return Some("a zip archive");
    }
    if [&b"ni1\0"[..], b"n+1\0"].iter().any(|magic| bytes.get(344..348) == Some(magic)) {
        return Some("NIfTI");
    }
    if start.starts_with(b"# vtk DataFile") {
        return Some("VTK");
    }
    if start.windows(8).any(|window| window == b"<VTKFile") {
        return Some("VTK XML");
    }
    let text = std::str::from_utf8(start.strip_suffix(b"\xef").unwrap_or(start)).ok()?;
    let mut words = text.lines().filter_map(|line| line.split_whitespace().next());
    let first = words.find(|word| !word.starts_with('#'))?;
    match first.to_ascii_lowercase().as_str() {
        "ply" => Some("PLY"),
        "solid" => Some("STL"),
        "v" | "vn" | "vt" | "o" | "g" | "mtllib" => Some("OBJ"),
        word if word.starts_with('<') => Some("XML or HTML"),
        _ => None,
    }
}

/// Returns the frame that 3D Slicer writes at the head of its files of triangles.
pub fn noted_frame(bytes: &[u8]) -> Option<Frame> {
    let head = &bytes[..bytes.len().min(1000)];
    let note = head.windows(9).find(|window| window.starts_with(b"SPACE="))?;
    frame_named(&note[6..])
}

pub fn frame_named(name: &[u8]) -> Option<Frame> {
    match name {
        b"RAS" => Some(Frame::Ras),
        b"LPS" => Some(Frame::Lps),
        _ => None,
    }
}

/// Converts a length to millimetres. `unit` is the number of millimetres of its unit.
#[cfg(feature = "centrelines")]
pub fn to_mm(length: f64, unit: f64) -> f64 {
    // Division by a whole number is exact; multiplication by its inverse is not.
    if unit < 1.0 { length / (1.0 / unit).round() } else { length * unit }
}

/// Returns the number of millimetres of a unit of length, by its name.
#[cfg(any(feature = "centrelines", feature = "label-maps"))]
pub fn unit_in_mm(name: &str) -> Option<f64> {
    Some(match name {
        "mm" | "millimeter" | "millimeters" | "millimetre" | "millimetres" => 1.0,
        "m" | "meter" | "meters" | "metre" | "metres" => 1000.0,
        "cm" | "centimeter" | "centimeters" | "centimetre" | "centimetres" => 10.0,
        "um" | "\u{b5}m" | "\u{3bc}m" | "micron" | "microns" | "micrometer" | "micrometers"
        | "micrometre" => 1e-3,
        _ => return None,
    })
}
