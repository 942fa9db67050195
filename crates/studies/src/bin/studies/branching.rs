//! The two distances of Tables II and III three ways: by a decision tree, by clamping as in the
//! paper's formulas, and as the library computes them.
//!
//! Trees and clamped formulas return the squared distance and use the same products, so that they
//! differ in branching alone. Neither is as exact as the library, which takes the determinant from
//! a cross product, scales the problem by a power of two and returns the closest points.

use parry_continuum::distance::laboratory::Mask;
use parry_continuum::distance::{Scalar, Vec3, point_triangle, segment_segment};

/// One way to compute a distance from four points.
pub trait Query {
    /// The distance, or its square.
    fn run<T: Scalar<Mask = bool>>(points: [Vec3<T>; 4]) -> T;
}

/// Segment p0 p1 and segment q0 q1: what all forms compute first.
struct Two<T> {
    along1: Vec3<T>,
    along2: Vec3<T>,
    gap: Vec3<T>,
    a: T,
    b: T,
    c: T,
    d: T,
    e: T,
}

impl<T: Scalar> Two<T> {
    #[inline(always)]
    fn new([p0, p1, q0, q1]: [Vec3<T>; 4]) -> Self {
        let (along1, along2, gap) = (p1 - p0, q0 - q1, p0 - q0);
        Self {
            along1,
            along2,
            gap,
            a: along1.dot(along1),
            b: along1.dot(along2),
            c: along2.dot(along2),
            d: along1.dot(gap),
            e: along2.dot(gap),
        }
    }

    #[inline(always)]
    fn squared(&self, t: T, v: T) -> T {
        (self.gap + self.along1 * t + self.along2 * v).norm_squared()
    }
}

/// (7) and (8) without a branch, corrected: the parameter of the second segment follows from that
/// of the first.
pub struct ClampedSegments;

impl Query for ClampedSegments {
    #[inline(always)]
    fn run<T: Scalar<Mask = bool>>(points: [Vec3<T>; 4]) -> T {
        let two = Two::new(points);
        let Two { a, b, c, d, e, .. } = two;
        let zero = a.zero();
        let free = (e * b - d * c) / (a * c - b * b);
        let (to_start, to_end) = (-d, -(d + b));
        let t =
            (free * a).max(to_start.min(to_end)).min(to_start.max(to_end)).max(zero).min(a).over(a);
        let v = (-(e + b * t)).max(zero).min(c).over(c);
        two.squared(t, v)
    }
}

/// The same by a decision tree: which of interior, end or start holds the closest point of either
/// segment.
pub struct TreeSegments;

impl Query for TreeSegments {
    #[inline(always)]
    fn run<T: Scalar<Mask = bool>>(points: [Vec3<T>; 4]) -> T {
        let two = Two::new(points);
        let Two { a, b, c, d, e, .. } = two;
        let (zero, one) = (a.zero(), a.one());
        // The first segment's parameter if the second were a line.
        let (numerator, determinant) = (e * b - d * c, a * c - b * b);
        let t = if determinant.le(zero) || numerator.le(zero) {
            zero
        } else if determinant.le(numerator) {
            one
        } else {
            numerator / determinant
        };
        let v = -(e + b * t);
        // If that leaves the second segment, its end decides, and the first follows.
        let follow = |v: T| {
            let t = -(d + b * v);
            if t.le(zero) {
                zero
            } else if a.le(t) {
                one
            } else {
                t / a
            }
        };
        if v.le(zero) {
            two.squared(follow(zero), zero)
        } else if c.le(v) {
            two.squared(follow(one), one)
        } else {
            two.squared(t, v / c)
        }
    }
}

/// The library's kernel.
pub struct LibrarySegments;

impl Query for LibrarySegments {
    #[inline(always)]
    fn run<T: Scalar<Mask = bool>>([p0, p1, q0, q1]: [Vec3<T>; 4]) -> T {
        segment_segment([p0, p1], [q0, q1]).distance
    }
}

/// Point and triangle without a branch: the face where the foot lies inside, and the three edges by
/// clamping.
pub struct ClampedTriangle;

impl Query for ClampedTriangle {
    #[inline(always)]
    fn run<T: Scalar<Mask = bool>>([p, a, b, c]: [Vec3<T>; 4]) -> T {
        let (ab, ac, ap) = (b - a, c - a, p - a);
        let normal = ab.cross(ac);
        let squared = normal.norm_squared();
        // Barycentric coordinates of the foot, times the normal's square.
        let (beta, gamma) = (ap.cross(ac).dot(normal), ab.cross(ap).dot(normal));
        let zero = squared.zero();
        let inside = zero.le(beta) & zero.le(gamma) & (beta + gamma).le(squared) & zero.lt(squared);
        let height = normal.dot(ap);
        let edges = edge(p, a, b).min(edge(p, b, c)).min(edge(p, c, a));
        inside.select((height * height).over(squared), edges)
    }
}

/// The squared distance between a point and a segment.
#[inline(always)]
fn edge<T: Scalar>(p: Vec3<T>, start: Vec3<T>, end: Vec3<T>) -> T {
    let (along, to) = (end - start, p - start);
    let squared = along.norm_squared();
    let t = along.dot(to).max(squared.zero()).min(squared).over(squared);
    (to + along * -t).norm_squared()
}

/// The same by a decision tree over the seven regions of the triangle's plane.
pub struct TreeTriangle;

impl Query for TreeTriangle {
    #[inline(always)]
    fn run<T: Scalar<Mask = bool>>([p, a, b, c]: [Vec3<T>; 4]) -> T {
        let (ab, ac, ap) = (b - a, c - a, p - a);
        let zero = ap.x.zero();
        let (b_a, c_a) = (ab.dot(ap), ac.dot(ap));
        if b_a.le(zero) && c_a.le(zero) {
            return ap.norm_squared(); // vertex a
        }
        let bp = p - b;
        let (b_b, c_b) = (ab.dot(bp), ac.dot(bp));
        if zero.le(b_b) && c_b.le(b_b) {
            return bp.norm_squared(); // vertex b
        }
        let gamma = b_a * c_b - b_b * c_a;
        if gamma.le(zero) && zero.le(b_a) && b_b.le(zero) {
            return (ap + ab * -(b_a / (b_a - b_b))).norm_squared(); // edge ab
        }
        let cp = p - c;
        let (b_c, c_c) = (ab.dot(cp), ac.dot(cp));
        if zero.le(c_c) && b_c.le(c_c) {
            return cp.norm_squared(); // vertex c
        }
        let beta = b_c * c_a - b_a * c_c;
        if beta.le(zero) && zero.le(c_a) && c_c.le(zero) {
            return (ap + ac * -(c_a / (c_a - c_c))).norm_squared(); // edge ac
        }
        let alpha = b_b * c_c - b_c * c_b;
        let (to_c, to_b) = (c_b - b_b, b_c - c_c);
        if alpha.le(zero) && zero.le(to_c) && zero.le(to_b) {
            return (bp + (c - b) * -(to_c / (to_c + to_b))).norm_squared(); // edge bc
        }
        let scale = zero.one() / (alpha + beta + gamma);
        (ap + ab * -(beta * scale) + ac * -(gamma * scale)).norm_squared() // face
    }
}

/// The library's kernel.
pub struct LibraryTriangle;

impl Query for LibraryTriangle {
    #[inline(always)]
    fn run<T: Scalar<Mask = bool>>([p, a, b, c]: [Vec3<T>; 4]) -> T {
        point_triangle(p, [a, b, c]).distance
    }
}
