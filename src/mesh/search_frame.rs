//! The mesh near one, in the precision of the search.
//!
//! The mesh is moved to its centre and multiplied by a power of two, then rounded to `E` (`f32` or
//! `f64`). A distance computed there errs by less than `error` = 64 u reach, where u is the unit
//! roundoff of `E` and reach bounds the coordinates of mesh and link in that frame: 16 u for each
//! unit of extent (at most 2 reach) from the kernel, and 2 u reach for each of the roundings of
//! vertices, axis and the bound it is compared with. What is computed in double precision, the way
//! into that frame and the measured distances, adds as much of its own. A triangle whose computed
//! distance exceeds a bound by `error` or more is therefore farther than the bound; any other is
//! measured again in double precision. So every search returns the double-precision answer.
//!
//! It does so in good time only while `error` is small beside the triangles. A single triangle that
//! reaches far out makes the frame coarse for all, and a link far from the mesh has a large reach.
//! [`SearchLink::is_resolved`](crate::pair::SearchLink::is_resolved) finds that out, and
//! the engines then search in double precision.

use super::engine_mesh::Mesh;
use crate::distance::lanes::Lane;
use crate::distance::{Scalar, Vec3};
use parry3d_f64::math::{Real, Vector};

/// The way from the mesh's frame to coordinates near one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SearchFrame {
    pub centre: Vector,
    pub scale: Real,
    /// The size of a typical triangle in this frame.
    pub typical: Real,
    /// What rounding to a subnormal number can do to a distance of the mesh's frame, seen in this
    /// one.
    pub least: Real,
}

/// How many triangles show what is typical.
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
        // Not a subnormal number itself: to compute with one takes longer than to place a link.
        let least = (Real::from_bits(1) * scale).max(Real::MIN_POSITIVE);
        Self { centre: low + (high - low) * 0.5, scale, typical: *typical * scale, least }
    }

    #[inline(always)] // for every corner of the mesh, each time that it moves
    pub(crate) fn point<E: Lane>(&self, point: Vector) -> Vec3<E> {
        round((point - self.centre) * self.scale)
    }
}

/// A point in the precision of the search.
pub(crate) fn round<E: Lane>(point: Vector) -> Vec3<E> {
    Vec3::from(point.to_array().map(E::round))
}
