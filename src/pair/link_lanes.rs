//! One link against a pack of triangles, in the precision of the search: which of them may be
//! nearer than a bound.
//!
//! # Definitions
//! All distances are measured from the axis, that is, the link's distance plus its radius. `F` is
//! the distance between axis and triangle. `error` is the rounding error of a distance
//! ([`SearchLink`]). The **axis limit** of a bound is the bound plus the radius, widened by
//! `error`.

use super::search_link::SearchLink;
use crate::distance::lanes::Pack;
use crate::distance::{Axial, Face, Link, Mask, Scalar, Vec3};
use crate::mesh::splat;

/// The bounds of a pack of triangles.
pub(crate) struct Nearer<L> {
    /// Which triangles may be nearer than the limit, one bit per lane.
    pub nearer: u64,
    /// A lower and an upper bound, before the link's `error`. Both equal the axis distance if no
    /// flat cap decides. `upper` is at least the radius if a flat cap may decide in this precision.
    pub lower: L,
    pub upper: L,
}

/// The same link in every lane.
#[derive(Clone, Copy)]
pub(crate) struct LinkLanes<L: Scalar> {
    pub start: Vec3<L>,
    pub length: L,
    /// The link relative to its start.
    pub link: Link<L>,
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
            link: Link {
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
        let t = relative.dot(self.link.axis).max(self.length.zero()).min(self.length);
        relative.along(self.link.axis, -t)
    }

    /// Returns upper bounds on the axis distances of the contents of spheres: some point of a
    /// sphere's contents is at most this far.
    #[inline(always)]
    pub(crate) fn reach_of_spheres(&self, centre: Vec3<L>, radius: L) -> L {
        // Any point of a triangle gives an upper bound on F. Beyond a flat cap it bounds the
        // distance itself, so the radius is added.
        let beyond = if self.has_flat_cap { self.link.radius } else { self.length.zero() };
        self.offset_from_axis(centre).norm() + radius + beyond
    }

    /// Returns which spheres around triangles come within `limit` of the axis, one bit per lane.
    #[inline(always)]
    pub(crate) fn meets_spheres(&self, centre: Vec3<L>, radius: L, limit: L) -> u64 {
        let reach = limit + radius;
        L::bits(self.offset_from_axis(centre).norm_squared().lt(reach * reach))
    }

    /// Returns the triangles that one separating plane cannot exclude, one bit per lane. The
    /// plane's normal points from the axis to the triangle's centre.
    #[inline(always)]
    pub(crate) fn not_behind_plane(&self, [a, b, c]: [Vec3<L>; 3], limit: L) -> u64 {
        let centre = (a + b + c) * self.length.lit(1.0 / 3.0);
        let v = self.offset_from_axis(centre);
        let axis = v.dot(self.start) + self.link.reach_along(v);
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
        let along = point.dot(self.link.axis);
        let behind = [self.error.lt(along), along.lt(self.length - self.error)];
        (behind[0] | !self.link.flat[0]) & (behind[1] | !self.link.flat[1])
    }

    /// Returns the bounds of a pack of triangles against the bound with the axis limit `limit`.
    #[inline(always)]
    pub(crate) fn may_be_nearer(&self, face: &Face<L>, limit: L) -> Nearer<L> {
        let face = face.seen_from(self.start);
        self.nearer(&Axial::new(&self.link, &face), &face, limit)
    }

    /// Same as [`may_be_nearer`](Self::may_be_nearer), for a face relative to the link's start.
    #[inline(always)]
    pub(crate) fn nearer(&self, axial: &Axial<L>, face: &Face<L>, limit: L) -> Nearer<L> {
        let axis = axial.axis_squared.sqrt();
        let nearer = L::bits(axis.lt(limit));
        if nearer == 0 || !self.has_flat_cap {
            return Nearer { nearer, lower: axis, upper: axis };
        }
        let (lower, upper) = axial.cap_bounds(&self.link, face);
        let beyond_cap = axial.beyond_flat_cap();
        let lower = beyond_cap.select(axis.max(lower + self.link.radius), axis);
        let mut upper = beyond_cap.select(upper + self.link.radius, axis);
        if L::bits(upper.lt(self.link.radius)) != 0 {
            // Rounding may have put p* behind a flat cap. Then there is a gap, however near the
            // axis is.
            let behind = self.is_behind_flat_caps(axial.on_triangle);
            upper = behind.select(upper, upper.max(self.link.radius));
        }
        Nearer { nearer: L::bits(lower.lt(limit)), lower, upper }
    }

    /// Returns the distances of triangles, with all discs that decide one: the paper's work for a
    /// pair.
    #[inline(always)]
    pub(crate) fn distances(&self, face: &Face<L>) -> L {
        let face = face.seen_from(self.start);
        let axial = Axial::new(&self.link, &face);
        if self.has_flat_cap && L::bits(axial.beyond_flat_cap()) != 0 {
            axial.with_caps(&self.link, &face).distance
        } else {
            (axial.axis_squared.sqrt() - self.link.radius).max(self.length.zero())
        }
    }
}
