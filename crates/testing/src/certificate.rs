//! Certificates of a distance between convex shapes, in double-double arithmetic.
//!
//! - **Upper bound**: the distance of two points that lie in the shapes.
//! - **Lower bound**: the separation of the shapes along a direction.
//!
//! Both hold for all points and directions, however they were computed.

use crate::kernels::{Input, KERNELS};
use parry_continuum::distance::*;

pub type Exact = Vec3<DoubleDouble>;

/// One of the narrow phase's shapes.
pub enum Shape {
    /// A point, a segment or a triangle.
    Hull(Vec<Exact>),
    /// The normal has unit length.
    Plane {
        point: Exact,
        normal: Exact,
    },
    /// The normal has unit length; zero makes a ball.
    Disc {
        centre: Exact,
        normal: Exact,
        radius: DoubleDouble,
    },
    Link {
        ends: [Exact; 2],
        axis: Exact,
        radius: DoubleDouble,
        flat: [bool; 2],
    },
}

/// Bounds on a distance.
#[derive(Clone, Copy, Debug)]
pub struct Bounds {
    pub lower: DoubleDouble,
    pub upper: DoubleDouble,
}

fn zero() -> DoubleDouble {
    DoubleDouble::ZERO
}

impl Shape {
    /// Returns the largest `<direction, x>` over the shape, for a unit direction.
    fn support(&self, direction: Exact) -> DoubleDouble {
        let across = |axis: Exact| (direction - axis * direction.dot(axis)).norm();
        match self {
            Self::Hull(points) => {
                let heights = points.iter().map(|&p| direction.dot(p));
                heights.reduce(Scalar::max).expect("a hull has points")
            }
            Self::Plane { point, .. } => direction.dot(*point),
            Self::Disc { centre, normal, radius } => {
                direction.dot(*centre) + *radius * across(*normal)
            }
            Self::Link { ends, axis, radius, flat } => {
                let forward = direction.dot(*axis);
                let reach = |end: usize, outward: DoubleDouble| {
                    // A round cap extends by its half ball in directions that point out of it,
                    // otherwise only by its rim.
                    let round = !flat[end] && zero().le(outward);
                    direction.dot(ends[end]) + if round { *radius } else { *radius * across(*axis) }
                };
                reach(0, -forward).max(reach(1, forward))
            }
        }
    }

    /// Returns the distance of a point from the shape.
    pub fn distance_to(&self, point: Exact) -> DoubleDouble {
        match self {
            Self::Hull(points) => distance_to_hull(points, point),
            Self::Plane { point: origin, normal } => (point - *origin).dot(*normal).abs(),
            Self::Disc { centre, normal, radius } => {
                let relative = point - *centre;
                let height = relative.dot(*normal);
                let beyond = ((relative - *normal * height).norm() - *radius).max(zero());
                (height * height + beyond * beyond).sqrt()
            }
            Self::Link { ends: [start, end], axis, radius, flat } => {
                let (from_start, from_end) = (point - *start, point - *end);
                let (below, above) = (-from_start.dot(*axis), from_end.dot(*axis));
                let (beyond, from, flat) = if zero().lt(above) {
                    (above, from_end, flat[1])
                } else {
                    (below, from_start, flat[0])
                };
                let rho = (from_start - *axis * from_start.dot(*axis)).norm();
                let barrel = (rho - *radius).max(zero());
                match (zero().lt(beyond), flat) {
                    (false, _) => barrel,
                    (true, true) => (beyond * beyond + barrel * barrel).sqrt(),
                    (true, false) => (from.norm() - *radius).max(zero()),
                }
            }
        }
    }
}

fn distance_to_hull(points: &[Exact], point: Exact) -> DoubleDouble {
    let to_segment = |a: Exact, b: Exact| {
        let edge = b - a;
        let squared = edge.norm_squared();
        let t = edge.dot(point - a).max(zero()).min(squared).over(squared);
        (point - a - edge * t).norm()
    };
    let (a, b, c) = match *points {
        [a] => return (point - a).norm(),
        [a, b] => return to_segment(a, b),
        [a, b, c] => (a, b, c),
        _ => unreachable!("a hull has up to three points"),
    };
    let normal = (b - a).cross(c - a);
    let sides = [(a, b), (b, c), (c, a)].map(|(p, q)| normal.dot((q - p).cross(point - p)));
    let edges = to_segment(a, b).min(to_segment(b, c)).min(to_segment(c, a));
    if zero().lt(normal.norm_squared()) && sides.iter().all(|side| zero().lt(*side)) {
        edges.min((point - a).dot(normal).abs().over(normal.norm()))
    } else {
        edges
    }
}

/// Returns the two shapes of each kernel, in the order of [`KERNELS`].
pub fn shapes(input: &Input<DoubleDouble>) -> [[Shape; 2]; KERNELS.len()] {
    let Input { triangle: [a, b, c], plane_normal, start, end, disc_normal, radius } = *input;
    let point = |p| Shape::Hull(vec![p]);
    let axis = || Shape::Hull(vec![start, end]);
    let edge = || Shape::Hull(vec![a, b]);
    let triangle = || Shape::Hull(vec![a, b, c]);
    let disc = || Shape::Disc { centre: end, normal: disc_normal.normalised(), radius };
    // A link without a length has no direction, so its caps are round.
    let has_length = zero().lt((end - start).norm_squared());
    let link = |flat: [bool; 2]| Shape::Link {
        ends: [start, end],
        axis: (end - start).normalised(),
        radius,
        flat: flat.map(|flat| flat && has_length),
    };
    [
        [axis(), edge()],
        [point(end), triangle()],
        [axis(), triangle()],
        [point(a), disc()],
        [edge(), disc()],
        [Shape::Plane { point: a, normal: plane_normal.normalised() }, disc()],
        [triangle(), disc()],
        [point(a), link([false, false])],
        [point(a), link([true, true])],
        [point(a), link([false, true])],
        [triangle(), link([false, false])],
        [triangle(), link([false, false])],
        [triangle(), link([true, true])],
        [triangle(), link([true, false])],
        [triangle(), link([false, true])],
    ]
}

/// Returns candidate directions that may separate the shapes of an input: those between the closest
/// points of all its pairs.
pub fn directions(input: &Input<DoubleDouble>, answers: &[Closest<DoubleDouble>]) -> Vec<Exact> {
    let Input { triangle, start, end, radius, .. } = *input;
    let discs = [start, end].map(|centre| triangle_disc(triangle, centre, end - start, radius));
    let gaps = discs.iter().chain(answers).map(|closest| closest.point1 - closest.point2);
    gaps.map(Vec3::normalised).collect()
}

/// Returns the bounds that an answer and some directions prove. (If two cases of a kernel tie, the
/// answer's own direction has only half as many digits as its distance.)
pub fn certify(
    [first, second]: &[Shape; 2],
    closest: &Closest<DoubleDouble>,
    directions: &[Exact],
) -> Bounds {
    let gap = closest.point1 - closest.point2;
    let off = first.distance_to(closest.point1) + second.distance_to(closest.point2);
    let apart = |direction: Exact| -first.support(-direction) - second.support(direction);
    let lower = match first {
        Shape::Plane { normal, .. } => apart(*normal).max(apart(-*normal)),
        _ => directions.iter().map(|&direction| apart(direction)).fold(zero(), Scalar::max),
    };
    Bounds { lower: lower.max(zero()), upper: gap.norm() + off }
}
