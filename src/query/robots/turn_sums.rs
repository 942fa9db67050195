//! How much a chain turns between two links.
//!
//! # Restrictions
//! Links that share a joint are never queried. This rule is for thin tubes. A joint is too sharp if
//! its links overlap over more than half of the shorter one. Then neighbours cannot be identified,
//! and the robot is refused.
//! - Two links of radius r overlap over r tan(angle / 2).
//! - At a step the thinner link leaves from the centre of the wider one's face. Only the thinner
//!   link leans over that face, so with its radius r they overlap over r tan(angle), for any radius
//!   of the wider link.
//!
//! So a joint is accepted if either length is at most half of the shorter link, the first with the
//! wider radius; 2^-24 more is accepted too, so that a joint at the limit is in every frame.
//!
//! # Rounding
//! The cosine of half a turn falls from 1 to -1 as the turn grows from 0
//! to 2 pi. So cosines are compared instead of turns. Let a and b be the unit axes of two links.
//! 1. Half of their angle has the cosine |a + b| / 2 and the sine |a - b| / 2.
//! 2. Half of the turn up to a link is the product of the complex numbers of its joints. Half of
//!    the turn between two links is the quotient of two such products.
//! 3. The axes are unit vectors to 4 u, so both numbers err by 8 u. Their products over n joints
//!    err by less than 20 n u of length, roundings included. A cosine of a quotient errs by twice
//!    that and 3 u.
//! 4. [`TurnSums`] therefore accepts cosines up to 128 n u above the required one, and 2^-24 more:
//!    parallel legs may open by as much (`pair::JoinedLink`).

use crate::answer::ProximityError;
use crate::distance::Scalar;
use crate::robot::{LEVEL, ModifiedCylinder};
use parry3d_f64::math::{Real, Vector};
use std::f64::consts::FRAC_1_SQRT_2;

/// The turns of a chain's centreline.
#[derive(Clone, Debug, Default)]
pub(super) struct TurnSums {
    /// The cosine and the sine of half of the total turn of the joints before each link.
    before: Vec<[Real; 2]>,
    slack: Real,
    /// For each link, the first later link with a turn of at least pi that shares no joint with it.
    /// If there is none, at least the number of links.
    pub queried_from: Vec<usize>,
    /// The same for a turn of at least pi / 2.
    pub quarter_from: Vec<usize>,
    /// The direction of each link.
    pub directions: Vec<Vector>,
}

impl TurnSums {
    /// Measures the turns of a chain.
    ///
    /// # Errors
    /// A joint is too sharp.
    pub fn measure(&mut self, links: &[ModifiedCylinder]) -> Result<(), ProximityError> {
        self.before.clear();
        let of_link = |link: &ModifiedCylinder| {
            let (length, axis) = link.length_and_axis();
            (axis, length, link.radius())
        };
        let (mut last, mut turned) = (of_link(&links[0]), [1.0, 0.0]);
        self.before.push(turned);
        self.directions.clear();
        self.directions.push(last.0);
        for (joint, link) in links[1..].iter().enumerate() {
            let next = of_link(link);
            // The cosine and the sine of half of the joint's angle.
            let (cosine, sine) =
                (0.5 * (next.0 + last.0).length(), 0.5 * (next.0 - last.0).length());
            let (length, wider, radius) =
                (next.1.min(last.1), next.2.max(last.2), next.2.min(last.2));
            // If a link folds back along the one before, rounding leaves no valid cosine.
            let is_folded = cosine * cosine <= 8.0 * Real::UNIT_ROUNDOFF;
            // The cosine of the whole angle.
            let ahead = (cosine - sine) * (cosine + sine);
            let length_at_least = length * (1.0 + LEVEL);
            let is_wide = 2.0 * wider * sine > length_at_least * cosine;
            let is_thin = || ahead > 0.0 && 4.0 * radius * sine * cosine <= length_at_least * ahead;
            if is_folded || is_wide && !is_thin() {
                let angle = 2.0 * libm::atan2(sine, cosine);
                return Err(ProximityError::JointTooSharp {
                    joint: joint + 1,
                    angle,
                    radius,
                    length,
                });
            }
            let [real, imaginary] = turned;
            turned = [real * cosine - imaginary * sine, real * sine + imaginary * cosine];
            self.before.push(turned);
            self.directions.push(next.0);
            last = next;
        }
        self.slack = 128.0 * links.len() as Real * Real::UNIT_ROUNDOFF + LEVEL;
        let (mut half, mut quarter) =
            (std::mem::take(&mut self.queried_from), std::mem::take(&mut self.quarter_from));
        self.find_queried(0.0, &mut half);
        self.find_queried(FRAC_1_SQRT_2, &mut quarter);
        (self.queried_from, self.quarter_from) = (half, quarter);
        Ok(())
    }

    /// Fills `queried_from`, which is monotone: for each link, the first link whose turn is large
    /// enough. `half_cosine`: the cosine of half of the required turn.
    ///
    /// **Claim.** Every tested turn is below 2 pi, so its half has a unique cosine.
    ///
    /// **Proof.** A tested turn spans two joints. Or it adds one joint to a turn below pi, from
    /// this link or from the link before. A joint turns by less than pi.
    fn find_queried(&self, half_cosine: Real, queried_from: &mut Vec<usize>) {
        queried_from.clear();
        let mut from = 0;
        for link in 0..self.before.len() {
            from = from.max(link + 2);
            while from < self.before.len() && !self.reach(half_cosine, link, from) {
                from += 1;
            }
            queried_from.push(from);
        }
    }

    /// Whether the turn between two links, the second after the first, is at least the angle whose
    /// half has this cosine, up to rounding. The turn must be below 2 pi.
    fn reach(&self, half_cosine: Real, first: usize, second: usize) -> bool {
        let ([c1, s1], [c2, s2]) = (self.before[first], self.before[second]);
        c1 * c2 + s1 * s2 <= half_cosine + self.slack
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::Chain;
    use continuum_testing::Random;
    use std::f64::consts::PI;

    fn turns(points: &[Vector]) -> TurnSums {
        let robot = Chain::with_constant_radius(points, 0.0).expect("points that differ");
        let mut turns = TurnSums::default();
        turns.measure(robot.links()).expect("no joint of a thin robot is too sharp");
        turns
    }

    /// In a regular polygon, a link at half a turn is queried, however rounding falls. Links before
    /// it are not.
    #[test]
    fn half_a_turn_of_a_polygon_is_asked_for() {
        for (corners, scale) in [(4, 1.0), (6, 1e-150), (20, 3.0), (360, 1e150), (2000, 0.1)] {
            let corner = |k: i32| {
                let (sin, cos) = (2.0 * PI * f64::from(k) / f64::from(corners)).sin_cos();
                Vector::new(cos, sin * 0.6, sin * 0.8) * scale
            };
            let points: Vec<_> = (0..3 * corners).map(corner).collect();
            let turns = turns(&points);
            let half = corners as usize / 2;
            for link in 0..points.len() - 1 {
                assert_eq!(
                    turns.queried_from[link],
                    (link + half).min(points.len() - 1).max(link + 2),
                    "{corners}"
                );
                let from = link + (corners as usize).div_ceil(4).max(2);
                assert_eq!(
                    turns.quarter_from[link],
                    from.min(points.len() - 1).max(link + 2),
                    "{corners}"
                );
            }
        }
    }

    #[test]
    fn turns_are_sums_of_angles() {
        let mut random = Random::new(6);
        let (mut asked, mut sharp) = (0, 0);
        for round in 0..2000 {
            // From nearly straight to nearly folded.
            let bend = [0.05, 0.5, 3.0, 50.0][round % 4];
            let mut way = random.direction();
            let mut points = vec![random.point()];
            for _ in 0..3 + random.below(40) {
                way = (way + random.point() * bend).normalize();
                way = if random.below(8) == 0 { -way } else { way };
                points.push(points[points.len() - 1] + way * random.between(0.1, 1.0));
            }
            let ways: Vec<_> =
                points.windows(2).map(|pair| (pair[1] - pair[0]).normalize()).collect();
            let angle = |pair: &[Vector]| {
                libm::atan2(pair[0].cross(pair[1]).length(), pair[0].dot(pair[1]))
            };
            let angles: Vec<_> = ways.windows(2).map(angle).collect();
            if angles.iter().any(|&angle| angle > PI - 1e-6) {
                continue;
            }
            sharp += usize::from(angles.iter().any(|&angle| angle > 3.0));
            let turns = turns(&points);
            for link in 0..ways.len() {
                let is_far = |&other: &usize| angles[link..other].iter().sum::<f64>() >= PI;
                let expected =
                    (link + 2..ways.len()).find(is_far).unwrap_or(ways.len().max(link + 2));
                assert_eq!(turns.queried_from[link], expected, "round {round}");
                asked += usize::from(expected < ways.len());
                let is_far = |&other: &usize| angles[link..other].iter().sum::<f64>() >= 0.5 * PI;
                let expected =
                    (link + 2..ways.len()).find(is_far).unwrap_or(ways.len().max(link + 2));
                assert_eq!(turns.quarter_from[link], expected, "round {round}");
            }
        }
        assert!(asked > 5000 && sharp > 100, "{asked} {sharp}");
    }
}
