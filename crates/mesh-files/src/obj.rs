//! Reads the vertices and faces of OBJ files, and writes triangles as OBJ.
//!
//! Polygons are triangulated, faces without area are left out, and all objects of the file form one
//! mesh. A statement that is unknown, or that adds a surface in another way, is an error.

use crate::mesh::Mesh;
use crate::polygon::Faces;
use crate::text::{lines, noted_frame, number, shown};

/// Returns triangles as the text of an OBJ file. Every coordinate is read back as the same double.
pub fn to_obj<Vertex: Copy + Into<[f64; 3]>>(
    vertices: &[Vertex],
    triangles: &[[u32; 3]],
) -> String {
    let vertices = vertices.iter().map(|&vertex| {
        let [x, y, z] = vertex.into();
        format!("v {x:?} {y:?} {z:?}\n")
    });
    let faces = triangles.iter().map(|[a, b, c]| format!("f {} {} {}\n", a + 1, b + 1, c + 1));
    vertices.chain(faces).collect()
}

/// The statements that change no vertex and no face.
const IGNORED: [&str; 37] = [
    "vt",
    "vn",
    "vp",
    "p",
    "l",
    "g",
    "s",
    "o",
    "mg",
    "usemtl",
    "mtllib",
    "usemap",
    "maplib",
    "lod",
    "bevel",
    "c_interp",
    "d_interp",
    "shadow_obj",
    "trace_obj",
    "ctech",
    "stech",
    "cstype",
    "deg",
    "bmat",
    "step",
    "curv",
    "curv2",
    "parm",
    "trim",
    "hole",
    "scrv",
    "sp",
    "end",
    "con",
    "cdc",
    "res",
    "csh",
];

/// The statements that add a surface of another kind, and one that includes another file.
const OTHER_SURFACES: [&str; 5] = ["surf", "bsp", "bzp", "cdp", "call"];

/// The content so far.
#[derive(Default)]
struct Reader {
    vertices: Vec<[f64; 3]>,
    faces: Faces,
    /// Whether the last line is ignored and ends in a backslash, so that numbers may follow.
    may_go_on: bool,
    /// The highest vertex that a face names, and the line of that face: the vertex may be defined
    /// later.
    last: (u32, usize),
}

impl Reader {
    /// Reads a vertex or a face, and ignores known statements of another kind.
    fn read_statement(&mut self, text: &str, line: usize) -> Result<(), String> {
        let mut words = text.split_whitespace();
        match words.next() {
            Some("v") => {
                let mut next = || number(words.next(), line);
                self.vertices.push([next()?, next()?, next()?]);
                // A weight and a colour may follow, but no statement of a line that is joined.
                for word in words {
                    number(Some(word), line)?;
                }
            }
            Some("f" | "fo") => {
                let corner = |word| corner(word, self.vertices.len(), line);
                let corners = words.map(corner).collect::<Result<Vec<_>, _>>()?;
                self.last = corners.iter().map(|&corner| (corner, line)).fold(self.last, Ord::max);
                self.faces.push(corners);
            }
            Some(word) if OTHER_SURFACES.contains(&word) => {
                return Err(format!(
                    "line {line} has the statement '{word}', whose surface is not read; export it as polygons"
                ));
            }
            Some(word) if IGNORED.contains(&word) || self.may_go_on && is_number(word) => {}
            Some(word) => {
                return Err(format!(
                    "line {line} has the unknown statement '{}'; remove the line if it is no face",
                    shown(word)
                ));
            }
            None => {}
        }
        Ok(())
    }
}

fn is_number(word: &str) -> bool {
    word.parse::<f64>().is_ok()
}

/// Returns whether a backslash joins the next line to this one. Names and comments may end in a
/// backslash, and ignored statements need no continuation.
fn goes_on(text: &str) -> bool {
    matches!(text.split_whitespace().next(), Some("v" | "f" | "fo"))
}

pub fn read(bytes: &[u8]) -> Result<Mesh, String> {
    let mut reader = Reader::default();
    let (mut open, mut last_line) = (String::new(), 0);
    for (line, text) in lines(bytes) {
        let text = text.split('#').next().unwrap_or_default().trim_end();
        last_line = line;
        match text.strip_suffix('\\') {
            Some(start) if !open.is_empty() || goes_on(start) => {
                open += start;
                open.push(' ');
            }
            start if open.is_empty() => {
                reader.read_statement(start.unwrap_or(text), line)?;
                reader.may_go_on = start.is_some();
            }
            _ => reader.read_statement(&(std::mem::take(&mut open) + text), line)?,
        }
    }
    reader.read_statement(&open, last_line)?;
    let (count, last) = (reader.vertices.len(), reader.last);
    if last.1 > 0 && last.0 as usize >= count {
        return Err(format!(
            "line {} names vertex {}, but there are {count}",
            last.1,
            u64::from(last.0) + 1
        ));
    }
    let mut mesh = Mesh { vertices: reader.vertices, frame: noted_frame(bytes), ..Mesh::default() };
    reader.faces.cut(&mut mesh)?;
    Ok(mesh)
}

/// Returns the vertex that a word such as `7/2/3` names, counted from 0. Textures and normals are
/// ignored.
fn corner(word: &str, count: usize, line: usize) -> Result<u32, String> {
    let wrong =
        || format!("line {line} has '{}' where the number of a vertex should be", shown(word));
    let number: i64 = word.split('/').next().unwrap_or_default().parse().map_err(|_| wrong())?;
    // Negative numbers count back from the latest vertex.
    let index = if number < 0 { (count as i64).checked_add(number) } else { number.checked_sub(1) };
    index.and_then(|index| u32::try_from(index).ok()).ok_or_else(wrong)
}
