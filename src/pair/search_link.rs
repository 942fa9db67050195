//! A link near one, in the precision of the search: what rounding does there is told in
//! [`search_frame`](crate::mesh::SearchFrame).

use super::placed_link::PlacedLink;
use crate::distance::lanes::Lane;
use crate::distance::{Scalar, Vec3, gives_direction};
use crate::mesh::{SearchFrame, round};
use parry3d_f64::math::{Real, Vector};

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
    /// A link in the frame of the search. None where it lies too far out for the precision, or its
    /// axis is too short for its flat caps.
    pub(crate) fn new(link: &PlacedLink, frame: &SearchFrame) -> Option<Self> {
        let axis = Vector::from(link.axis());
        Self::of([link.start(), link.end()], link.along(), axis, link.radius(), link.flat(), frame)
    }

    /// The same from the ends of the axis in the mesh's frame, for a link that no pair is measured
    /// with.
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
        // Not from the ends after they are rounded: the direction of a short, thick link must not
        // turn.
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

    /// Whether its `error` is so small that the search rules out nearly all that is farther than
    /// the nearest triangle.
    pub(crate) fn is_resolved(&self, frame: &SearchFrame) -> bool {
        let error: Real = self.error.into();
        4.0 * error <= frame.typical
    }

    /// What the bound of a node must be below for the node to hold a triangle whose axis distance
    /// is below `limit`: the bound may be too large by three times `error`.
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

    /// What every triangle at most `limit` from the axis is nearer than: the converse of
    /// [`SearchLink::axis_limit`].
    pub(crate) fn bound_within(&self, limit: E) -> Real {
        let (limit, radius, error): (Real, Real, Real) =
            (limit.into(), self.radius.into(), self.error.into());
        ((limit - radius).max(0.0) + 2.0 * error) / self.scale
    }

    /// What a triangle is at least from the link, if its axis distance (beyond a flat cap: its
    /// distance and the radius) was computed as `axis_distance`.
    pub(crate) fn at_least(&self, axis_distance: Real) -> Real {
        let (radius, error): (Real, Real) = (self.radius.into(), self.error.into());
        (axis_distance - radius - error).max(0.0) / self.scale
    }

    /// What the upper bound on a triangle's axis distance must stay below for it to be certainly at
    /// most `bound` from the link: the error of [`SearchLink::axis_limit`] the other way.
    pub(crate) fn certain_limit(&self, bound: Real) -> E {
        E::round(bound * self.scale) + self.radius - self.error
    }

    /// What a triangle's axis distance must stay below for it to be possibly at most `bound` from
    /// the link.
    pub(crate) fn axis_limit(&self, bound: Real) -> E {
        E::round(bound * self.scale) + self.radius + self.error
    }
}
