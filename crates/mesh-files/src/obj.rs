//! OBJ: its vertices and faces. Polygons are cut into fans, faces without area are left out; all objects of the file make
//! one mesh.

use crate::mesh::Mesh;
use crate::text::{lines, noted_frame, number, shown};

pub fn read(bytes: &[u8]) -> Result<Mesh, String> {
    let mut mesh = Mesh { frame: noted_frame(bytes), ..Mesh::default() };
    // The last vertex that a face names, and where: it may stand further down.
    let mut last = (0, 0);
    let mut whole = String::new();
    for (line, text) in lines(bytes) {
        // A backslash at the end of a line joins the next one.
        if let Some(start) = text.trim_end().strip_suffix('\\') {
            whole += start;
            whole.push(' ');
            continue;
        }
        whole += &text;
        let mut words = whole.split_whitespace();
        match words.next() {
            Some("v") => {
                let mut next = || number(words.next(), line);
                mesh.vertices.push([next()?, next()?, next()?]);
            }
            Some("f") => {
                let corner = |word| corner(word, mesh.vertices.len(), line);
                let corners = words.map(corner).collect::<Result<Vec<_>, _>>()?;
                last = corners.iter().map(|&corner| (corner, line)).fold(last, Ord::max);
                mesh.add_face(&corners);
            }
            _ => {}
        }
        whole.clear();
    }
    let count = mesh.vertices.len();
    if !mesh.triangles.is_empty() && last.0 as usize >= count {
        return Err(format!("line {} names vertex {}, but there are {count}", last.1, u64::from(last.0) + 1));
    }
    Ok(mesh)
}

/// The vertex that a corner such as `7/2/3` names, counted from 0. The numbers of textures and normals are not needed.
fn corner(word: &str, count: usize, line: usize) -> Result<u32, String> {
    let wrong = || format!("line {line} has '{}' where the number of a vertex should be", shown(word));
    let number: i64 = word.split('/').next().unwrap_or_default().parse().map_err(|_| wrong())?;
    // Negative numbers count back from the last vertex so far.
    let index = if number < 0 { count as i64 + number } else { number - 1 };
    u32::try_from(index).map_err(|_| wrong())
}
