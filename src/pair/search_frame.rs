//! The mesh and the links near one, in the precision of the search.
//!
//! The mesh is moved to its centre and multiplied by a power of two, then rounded to `E` (`f32` or `f64`). A
//! distance computed there errs by less than `error` = 64 u reach, where u is the unit roundoff of `E` and reach
//! bounds the coordinates of mesh and link in that frame: 16 u for each unit of extent (at most 2 reach) from
//! the kernel, and 2 u reach for each of the roundings of vertices, axis and the bound it is compared with. What is
//! computed in double precision, the way into that frame and the measured distances, adds as much of its own. A
//! triangle whose computed distance exceeds a bound by `error` or more is therefore farther than the bound;
//! any other is measured again in double precision. So every search returns the double-precision answer.
//!
//! It does so in good time only while `error` is small beside the triangles. A single triangle that reaches far out
//! makes the frame coarse for all, and a link far from the mesh has a large reach. [`SearchFrame::resolves`] tells, and
//! the engines then search in double precision.

use super::placed::PlacedLink;
use crate::distance::lanes::Lane;
use crate::distance::{Scalar, Vec3, gives_direction};
use crate::mesh::Mesh;
use parry3d_f64::math::{Real, Vector};

/// The way from the mesh's frame to coordinates near one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SearchFrame {
    centre: Vector,
    scale: Real,
    /// The size of a typical triangle in this frame.
    typical: Real,
    /// What rounding to a subnormal number can do to a distance of the mesh's frame, seen in this one.
    least: Real,
}

/// How many triangles tell what is typical.
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

    pub(crate) fn point<E: Lane>(&self, point: Vector) -> Vec3<E> {
        round((point - self.centre) * self.scale)
    }

    /// Whether a link's `error` is so small that the search rules out nearly all that is farther than the nearest
    /// triangle.
    pub(crate) fn resolves<E: Lane>(&self, link: &SearchLink<E>) -> bool {
        let error: Real = link.error.into();
        4.0 * error <= self.typical
    }
}

/// A link in the precision of the search.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SearchLink<E> {
    pub start: Vec3<E>,
    /// From start to end.
    pub along: Vec3<E>,
    pub axis: Vec3<E>,
    pub length: E,
    pub radius: E,
    pub flat: [bool; 2],
    /// What rounding can do to a distance.
    pub error: E,
    /// Brings a length of the mesh's frame into the search's.
    scale: Real,
}

impl<E: Lane> SearchLink<E> {
    /// A link in the frame of the search. None where it lies too far out for the precision, or its axis is too short
    /// for its flat caps.
    pub(crate) fn new(link: &PlacedLink, frame: &SearchFrame) -> Option<Self> {
        let axis = Vector::from(link.axis());
        Self::of([link.start(), link.end()], link.along(), axis, link.radius(), link.flat(), frame)
    }

    /// The same from the ends of the axis in the mesh's frame, for a link that no pair is measured with.
    #[inline]
    pub(crate) fn between(
        [start, end]: [Vector; 2],
        radius: Real,
        flat: [bool; 2],
        frame: &SearchFrame,
    ) -> Option<Self> {
        let along = end - start;
        let scaled = along * frame.scale;
        let squared = scaled.length_squared();
        let has_direction = gives_direction(squared) && squared < Real::INFINITY;
        let axis = if has_direction { scaled * (1.0 / squared.sqrt()) } else { Vector::ZERO };
        Self::of([start, end], along, axis, radius, flat, frame)
    }

    #[inline]
    fn of(
        ends: [Vector; 2],
        along: Vector,
        axis: Vector,
        radius: Real,
        flat: [bool; 2],
        frame: &SearchFrame,
    ) -> Option<Self> {
        // Not from the ends after they are rounded: the direction of a short, thick link must not turn.
        let along = along * frame.scale;
        let [start, end] = ends.map(|point| (point - frame.centre) * frame.scale);
        let radius = radius * frame.scale;
        let reach = start.abs().max(end.abs()).max_element().max(radius).max(1.0);
        if reach.is_nan() || reach > E::FARTHEST {
            return None;
        }
        let length = along.dot(axis);
        // A link too short for its flat caps in this precision is one for double precision alone.
        if flat != [false; 2] && !gives_direction(E::round(length) * E::round(length)) {
            return None;
        }
        let error = 64.0 * (E::UNIT_ROUNDOFF + f64::UNIT_ROUNDOFF) * reach + frame.least;
        Some(Self {
            start: round(start),
            along: round(along),
            // Without a direction the flat caps count as round, which is a bound for them too.
            axis: round(axis),
            length: E::round(length),
            radius: E::round(radius),
            flat,
            error: E::round(error),
            scale: frame.scale,
        })
    }

    /// What the bound of a node must be below for the node to hold a triangle whose axis distance is below `limit`: the
    /// bound may be too large by three times `error`.
    #[inline(always)]
    pub(crate) fn limit_of_bounds(&self, limit: E) -> E {
        limit + self.error + self.error + self.error
    }

    /// The square of [`SearchLink::limit_of_bounds`].
    #[inline(always)]
    pub(crate) fn squared_limit_of_bounds(&self, limit: E) -> E {
        let limit = self.limit_of_bounds(limit);
        limit * limit
    }

    /// What every triangle at most `limit` from the axis is nearer than: the converse of [`SearchLink::axis_limit`].
    pub(crate) fn bound_within(&self, limit: E) -> Real {
        let (limit, radius, error): (Real, Real, Real) =
            (limit.into(), self.radius.into(), self.error.into());
        ((limit - radius).max(0.0) + 2.0 * error) / self.scale
    }

    /// What a triangle is at least from the link, if its axis distance (beyond a flat cap: its distance and the radius)
    /// was computed as `axis_distance`.
    pub(crate) fn at_least(&self, axis_distance: Real) -> Real {
        let (radius, error): (Real, Real) = (self.radius.into(), self.error.into());
        (axis_distance - radius - error).max(0.0) / self.scale
    }

    /// What the upper bound on a triangle's axis distance must stay below for it to be certainly at most `bound` from
    /// the link: the error of [`SearchLink::axis_limit`] the other way.
    pub(crate) fn certain_limit(&self, bound: Real) -> E {
        E::round(bound * self.scale) + self.radius - self.error
    }

    /// What a triangle's axis distance must stay below for it to be possibly at most `bound` from the link.
    pub(crate) fn axis_limit(&self, bound: Real) -> E {
        E::round(bound * self.scale) + self.radius + self.error
    }
}

fn round<E: Lane>(point: Vector) -> Vec3<E> {
    Vec3::from(point.to_array().map(E::round))
}
