//! One link against a pack of triangles: which of them may be nearer than a bound.

use super::coarse::CoarseLink;
use crate::distance::lanes::{Lane, Pack};
use crate::distance::{Axial, DiscSolver, Face, Link, Mask, Scalar, Vec3, pack_disc};

/// How many triangles stand together in memory: the widest pack, so that any narrower one divides it.
pub(super) const BLOCK: usize = 16;

/// Patches of the mesh: what a hierarchy's node knows of its children.
#[derive(Clone, Copy)]
pub(super) struct Patches<L> {
    pub centre: Vec3<L>,
    /// Half extents of the box around the centre.
    pub half: Vec3<L>,
    /// The unit normal of the disc around the centre.
    pub normal: Vec3<L>,
    /// How far the patch reaches from the centre along the normal.
    pub thickness: L,
    /// How far it reaches across the normal.
    pub radius: L,
}

/// What a pack of triangles is to a link. All distances are counted from the axis: the link's own and the radius.
pub(super) struct Nearer<L> {
    /// Which may be nearer than a bound, one bit per lane.
    pub nearer: u64,
    /// Bounds on how near they are: twice the axis distance where no flat cap decides.
    pub lower: L,
    pub upper: L,
}

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
    fn offset_from_axis(&self, point: Vec3<L>) -> Vec3<L> {
        let relative = point - self.start;
        let t = relative.dot(self.link.axis).max(self.length.zero()).min(self.length);
        relative.along(self.link.axis, -t)
    }

    /// Upper bounds on the axis limits of what is in spheres: some point of it is that near.
    #[inline(always)]
    pub(super) fn reach_of_spheres(&self, centre: Vec3<L>, radius: L) -> L {
        // Any point of a triangle is an upper bound on F; beyond a flat cap that is one on the distance alone.
        let beyond = if self.has_flat_cap { self.link.radius } else { self.length.zero() };
        self.offset_from_axis(centre).norm() + radius + beyond
    }

    /// Which spheres around triangles come within `limit` of the axis, as bits.
    #[inline(always)]
    pub(super) fn meets_spheres(&self, centre: Vec3<L>, radius: L, limit: L) -> u64 {
        let reach = limit + radius;
        L::bits(self.offset_from_axis(centre).norm_squared().lt(reach * reach))
    }

    /// The squared distance between the axis and patches, from below but for rounding.
    ///
    /// Let v lead from the axis to a patch's centre. The plane with normal v before the axis keeps as far from the
    /// centre as v is long, less e, where e is how far the patch reaches from its centre against v: at most
    /// (|v_n| thickness + |v_t| radius) / |v| for its disc, with v_n and v_t the parts of v along and across the
    /// disc's normal, and <|v|, half> / |v| for its box. The disc is nearly exact for a patch of wall, however it
    /// is turned. The distance between the boxes of patch and axis serves the large patches near the root.
    #[inline(always)]
    pub(super) fn squared_distance_to_patches(&self, patch: &Patches<L>) -> L {
        let zero = self.length.zero();
        let v = self.offset_from_axis(patch.centre);
        let squared = v.norm_squared();
        let normal_part = v.dot(patch.normal);
        // Not the root of |v|^2 - v_n^2, which loses angles up to the root of the rounding.
        let across = v.along(patch.normal, -normal_part).norm();
        let disc = normal_part.abs().mul_add(patch.thickness, across * patch.radius);
        let reach = disc.min(magnitudes(v).dot(patch.half));
        let relative = patch.centre - self.start;
        let ahead = (v.dot(relative) - self.link.reach_along(v) - reach).max(zero);
        let plane = (ahead * ahead).over(squared);

        let middle = self.link.end * zero.lit(0.5);
        let gap = magnitudes(relative - middle) - patch.half - magnitudes(middle);
        let gap = Vec3::new(gap.x.max(zero), gap.y.max(zero), gap.z.max(zero));
        plane.max(gap.norm_squared())
    }

    /// Which triangles the plane of [`PackedLink::squared_distance_to_patches`] does not rule out, as bits.
    #[inline(always)]
    pub(super) fn not_behind_plane(&self, [a, b, c]: [Vec3<L>; 3], limit: L) -> u64 {
        let centre = (a + b + c) * self.length.lit(1.0 / 3.0);
        let v = self.offset_from_axis(centre);
        let axis = v.dot(self.start) + self.link.reach_along(v);
        let ahead = (v.dot(a).min(v.dot(b)).min(v.dot(c)) - axis).max(limit.zero());
        // A centre on the axis rules nothing out, nor does what falls below the range.
        L::bits(!(limit * limit * v.norm_squared()).lt(ahead * ahead))
    }

    /// Which triangles may be nearer than the bound whose axis limit is `limit`.
    #[inline(always)]
    pub(super) fn may_be_nearer(&self, face: &Face<L>, limit: L) -> Nearer<L> {
        let face = face.seen_from(self.start);
        let axial = Axial::new(&self.link, &face);
        let axis = axial.axis_squared.sqrt();
        let nearer = L::bits(axis.lt(limit));
        if nearer == 0 || !self.has_flat_cap {
            return Nearer { nearer, lower: axis, upper: axis };
        }
        let (lower, upper) = axial.cap_bounds(&self.link, &face);
        let beyond_cap = axial.beyond_flat_cap();
        let lower = beyond_cap.select(axis.max(lower + self.link.radius), axis);
        let upper = beyond_cap.select(upper + self.link.radius, axis);
        Nearer { nearer: L::bits(lower.lt(limit)), lower, upper }
    }

    /// The distances of triangles with every disc that decides one, by the route `S`: the paper's work for a pair.
    #[inline(always)]
    pub(super) fn distances<S: DiscSolver<L::Element>>(&self, token: L::Token, face: &Face<L>) -> L
    where
        L::Element: Lane,
    {
        let face = face.seen_from(self.start);
        let axial = Axial::new(&self.link, &face);
        let beyond_cap = axial.beyond_flat_cap();
        if self.has_flat_cap && L::bits(beyond_cap) != 0 {
            let upper = axial.without_caps(&self.link).distance;
            let (centre, outward) = axial.cap(&self.link);
            let face = face.seen_from(centre);
            let disc = pack_disc::<S, _, L>(token, &face, outward, self.link.radius, beyond_cap).distance;
            (beyond_cap & disc.lt(upper)).select(disc, upper)
        } else {
            (axial.axis_squared.sqrt() - self.link.radius).max(self.length.zero())
        }
    }
}

// Functions and not closures below a dispatch: a closure may escape inlining, and its code would then be compiled
// without the instruction set.

#[inline(always)]
pub(super) fn splat<L: Pack>(token: L::Token, point: Vec3<L::Element>) -> Vec3<L> {
    Vec3::new(L::splat(token, point.x), L::splat(token, point.y), L::splat(token, point.z))
}

#[inline(always)]
fn magnitudes<L: Pack>(vector: Vec3<L>) -> Vec3<L> {
    Vec3::new(vector.x.abs(), vector.y.abs(), vector.z.abs())
}
