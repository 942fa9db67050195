//! One link against a pack of triangles, in the precision of the search: which of them may be
//! nearer than a bound.
//!
//! # Definitions
//! All distances are measured from the axis, that is, the link's distance plus its radius. `F` is
//! the distance between axis and triangle. `error` is the rounding error of a distance
//! ([`SearchLink`]). The **axis limit** of a bound is the bound plus the radius, widened by
//! `error`.
//!
//! [`SearchFrame`](crate::mesh::SearchFrame) derives the error.

use super::placed_link::PlacedLink;
use crate::distance::lanes::{Lane, Pack};
use crate::distance::{Axial, Face, Link, Mask, Scalar, Vec3, gives_direction};
use crate::mesh::{SearchFrame, round, splat};
use parry3d_f64::math::{Real, Vector};

/// The bounds of a pack of triangles.
pub(crate) struct Nearer<L> {
    /// Which triangles may be nearer than the limit, one bit per lane.
    pub nearer: u64,
    /// A lower and an upper bound, before the link's `error`. Both equal the axis distance if no
    /// flat cap decides. `upper` is at least the radius if a flat cap may decide in this precision:
    /// such a triangle never counts as certainly overlapping.
    pub lower: L,
    pub upper: L,
}

/// The same link in every lane.
#[derive(Clone, Copy)]
pub(crate) struct LinkLanes<L: Scalar> {
    pub start: Vec3<L>,
    pub length: L,
    /// The link relative to its start.
    pub shape: Link<L>,
    has_flat_cap: bool,
    error: L,
}

impl<L: Pack> LinkLanes<L> {
    #[inline(always)]
    pub(crate) fn new(token: L::Token, link: &SearchLink<L::Element>) -> Self {
        let radius = L::splat(token, link.radius);
        let (yes, no) = (radius.zero().le(radius.zero()), radius.zero().lt(radius.zero()));
        Self {
            start: splat(token, link.start),
            length: L::splat(token, link.length),
            shape: Link {
                end: splat(token, link.along),
                axis: splat(token, link.axis),
                radius,
                flat: [if link.flat[0] { yes } else { no }, if link.flat[1] { yes } else { no }],
            },
            has_flat_cap: link.flat[0] || link.flat[1],
            error: L::splat(token, link.error),
        }
    }

    #[inline(always)]
    pub(crate) fn has_flat_cap(&self) -> bool {
        self.has_flat_cap
    }

    /// Returns the vector from the closest axis point to `point`.
    #[inline(always)]
    pub(crate) fn offset_from_axis(&self, point: Vec3<L>) -> Vec3<L> {
        let relative = point - self.start;
        let t = relative.dot(self.shape.axis).max(self.length.zero()).min(self.length);
        relative.along(self.shape.axis, -t)
    }

    /// Returns upper bounds on the axis distances of the contents of spheres: some point of a
    /// sphere's contents is at most this far.
    #[cfg(feature = "exhaustive")]
    #[inline(always)]
    pub(crate) fn reach_of_spheres(&self, centre: Vec3<L>, radius: L) -> L {
        // Any point of a triangle gives an upper bound on F. Beyond a flat cap it bounds the
        // distance itself, so the radius is added.
        let beyond = if self.has_flat_cap { self.shape.radius } else { self.length.zero() };
        self.offset_from_axis(centre).norm() + radius + beyond
    }

    /// Returns which spheres around triangles come within `limit` of the axis, one bit per lane.
    #[cfg(feature = "exhaustive")]
    #[inline(always)]
    pub(crate) fn meets_spheres(&self, centre: Vec3<L>, radius: L, limit: L) -> u64 {
        let reach = limit + radius;
        L::bits(self.offset_from_axis(centre).norm_squared().lt(reach * reach))
    }

    /// Returns the triangles that one separating plane cannot exclude, one bit per lane. The
    /// plane's normal points from the axis to the triangle's centre.
    #[inline(always)]
    pub(crate) fn not_excluded_by_plane(&self, [a, b, c]: [Vec3<L>; 3], limit: L) -> u64 {
        let centre = (a + b + c) * self.length.lit(1.0 / 3.0);
        let v = self.offset_from_axis(centre);
        let axis = v.dot(self.start) + self.shape.reach_along(v);
        let ahead = (v.dot(a).min(v.dot(b)).min(v.dot(c)) - axis).max(limit.zero());
        // A centre on the axis excludes nothing, and neither does a square that underflows.
        L::bits(!(limit * limit * v.norm_squared()).lt(ahead * ahead))
    }

    /// Returns whether the centre of some triangle is nearer to the axis than `certain`, and not
    /// beyond a flat cap. Then that triangle is within the bound whose certain limit this is, and
    /// needs no further test.
    ///
    /// **Rounding.** The centre errs by less than 4 u of the largest coordinate, and its position
    /// along the axis by less than 16 u; `error` is 64 u of that coordinate.
    #[inline(always)]
    pub(crate) fn has_centre_within(&self, [a, b, c]: [Vec3<L>; 3], certain: L) -> bool {
        let centre = (a + b + c) * self.length.lit(1.0 / 3.0);
        let certain = certain.max(certain.zero());
        let near = self.offset_from_axis(centre).norm_squared().lt(certain * certain);
        if !self.has_flat_cap {
            return L::bits(near) != 0;
        }
        L::bits(near & self.is_behind_flat_caps(centre - self.start)) != 0
    }

    /// Returns which points, relative to the start, certainly do not lie beyond a flat cap.
    #[inline(always)]
    fn is_behind_flat_caps(&self, point: Vec3<L>) -> L::Mask {
        let along = point.dot(self.shape.axis);
        let behind = [self.error.lt(along), along.lt(self.length - self.error)];
        (behind[0] | !self.shape.flat[0]) & (behind[1] | !self.shape.flat[1])
    }

    /// Returns the bounds of a pack of triangles against the bound with the axis limit `limit`.
    #[inline(always)]
    pub(crate) fn may_be_nearer(&self, face: &Face<L>, limit: L) -> Nearer<L> {
        let face = face.seen_from(self.start);
        self.nearer(&Axial::new(&self.shape, &face), &face, limit)
    }

    /// Same as [`may_be_nearer`](Self::may_be_nearer), for a face relative to the link's start.
    #[inline(always)]
    pub(crate) fn nearer(&self, axial: &Axial<L>, face: &Face<L>, limit: L) -> Nearer<L> {
        let axis = axial.axis_squared.sqrt();
        let nearer = L::bits(axis.lt(limit));
        if nearer == 0 || !self.has_flat_cap {
            return Nearer { nearer, lower: axis, upper: axis };
        }
        let (lower, upper) = axial.cap_bounds(&self.shape, face);
        let beyond_cap = axial.beyond_flat_cap();
        let lower = beyond_cap.select(axis.max(lower + self.shape.radius), axis);
        let mut upper = beyond_cap.select(upper + self.shape.radius, axis);
        if L::bits(upper.lt(self.shape.radius)) != 0 {
            // Rounding may have put p* behind a flat cap. Then there is a gap, however near the
            // axis is.
            let behind = self.is_behind_flat_caps(axial.on_triangle);
            upper = behind.select(upper, upper.max(self.shape.radius));
        }
        Nearer { nearer: L::bits(lower.lt(limit)), lower, upper }
    }

    /// Returns the distances of triangles, with all discs that decide one: the paper's work for a
    /// pair.
    #[cfg(feature = "exhaustive")]
    #[inline(always)]
    pub(crate) fn distances(&self, face: &Face<L>) -> L {
        let face = face.seen_from(self.start);
        let axial = Axial::new(&self.shape, &face);
        if self.has_flat_cap && L::bits(axial.beyond_flat_cap()) != 0 {
            axial.with_caps(&self.shape, &face).distance
        } else {
            (axial.axis_squared.sqrt() - self.shape.radius).max(self.length.zero())
        }
    }
}

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
            // Without a direction the flat caps count as round: the capsule contains the link.
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
    #[cfg(feature = "exhaustive")]
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
