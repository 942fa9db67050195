//! The frame of the search: the mesh with coordinates near one, in the precision of the search.
//!
//! # Definitions
//! - `E`: the precision, `f32` or `f64`; u: its unit roundoff.
//! - The mesh is centred at 0, scaled by a power of two and rounded to `E`.
//! - reach: a bound on the coordinates of mesh and link in that frame.
//! - `error = 64 u reach`.
//!
//! **Claim.** A distance computed in that frame errs by less than `error`. So a triangle whose
//! computed distance exceeds a bound by `error` or more is farther than the bound.
//!
//! **Proof.** The kernel errs by `16 u` for each unit of extent, which is at most `2 reach`. Each
//! rounding of the vertices, the axis and the bound adds `2 u reach`. The conversion to that frame
//! and the measured distances are in double precision and add as much of their own roundoff.
//!
//! Every other triangle is measured again in double precision. So every search returns the
//! double-precision answer.
//!
//! **Speed.** The search is fast only while `error` is small beside the triangles. A single
//! triangle that reaches far out makes the frame coarse for all. A link far from the mesh has a
//! large reach. [`SearchLink::is_resolved`](crate::pair::SearchLink::is_resolved) detects both, and
//! the engines then search in double precision.

use super::engine_mesh::Mesh;
use crate::distance::lanes::Lane;
use crate::distance::{Scalar, Vec3};
use parry3d_f64::math::{Real, Vector};

/// The transformation from the mesh's frame to coordinates near one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SearchFrame {
    pub centre: Vector,
    pub scale: Real,
    /// The median size of a sample of triangles, in this frame.
    pub typical: Real,
    /// The most by which rounding to a subnormal number in the mesh's frame changes a distance, in
    /// this frame.
    pub least: Real,
}

/// The size of the sample for `typical`.
const SAMPLE: usize = 1023;

impl SearchFrame {
    /// The frame of a mesh with at least one triangle.
    pub(crate) fn new(mesh: &Mesh) -> Self {
        let [low, high] = mesh.bounds();
        let scale = (high - low).max_element().power_of_two_to_unity();
        let size = |triangle: usize| {
            let [a, b, c] = mesh.corners(triangle as u32);
            (a.max(b).max(c) - a.min(b).min(c)).max_element()
        };
        let mut sizes: Vec<_> =
            (0..mesh.len()).step_by(mesh.len().div_ceil(SAMPLE).max(1)).map(size).collect();
        let middle = sizes.len() / 2;
        let (_, typical, _) = sizes.select_nth_unstable_by(middle, Real::total_cmp);
        // At least the least normal number: arithmetic on a subnormal number takes longer than
        // placing a link.
        let least = (Real::from_bits(1) * scale).max(Real::MIN_POSITIVE);
        Self { centre: low + (high - low) * 0.5, scale, typical: *typical * scale, least }
    }

    #[inline(always)] // called for every corner of the mesh at each refit
    pub(crate) fn point<E: Lane>(&self, point: Vector) -> Vec3<E> {
        round((point - self.centre) * self.scale)
    }
}

/// A point in the precision of the search.
pub(crate) fn round<E: Lane>(point: Vector) -> Vec3<E> {
    Vec3::new(E::round(point.x), E::round(point.y), E::round(point.z))
}
