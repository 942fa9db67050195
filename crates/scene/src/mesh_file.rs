//! Anatomy from a file: STL (binary or ASCII), OBJ or PLY, by the file's extension.
//!
//! Every error is one line that says what to change. STL names no vertices, so corners at exactly the same place
//! become one vertex. STL and OBJ coordinates are read in single precision, as most programs write them. Polygons
//! are cut into fans.

use crate::surface::Mesh;
use parry_continuum::parry::math::{Real, Vector};
use ply_rs_bw::parser::{Parser, Reader};
use ply_rs_bw::ply::{Property, PropertyAccess, PropertyAccessResult};
use std::collections::HashMap;
use std::io::Cursor;
use std::path::Path;

/// The mesh in the file, every coordinate multiplied by `scale`.
///
/// # Errors
/// One line: the file cannot be read, is of unknown format or broken, has no triangle, a vertex is not finite, a
/// triangle names a vertex that is not there, or the scale is not a positive number.
pub fn load(path: &Path, scale: Real) -> Result<Mesh, String> {
    let bytes = std::fs::read(path)
        .map_err(|error| format!("cannot read {} ({error}); check the path", path.display()))?;
    from_bytes(path, bytes, scale)
}

/// As [`load`], for a file of this name that holds these bytes.
pub fn from_bytes(path: &Path, bytes: Vec<u8>, scale: Real) -> Result<Mesh, String> {
    let name = path.display();
    if !(scale > 0.0 && scale.is_finite()) {
        return Err(format!(
            "the scale is {scale}; give a positive number, for example 1000 for metres to millimetres"
        ));
    }
    let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
    let parse = match extension.as_str() {
        "stl" => stl,
        "obj" => obj,
        "ply" => ply,
        _ => {
            return Err(format!(
                "the format of {name} is unknown; give a file that ends in .stl, .obj or .ply"
            ));
        }
    };
    let broken = |reason: String| {
        let reason = reason.split_whitespace().collect::<Vec<_>>().join(" ");
        format!("{name} is not a valid {} file ({reason}); export it again", extension.to_uppercase())
    };
    let (mut points, triangles) = parse(bytes).map_err(broken)?;
    if triangles.is_empty() {
        return Err(format!("{name} holds no triangles; export the surface, not only its points"));
    }
    for triangle in &triangles {
        if let Some(corner) = triangle.iter().find(|&&corner| corner as usize >= points.len()) {
            let count = points.len();
            return Err(broken(format!(
                "a triangle names vertex {corner}, but there are {count}, counted from 0"
            )));
        }
    }
    for (index, point) in points.iter_mut().enumerate() {
        let place = *point;
        *point *= scale;
        if !point.is_finite() {
            let [x, y, z] = place.to_array();
            let advice = if place.is_finite() { "choose a smaller scale" } else { "repair that vertex" };
            return Err(format!(
                "vertex {index} of {name} is not finite ({x}, {y}, {z}; scale {scale}); {advice}"
            ));
        }
    }
    Ok((points, triangles))
}

/// Corners to vertices: those at exactly the same place are one.
#[derive(Default)]
struct Merger {
    points: Vec<Vector>,
    numbers: HashMap<[u64; 3], u32>,
}

impl Merger {
    fn number(&mut self, point: Vector) -> u32 {
        // Adding 0 makes -0 and 0 the same.
        let place = (point + Vector::ZERO).to_array().map(Real::to_bits);
        *self.numbers.entry(place).or_insert_with(|| {
            self.points.push(point);
            self.points.len() as u32 - 1
        })
    }
}

fn stl(mut bytes: Vec<u8>) -> Result<Mesh, String> {
    // A binary file has 80 free bytes, the number of triangles, and 50 bytes for each. Some begin with "solid" all
    // the same, and some ASCII files do not name their solid: both would mislead the reader.
    let count = bytes.get(80..84).map(|n| u32::from_le_bytes([n[0], n[1], n[2], n[3]]));
    if count.is_some_and(|count| bytes.len() as u64 == 84 + 50 * u64::from(count)) {
        bytes[..80].fill(0);
    } else if bytes.starts_with(b"solid") {
        let line = bytes.iter().position(|&byte| byte == b'\n').unwrap_or(bytes.len());
        bytes.splice(..line, *b"solid mesh");
    }
    let mut source = Cursor::new(bytes);
    let mut merger = Merger::default();
    let mut triangles = Vec::new();
    for triangle in stl_io::create_stl_reader(&mut source).map_err(|e| e.to_string())? {
        let corners = triangle.map_err(|e| e.to_string())?.vertices;
        triangles.push(corners.map(|corner| merger.number(Vector::from(corner.0.map(Real::from)))));
    }
    Ok((merger.points, triangles))
}

fn obj(bytes: Vec<u8>) -> Result<Mesh, String> {
    // Only vertices and faces: with texture coordinates and normals the reader would look up a face's numbers for them,
    // and overflow where those are out of range.
    let is_geometry =
        |line: &&[u8]| matches!(String::from_utf8_lossy(line).split_whitespace().next(), Some("v" | "f"));
    let bytes = bytes.split(|&byte| byte == b'\n').filter(is_geometry).collect::<Vec<_>>().join(&b'\n');
    let options = tobj::LoadOptions { triangulate: true, ..Default::default() };
    let no_materials = |_: &Path| Ok(Default::default());
    let (models, _) =
        tobj::load_obj_buf(&mut bytes.as_slice(), &options, no_materials).map_err(|e| e.to_string())?;
    let mut mesh = Mesh::default();
    for model in models {
        let first = mesh.0.len() as u32;
        mesh.0.extend(
            model.mesh.positions.as_chunks().0.iter().map(|p: &[_; 3]| Vector::from(p.map(Real::from))),
        );
        mesh.1
            .extend(model.mesh.indices.as_chunks().0.iter().map(|t: &[_; 3]| t.map(|corner| first + corner)));
    }
    Ok(mesh)
}

/// A vertex or a face of a PLY file: of all its properties, the ones needed here.
struct Element {
    place: Vector,
    corners: Option<Vec<u32>>,
}

impl PropertyAccess for Element {
    fn new() -> Self {
        Self { place: Vector::NAN, corners: None }
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        let number = match property {
            Property::Double(value) => Some(value),
            ref other => other.to_f32_lossy().map(Real::from),
        };
        match (name, number) {
            ("x", Some(value)) => self.place.x = value,
            ("y", Some(value)) => self.place.y = value,
            ("z", Some(value)) => self.place.z = value,
            ("vertex_indices" | "vertex_index", _) => self.corners = property.to_u32_list(),
            _ => return PropertyAccessResult::Ignored,
        }
        PropertyAccessResult::Set
    }
}

fn ply(bytes: Vec<u8>) -> Result<Mesh, String> {
    let parser = Parser::<Element>::new();
    let mut source = Reader::new(Cursor::new(bytes));
    let header = parser.read_header(&mut source).map_err(|e| e.to_string())?;
    let mut mesh = Mesh::default();
    for (_, definition) in &header.elements {
        let elements =
            parser.read_payload_for_element(&mut source, definition, &header).map_err(|e| e.to_string())?;
        match definition.name.as_str() {
            "vertex" => mesh.0 = elements.into_iter().map(|element| element.place).collect(),
            "face" => {
                for (index, face) in elements.into_iter().enumerate() {
                    let corners =
                        face.corners.ok_or(format!("face {index} has no list of vertex indices"))?;
                    let fan = corners.windows(2).skip(1).map(|pair| [corners[0], pair[0], pair[1]]);
                    mesh.1.extend(fan);
                }
            }
            _ => {}
        }
    }
    Ok(mesh)
}
