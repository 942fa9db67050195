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
    // Some binary files begin with "solid" all the same: the length decides, then the bytes that
    // text has not.
    let start = without_mark(bytes).trim_ascii_start();
    let is_solid = start.get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    let mut mesh = match (count, count.and_then(|count| triangles(count, body))) {
        (_, Some(triangles)) => binary(&triangles),
        _ if is_solid && !bytes[..bytes.len().min(1000)].contains(&0) => ascii(bytes)?,
        (Some(count), None) => {
            let there = body.len() / TRIANGLE;
            return Err(if there < count {
                format!("its header counts {count} triangles, but it ends after {there}")
            } else {
                let more = body.len() - count * TRIANGLE;
                format!("its header counts {count} triangles, but {more} more bytes follow them")
            });
        }
        (None, None) => {
            return Err(
                "it neither begins with 'solid', as text does, nor has the 84 bytes of a binary header"
                    .into(),
            );
        }
    };
    mesh.frame = noted_frame(bytes);
    Ok(mesh)
}

/// The triangles of a binary file whose length leaves no doubt: as many as its header counts, and
/// less than one behind them; or as many as there are, where a writer never came back to count (0,
/// or all bits set). In some files bytes follow each triangle, as many as its last two bytes say;
/// in others these two are a colour.
fn triangles(count: usize, body: &[u8]) -> Option<Vec<&[u8; TRIANGLE]>> {
    let (all, tail) = body.as_chunks::<TRIANGLE>();
    let is_uncounted = count == 0 || count == u32::MAX as usize;
    if tail.is_empty() && (all.len() == count || is_uncounted) {
        return Some(all.iter().collect());
    }
    with_attributes(count, body).or_else(|| (all.len() == count).then(|| all.iter().collect()))
}

/// The triangles, if the bytes behind each end where the file does.
fn with_attributes(count: usize, body: &[u8]) -> Option<Vec<&[u8; TRIANGLE]>> {
    let (mut found, mut rest) = (Vec::new(), body);
    while found.len() < count {
        let (triangle, others) = rest.split_first_chunk::<TRIANGLE>()?;
        found.push(triangle);
        rest = others.get(usize::from(u16::from_le_bytes([triangle[48], triangle[49]]))..)?;
    }
    rest.is_empty().then_some(found)
}

fn binary(triangles: &[&[u8; TRIANGLE]]) -> Mesh {
    let (mut mesh, mut merger) = (Mesh::default(), Merger::default());
    for triangle in triangles {
        // The normal comes first; it follows from the corners.
        let at = |i: usize| {
            f32::from_le_bytes([0, 1, 2, 3].map(|byte| triangle[12 + 4 * i + byte])).into()
        };
        mesh.add_face(
            &[0, 3, 6].map(|corner| merger.number([at(corner), at(corner + 1), at(corner + 2)])),
        );
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
            let mut word = word.to_ascii_lowercase();
            // Some programs write the end of a solid, a facet or a loop in two words.
            if word == "end" {
                word += &words.next().unwrap_or_default().to_ascii_lowercase();
            }
            match word.as_str() {
                "solid" | "endsolid" => {
                    is_open = word == "solid";
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
                _ => return Err(format!("line {line} has the unknown word '{}'", shown(&word))),
            }
        }
    }
    if is_open || !corners.is_empty() {
        return Err("it ends without 'endsolid', so it may be cut short".into());
    }
    Ok(Mesh { vertices: merger.vertices, ..mesh })
}
