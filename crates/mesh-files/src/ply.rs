//! PLY, ASCII and binary. Polygons are cut into fans, faces without area are left out.

use crate::mesh::Mesh;
use crate::text::{noted_frame, shown, without_mark};
use ply_rs_bw::parser::{Parser, Reader};
use ply_rs_bw::ply::{ElementDef, Encoding, Property, PropertyAccess, PropertyAccessResult};
use std::io::Cursor;

/// So many elements are read at once: what the header counts is not believed, nor is the rest of an element kept.
const AT_ONCE: usize = 4096;

/// The names of a face's list of vertices.
const CORNERS: [&str; 2] = ["vertex_indices", "vertex_index"];

/// A vertex or a face: of all its properties, the ones needed here.
struct Element {
    place: [f64; 3],
    corners: Option<Vec<u32>>,
}

impl PropertyAccess for Element {
    fn new() -> Self {
        Self { place: [f64::NAN; 3], corners: None }
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        let number = match property {
            Property::Char(value) => Some(value.into()),
            Property::UChar(value) => Some(value.into()),
            Property::Short(value) => Some(value.into()),
            Property::UShort(value) => Some(value.into()),
            Property::Int(value) => Some(value.into()),
            Property::UInt(value) => Some(value.into()),
            Property::Float(value) => Some(value.into()),
            Property::Double(value) => Some(value),
            _ => None,
        };
        match (name, number) {
            ("x", Some(value)) => self.place[0] = value,
            ("y", Some(value)) => self.place[1] = value,
            ("z", Some(value)) => self.place[2] = value,
            (name, _) if CORNERS.contains(&name) => self.corners = property.to_u32_list(),
            _ => return PropertyAccessResult::Ignored,
        }
        PropertyAccessResult::Set
    }
}

pub fn read(bytes: &[u8]) -> Result<Mesh, String> {
    let parser = Parser::<Element>::new();
    let mut source = Reader::new(Cursor::new(without_mark(bytes)));
    let header = parser.read_header(&mut source).map_err(|_| {
        "its header does not begin with 'ply' and a format, name elements and properties, and end with 'end_header'"
    })?;
    let mut mesh = Mesh { frame: noted_frame(bytes), ..Mesh::default() };
    for (_, definition) in &header.elements {
        let name = shown(&definition.name);
        let (is_vertex, is_face) = (definition.name == "vertex", definition.name == "face");
        if is_vertex && let Some(axis) = ["x", "y", "z"].into_iter().find(|axis| !has(definition, axis)) {
            return Err(format!("its vertices have no property '{axis}'"));
        }
        // Without properties they have no bytes, and there may be any number of them.
        if definition.properties.is_empty() && header.encoding != Encoding::Ascii {
            continue;
        }
        let mut part = definition.clone();
        for first in (0..definition.count).step_by(AT_ONCE) {
            part.count = AT_ONCE.min(definition.count - first);
            let elements = parser.read_payload_for_element(&mut source, &part, &header).map_err(|_| {
                let count = definition.count;
                format!(
                    "the {count} of element '{name}' end early, or hold what their header does not announce"
                )
            })?;
            if is_vertex {
                mesh.vertices.extend(elements.into_iter().map(|element| element.place));
            } else if is_face {
                for (face, index) in elements.into_iter().zip(first..) {
                    let corners = face
                        .corners
                        .ok_or_else(|| format!("face {index} has no list of vertices, each at least 0"))?;
                    mesh.add_face(&corners);
                }
            }
        }
    }
    Ok(mesh)
}

fn has(definition: &ElementDef, property: &str) -> bool {
    definition.properties.iter().any(|(name, _)| name == property)
}
