//! Reads PLY files, ASCII and binary. Polygons and strips are triangulated, and faces without area
//! are left out.
//!
//! The crates for PLY refuse files that other programs read: numbers such as `30.`, one value a
//! line, blank lines, comments in Latin-1, lines that end in carriage returns. So this module
//! parses the format itself.

use crate::mesh::Mesh;
use crate::polygon::Faces;
use crate::text::{no_number, noted_frame, shown, without_mark};

/// The names of a face's list of vertices.
const CORNERS: [&str; 2] = ["vertex_indices", "vertex_index"];

/// The index that ends a strip and begins the next one.
const RESTART: f64 = -1.0;

/// The type of a number.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Kind {
    fn of(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }
}

struct Property {
    name: String,
    kind: Kind,
    /// The type of the count, for a list.
    count: Option<Kind>,
}

struct Element {
    name: String,
    count: u64,
    properties: Vec<Property>,
}

/// The data after the header.
enum Body<'a> {
    Text(&'a [u8]),
    Bytes { rest: &'a [u8], is_big_endian: bool },
}

/// Why the next number could not be read.
enum Fault<'a> {
    End,
    Word(&'a [u8]),
}

impl<'a> Body<'a> {
    fn next(&mut self, kind: Kind) -> Result<f64, Fault<'a>> {
        match self {
            Self::Text(rest) => {
                let word = next_word(rest).ok_or(Fault::End)?;
                let number = std::str::from_utf8(word).ok().and_then(|word| word.parse().ok());
                number.ok_or(Fault::Word(word))
            }
            Self::Bytes { rest, is_big_endian } => {
                let is_big_endian = *is_big_endian;
                Ok(match kind {
                    Kind::I8 => i8::from_le_bytes(take(rest, is_big_endian)?).into(),
                    Kind::U8 => u8::from_le_bytes(take(rest, is_big_endian)?).into(),
                    Kind::I16 => i16::from_le_bytes(take(rest, is_big_endian)?).into(),
                    Kind::U16 => u16::from_le_bytes(take(rest, is_big_endian)?).into(),
                    Kind::I32 => i32::from_le_bytes(take(rest, is_big_endian)?).into(),
                    Kind::U32 => u32::from_le_bytes(take(rest, is_big_endian)?).into(),
                    Kind::F32 => f32::from_le_bytes(take(rest, is_big_endian)?).into(),
                    Kind::F64 => f64::from_le_bytes(take(rest, is_big_endian)?),
                })
            }
        }
    }
}

fn is_space(byte: &u8) -> bool {
    byte.is_ascii_whitespace() || *byte == b'\x0b'
}

fn next_word<'a>(rest: &mut &'a [u8]) -> Option<&'a [u8]> {
    let from = rest.iter().position(|byte| !is_space(byte))?;
    let length = rest[from..].iter().position(is_space).unwrap_or(rest.len() - from);
    let (word, others) = rest[from..].split_at(length);
    *rest = others;
    Some(word)
}

/// Returns the next bytes in little-endian order.
fn take<'a, const SIZE: usize>(
    rest: &mut &'a [u8],
    is_big_endian: bool,
) -> Result<[u8; SIZE], Fault<'a>> {
    let (&own, others) = rest.split_first_chunk::<SIZE>().ok_or(Fault::End)?;
    *rest = others;
    let mut own = own;
    if is_big_endian {
        own.reverse();
    }
    Ok(own)
}

pub fn read(bytes: &[u8]) -> Result<Mesh, String> {
    let (elements, mut body) = header(without_mark(bytes))?;
    let mut mesh = Mesh { frame: noted_frame(bytes), ..Mesh::default() };
    let mut faces = Faces::default();
    for element in &elements {
        let has =
            |axis: &&str| element.properties.iter().any(|p| p.name == *axis && p.count.is_none());
        if element.name == "vertex"
            && let Some(axis) = ["x", "y", "z"].iter().find(|axis| !has(axis))
        {
            return Err(format!("its vertices have no property '{axis}'"));
        }
        // An element without properties has no bytes, so its count is unlimited.
        if element.properties.is_empty() {
            continue;
        }
        for index in 0..element.count {
            read_element(element, index, &mut body, &mut mesh, &mut faces)?;
        }
    }
    // Blank bytes may follow the data. The count of a face is none of them.
    let is_blank = |byte: &u8| [0, 0x1a].contains(byte) || is_space(byte);
    match body {
        Body::Text(mut rest) => {
            if let Some(word) = next_word(&mut rest)
                && !word.iter().all(is_blank)
            {
                return Err(format!(
                    "it has more numbers than its header announces, the first one is '{}'",
                    shown(&String::from_utf8_lossy(word))
                ));
            }
        }
        Body::Bytes { rest, .. } => {
            if !rest.iter().all(is_blank) {
                let more = rest.len();
                return Err(format!("it has {more} more bytes than its header announces"));
            }
        }
    }
    faces.cut(&mut mesh)?;
    Ok(mesh)
}

fn read_element(
    element: &Element,
    index: u64,
    body: &mut Body<'_>,
    mesh: &mut Mesh,
    faces: &mut Faces,
) -> Result<(), String> {
    let (name, count) = (shown(&element.name), element.count);
    let fault = |fault: Fault<'_>| match fault {
        Fault::End => format!("the {count} of element '{name}' end early"),
        Fault::Word(word) => {
            let word = no_number(&String::from_utf8_lossy(word));
            format!("{index} of element '{name}', counted from 0, has {word}")
        }
    };
    let mut place = [f64::NAN; 3];
    let mut list = None;
    let is_of_faces = ["face", "tristrips"].contains(&element.name.as_str());
    for property in &element.properties {
        let Some(kind) = property.count else {
            let number = body.next(property.kind).map_err(fault)?;
            if let Some(axis) = ["x", "y", "z"].iter().position(|axis| property.name == *axis) {
                place[axis] = number;
            }
            continue;
        };
        let length = body.next(kind).map_err(fault)?;
        if !(length >= 0.0 && length.fract() == 0.0) {
            return Err(format!("{index} of element '{name}' has a list of {length} numbers"));
        }
        let is_of_corners = CORNERS.contains(&property.name.as_str());
        let is_needed = is_of_faces && is_of_corners;
        // Other elements, such as range grids, name at most one vertex.
        if is_of_corners && !is_needed && length >= 3.0 {
            return Err(format!("its element '{name}' has faces; name the element 'face'"));
        }
        let mut numbers = Vec::new();
        for _ in 0..length as u64 {
            let number = body.next(property.kind).map_err(fault)?;
            if is_needed {
                numbers.push(number);
            }
        }
        if is_needed {
            list = Some(numbers);
        }
    }
    let wrong = || format!("{} {index} has no list of vertices, each at least 0", element.name);
    let corner = |&number: &f64| {
        let is_index = number >= 0.0 && number <= u32::MAX.into() && number.fract() == 0.0;
        is_index.then_some(number as u32).ok_or_else(wrong)
    };
    match element.name.as_str() {
        "vertex" => mesh.vertices.push(place),
        "face" => {
            let list = list.ok_or_else(wrong)?;
            faces.push(list.iter().map(corner).collect::<Result<Vec<_>, _>>()?);
        }
        "tristrips" => {
            let list = list.ok_or_else(wrong)?;
            for strip in list.split(|&corner| corner == RESTART).filter(|strip| !strip.is_empty()) {
                faces.push_strip(&strip.iter().map(corner).collect::<Result<Vec<_>, _>>()?);
            }
        }
        _ => {}
    }
    Ok(())
}

const NO_HEADER: &str = "its header does not begin with 'ply' and a format, name elements and properties, and end with 'end_header'";

/// Returns the elements, and the data after the header.
fn header(bytes: &[u8]) -> Result<(Vec<Element>, Body<'_>), String> {
    let rest = bytes.strip_prefix(b"ply").ok_or(NO_HEADER)?;
    let spaces = rest.iter().take_while(|byte| matches!(byte, b' ' | b'\t')).count();
    let rest = &rest[spaces..];
    // In a binary file the byte after a carriage return may belong to the data.
    let ends = [&b"\r\n"[..], b"\n", b"\r"];
    let end = ends.into_iter().find(|end| rest.starts_with(end)).ok_or(NO_HEADER)?;
    let mut rest = &rest[end.len()..];
    let (mut elements, mut format) = (Vec::<Element>::new(), None);
    loop {
        let length = rest.iter().position(|byte| matches!(byte, b'\n' | b'\r')).ok_or(NO_HEADER)?;
        let line = String::from_utf8_lossy(&rest[..length]);
        let is_pair = end != b"\r" && rest[length..].starts_with(b"\r\n");
        rest = &rest[length + if is_pair { 2 } else { 1 }..];
        let words: Vec<_> = line.split_whitespace().collect();
        let wrong =
            || format!("its header has '{}', which is no line of a header", shown(line.trim()));
        let kind = |name: &str| Kind::of(name).ok_or_else(wrong);
        match words[..] {
            [] | ["comment" | "obj_info", ..] => {}
            ["format", name, ..] => format = Some(name.to_owned()),
            ["element", name, count] => {
                let count = count.parse().map_err(|_| wrong())?;
                elements.push(Element { name: name.into(), count, properties: Vec::new() });
            }
            ["property", "list", count, number, name] => {
                let property =
                    Property { name: name.into(), kind: kind(number)?, count: Some(kind(count)?) };
                elements.last_mut().ok_or_else(wrong)?.properties.push(property);
            }
            ["property", number, name] => {
                let property = Property { name: name.into(), kind: kind(number)?, count: None };
                elements.last_mut().ok_or_else(wrong)?.properties.push(property);
            }
            ["end_header"] => break,
            _ => return Err(wrong()),
        }
    }
    let body = match format.as_deref() {
        Some("ascii") => Body::Text(rest),
        Some("binary_little_endian") => Body::Bytes { rest, is_big_endian: false },
        Some("binary_big_endian") => Body::Bytes { rest, is_big_endian: true },
        _ => return Err(NO_HEADER.into()),
    };
    Ok((elements, body))
}
