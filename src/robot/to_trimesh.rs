//! A link's surface as triangles, for drawing and export.
//!
//! Every link is a surface of revolution. Its profile starts on the axis at one end and climbs to
//! the radius: in one step for a flat cap, along a quarter circle for a round cap. It descends in
//! the same way at the other end. The revolved profile is a fan of triangles at each end, with
//! rings of quadrilaterals between them.

use super::{Cap, ModifiedCylinder};
use parry3d_f64::math::{Real, Vector};
use std::f64::consts::{FRAC_PI_2, TAU};

impl ModifiedCylinder {
    /// Returns the link's surface as a closed mesh: vertices, and triangles that are
    /// counter-clockwise seen from outside.
    ///
    /// `nsubdiv` is the number of vertices around the axis, as in parry's `Cylinder::to_trimesh`,
    /// clamped to 3..=4096. A round cap has a quarter as many rings. All vertices lie on the link's
    /// surface, so the mesh is inscribed. A link of radius 0 has no surface: the result is its two
    /// end points and no triangle.
    pub fn to_trimesh(&self, nsubdiv: u32) -> (Vec<Vector>, Vec<[u32; 3]>) {
        if self.radius() == 0.0 {
            return (vec![self.start(), self.end()], vec![]);
        }
        let around = nsubdiv.clamp(3, 4096);
        let rings = self.rings(around.div_ceil(4));
        let [back, front] =
            self.caps().map(|cap| if cap == Cap::Round { self.radius() } else { 0.0 });
        let axis = self.axis_or_z();
        let (side, up) = axis.any_orthonormal_pair();

        let mut vertices = vec![self.start() - axis * back];
        for (centre, radius) in &rings {
            vertices.extend((0..around).map(|i| {
                let (sin, cos) = (TAU * Real::from(i) / Real::from(around)).sin_cos();
                centre + (side * cos + up * sin) * radius
            }));
        }
        vertices.push(self.end() + axis * front);
        let last_ring = rings.len() as u32 - 1;
        (vertices, triangles(around, last_ring))
    }

    /// Returns centre and radius of each ring, from start to end. A round cap has `steps` rings,
    /// its rim included.
    fn rings(&self, steps: u32) -> Vec<(Vector, Real)> {
        let axis = self.axis_or_z();
        let cap_ring = |pole: Vector, outward: Vector, step: u32| {
            let (sin, cos) = (FRAC_PI_2 * Real::from(step) / Real::from(steps)).sin_cos();
            (pole + outward * (self.radius() * sin), self.radius() * cos)
        };
        let inner_steps = |cap| if cap == Cap::Round { 1..steps } else { 1..1 };
        let [back, front] = self.caps();

        let mut rings: Vec<_> =
            inner_steps(back).rev().map(|step| cap_ring(self.start(), -axis, step)).collect();
        rings.push((self.start(), self.radius()));
        if self.start() != self.end() {
            rings.push((self.end(), self.radius()));
        }
        rings.extend(inner_steps(front).map(|step| cap_ring(self.end(), axis, step)));
        rings
    }

    /// The link's axis. A ball has none; z serves.
    fn axis_or_z(&self) -> Vector {
        if self.start() == self.end() { Vector::Z } else { self.axis() }
    }
}

/// Joins vertex 0, then `last_ring + 1` rings of `around` vertices each, then one last vertex.
fn triangles(around: u32, last_ring: u32) -> Vec<[u32; 3]> {
    let vertex = |ring: u32, i: u32| 1 + ring * around + i % around;
    let tip = 1 + (last_ring + 1) * around;
    let mut triangles = Vec::new();
    for i in 0..around {
        triangles.push([0, vertex(0, i + 1), vertex(0, i)]);
        for ring in 0..last_ring {
            let [a, b] = [vertex(ring, i), vertex(ring, i + 1)];
            let [c, d] = [vertex(ring + 1, i), vertex(ring + 1, i + 1)];
            triangles.extend([[a, b, d], [a, d, c]]);
        }
        triangles.push([tip, vertex(last_ring, i), vertex(last_ring, i + 1)]);
    }
    triangles
}
