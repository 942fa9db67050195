//! Reads STL files, binary and ASCII.
//!
//! STL names no vertices: identical positions become one vertex, and facets with fewer than three
//! different positions are left out.

use crate::mesh::{Merger, Mesh};
use crate::text::{lines, noted_frame, number, shown, without_mark};

/// The sizes in a binary file: 80 free bytes and the number of triangles, then 50 bytes for each
/// triangle.
const HEAD: usize = 84;
const TRIANGLE: usize = 50;

pub fn read(bytes: &[u8]) -> Result<Mesh, String> {
    let count = bytes.get(80..HEAD).map(|n| u32::from_le_bytes([n[0], n[1], n[2], n[3]]) as usize);
    let body = bytes.get(HEAD..).unwrap_or_default();
    // Some binary files also begin with "solid". The length decides, then bytes that text does not
    // contain.
    let start = without_mark(bytes).trim_ascii_start();
    let is_solid = start.get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    let mut mesh = match (count, count.and_then(|count| triangles(count, body))) {
        (_, Some(triangles)) => binary(&triangles),
        _ if is_solid && !bytes[..bytes.len().min(1000)].contains(&0) => ascii(bytes)?,
        (Some(count), None) => {
            let there = body.len() / TRIANGLE;
            let remedy = if body.len() % TRIANGLE == 0 {
                format!("; if all are there, write {there} into its bytes 80 to 83")
            } else if there < count {
                "; it may be cut short".into()
            } else {
                format!(
                    "; if these are no triangles, cut it after byte {}",
                    HEAD + count * TRIANGLE
                )
            };
            return Err(if there < count {
                format!("its header counts {count} triangles, but it ends after {there}{remedy}")
            } else {
                let more = body.len() - count * TRIANGLE;
                format!(
                    "its header counts {count} triangles, but {more} more bytes follow them{remedy}"
                )
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

/// Returns the triangles of a binary file whose length is consistent:
/// - as many as its header counts, and less than one triangle after them;
/// - or all of them, if the writer never wrote the count (0, or all bits set).
///
/// In some files each triangle is followed by as many bytes as its last two bytes say. In others
/// these two bytes are a colour.
fn triangles(count: usize, body: &[u8]) -> Option<Vec<&[u8; TRIANGLE]>> {
    let (all, tail) = body.as_chunks::<TRIANGLE>();
    let is_uncounted = count == 0 || count == u32::MAX as usize;
    if tail.is_empty() && (all.len() == count || is_uncounted) {
        return Some(all.iter().collect());
    }
    with_attributes(count, body).or_else(|| (all.len() == count).then(|| all.iter().collect()))
}

/// Returns the triangles, if the bytes after the triangles end exactly at the end of the file.
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
        // The normal comes first; it is ignored, because the vertices determine it.
        let at = |i: usize| {
            f32::from_le_bytes([0, 1, 2, 3].map(|byte| triangle[12 + 4 * i + byte])).into()
        };
        mesh.add_face(
            &[0, 3, 6].map(|corner| merger.number([at(corner), at(corner + 1), at(corner + 2)])),
        );
    }
    Mesh { vertices: merger.vertices, ..mesh }
}

/// Reads an ASCII file. Words are compared without case. A name follows `solid`: to the end of the
/// line, or to the first facet if all words are in one line.
fn ascii(bytes: &[u8]) -> Result<Mesh, String> {
    let (mut mesh, mut merger) = (Mesh::default(), Merger::default());
    let mut corners = Vec::new();
    let mut is_open = false;
    for (line, text) in lines(bytes) {
        let mut words = text.split_whitespace();
        while let Some(word) = words.next() {
            let mut word = word.to_ascii_lowercase();
            // Some programs write "end solid", "end facet" or "end loop" in two words.
            if word == "end" {
                word += &words.next().unwrap_or_default().to_ascii_lowercase();
            }
            match word.as_str() {
                "solid" | "endsolid" => {
                    is_open = word == "solid";
                    let mut is_end = false;
                    while !begins_facet(words.clone())
                        && let Some(word) = words.next()
                    {
                        let word = word.to_ascii_lowercase();
                        if word == "endfacet" || is_end && word == "facet" {
                            return Err(format!("line {line} ends a facet that does not begin"));
                        }
                        is_end = word == "end";
                    }
                }
                // Skip "normal" and its three numbers: the vertices determine it.
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

/// Returns whether a facet begins with these words.
fn begins_facet<'a>(mut words: impl Iterator<Item = &'a str>) -> bool {
    let mut is_next = |word: &str| words.next().is_some_and(|own| own.eq_ignore_ascii_case(word));
    is_next("facet") && is_next("normal")
}
