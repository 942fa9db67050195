//! PLY, ASCII and binary. Polygons are cut into fans.

use crate::mesh::Mesh;
use crate::text::{noted_frame, shown, without_mark};
use ply_rs_bw::parser::{Parser, Reader};
use ply_rs_bw::ply::{ElementDef, Property, PropertyAccess, PropertyAccessResult};
use std::io::Cursor;

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
            Property::Double(value) => Some(value),
            ref other => other.to_f32_lossy().map(f64::from),
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
        let is_vertex = definition.name == "vertex";
        if is_vertex {
            for axis in ["x", "y", "z"] {
                if !has(definition, axis) {
                    return Err(format!("its vertices have no property '{axis}'"));
                }
            }
        }
        let elements = parser.read_payload_for_element(&mut source, definition, &header).map_err(|_| {
            let count = definition.count;
            format!("the {count} of element '{name}' end early, or hold what their header does not announce")
        })?;
        if is_vertex {
            mesh.vertices = elements.into_iter().map(|element| element.place).collect();
        } else if definition.name == "face" {
            for (index, face) in elements.into_iter().enumerate() {
                let corners = face.corners.unwrap_or_default();
                let &[first, _, _, ..] = corners.as_slice() else {
                    return Err(format!("face {index} has no list of 3 or more vertices, each at least 0"));
                };
                mesh.triangles.extend(corners[1..].windows(2).map(|edge| [first, edge[0], edge[1]]));
            }
        }
    }
    Ok(mesh)
}

fn has(definition: &ElementDef, property: &str) -> bool {
    definition.properties.iter().any(|(name, _)| name == property)
}
