//! The distance between a triangle and a modified cylinder (paper, equations (26) to (33),
//! corrected).
//!
//! ```text
//!                   case 1                     p*  case 2
//!                     p*                      /
//!                     | F - r                /
//!        _____________|_____________________/
//!       /                                  |
//!      |  s = 0 o--------- axis -----------o s = 1
//!       \__________________________________|
//!     round end                         flat end
//! ```
//!
//! # Definitions
//! - `Z`: the link, with an axis segment, a radius `r` and two caps. `T`: the triangle.
//! - `F`: the distance between the axis and `T`, attained at the axis parameter `s` in `[0, 1]` and
//!   at the point `p*` of `T`.
//! - `K`: the capsule, all points at most `r` from the axis. `K` contains `Z`.
//! - `d`: the distance between `Z` and `T`.
//!
//! # Algorithm
//! 1. **Barrel or round cap**: `0 < s < 1`, or the end at `s` is round. Then `d = max(0, F - r)`,
//!    the distance of the capsule.
//! 2. **Flat cap**: `s` is exactly 0 or 1, and that end is flat. Then `d` is the distance between
//!    `T` and the disc of that end.
//!
//! # Claim
//! The two cases are exact in every configuration, overlap included.
//!
//! # Proof
//! Case 1. `K` contains `Z`, so `d >= max(0, F - r)`. The point of `K` nearest to `p*` belongs to
//! `Z`; if `F <= r`, that is `p*` itself.
//!
//! Case 2. Place the flat end at `z = 0`, with `Z` in `z <= 0`; then `z(p*) >= 0`. Let the point
//! `p` of `T` attain `d`.
//! - If `z(p) >= 0`, the nearest point of `Z` to `p` belongs to the disc.
//! - If `z(p) < 0`, the segment from `p*` to `p` crosses `z = 0` at a point `c` of `T`. The
//!   distance from the axis is convex along this segment and least at `p*`, so it does not decrease
//!   from `c` to `p`. The disc is therefore no farther from `c` than `Z` is from `p`.
//!
//! The proof uses only that `T` is convex.
//!
//! # Rounding
//! - `segment_triangle` computes `s` exactly 0 or 1 at an end. On a very short axis both ends are
//!   equally near within rounding, so `s` may name the wrong end. A flat end therefore also counts
//!   if `p*` lies beyond it.
//! - Case 2 keeps two candidates: the disc, and the closed-form distance between `p*` and `Z`. Each
//!   is a distance between a point of `T` and a point of `Z`. The smaller is right if either is
//!   right.
//! - A triangle may begin in the plane of a cap and reach deep into the link. Both candidates are
//!   then as small as rounding, although the overlap is deep. The third candidate is the segment
//!   from `p*` to the deepest vertex of `T`: if this segment passes through the disc, the crossing
//!   is a common point.
//! - In case 2 a distance within rounding of 0 becomes 0, by the rule of [`touching`].
//!
//! # Bounds at a flat cap
//! From the closest points of the axis alone ([`separating_plane`]).
//!
//! ```text
//!       A ^                      . p*
//!         |                   .  |
//!         +---> R          .     | l        normal along the dots
//!                       .        |
//!      _______________x..........|
//!     |               |    b
//!     |     link      |
//! ```
//!
//! ## Definitions
//! - `F`: the distance between axis and triangle. `p*`: the triangle's closest point. `d`: the
//!   distance between link and triangle.
//! - `K`: the capsule around the link, with the distance `d_K = max(0, F - r)`.
//! - `U`: the distance of `p*` from the link.
//! - `A`: the unit axis pointing out of the flat end. `R`: the unit vector from the axis to `p*`,
//!   across the axis.
//! - `l`: the height of `p*` over the cap. `b`: the distance of `p*` from the rim's cylinder.
//! - `x`: the rim point towards `p*`, or the foot of `p*` on the cap if `b = 0`.
//!
//! ## Claim
//! `d_K <= d <= U <= F`, and with the separating plane through `x`,
//!
//! ```text
//! normal = (l A + b R) / |(l, b)|,
//! min over the vertices T_i of <normal, T_i - x> <= d.
//! ```
//!
//! ## Proof
//! `K` contains the link, and `p*` lies in the triangle: this gives the first line. Both
//! coefficients of the normal are at least 0, with any rounding, so the link lies behind the plane.
//! The triangle lies ahead of the plane by at least the minimum over its vertices. This bound is
//! far sharper than `d_K`.
//!
//! ## Rounding
//! - In exact arithmetic `p* - x` is the same normal. Its rounding tilts it by `u extent / U`,
//!   which makes the bound wrong by as much where the link nearly touches. So the normal is
//!   composed of `A` and `R`.
//! - `R` is perpendicular to `A` only within rounding. `p*` may be much nearer to the axis than to
//!   the cap's centre. The far end of the link then passes through the plane by `-<normal, A>`
//!   times its distance from the cap. This amount is subtracted.

use super::face::Face;
use super::frame::Frame;
use super::point_modified_cylinder::Link;
use super::{
    Closest, Convex, DiscSolver, Mask, Scalar, Vec3, segment_triangle, touching, triangle_disc,
};

/// Returns the distance between a triangle and a solid modified cylinder, and the closest points;
/// equations (28) to (33).
///
/// ```text
///      ____________*____________   triangle, with point1
///                  |
///                  | distance
///       ___________*___________
///      /         point2        |  ^
///     |  o start ---------- end o | radius
///      \_______________________|
///  flat[0] = false      flat[1] = true
/// ```
///
/// - `triangle`: the vertices. `start`, `end`: the ends of the axis. All share one frame and unit.
/// - `radius`: in the same unit, at least 0.
/// - `flat`: whether the cap at `start` and the cap at `end` are flat; a cap that is not flat is
///   round.
///
/// `point1` lies on the triangle and `point2` in the link. If the two meet, both are one common
/// point. The caps of a link without a direction count as round: its length is 0, or the square of
/// the length falls below the range beside the problem's extent (1e-19 of the extent in `f32`,
/// 1e-154 in `f64`).
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

/// Same as [`triangle_modified_cylinder`], with the solver `S` for segments and discs.
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

/// Returns the distance between a triangle and a capsule, and the closest points; equations (26),
/// (27).
///
/// ```text
///      ____________*____________   triangle, with point1
///                  |
///                  | distance
///       ___________*___________
///      /         point2        \    ^
///     |  o start --------- end o |  | radius
///      \_______________________/
/// ```
///
/// The arguments are the same as for [`triangle_modified_cylinder`], with two round caps.
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

/// The closest points of a link's axis and a triangle, and the case that they select.
///
/// Coordinates are relative to the link's start.
#[derive(Clone, Copy)]
pub(crate) struct Axial<T: Scalar> {
    /// `F^2`, the squared distance between axis and triangle.
    pub axis_squared: T,
    /// Whether the axis meets the triangle, within rounding.
    pub meets: T::Mask,
    /// `s`, the parameter on the axis.
    pub s: T,
    /// `p*`, the closest point of the triangle.
    pub on_triangle: Vec3<T>,
    /// The squared distances between the axis and the edges of the triangle, in the order of the
    /// face's vertices.
    pub edges_squared: [T; 3],
    /// Whether the disc at the start, and the disc at the end, decides (case 2).
    pub at_flat: [T::Mask; 2],
}

impl<T: Scalar> Axial<T> {
    #[inline(always)]
    pub(crate) fn new(link: &Link<T>, face: &Face<T>) -> Self {
        let (axis, meets) = segment_triangle::from_start(link.end, face);
        let (zero, one) = (axis.s.zero(), axis.s.one());
        let has_axis = zero.lt(link.axis.norm_squared());
        // On a short axis both ends may be equally near within rounding: take the end that p* lies
        // beyond.
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

    /// Returns the distance between `p*` and the link: the answer in case 1, an upper bound in case
    /// 2.
    ///
    /// If the axis meets the triangle, `p*` is a common point, even if rounding puts it beside a
    /// link of radius 0.
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

    /// Returns a lower and an upper bound on the answer in case 2. The lower bound allows for
    /// rounding.
    #[inline(always)]
    pub(crate) fn cap_bounds(&self, link: &Link<T>, face: &Face<T>) -> (T, T) {
        let (centre, outward) = self.cap(link);
        let vertices = face.seen_from(centre).vertices;
        let behind = link.end.largest() * link.radius.lit(2.0) + link.radius;
        separating_plane(vertices, self.on_triangle - centre, outward, link.radius, behind)
    }

    /// Returns the answer of both cases.
    #[inline(always)]
    pub(crate) fn with_caps(&self, link: &Link<T>, face: &Face<T>) -> Closest<T> {
        self.with_caps_by::<Convex>(link, face)
    }

    /// Same as [`with_caps`](Self::with_caps), with the solver `S` for segments and discs.
    #[inline(always)]
    fn with_caps_by<S: DiscSolver<T>>(&self, link: &Link<T>, face: &Face<T>) -> Closest<T> {
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

    /// Returns whether the segment from `p*` to the deepest vertex behind the cap passes through
    /// the disc, and the crossing (third candidate of case 2).
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

    /// Returns the centre and the outward normal of the cap that `p*` lies beyond, or of the start
    /// cap if `p*` lies beyond neither; then nothing uses it.
    #[inline(always)]
    pub(crate) fn cap(&self, link: &Link<T>) -> (Vec3<T>, Vec3<T>) {
        let at_end = self.at_flat[1];
        (
            Vec3::select(at_end, link.end, Vec3::zero(link.radius)),
            Vec3::select(at_end, link.axis, -link.axis),
        )
    }
}

/// Returns a lower bound on the distance between a triangle and a link, and the upper bound `U`.
///
/// - `vertices`, `on_triangle`: the triangle and `p*`, relative to the centre of the flat cap.
/// - `outward`: the outward unit normal of the cap. `radius`: the radius of the link.
/// - `behind`: how far the link extends behind the cap, at most.
///
/// The lower bound is reduced by what rounding may have added.
#[inline(always)]
fn separating_plane<T: Scalar>(
    vertices: [Vec3<T>; 3],
    on_triangle: Vec3<T>,
    outward: Vec3<T>,
    radius: T,
    behind: T,
) -> (T, T) {
    let zero = radius.zero();
    let height = on_triangle.dot(outward);
    let radial = on_triangle.along(outward, -height);
    let rho = radial.norm();
    let direction = radial * zero.one().over(rho);
    let (up, out) = (height.max(zero), (rho - radius).max(zero));
    let normal = outward * up + direction * out;
    let upper = up.mul_add(up, out * out).sqrt();

    let support = direction * rho.min(radius);
    let [a, b, c] = vertices;
    let ahead = normal.dot(a - support).min(normal.dot(b - support)).min(normal.dot(c - support));
    let tilt = (-normal.dot(outward)).max(zero);
    let extent = a.largest().max(b.largest()).max(c.largest()).max(behind);
    let bound = (ahead - tilt * behind).over(upper) - extent * zero.lit(16.0 * T::UNIT_ROUNDOFF);
    (zero.lt(upper).select(bound.max(zero), zero), upper)
}
