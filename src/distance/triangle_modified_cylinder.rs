//! Triangle against modified cylinder (paper, equations (26) to (33), corrected).
//!
//! Let s be the parameter of the axis point closest to the triangle, p* the triangle's point and F
//! their distance.
//!
//! 1. **Beside the barrel or beyond a round cap**, 0 < s < 1 or that end is round: the answer is
//!    that of the capsule, max(0, F - r).
//! 2. **Beyond a flat cap**, s exactly 0 or 1 and that end flat: the answer is that of the end's
//!    disc.
//!
//! The split is exact in every configuration, penetration included. Case 1: the capsule contains
//! the link, and the link attains F - r. Case 2: let the flat end lie at z = 0 with the link below,
//! and let p realise the triangle's distance from the link with z(p) beyond it. On the way from p*
//! to p the triangle crosses the plane of the cap; the distance from the axis is convex along that
//! way with its least value at p*, so it does not shrink after the crossing, and the disc is no
//! farther from the crossing than the link from p.
//!
//! Rounding: `segment_triangle` makes s exact near the ends. Where a link is so short that both
//! ends are equally near as far as rounding can tell, s may name the wrong one, so an end also
//! counts where p* lies beyond it. In case 2 the distance between p* and the link, in closed form,
//! is a candidate beside the disc's: both are distances to points of the link, so that the lesser
//! is right wherever either is. A triangle that begins in the plane of a cap and reaches into the
//! link has both as small as rounding, yet it overlaps the link deeply. So the way from p* to
//! the triangle's deepest vertex is a third candidate: where it passes through the disc the two
//! have a common point. What is left of rounding in case 2 counts as 0 by the rule of [`touching`].

use super::point_modified_cylinder::Link;
use super::{
    Closest, Convex, DiscSolver, Mask, Scalar, Vec3, bounds, face::Face, frame::Frame,
    segment_triangle, touching, triangle_disc,
};

/// The distance between a triangle and the solid modified cylinder from `start` to `end`; (28) to
/// (33). `flat` says which of the two caps are flat.
///
/// `point1` lies on the triangle and `point2` in the link. Where the two meet, both are a common
/// point. A link of length 0, or of one whose square falls below the range beside the problem's
/// extent (1e-19 of it in `f32`, 1e-154 in `f64`), has no direction: its caps count as round.
#[inline(always)]
pub fn triangle_modified_cylinder<T: Scalar>(
    triangle: [Vec3<T>; 3],
    start: Vec3<T>,
    end: Vec3<T>,
    radius: T,
    flat: [T::Mask; 2],
) -> Closest<T> {
    triangle_modified_cylinder_by::<Convex, T>(triangle, start, end, radius, flat)
}

/// As [`triangle_modified_cylinder`], with the discs by the route `S`.
#[inline(always)]
pub fn triangle_modified_cylinder_by<S: DiscSolver<T>, T: Scalar>(
    triangle: [Vec3<T>; 3],
    start: Vec3<T>,
    end: Vec3<T>,
    radius: T,
    flat: [T::Mask; 2],
) -> Closest<T> {
    let [a, b, c] = triangle;
    let frame = Frame::around(start, [end, a, b, c], radius);
    let face = Face::new(triangle.map(|vertex| frame.point(vertex)));
    let link = Link::new(frame.point(end), frame.length(radius), flat);
    frame.answer(Axial::new(&link, &face).with_caps_by::<S>(&link, &face))
}

/// The distance between a triangle and a capsule; (26), (27).
#[inline(always)]
pub fn triangle_capsule<T: Scalar>(
    triangle: [Vec3<T>; 3],
    start: Vec3<T>,
    end: Vec3<T>,
    radius: T,
) -> Closest<T> {
    let neither = radius.lt(radius);
    triangle_modified_cylinder(triangle, start, end, radius, [neither, neither])
}

/// What the axis alone decides of a link and a triangle, in coordinates from the link's start.
#[derive(Clone, Copy)]
pub(crate) struct Axial<T: Scalar> {
    /// F^2, the squared distance between axis and triangle.
    pub axis_squared: T,
    /// Whether the axis meets the triangle, which may be as far as rounding can tell.
    pub meets: T::Mask,
    /// s, where on the axis.
    pub s: T,
    /// p*, the triangle's point.
    pub on_triangle: Vec3<T>,
    /// The squared distances between the axis and the triangle's edges, from the face's first
    /// vertex on.
    pub edges_squared: [T; 3],
    /// Whether the disc at the start, or at the end, decides (case 2).
    pub at_flat: [T::Mask; 2],
}

impl<T: Scalar> Axial<T> {
    #[inline(always)]
    pub(crate) fn new(link: &Link<T>, face: &Face<T>) -> Self {
        let (axis, meets) = segment_triangle::from_start(link.end, face);
        let (zero, one) = (axis.s.zero(), axis.s.one());
        let has_axis = zero.lt(link.axis.norm_squared());
        // Both ends of a short link may be as near as rounding can tell; then the end that p* is
        // beyond decides.
        let before_start = axis.on_triangle.dot(link.axis).lt(zero);
        let beyond_end = zero.lt((axis.on_triangle - link.end).dot(link.axis));
        let at_start = before_start | (axis.s.le(zero) & !beyond_end);
        let at_end = beyond_end | (one.le(axis.s) & !before_start);
        Self {
            axis_squared: axis.squared,
            meets,
            s: axis.s,
            on_triangle: axis.on_triangle,
            edges_squared: axis.edges_squared,
            at_flat: [link.flat[0] & has_axis & at_start, link.flat[1] & has_axis & at_end],
        }
    }

    /// Whether a disc decides (case 2).
    #[inline(always)]
    pub(crate) fn beyond_flat_cap(&self) -> T::Mask {
        self.at_flat[0] | self.at_flat[1]
    }

    /// Between p* and the link: an upper bound, and the answer in case 1. Where the axis itself
    /// meets the triangle, p* is a common point, even if rounding puts it beside a link of
    /// radius 0.
    #[inline(always)]
    pub(crate) fn without_caps(&self, link: &Link<T>) -> Closest<T> {
        let zero = self.axis_squared.zero();
        let (distance, on_link) = link.closest_to(self.on_triangle);
        Closest {
            distance: self.meets.select(zero, distance),
            point1: self.on_triangle,
            point2: Vec3::select(self.meets, self.on_triangle, on_link),
        }
    }

    /// A lower and an upper bound on the answer in case 2. The lower one stands against rounding.
    #[inline(always)]
    pub(crate) fn cap_bounds(&self, link: &Link<T>, face: &Face<T>) -> (T, T) {
        let (centre, outward) = self.cap(link);
        let vertices = face.seen_from(centre).vertices;
        let behind = link.end.largest() * link.radius.lit(2.0) + link.radius;
        bounds::separating_plane(vertices, self.on_triangle - centre, outward, link.radius, behind)
    }

    /// The answer, discs included.
    #[inline(always)]
    pub(crate) fn with_caps(&self, link: &Link<T>, face: &Face<T>) -> Closest<T> {
        self.with_caps_by::<Convex>(link, face)
    }

    /// The answer, discs included, by the route `S`.
    #[inline(always)]
    pub(crate) fn with_caps_by<S: DiscSolver<T>>(
        &self,
        link: &Link<T>,
        face: &Face<T>,
    ) -> Closest<T> {
        let upper = self.without_caps(link);
        let (centre, outward) = self.cap(link);
        let disc =
            triangle_disc::from_centre::<S, T>(&face.seen_from(centre), outward, link.radius);
        let disc = Closest {
            distance: disc.distance,
            point1: disc.point1 + centre,
            point2: disc.point2 + centre,
        };
        let beyond = self.beyond_flat_cap();
        let nearer = Closest::select(beyond & disc.distance.lt(upper.distance), disc, upper);
        let (passes, point) = self.way_in(link, face);
        let zero = link.radius.zero();
        let met = Closest { distance: zero, point1: point, point2: point };
        let closest = Closest::select(beyond & passes & zero.lt(nearer.distance), met, nearer);
        let [a, b, c] = face.vertices;
        touching::settle(closest, beyond, touching::extent([link.end, a, b, c], link.radius))
    }

    /// Whether the way from p* to the vertex that lies deepest behind the cap passes through the
    /// disc, and where.
    #[inline(always)]
    fn way_in(&self, link: &Link<T>, face: &Face<T>) -> (T::Mask, Vec3<T>) {
        let (centre, outward) = self.cap(link);
        let [a, b, c] = face.seen_from(centre).vertices;
        let [of_a, of_b, of_c] = [-a.dot(outward), -b.dot(outward), -c.dot(outward)];
        let depth = of_a.max(of_b).max(of_c);
        let deepest = Vec3::select(depth.le(of_a), a, Vec3::select(depth.le(of_b), b, c));
        let from = self.on_triangle - centre;
        let height = from.dot(outward).max(depth.zero());
        let crossing = from.along(deepest - from, height.over(height + depth));
        let radial = crossing.along(outward, -crossing.dot(outward));
        let passes = depth.zero().lt(depth) & radial.norm_squared().le(link.radius * link.radius);
        (passes, centre + radial)
    }

    /// The centre and the outward normal of the cap that p* is beyond; the start's where it is
    /// beyond neither.
    #[inline(always)]
    pub(crate) fn cap(&self, link: &Link<T>) -> (Vec3<T>, Vec3<T>) {
        let at_end = self.at_flat[1];
        (
            Vec3::select(at_end, link.end, Vec3::zero(link.radius)),
            Vec3::select(at_end, link.axis, -link.axis),
        )
    }
}
