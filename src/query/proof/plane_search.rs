//! The search for separating planes.
//!
//! One plane separates a group of triangles from a run of bodies, or the larger of both is halved
//! and each half is tried.

use super::body::ProofBody;
use super::direction::{between_hulls, between_pair};
use super::groups::{ALL, Groups};
use crate::mesh::Mesh;
use fearless_simd::Level;
use parry3d_f64::math::{Real, Vector};
use std::ops::Range;

/// The bits of a plane's coordinates, tried in order: planes are written out, so few bits are
/// preferred.
const BITS: [u32; 4] = [7, 12, 22, 50];

/// A step of the proof, for its checker.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Step {
    /// Halve the triangles.
    Triangles,
    /// Halve the pieces.
    Pieces,
    /// Check that the plane separates both: q . x is less on the robot's side.
    Plane([i64; 3]),
}

/// A search for separating planes in one mesh.
pub(crate) struct PlaneSearch<'a> {
    level: Level,
    groups: Groups<'a>,
}

impl<'a> PlaneSearch<'a> {
    pub(crate) fn new(level: Level, mesh: &'a Mesh) -> Self {
        Self { level, groups: Groups::new(mesh) }
    }

    pub(crate) fn mesh(&self) -> &'a Mesh {
        self.groups.mesh
    }

    /// Returns the steps that separate all triangles from all bodies; `None` if a body is too near
    /// a triangle, or within rounding of that.
    pub(crate) fn steps(&mut self, bodies: &[ProofBody]) -> Option<Vec<Step>> {
        let mut steps = Vec::new();
        self.part(ALL, bodies, 0..bodies.len(), &mut steps).then_some(steps)
    }

    fn part(
        &mut self,
        group: usize,
        bodies: &[ProofBody],
        run: Range<usize>,
        steps: &mut Vec<Step>,
    ) -> bool {
        if let Some(plane) = self.plane(group, &bodies[run.clone()]) {
            steps.push(Step::Plane(plane));
            return true;
        }
        let (triangles, pieces) = (self.groups.get(group).triangles.len(), run.len());
        let [low, high] = self.groups.get(group).bounds;
        let is_larger = (high - low).length_squared() >= size_of(&bodies[run.clone()]);
        if triangles > 1 && (pieces == 1 || is_larger) {
            steps.push(Step::Triangles);
            let halves = self.groups.halves(group);
            return halves.into_iter().all(|half| self.part(half, bodies, run.clone(), steps));
        }
        if pieces > 1 {
            steps.push(Step::Pieces);
            let middle = run.start.midpoint(run.end);
            let halves = [run.start..middle, middle..run.end];
            return halves.into_iter().all(|half| self.part(group, bodies, half, steps));
        }
        false
    }

    /// Returns a plane that separates a group from a run of bodies.
    fn plane(&self, group: usize, bodies: &[ProofBody]) -> Option<[i64; 3]> {
        let wall = self.groups.get(group);
        let most = bodies.iter().flat_map(|body| body.ends).map(|end| end.abs().max_element());
        let most = most.fold(wall.reach(), Real::max);
        let parts = |q: Vector| {
            let level = wall.level(q);
            bodies.iter().all(|body| body.is_below(q, level, most))
        };
        let try_along =
            |way: Vector| BITS.iter().filter_map(|&bits| in_bits(way, bits)).find(|q| parts(*q));
        let found = between_hulls(wall, bodies).and_then(try_along).or_else(|| {
            let (&[triangle], [body]) = (&*wall.triangles, bodies) else { return None };
            let ways = between_pair(self.level, self.groups.mesh, triangle, body);
            ways.into_iter().flatten().find_map(try_along)
        });
        found.map(|q| q.to_array().map(|number| number as i64))
    }
}

/// Returns a direction in whole numbers of at most `bits` bits.
fn in_bits(way: Vector, bits: u32) -> Option<Vector> {
    let largest = way.abs().max_element();
    let q = (way / largest * 2.0_f64.powi(bits as i32)).round();
    (largest > 0.0 && q.is_finite()).then_some(q)
}

/// Returns the squared diagonal of the bounding box of the bodies' ends.
fn size_of(bodies: &[ProofBody]) -> Real {
    let nothing = [Vector::INFINITY, Vector::NEG_INFINITY];
    let ends = bodies.iter().flat_map(|body| body.ends);
    let [low, high] = ends.fold(nothing, |[low, high], end| [low.min(end), high.max(end)]);
    (high - low).length_squared()
}
