//! One link against a pack of triangles: which of them may be nearer than a bound.

use super::coarse::CoarseLink;
use crate::distance::lanes::Pack;
use crate::distance::{Axial, Face, Link, Scalar, Vec3};

/// How many triangles stand together in memory: the widest pack, so that any narrower one divides it.
pub(super) const BLOCK: usize = 16;

/// A link in every lane.
#[derive(Clone, Copy)]
pub(super) struct PackedLink<L: Scalar> {
    start: Vec3<L>,
    length: L,
    link: Link<L>,
    has_flat_cap: bool,
}

impl<L: Pack> PackedLink<L> {
    #[inline(always)]
    pub(super) fn new(token: L::Token, link: &CoarseLink<L::Element>) -> Self {
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
        }
    }

    /// The axis point nearest to `point`, and from it to `point`; both from the link's start.
    #[inline(always)]
    fn from_axis(&self, point: Vec3<L>) -> Vec3<L> {
        let relative = point - self.start;
        let t = relative.dot(self.link.axis).max(self.length.zero()).min(self.length);
        relative.along(self.link.axis, -t)
    }

    /// Which spheres around triangles come within `limit` of the axis, as bits.
    #[inline(always)]
    pub(super) fn meets_spheres(&self, centre: Vec3<L>, radius: L, limit: L) -> u64 {
        let reach = limit + radius;
        L::bits(self.from_axis(centre).norm_squared().lt(reach * reach))
    }

    /// The squared distance between the axis and boxes, from below but for rounding.
    ///
    /// Two bounds, of which the larger counts. With v from the axis to the box's centre and h the half extents,
    /// the plane with normal v through the axis keeps |v| - <|v|, h> / |v| from the box: nearly exact for a box
    /// that is small against its distance. The distance between the boxes of node and axis serves large ones.
    #[inline(always)]
    pub(super) fn squared_distance_to_boxes(&self, centre: Vec3<L>, half: Vec3<L>) -> L {
        let zero = self.length.zero();
        let v = self.from_axis(centre);
        let squared = v.norm_squared();
        let ahead = (squared - magnitudes(v).dot(half)).max(zero);
        let plane = (ahead * ahead).over(squared);

        let middle = self.link.end * zero.lit(0.5);
        let gap = magnitudes(centre - self.start - middle) - half - magnitudes(middle);
        let gap = Vec3::new(gap.x.max(zero), gap.y.max(zero), gap.z.max(zero));
        plane.max(gap.norm_squared())
    }

    /// Which triangles may be nearer than the bound whose axis limit is `limit`, as bits, and the squares of
    /// their axis distances.
    #[inline(always)]
    pub(super) fn may_be_nearer(&self, face: &Face<L>, limit: L) -> (u64, L) {
        let face = face.seen_from(self.start);
        let axial = Axial::new(&self.link, &face);
        let squared_limit = limit * limit;
        let mut nearer = L::bits(axial.axis_squared.lt(squared_limit));
        if nearer != 0 && self.has_flat_cap {
            let beyond_cap = axial.plane_bound(&self.link, &face) + self.link.radius;
            nearer &= !L::bits(axial.beyond_flat_cap() & limit.le(beyond_cap));
        }
        (nearer, axial.axis_squared)
    }

    /// The distances of triangles with every disc that decides one: the paper's work for a pair.
    #[inline(always)]
    pub(super) fn distances(&self, face: &Face<L>) -> L {
        let face = face.seen_from(self.start);
        let axial = Axial::new(&self.link, &face);
        if self.has_flat_cap && L::bits(axial.beyond_flat_cap()) != 0 {
            axial.with_caps(&self.link, &face).distance
        } else {
            (axial.axis_squared.sqrt() - self.link.radius).max(self.length.zero())
        }
    }
}

// Functions and not closures below a dispatch: a closure may escape inlining, and its code would then be compiled
// without the instruction set.

#[inline(always)]
fn splat<L: Pack>(token: L::Token, point: Vec3<L::Element>) -> Vec3<L> {
    Vec3::new(L::splat(token, point.x), L::splat(token, point.y), L::splat(token, point.z))
}

#[inline(always)]
fn magnitudes<L: Pack>(vector: Vec3<L>) -> Vec3<L> {
    Vec3::new(vector.x.abs(), vector.y.abs(), vector.z.abs())
}
