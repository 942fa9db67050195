//! Triangulates faces: a fan about the first vertex if the face is convex, ear clipping otherwise.

use crate::mesh::Mesh;
use earcut::Earcut;

/// The largest number of vertices of a face that is not convex. Ear clipping takes quadratic time
/// at worst.
const MOST_CORNERS: usize = 1 << 14;

/// The rounding error of a cross product of coordinates up to 1: two products of differences up to
/// 2, each with three roundings, and their difference.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Faces before the triangulation. They are collected first, because a face may name vertices that
/// the file defines later.
#[derive(Default)]
pub(crate) struct Faces {
    corners: Vec<u32>,
    /// The end of each face in `corners`.
    ends: Vec<usize>,
}

impl Faces {
    pub fn push(&mut self, corners: impl IntoIterator<Item = u32>) {
        self.corners.extend(corners);
        self.ends.push(self.corners.len());
    }

    /// Adds the triangles of a strip. Each further vertex forms one with the two before it, with
    /// alternating orientation. A triangle that names a vertex twice only continues the strip. A
    /// strip without any triangle is a face without area.
    pub fn push_strip(&mut self, strip: &[u32]) {
        let before = self.ends.len();
        for (index, corners) in strip.windows(3).enumerate() {
            let [a, b, c] = [corners[0], corners[1], corners[2]];
            if a != b && b != c && c != a {
                self.push(if index % 2 == 0 { [a, b, c] } else { [b, a, c] });
            }
        }
        if self.ends.len() == before {
            self.push([]);
        }
    }

    /// Adds the triangles of the faces to a mesh that has its vertices.
    ///
    /// # Errors
    /// A face that is not convex has too many vertices.
    pub fn cut(self, mesh: &mut Mesh) -> Result<(), String> {
        let mut cutter = Cutter::default();
        let mut from = 0;
        for end in self.ends {
            let corners = &self.corners[from..end];
            from = end;
            let is_cut = corners.len() > 3 && cutter.cut_ears(corners, mesh)?;
            if !is_cut {
                mesh.add_face(corners);
            }
        }
        Ok(())
    }
}

/// Clips ears. Keeps its buffers from face to face.
#[derive(Default)]
struct Cutter {
    earcut: Earcut<f64>,
    /// The face without consecutive repeated vertices.
    corners: Vec<u32>,
    outline: Vec<[f64; 2]>,
    ears: Vec<u32>,
}

impl Cutter {
    /// Adds the triangles of a face. Returns false, without adding any, if a fan is right.
    fn cut_ears(&mut self, corners: &[u32], mesh: &mut Mesh) -> Result<bool, String> {
        self.corners.clear();
        self.corners.extend(corners);
        self.corners.dedup();
        while self.corners.len() > 1 && self.corners.first() == self.corners.last() {
            self.corners.pop();
        }
        if self.corners.len() < 4 || !self.project(&mesh.vertices) || is_convex(&self.outline) {
            return Ok(false);
        }
        let count = self.corners.len();
        if count > MOST_CORNERS {
            return Err(format!(
                "a face of {count} corners is not convex; triangulate it before the export"
            ));
        }
        self.earcut.earcut_slice::<u32>(&self.outline, &[], &mut self.ears);
        let before = mesh.triangles.len();
        for &ear in self.ears.as_chunks::<3>().0 {
            let [a, b, c] = ear.map(|corner| self.outline[corner as usize]);
            let [p, q, r] = ear.map(|corner| self.corners[corner as usize]);
            if p != q && q != r && r != p {
                mesh.triangles.push(if turn(a, b, c) < 0.0 { [p, r, q] } else { [p, q, r] });
            }
        }
        Ok(mesh.triangles.len() > before)
    }

    /// Computes the outline, counter-clockwise, in the coordinate plane that is most parallel to
    /// the face. Coordinates are relative to the first vertex, scaled by a power of two to at most
    /// 1.
    fn project(&mut self, vertices: &[[f64; 3]]) -> bool {
        let corner = |&index: &u32| vertices.get(index as usize).copied();
        let Some(places) = self.corners.iter().map(corner).collect::<Option<Vec<_>>>() else {
            return false;
        };
        let away = |place: [f64; 3]| [0, 1, 2].map(|axis| place[axis] - places[0][axis]);
        let largest = places
            .iter()
            .flat_map(|&place| away(place))
            .fold(0.0, |most: f64, x| most.max(x.abs()));
        if !(f64::MIN_POSITIVE..f64::MAX).contains(&largest) {
            return false;
        }
        let scale = (-largest.log2().floor() - 1.0).exp2();
        let places: Vec<_> = places.iter().map(|&place| away(place).map(|x| x * scale)).collect();
        // Twice the area in each coordinate plane.
        let normal = [0, 1, 2].map(|axis| {
            let [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
            let pairs = places.iter().zip(places.iter().cycle().skip(1));
            pairs.map(|(p, q)| p[u] * q[v] - p[v] * q[u]).sum::<f64>()
        });
        let axis =
            (0..3).fold(
                0,
                |best, axis| if normal[axis].abs() > normal[best].abs() { axis } else { best },
            );
        let [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
        let [u, v] = if normal[axis] < 0.0 { [v, u] } else { [u, v] };
        self.outline.clear();
        self.outline.extend(places.iter().map(|place| [place[u], place[v]]));
        normal[axis] != 0.0 && normal[axis].is_finite()
    }
}

/// Returns whether the outline turns left at every vertex, and the fan about the first vertex as
/// well. The second condition excludes outlines that wind twice.
fn is_convex(outline: &[[f64; 2]]) -> bool {
    let count = outline.len();
    let at = |index: usize| outline[index % count];
    (0..count).all(|i| {
        let is_left = |a, b, c| turn(a, b, c) >= -ROUNDING;
        is_left(at(i), at(i + 1), at(i + 2)) && is_left(at(0), at(i), at(i + 1))
    })
}

fn turn(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}
