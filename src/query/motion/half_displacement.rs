//! Where a piece goes before or after the middle shape of an interval, and what that takes of a
//! gap.
//!
//! A motion may know the course of a piece (`robot::motion::course`): seen from the middle, every
//! point of it goes a part of a way between two known ones, and is `off` that at most. The body of
//! the moment holds balls around the points, or discs, whose points move by the radius times the
//! turn more; and a mesh that moves comes nearer by its speed times the time. So where a plane with
//! the normal n parts the body from a triangle by a gap, the two are at all times parted by that
//! gap, less
//!
//! max(0, -n a, -n b) + off + (radius x turn + mesh speed) x time,
//!
//! a and b being the two ways. What moves along a wall, or away from it, needs no gap for it. Any n
//! will do, for each triangle another: the gap is computed along the very n, and the sum above with
//! it. Of both all coordinates and lengths are at most `reach`; less than 32 u reach is lost in
//! either, which the slack of a placed tube is more than twice of (128 u reach).

use crate::distance::Scalar;
use crate::pair::PlacedLink;
use crate::robot::Course;
use parry3d_f64::math::{Real, Vector};

/// Where a piece goes on one side of the middle shape.
#[derive(Clone, Copy, Debug)]
pub(super) struct HalfDisplacement {
    /// The ways of its two ends, seen from the middle.
    pub ways: [Vector; 2],
    /// How much nearer it may come besides, in any direction.
    pub off: Real,
}

/// Fewer than 16 roundings.
const UP: Real = 1.0 + 16.0 * Real::UNIT_ROUNDOFF;

impl HalfDisplacement {
    /// Side 0 is before the middle shape, 1 after it. None if the course is not known.
    pub(super) fn of(course: &Course, side: usize, beside: Real) -> Option<Self> {
        let is_known = course.ways.iter().all(|way| way.is_finite())
            && (0.0..Real::INFINITY).contains(&course.off);
        let sign = if side == 0 { -1.0 } else { 1.0 };
        is_known.then(|| Self { ways: course.ways.map(|way| way * sign), off: course.off + beside })
    }

    /// A body that holds a body wherever it goes, but for `off`.
    ///
    /// Some vectors lead from a body to where its points are: they are in the triangle of 0 and the
    /// two ways. Along the axis they make it longer; across, it is moved to the middle of them,
    /// and wider by how far they are from there at most.
    pub(super) fn swept_body(&self, body: &PlacedLink) -> PlacedLink {
        let axis = Vector::from(body.axis());
        let along = self.ways.map(|way| way.dot(axis));
        let across = [0, 1].map(|end| self.ways[end] - axis * along[end]);
        let midpoint = (across[0] + across[1]) * 0.25;
        let wider = [-midpoint, across[0] - midpoint, across[1] - midpoint].map(Vector::length);
        let back = along[0].min(along[1]).min(0.0);
        let ahead = along[0].max(along[1]).max(0.0);
        let radius = body.radius() + wider[0].max(wider[1]).max(wider[2]);
        let (start, end) =
            (body.start() + midpoint + axis * back, body.end() + midpoint + axis * ahead);
        PlacedLink::between(start, end, radius, body.flat())
    }

    /// How much of a gap along a normal it takes, which leads from a triangle to the piece.
    pub(super) fn gap_loss(&self, normal: Vector) -> Real {
        let against = (-normal.dot(self.ways[0])).max(-normal.dot(self.ways[1])).max(0.0);
        (against + self.off) * UP
    }
}

/// By how much a plane with this normal, which is of unit length or about, parts a body from a
/// triangle.
pub(super) fn gap(body: &PlacedLink, corners: [Vector; 3], normal: Vector) -> Real {
    let start = body.start();
    let axis = Vector::from(body.axis());
    let size = normal.length();
    // What is behind a flat end reaches across the axis alone.
    let across = normal.cross(axis).length();
    let [first, last] = body.flat().map(|flat| body.radius() * if flat { across } else { size });
    let least = (-first).min(normal.dot(body.along()) - last);
    let most = corners.map(|corner| normal.dot(corner - start));
    least - most[0].max(most[1]).max(most[2])
}

#[cfg(test)]
mod tests {
    use super::*;
    use continuum_testing::Random;

    /// Points of a body: on the edges of flat ends, on the spheres of round ones and on its side.
    fn points(random: &mut Random, body: &PlacedLink) -> Vec<Vector> {
        let axis = Vector::from(body.axis());
        let mut points = Vec::new();
        for (end, sign) in [(0, -1.0), (1, 1.0)] {
            let centre = if end == 0 { body.start() } else { body.end() };
            for _ in 0..200 {
                let way = random.direction();
                let across = (way - axis * way.dot(axis)).normalize();
                let ahead = if sign * way.dot(axis) > 0.0 { way } else { across };
                points.push(centre + if body.flat()[end] { across } else { ahead } * body.radius());
            }
        }
        points
    }

    fn body(random: &mut Random) -> PlacedLink {
        let flat = [random.below(2) == 0, random.below(2) == 0];
        PlacedLink::between(random.point(), random.point(), random.between(0.05, 0.5), flat)
    }

    #[test]
    fn a_gap_less_what_a_side_takes_is_left_wherever_the_body_goes() {
        let mut random = Random::new(5);
        let (mut least, mut flat, mut away) = (Real::INFINITY, 0, 0);
        for _ in 0..400 {
            let body = body(&mut random);
            let side =
                HalfDisplacement { ways: [random.point(), random.point()], off: random.unit() };
            let (corners, normal) =
                ([random.point(), random.point(), random.point()], random.direction());
            let stated = gap(&body, corners, normal) - side.gap_loss(normal);
            let beyond = corners
                .into_iter()
                .fold(Real::NEG_INFINITY, |most, corner| most.max(normal.dot(corner)));
            let nearest =
                points(&mut random, &body).into_iter().fold(Real::INFINITY, |nearest, point| {
                    let ways = [Vector::ZERO, side.ways[0], side.ways[1]];
                    ways.into_iter()
                        .fold(nearest, |nearest, way| nearest.min(normal.dot(point + way)))
                });
            let left = nearest - side.off - beyond;
            assert!(left >= stated - 1e-12, "{left} {stated} {body:?} {side:?}");
            least = least.min(left - stated);
            flat += usize::from(body.flat() != [false; 2] && left - stated < 0.01);
            away += usize::from(side.ways.iter().all(|way| normal.dot(*way) > 0.0));
        }
        // Nothing is taken that a sample does not come near to needing.
        assert!(least < 1e-3 && flat > 100 && away > 50, "{least} {flat} {away}");
    }

    #[test]
    fn what_is_swept_holds_the_body_wherever_it_goes() {
        let mut random = Random::new(6);
        let mut used: Real = 0.0;
        for _ in 0..400 {
            let body = body(&mut random);
            let scale = random.between(0.0, 1.0);
            let side = HalfDisplacement {
                ways: [random.point() * scale, random.point() * scale],
                off: 0.0,
            };
            let swept = side.swept_body(&body);
            for point in points(&mut random, &body) {
                let parts = [random.unit(), random.unit()];
                let way = side.ways[0] * parts[0].min(parts[1])
                    + side.ways[1] * (1.0 - parts[0].max(parts[1]));
                for way in [Vector::ZERO, side.ways[0], side.ways[1], way] {
                    let away = swept.measure(0, [point + way; 3]).distance;
                    assert!(away <= 1e-12, "{away} {body:?} {side:?}");
                    let axis = swept.start() + swept.along() * swept.share_of(point + way);
                    used = used.max((point + way - axis).length() / swept.radius());
                }
            }
        }
        assert!(used > 0.99, "{used}");
    }
}
