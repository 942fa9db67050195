//! Triangulates faces. A face of n corners becomes n - 2 triangles whose common boundary is the
//! outline of the face, so neighbouring faces stay connected.
//!
//! # Algorithm
//! 1. Project the outline to the coordinate plane that is most parallel to the face.
//! 2. Take the fan about the first corner if no triangle of it is turned over.
//! 3. Otherwise clip ears ([`Ears`]). No ear is turned over.
//! 4. If ears run out, the outline crosses itself: take the fan, as other programs do.
//!
//! # Correctness
//! **Claim.** If no triangle is turned over, the triangles cover each point of the plane as often
//! as the outline winds around it: once inside an outline without crossings, and never outside.
//! **Proof.** The triangles form a disc whose boundary is the outline. A point that is on no edge
//! is covered by triangles that turn left, minus triangles that turn right, as often as the
//! boundary winds around it. No triangle turns right.
//! **Rounding.** A triangle counts as turned over if its cross product is less than `-ROUNDING`.

use crate::ears::{Ears, ROUNDING, turn};
use crate::mesh::Mesh;

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

    /// Adds the triangles of the faces to a mesh that has its vertices. Triangles that name a
    /// vertex twice are left out.
    ///
    /// # Errors
    /// The outlines of faces are too intricate.
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

/// Cuts faces for which the fan is wrong. Keeps its buffers from face to face.
#[derive(Default)]
struct Cutter {
    ears: Ears,
    /// The face without consecutive repeated vertices.
    corners: Vec<u32>,
    places: Vec<[f64; 3]>,
    outline: Vec<[f64; 2]>,
}

impl Cutter {
    /// Adds the triangles of a face. Returns false, without adding any, if the fan is right.
    fn cut_ears(&mut self, corners: &[u32], mesh: &mut Mesh) -> Result<bool, String> {
        self.corners.clear();
        self.corners.extend(corners);
        self.corners.dedup();
        while self.corners.len() > 1 && self.corners.first() == self.corners.last() {
            self.corners.pop();
        }
        if self.corners.len() < 4 || !self.project(&mesh.vertices) || fan_covers(&self.outline) {
            return Ok(false);
        }
        let count = self.corners.len();
        let Some(ears) = self.ears.clip(&self.outline).map_err(|_| {
            format!("the outline of a face of {count} corners is too intricate; triangulate it before the export")
        })?
        else {
            return Ok(false);
        };
        let named = ears.iter().map(|ear| ear.map(|corner| self.corners[corner as usize]));
        let before = mesh.triangles.len();
        mesh.triangles.extend(named.filter(|[a, b, c]| a != b && b != c && c != a));
        Ok(mesh.triangles.len() > before)
    }

    /// Computes the outline, counter-clockwise, in the coordinate plane that is most parallel to
    /// the face. Coordinates are relative to the first vertex, scaled by a power of two to at most
    /// 1.
    fn project(&mut self, vertices: &[[f64; 3]]) -> bool {
        let Some(&first) = self.corners.first().and_then(|&first| vertices.get(first as usize))
        else {
            return false;
        };
        self.places.clear();
        let mut largest = 0.0_f64;
        for &corner in &self.corners {
            let Some(place) = vertices.get(corner as usize) else { return false };
            let away = [0, 1, 2].map(|axis| place[axis] - first[axis]);
            largest = away.iter().fold(largest, |most, x| most.max(x.abs()));
            self.places.push(away);
        }
        if !(f64::MIN_POSITIVE..f64::MAX).contains(&largest) {
            return false;
        }
        let scale = (-largest.log2().floor() - 1.0).exp2();
        self.places.iter_mut().flatten().for_each(|x| *x *= scale);
        // Twice the area in each coordinate plane.
        let normal = [0, 1, 2].map(|axis| {
            let [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
            let pairs = self.places.iter().zip(self.places.iter().cycle().skip(1));
            pairs.map(|(p, q)| p[u] * q[v] - p[v] * q[u]).sum::<f64>()
        });
        let is_larger = |a: usize, b: usize| normal[a].abs() > normal[b].abs();
        let axis = (1..3).fold(0, |best, axis| if is_larger(axis, best) { axis } else { best });
        let [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
        let [u, v] = if normal[axis] < 0.0 { [v, u] } else { [u, v] };
        self.outline.clear();
        self.outline.extend(self.places.iter().map(|place| [place[u], place[v]]));
        normal[axis] != 0.0 && normal[axis].is_finite()
    }
}

/// Returns whether no triangle of the fan about the first corner is turned over.
fn fan_covers(outline: &[[f64; 2]]) -> bool {
    outline.windows(2).all(|edge| turn(outline[0], edge[0], edge[1]) >= -ROUNDING)
}
