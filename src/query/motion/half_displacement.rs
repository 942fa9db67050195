//! The displacement of a piece before or after the middle shape of an interval, and the gap that
//! remains.
//!
//! # Definitions
//! - A motion may bound the displacement of a piece (`motion::speed`). Relative to the
//!   middle shape, every point moves by a vector in the triangle (0, a, b), up to an error of
//!   `off`. Here a and b are the displacements of the ends of the piece: at the share s of the
//!   piece and the fraction q of the time, the displacement is q ((1 - s) a + s b). Before the
//!   middle shape, a and b are the negatives of the displacements up to it, and q runs backwards
//!   from it.
//! - n: the normal of a plane that separates the body in the middle shape from a triangle. gap: the
//!   width of the separation along n.
//! - **beside**: (radius x turn + mesh speed) x time. The body contains balls around the points, or
//!   discs, whose points move by radius x turn more. A moving mesh comes nearer by its speed. A
//!   shift that all its vertices share is subtracted from a and b instead.
//!
//! # Claim
//! At all times of that half of the interval, body and triangle are separated along n by at least
//!
//! `gap - (max(0, -n . a, -n . b) + off + beside)`.
//!
//! So motion along the wall or away from it needs no gap. Every unit vector n is valid, and each
//! triangle may have its own.
//!
//! **Rounding.** The gap and the sum use the same n. All coordinates and lengths are at most
//! `reach`. Each loses less than 32 u reach; the slack of a placed tube is 128 u reach, more than
//! twice that.

use crate::distance::Scalar;
use crate::motion::DisplacementBound;
use crate::pair::PlacedLink;
use parry3d_f64::math::{Real, Vector};

/// The displacement of a piece on one side of the middle shape.
#[derive(Clone, Copy, Debug)]
pub(super) struct HalfDisplacement {
    /// The displacements a and b relative to the middle shape.
    pub ways: [Vector; 2],
    /// How much nearer it may come in addition, in any direction: off + beside.
    pub any_direction: Real,
}

/// Covers fewer than 16 roundings.
const UP: Real = 1.0 + 16.0 * Real::UNIT_ROUNDOFF;

impl HalfDisplacement {
    /// Returns the displacement before the middle shape (`side` 0) or after it (1); `None` if it is
    /// not bounded.
    pub(super) fn of(bound: &DisplacementBound, side: usize, beside: Real) -> Option<Self> {
        let is_known = bound.ways.iter().all(|way| way.is_finite())
            && (0.0..Real::INFINITY).contains(&bound.off);
        let sign = if side == 0 { -1.0 } else { 1.0 };
        is_known.then(|| Self {
            ways: bound.ways.map(|way| way * sign),
            any_direction: bound.off + beside,
        })
    }

    /// Returns a body that contains the body at every displacement in the triangle (0, a, b).
    /// `any_direction` is not included: the caller searches that much farther.
    ///
    /// All displacements lie in the triangle (0, a, b). Along the axis the body becomes longer by
    /// their range. Let a' and b' be the components across the axis. The body moves by (a' + b') /
    /// 4 and becomes wider by the largest distance of 0, a' and b' from there.
    pub(super) fn swept_body(&self, body: &PlacedLink) -> PlacedLink {
        let axis = Vector::from(body.axis());
        let along = self.ways.map(|way| way.dot(axis));
        let across = [0, 1].map(|end| self.ways[end] - axis * along[end]);
        let shift = (across[0] + across[1]) * 0.25;
        let wider = [-shift, across[0] - shift, across[1] - shift].map(Vector::length);
        let back = along[0].min(along[1]).min(0.0);
        let ahead = along[0].max(along[1]).max(0.0);
        let radius = body.radius() + wider[0].max(wider[1]).max(wider[2]);
        let (start, end) = (body.start() + shift + axis * back, body.end() + shift + axis * ahead);
        PlacedLink::between(start, end, radius, body.flat())
    }

    /// Returns the gap that the displacement uses up along a normal from the triangle to the piece.
    pub(super) fn gap_loss(&self, normal: Vector) -> Real {
        let against = (-normal.dot(self.ways[0])).max(-normal.dot(self.ways[1])).max(0.0);
        (against + self.any_direction) * UP
    }
}

/// Returns the gap between a body and a triangle along `normal`, which has unit length up to
/// rounding; negative if they overlap.
pub(super) fn gap(body: &PlacedLink, corners: [Vector; 3], normal: Vector) -> Real {
    let start = body.start();
    let axis = Vector::from(body.axis());
    let size = normal.length();
    // A flat end extends along the normal only by its disc.
    let across = normal.cross(axis).length();
    let [at_start, at_end] =
        body.flat().map(|flat| body.radius() * if flat { across } else { size });
    let least = (-at_start).min(normal.dot(body.along()) - at_end);
    let most = corners.map(|corner| normal.dot(corner - start));
    least - most[0].max(most[1]).max(most[2])
}

#[cfg(test)]
mod tests {
    use super::*;
    use continuum_testing::Random;

    /// Returns points of a body: on the edges of flat ends, on the spheres of round ends and on its
    /// side.
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
            let side = HalfDisplacement {
                ways: [random.point(), random.point()],
                any_direction: random.unit(),
            };
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
            let left = nearest - side.any_direction - beyond;
            assert!(left >= stated - 1e-12, "{left} {stated} {body:?} {side:?}");
            least = least.min(left - stated);
            flat += usize::from(body.flat() != [false; 2] && left - stated < 0.01);
            away += usize::from(side.ways.iter().all(|way| normal.dot(*way) > 0.0));
        }
        // The bound is tight: some sample comes close to it.
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
                any_direction: 0.0,
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
