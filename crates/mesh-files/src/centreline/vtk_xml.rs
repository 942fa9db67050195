//! Reads VTK's XML files with PolyData. Arrays are text, base64, or appended after the XML, and may
//! be compressed by zlib.

use super::data_array::{Arrays, DataArray};
use super::poly_data::PolyData;
use super::xml::{self, Element};
use crate::mesh::Frame;
use crate::text::{frame_named, noted_frame, shown};

pub fn read(bytes: &[u8], limit: u64) -> Result<PolyData, String> {
    // Appended data need not be XML: cut it off, and close the open elements.
    let mark = b"<AppendedData";
    let cut = bytes.windows(mark.len()).position(|window| window == mark);
    let head = &bytes[..cut.unwrap_or(bytes.len())];
    let text = String::from_utf8_lossy(head);
    let root = xml::parse(text.trim_start_matches('\u{feff}'), cut.is_some())?;
    if root.name != "VTKFile" || root.attribute("type") != Some("PolyData") {
        return Err("it holds no PolyData; export the centreline or the surface as PolyData".into());
    }
    let arrays = Arrays::new(&root, cut.map(|cut| &bytes[cut..]), limit)?;
    let mut all = PolyData::default();
    for data in root.children("PolyData") {
        for piece in data.children("Piece") {
            all.append(self::piece(piece, &arrays)?);
        }
        for field in data.children("FieldData") {
            all.frame = all.frame.or(noted_space(field, &arrays));
        }
    }
    all.frame = all.frame.or(noted_frame(head));
    Ok(all)
}

/// Returns the frame that 3D Slicer writes as an array of text. Other arrays of this name are
/// ignored.
fn noted_space(field: &Element, arrays: &Arrays) -> Option<Frame> {
    let is_space = |array: &&Element| array.attribute("Name") == Some("SPACE");
    let array = field.children.iter().find(is_space)?;
    let DataArray::Integers(letters) = arrays.read(array).ok()? else { return None };
    let letters: Option<Vec<u8>> =
        letters.into_iter().map(|letter| u8::try_from(letter).ok()).collect();
    frame_named(letters?.split(|&letter| letter == 0).next()?)
}

/// Reads a piece. Its points and cells must agree with the counts that it states.
fn piece(piece: &Element, arrays: &Arrays) -> Result<PolyData, String> {
    let points = only(piece, "Points")?.and_then(|points| points.child("DataArray"));
    let points = points.map(|points| arrays.read(points)).transpose()?;
    let points = points.map(DataArray::into_numbers).unwrap_or_default();
    if points.len() % 3 != 0 {
        return Err(format!(
            "its points have {} coordinates, which is no multiple of 3",
            shown(&points.len().to_string())
        ));
    }
    let points = points.as_chunks().0.to_vec();
    compare(piece, "Points", points.len())?;
    let cells = |name: &str| {
        let cells = cells(only(piece, name)?, arrays)?;
        compare(piece, name, cells.len())?;
        Ok::<_, String>(cells)
    };
    Ok(PolyData {
        points,
        lines: cells("Lines")?,
        polygons: cells("Polys")?,
        strips: cells("Strips")?,
        frame: None,
    })
}

/// Returns the child of this name.
///
/// # Errors
/// There are several.
fn only<'a>(piece: &'a Element, name: &'a str) -> Result<Option<&'a Element>, String> {
    let mut all = piece.children(name);
    match (all.next(), all.next()) {
        (first, None) => Ok(first),
        _ => Err(format!("a piece has the element {name} twice")),
    }
}

/// Compares the count that a piece states, as in `NumberOfPolys="4"`, with the count that it has.
fn compare(piece: &Element, name: &str, count: usize) -> Result<(), String> {
    let attribute = format!("NumberOf{name}");
    match piece.attribute(&attribute) {
        Some(stated) if stated.trim().parse() != Ok(count) => {
            Err(format!("its {attribute} is {}, but there are {count}", shown(stated)))
        }
        _ => Ok(()),
    }
}

fn cells(parent: Option<&Element>, arrays: &Arrays) -> Result<Vec<Vec<u64>>, String> {
    let indices = |name: &str| -> Result<Vec<u64>, String> {
        let is_it = |array: &&Element| array.attribute("Name") == Some(name);
        let array = parent.and_then(|parent| parent.children("DataArray").find(is_it));
        array.map_or(Ok(Vec::new()), |array| arrays.read(array)?.into_indices())
    };
    let (connectivity, ends) = (indices("connectivity")?, indices("offsets")?);
    let mut from = 0;
    let mut cells = Vec::new();
    for end in ends {
        let to = usize::try_from(end).unwrap_or(usize::MAX);
        let cell = connectivity.get(from..to).ok_or("its offsets do not fit its connectivity")?;
        cells.push(cell.to_vec());
        from = to;
    }
    if from != connectivity.len() {
        return Err("its offsets do not fit its connectivity".into());
    }
    Ok(cells)
}
