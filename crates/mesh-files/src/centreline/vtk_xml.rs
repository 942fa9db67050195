//! VTK's XML files with PolyData: arrays as text, as base64, or appended behind the XML, packed by zlib or not.

use super::data_array::{Arrays, DataArray};
use super::{Lines, PolyData};
use crate::text::{noted_frame, shown};
use roxmltree::{Document, Node};

pub fn read(bytes: &[u8], limit: u64) -> Result<Lines, String> {
    // What is appended need not be XML: it is cut off, and what was open is closed.
    let mark = b"<AppendedData";
    let cut = bytes.windows(mark.len()).position(|window| window == mark);
    let head = &bytes[..cut.unwrap_or(bytes.len())];
    let mut text = String::from_utf8_lossy(head).trim_start_matches('\u{feff}').to_owned();
    if cut.is_some() {
        text.push_str("</VTKFile>");
    }
    let document = Document::parse(&text).map_err(|error| error.to_string().replace('\n', " "))?;
    let root = document.root_element();
    if root.tag_name().name() != "VTKFile" || root.attribute("type") != Some("PolyData") {
        return Err("it holds no PolyData; export the centreline as PolyData".into());
    }
    let arrays = Arrays::new(root, cut.map(|cut| &bytes[cut..]), limit)?;
    let mut lines = Vec::new();
    for piece in root.descendants().filter(|node| node.has_tag_name("Piece")) {
        lines.extend(self::piece(piece, &arrays)?.resolve()?);
    }
    Ok(Lines { lines, frame: noted_frame(head) })
}

fn piece(piece: Node, arrays: &Arrays) -> Result<PolyData, String> {
    let child = |name: &str| piece.children().find(|node| node.has_tag_name(name));
    let array = |parent: Option<Node>, name: Option<&str>| -> Result<Option<DataArray>, String> {
        let found = parent.and_then(|parent| {
            let is_it = |node: &Node| {
                node.has_tag_name("DataArray") && (name.is_none() || node.attribute("Name") == name)
            };
            parent.children().find(is_it)
        });
        found.map(|node| arrays.read(node)).transpose()
    };
    let points = array(child("Points"), None)?.map(DataArray::into_numbers).unwrap_or_default();
    let indices = |name: &str| -> Result<Vec<u64>, String> {
        array(child("Lines"), Some(name))?.map_or(Ok(Vec::new()), DataArray::into_indices)
    };
    let (connectivity, ends) = (indices("connectivity")?, indices("offsets")?);
    let mut from = 0;
    let mut lines = Vec::new();
    for end in ends {
        let to = usize::try_from(end).unwrap_or(usize::MAX);
        let line = connectivity.get(from..to).ok_or("its offsets do not fit its connectivity")?;
        lines.push(line.to_vec());
        from = to;
    }
    if points.len() % 3 != 0 {
        return Err(format!(
            "its points have {} coordinates, which is no multiple of 3",
            shown(&points.len().to_string())
        ));
    }
    Ok(PolyData { points: points.as_chunks().0.to_vec(), lines })
}
