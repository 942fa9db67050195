//! A link in the precision and frame of the search, with the rounding error of its distances.
//! [`SearchFrame`](crate::mesh::SearchFrame) derives the error.

use super::placed_link::PlacedLink;
use crate::distance::lanes::Lane;
use crate::distance::{Scalar, Vec3, gives_direction};
use crate::mesh::{SearchFrame, round};
use parry3d_f64::math::{Real, Vector};

/// A link in the precision of the search.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SearchLink<E> {
    pub start: Vec3<E>,
    /// The vector from start to end.
    pub along: Vec3<E>,
    pub axis: Vec3<E>,
    pub length: E,
    pub radius: E,
    pub flat: [bool; 2],
    /// The rounding error of a distance.
    pub error: E,
    /// The factor from the mesh's unit to that of the search.
    scale: Real,
}

impl<E: Lane> SearchLink<E> {
    /// Returns the link in the frame of the search. Returns `None` if it lies too far out for the
    /// precision, or if its axis is too short for its flat caps.
    pub(crate) fn new(link: &PlacedLink, frame: &SearchFrame) -> Option<Self> {
        let axis = Vector::from(link.axis());
        Self::of([link.start(), link.end()], link.along(), axis, link.radius(), link.flat(), frame)
    }

    /// Same as [`new`](Self::new), from the ends of the axis in the mesh's frame, for a link that
    /// is only searched and never measured.
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
        // Scale the axis vector itself: as a difference of rounded ends, the direction of a short,
        // thick link would turn.
        let along = along * frame.scale;
        let [start, end] = ends.map(|point| (point - frame.centre) * frame.scale);
        let radius = radius * frame.scale;
        let reach = start.abs().max(end.abs()).max_element().max(radius).max(1.0);
        if reach.is_nan() || reach > E::FARTHEST {
            return None;
        }
        let length = along.dot(axis);
        // Such a link is searched in double precision only.
        if flat != [false; 2] && !gives_direction(E::round(length) * E::round(length)) {
            return None;
        }
        let error = 64.0 * (E::UNIT_ROUNDOFF + f64::UNIT_ROUNDOFF) * reach + frame.least;
        Some(Self {
            start: round(start),
            along: round(along),
            // Without a direction the flat caps count as round, which bounds them too.
            axis: round(axis),
            length: E::round(length),
            radius: E::round(radius),
            flat,
            error: E::round(error),
            scale: frame.scale,
        })
    }

    /// Returns whether `error` is small enough that the search excludes nearly all triangles beyond
    /// the closest one.
    pub(crate) fn is_resolved(&self, frame: &SearchFrame) -> bool {
        let error: Real = self.error.into();
        4.0 * error <= frame.typical
    }

    /// Returns the limit below which a node's bound must be if the node holds a triangle with an
    /// axis distance below `limit`: the bound may be too large by `3 error`.
    #[inline(always)]
    pub(crate) fn limit_of_bounds(&self, limit: E) -> E {
        limit + self.error + self.error + self.error
    }

    /// Returns the square of [`SearchLink::limit_of_bounds`].
    #[inline(always)]
    pub(crate) fn squared_limit_of_bounds(&self, limit: E) -> E {
        let limit = self.limit_of_bounds(limit);
        limit * limit
    }

    /// Returns an upper bound on the distance of every triangle at most `limit` from the axis: the
    /// converse of [`SearchLink::axis_limit`].
    pub(crate) fn bound_within(&self, limit: E) -> Real {
        let (limit, radius, error): (Real, Real, Real) =
            (limit.into(), self.radius.into(), self.error.into());
        ((limit - radius).max(0.0) + 2.0 * error) / self.scale
    }

    /// Returns a lower bound on a triangle's distance, from its computed axis distance (beyond a
    /// flat cap: its computed distance plus the radius).
    pub(crate) fn at_least(&self, axis_distance: Real) -> Real {
        let (radius, error): (Real, Real) = (self.radius.into(), self.error.into());
        (axis_distance - radius - error).max(0.0) / self.scale
    }

    /// Returns the limit below which the upper bound on a triangle's axis distance must be for the
    /// triangle to be certainly at most `bound` from the link: as [`SearchLink::axis_limit`], with
    /// the error subtracted.
    pub(crate) fn certain_limit(&self, bound: Real) -> E {
        E::round(bound * self.scale) + self.radius - self.error
    }

    /// Returns the limit below which a triangle's axis distance must be for the triangle to be
    /// possibly at most `bound` from the link.
    pub(crate) fn axis_limit(&self, bound: Real) -> E {
        E::round(bound * self.scale) + self.radius + self.error
    }
}
