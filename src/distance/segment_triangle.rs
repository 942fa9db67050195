//! The distance between a segment and a triangle, with the parameter of the closest point on the
//! segment.
//!
//! ```text
//!     The triangle, seen edge-on:
//!
//!     1. piercing          2. an end            3. an edge
//!          |                   /                 \
//!          |                  /                   \
//!     _____|_____         ___._____                \ _________
//!          |                 foot                   edge
//! ```
//!
//! 1. **Piercing.** The ends lie on opposite sides of the plane and the crossing lies inside:
//!    distance 0.
//! 2. **An end above the interior.** The foot of the end on the plane lies inside.
//! 3. **An edge.** Segment-segment with each of the three edges.
//!
//! # Rounding
//! - The crossing is computed as a point and then located in the triangle. Interpolating the plane
//!   coordinates of the ends would fail on a sliver: they are as large as length / height, and so
//!   is their error.
//! - A segment whose ends lie on opposite sides, and which passes an edge within rounding, meets
//!   the edge. Otherwise the segment might miss both triangles of the edge and pass through a
//!   closed wall.
//! - The ends count only against the interior, and the edges by segment-segment. So the parameter
//!   is exact within rounding, and exactly 0 or 1 at an end. The caps of a link depend on this.

use super::face::{Face, Projection};
use super::{Closest, Mask, Scalar, Vec3, frame::Frame, segment_segment};

/// The largest distance at which a segment counts as meeting an edge, in units of `u` and the
/// largest coordinate.
const AT_AN_EDGE: f64 = 4.0;

/// Returns the distance between a segment and a triangle, and the closest points.
///
/// ```text
///     segment[1] `-._
///                    `* point1 = segment[0]
///                     |
///                     | distance
///   __________________*_______   triangle, edge-on
///                   point2
/// ```
///
/// All points share one frame and unit. Both shapes may be degenerate.
#[inline(always)]
pub fn segment_triangle<T: Scalar>(segment: [Vec3<T>; 2], triangle: [Vec3<T>; 3]) -> Closest<T> {
    let [a, b, c] = triangle;
    let frame = Frame::around(segment[0], [segment[1], a, b, c], a.x.zero());
    let face = Face::new(triangle.map(|vertex| frame.point(vertex)));
    let end = frame.point(segment[1]);
    let (found, meets) = from_start(end, &face);
    let distance = meets.select(end.x.zero(), found.squared.sqrt());
    frame.answer(Closest { distance, point1: end * found.s, point2: found.on_triangle })
}

/// The closest points of a link's axis and a triangle.
#[derive(Clone, Copy)]
pub(crate) struct AxisTriangle<T> {
    /// The squared distance.
    pub squared: T,
    /// The parameter on the segment, in `[0, 1]`.
    pub s: T,
    /// The closest point of the triangle.
    pub on_triangle: Vec3<T>,
    /// The squared distances of the triangle's edges, in the order of the face's vertices.
    pub edges_squared: [T; 3],
}

impl<T: Scalar> AxisTriangle<T> {
    #[inline(always)]
    fn nearer(self, other: Self) -> Self {
        other.select(other.squared.lt(self.squared), self)
    }

    #[inline(always)]
    fn nearer_where(self, mask: T::Mask, other: Self) -> Self {
        other.select(mask & other.squared.lt(self.squared), self)
    }

    /// Returns `self` where the mask is true, `no` elsewhere. The distances of the edges stay those
    /// of `no`, which has measured them.
    #[inline(always)]
    fn select(self, take: T::Mask, no: Self) -> Self {
        Self {
            squared: take.select(self.squared, no.squared),
            s: take.select(self.s, no.s),
            on_triangle: Vec3::select(take, self.on_triangle, no.on_triangle),
            edges_squared: no.edges_squared,
        }
    }
}

/// Same as [`segment_triangle`], for the segment from the origin to `end` and numbers near one.
/// Also returns whether the two meet.
#[inline(always)]
pub(crate) fn from_start<T: Scalar>(end: Vec3<T>, face: &Face<T>) -> (AxisTriangle<T>, T::Mask) {
    let (zero, one) = (end.x.zero(), end.x.one());
    let [a, b, c] = face.vertices;
    // Case 3.
    let (ab, bc, ca) = (edge(end, a, b), edge(end, b, c), edge(end, c, a));
    let edges_squared = [ab.squared, bc.squared, ca.squared];
    let nearest = AxisTriangle { edges_squared, ..ab.nearer(bc).nearer(ca) };
    // Case 2.
    let (low, high) = (face.project(Vec3::zero(zero)), face.project(end));
    let nearest = nearest
        .nearer_where(low.inside, above(face, zero, &low))
        .nearer_where(high.inside, above(face, one, &high));
    // Case 1.
    let (from, to) = (-face.across.dot(a), face.across.dot(end - a));
    let opposite = (from.lt(zero) & zero.lt(to)) | (to.lt(zero) & zero.lt(from));
    let s = from.abs().over(from.abs() + to.abs());
    let pierced = AxisTriangle { squared: zero, s, on_triangle: end * s, edges_squared: [zero; 3] };
    let extent = end.largest().max(a.largest()).max(b.largest()).max(c.largest());
    let rounding = extent * zero.lit(AT_AN_EDGE * T::UNIT_ROUNDOFF);
    let nearest = nearest.nearer_where(opposite & face.holds_point(end * s, rounding), pierced);
    let meets = nearest.squared.le(zero) | (opposite & nearest.squared.le(rounding * rounding));
    (nearest, meets)
}

/// Case 3, for one edge. (A function, because a closure may not be inlined.)
#[inline(always)]
fn edge<T: Scalar>(end: Vec3<T>, from: Vec3<T>, to: Vec3<T>) -> AxisTriangle<T> {
    let found = segment_segment::parameters(-from, end, to - from);
    AxisTriangle {
        squared: found.gap.norm_squared(),
        s: found.s,
        on_triangle: from.along(to - from, found.t),
        edges_squared: [found.gap.norm_squared(); 3],
    }
}

/// Case 2, for the end at `s`.
#[inline(always)]
fn above<T: Scalar>(face: &Face<T>, s: T, foot: &Projection<T>) -> AxisTriangle<T> {
    let squared = foot.residual.norm_squared();
    AxisTriangle {
        squared,
        s,
        on_triangle: face.at(foot.alpha, foot.beta),
        edges_squared: [squared; 3],
    }
}
