//! STL, binary and ASCII. It names no vertices, so corners at exactly the same place become one,
//! and facets with fewer than three of them are left out.

use crate::mesh::{Merger, Mesh};
use crate::text::{lines, noted_frame, number, shown, without_mark};

/// A binary file: 80 free bytes, the number of triangles, and 50 bytes for each.
const HEAD: usize = 84;
const TRIANGLE: usize = 50;

pub fn read(bytes: &[u8]) -> Result<Mesh, String> {
    let count = bytes.get(80..HEAD).map(|n| u32::from_le_bytes([n[0], n[1], n[2], n[3]]) as usize);
    let body = bytes.get(HEAD..).unwrap_or_default();
    let whole = count.and_then(|count| count.checked_mul(TRIANGLE)) == Some(body.len());
    // Some binary files begin with "solid" all the same: the length decides, then the bytes that text has not.
    let start = without_mark(bytes).trim_ascii_start();
    let is_solid = start.get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    let mut mesh = match count {
        Some(_) if whole => binary(body),
        _ if is_solid && !bytes[..bytes.len().min(1000)].contains(&0) => ascii(bytes)?,
        Some(count) => {
            let there = body.len() / TRIANGLE;
            return Err(if there < count {
                format!("its header counts {count} triangles, but it ends after {there}")
            } else {
                let more = body.len() - count * TRIANGLE;
                format!("its header counts {count} triangles, but {more} more bytes follow them")
            });
        }
        None => {
            return Err(
                "it neither begins with 'solid', as text does, nor has the 84 bytes of a binary header"
                    .into(),
            );
        }
    };
    mesh.frame = noted_frame(bytes);
    Ok(mesh)
}

fn binary(body: &[u8]) -> Mesh {
    let (mut mesh, mut merger) = (Mesh::default(), Merger::default());
    for triangle in body.as_chunks::<TRIANGLE>().0 {
        // The normal comes first; it follows from the corners.
        let at = |i: usize| f32::from_le_bytes([0, 1, 2, 3].map(|byte| triangle[12 + 4 * i + byte])).into();
        mesh.add_face(&[0, 3, 6].map(|corner| merger.number([at(corner), at(corner + 1), at(corner + 2)])));
    }
    Mesh { vertices: merger.vertices, ..mesh }
}

/// The words of an ASCII file after the name of its solid, in any case.
fn ascii(bytes: &[u8]) -> Result<Mesh, String> {
    let (mut mesh, mut merger) = (Mesh::default(), Merger::default());
    let mut corners = Vec::new();
    let mut is_open = false;
    for (line, text) in lines(bytes) {
        let mut words = text.split_whitespace();
        while let Some(word) = words.next() {
            match word.to_ascii_lowercase().as_str() {
                "solid" | "endsolid" => {
                    is_open = word.len() == 5;
                    break;
                }
                // Three numbers after "normal", which follow from the corners.
                "facet" => words.by_ref().take(4).for_each(drop),
                "outer" | "loop" | "endloop" => {}
                "vertex" => {
                    let mut next = || number(words.next(), line);
                    corners.push(merger.number([next()?, next()?, next()?]));
                }
                "endfacet" => {
                    if corners.len() != 3 {
                        let count = corners.len();
                        return Err(format!(
                            "the facet that ends in line {line} has {count} vertices, not 3"
                        ));
                    }
                    mesh.add_face(&corners);
                    corners.clear();
                }
                _ => return Err(format!("line {line} has the unknown word '{}'", shown(word))),
            }
        }
    }
    if is_open || !corners.is_empty() {
        return Err("it ends without 'endsolid', so it may be cut short".into());
    }
    Ok(Mesh { vertices: merger.vertices, ..mesh })
}
