//! Self contact of a chain: which pairs of its parts may come near each other, and how near they
//! are.
//!
//! # Definitions
//! - **Queried** pair: two places at a local minimum of the distance: it does not decrease if
//!   either place moves along the robot. No margin enters this definition.
//! - **Turn** of two places: the sum of the joint angles between them.
//! - **Face**: the base, the tip, or the wider side of a step in radius. c: its centre. n: its
//!   normal, out of the robot.
//! - **Shoulder**: a round cap at the wider side of a step: a ball around c.
//!
//! Neighbouring links touch, and links around a bend are near only because they are neighbours.
//! Such pairs are no local minima.
//!
//! # Claims: the turn of a queried pair
//! **Claim 1.** Two links need a turn of at least pi.
//!
//! **Proof.** Let x and y be places on the axes of two links where the distance of the axes is a
//! local minimum, and v the unit vector from x to y. The centreline from x to y and the way back
//! along the chord form a closed polygon. Its exterior angles sum to at least 2 pi (Fenchel;
//! equality for plane convex polygons).
//! 1. At x the polygon turns from -v to the direction t of the centreline. Moving x by t changes
//!    the distance at the rate -v . t, which is at least 0 at a minimum. So the angle between -v
//!    and t is at most pi / 2.
//! 2. The same holds at y, at a joint (for the direction of the centreline between x and y), and at
//!    the robot's ends.
//! 3. So the joints between x and y turn by at least 2 pi - pi / 2 - pi / 2 = pi.
//! 4. If the axes meet there is one corner, of at most pi, and the same remains.
//!
//! The distance of two barrels is the distance of their axes minus both radii.
//!
//! **Claim 2.** A flat face and a link need a turn of at least pi / 2.
//!
//! **Proof.** The shortest segment leaves the face at c + a e along v, where e is perpendicular to
//! n, a >= 0, and v lies between n and e at the angle alpha from n. Prolonged by the other link's
//! radius, it ends at a place y of an axis, which it meets at a right angle, as above.
//! 1. Close the polygon by the chord from c to y instead. The chord is a e plus a multiple of v:
//!    its angle beta from n satisfies alpha <= beta <= pi / 2.
//! 2. At y the chord has turned by beta - alpha, which adds that much to pi / 2.
//! 3. At c the centreline continues along n, or comes from the direction opposite to n. The polygon
//!    turns by at most pi - beta in the first case, by beta in the second.
//! 4. The sum is at most 3/2 pi, which leaves pi / 2 for the joints.
//!
//! **Claim 3.** A shoulder and a link need a turn of at least pi / 2.
//!
//! **Proof.** The place of the link nearest to y may be its end only because the robot is thinner
//! beyond. Moving along the centreline is then no descent, so the corner at c is bounded by pi
//! instead of pi / 2. The rest is as in claim 1: pi / 2 is left for the joints. At a round base or
//! tip the centreline ends, and claim 1 holds.
//!
//! **Two faces that look at one another**, the end of a link and the start of a later one, are
//! queried at any turn. Of two other faces, one is at the end of its link that the way to the other
//! reaches anyway. So the turn of pi / 2 remains.
//!
//! The turn only saves work. `pair::JoinedLink` decides whether a face counts beside a link or
//! another face. It also decides whether two links with a turn of pi count: the robot must lead
//! nowhere nearer from their closest places.
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
//! wider radius.
//!
//! # Algorithm
//! 1. [`Descent`] searches the pairs with a turn of pi. From some pairs that do not count,
//!    [`RobotWithItself::slide`] moves to neighbours as long as they are nearer. The last one
//!    probably counts, and then it bounds the search.
//! 2. [`OwnFaces`] searches all others. If [`MOST_REFUSED`] pairs of step 1 do not count, nothing
//!    bounds that search. Then [`OwnFaces`] searches all pairs, since it knows where the robot
//!    leads nearer.
//!
//! # Rounding
//! **Distances.** A measured distance within a bound is truly within [`JoinedLink::tolerance`] of
//! it. The ball around a face is tested first, with that tolerance. It is smaller than the face's
//! link, so it is known more precisely than the measurement.
//!
//! **Turns without angles.** The cosine of half a turn falls from 1 to -1 as the turn grows from 0
//! to 2 pi. So cosines are compared instead of turns. Let a and b be the unit axes of two links.
//! 1. Half of their angle has the cosine |a + b| / 2 and the sine |a - b| / 2.
//! 2. Half of the turn up to a link is the product of the complex numbers of its joints. Half of
//!    the turn between two links is the quotient of two such products.
//! 3. The axes are unit vectors to 4 u, so both numbers err by 8 u. Their products over n joints
//!    err by less than 20 n u of length, roundings included. A cosine of a quotient errs by twice
//!    that and 3 u.
//! 4. [`TurnSums`] therefore accepts cosines up to 128 n u above the required one, and 2^-24 more:
//!    parallel legs may open by as much (`pair::JoinedLink`).

use super::descent::{Descent, PairLimit, measure_pair};
use super::own_faces::{Band, OwnFaces};
use crate::answer::{ProximityError, RobotProximity};
use crate::distance::Scalar;
use crate::pair::{JoinedLink, NearestOfLinks, PlacedLink, PlacedRobot};
use crate::robot::{Chain, LEVEL, ModifiedCylinder};
use parry3d_f64::math::{Pose, Real, Vector};
use std::f64::consts::FRAC_1_SQRT_2;

/// With more rejected pairs the nodes of [`OwnFaces`] are cheaper.
const MOST_REFUSED: usize = 64;

/// The most moves from a rejected pair.
const MOST_MOVES: u32 = 64;

/// State and memory that the next query reuses.
#[derive(Clone, Debug, Default)]
pub(crate) struct SelfMemory {
    descent: Descent,
    turns: TurnSums,
    faces: OwnFaces,
    /// The closest links of the last query.
    nearest: Option<[usize; 2]>,
}

#[cfg(test)]
impl SelfMemory {
    pub(super) fn faces(&self) -> &OwnFaces {
        &self.faces
    }

    #[cfg(test)]
    pub(super) fn faces_mut(&mut self) -> &mut OwnFaces {
        &mut self.faces
    }
}

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
    fn measure(&mut self, links: &[ModifiedCylinder]) -> Result<(), ProximityError> {
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
            let is_wide = 2.0 * wider * sine > length * cosine;
            let is_thin = || ahead > 0.0 && 4.0 * radius * sine * cosine <= length * ahead;
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

/// A robot beside itself, in its own frame.
pub(crate) struct RobotWithItself<'a> {
    robot: PlacedRobot<'a>,
}

impl<'a> RobotWithItself<'a> {
    /// Places a robot beside itself.
    ///
    /// # Errors
    /// A joint is too sharp.
    pub fn new(robot: &'a Chain, memory: &mut SelfMemory) -> Result<Self, ProximityError> {
        let robot = PlacedRobot::new(robot, &Pose::IDENTITY)?;
        memory.turns.measure(robot.links())?;
        Ok(Self { robot })
    }

    /// Returns the nearest pair that counts; `None` if no pair counts.
    pub fn minimum(&self, memory: &mut SelfMemory) -> Option<RobotProximity> {
        let SelfMemory { descent, turns, faces, nearest } = memory;
        let remembered = nearest.filter(|links| links[1] < self.robot.links().len());
        let remembered = remembered
            .filter(|&links| turns.queried_from[links[0]] <= links[1] && self.counts(links));
        let mut best = remembered.map(|links| measure_pair([&self.robot; 2], links));
        let mut refused = 0;
        descent.run([&self.robot; 2], PairLimit::at_best(&best), queried_from(turns), |found| {
            if self.counts(found.links.map(|link| link as usize)) {
                return PairLimit::at(best.insert(found));
            }
            refused += 1;
            if let Some(found) = self.slide(turns, found, refused)
                && PairLimit::at_best(&best).admits(found.distance, found.links.map(|k| k as usize))
            {
                best = Some(found);
            }
            if refused < MOST_REFUSED { PairLimit::at_best(&best) } else { PairLimit::NOTHING }
        });
        // Faces come last because they cost most: the bound so far prunes most of them.
        let band = if refused < MOST_REFUSED { Band::Faces } else { Band::All };
        self.beside_faces(turns, faces, band, PairLimit::at_best(&best), |found| {
            let links = found.links.map(|link| link as usize);
            if PairLimit::at_best(&best).admits(found.distance, links) {
                best = Some(found);
            }
            Some(PairLimit::at_best(&best))
        });
        *nearest = best.map(|best| best.links.map(|link| link as usize));
        best
    }

    /// Whether all pairs that count are farther apart than `margin`.
    pub fn clears(&self, margin: Real, memory: &mut SelfMemory) -> bool {
        let SelfMemory { descent, turns, faces, .. } = memory;
        let (mut is_clear, mut refused) = (true, 0);
        descent.run([&self.robot; 2], PairLimit::of(margin), queried_from(turns), |found| {
            is_clear = !self.counts(found.links.map(|link| link as usize));
            refused += usize::from(is_clear);
            if is_clear && let Some(found) = self.slide(turns, found, refused) {
                is_clear = found.distance > margin;
            }
            if is_clear && refused < MOST_REFUSED {
                PairLimit::of(margin)
            } else {
                PairLimit::NOTHING
            }
        });
        let band = if refused < MOST_REFUSED { Band::Faces } else { Band::All };
        let limit = PairLimit::of(margin);
        let keep = |found: RobotProximity| (found.distance > margin).then_some(limit);
        is_clear && self.beside_faces(turns, faces, band, limit, keep)
    }

    /// Whether two links with a turn of pi between them count.
    fn counts(&self, links: [usize; 2]) -> bool {
        let [one, two] = links.map(|link| self.joined(link));
        one.counts_beside(&two, one.tolerance(&two))
    }

    /// Moves from a rejected pair to nearer ones, one link at a time. Returns the last pair if it
    /// counts. Of the rejected pairs, only the first, second, fourth and so on are moved.
    fn slide(
        &self,
        turns: &TurnSums,
        mut nearest: RobotProximity,
        refused: usize,
    ) -> Option<RobotProximity> {
        if !refused.is_power_of_two() {
            return None;
        }
        for _ in 0..MOST_MOVES {
            let [one, two] = nearest.links.map(|link| link as usize);
            let neighbours =
                [[one.wrapping_sub(1), two], [one + 1, two], [one, two - 1], [one, two + 1]];
            let is_queried = |[one, two]: &[usize; 2]| {
                *two < turns.queried_from.len()
                    && turns.queried_from.get(*one).is_some_and(|from| from <= two)
            };
            let measured = neighbours.into_iter().filter(is_queried);
            let next = measured
                .map(|links| measure_pair([&self.robot; 2], links))
                .min_by(|a, b| a.distance.total_cmp(&b.distance));
            match next.filter(|next| next.distance < nearest.distance) {
                Some(next) => nearest = next,
                None => break,
            }
        }
        self.counts(nearest.links.map(|link| link as usize)).then_some(nearest)
    }

    /// Returns a link with its neighbours.
    fn joined(&self, link: usize) -> JoinedLink {
        let place = |link| self.robot.link(link);
        let count = self.robot.links().len();
        JoinedLink::new(place(link), (0..link).rev().map(place), (link + 1..count).map(place))
    }

    /// Calls `keep` with the pairs beside faces that count and are within `limit`. Each call
    /// returns the next limit, or `None` to stop. Returns false if it was stopped.
    fn beside_faces(
        &self,
        turns: &TurnSums,
        faces: &mut OwnFaces,
        band: Band,
        limit: PairLimit,
        mut keep: impl FnMut(RobotProximity) -> Option<PairLimit>,
    ) -> bool {
        if !faces.begin(&self.robot, turns, band) {
            return true;
        }
        let mut limit = limit;
        faces.run(&self.robot, turns, band, limit, |links, [in_band, look]| {
            let is_half_turn = links[1] >= turns.queried_from[links[0]];
            if in_band && is_half_turn && band == Band::All {
                let [one, two] = links.map(|link| self.robot.link(link));
                if let Some(nearest) = one.measure_link_within(limit.distance(), &two)
                    && self.counts(links)
                {
                    limit = keep(nearest.answer(links, [&one, &two]))?;
                }
            }
            let is_at_face = in_band && !is_half_turn && links[1] >= turns.quarter_from[links[0]];
            if !look && !is_at_face {
                return Some(limit);
            }
            let joined = links.map(|link| self.joined(link));
            let [one, two] = &joined;
            let tolerance = one.tolerance(two);
            let bound = |limit: PairLimit| limit.distance() + tolerance.0;
            if look && one.is_face(1) && two.is_face(0) {
                let may = one.face_gap(1, two, 0) <= bound(limit)
                    && one.ball(1).may_be_within(bound(limit), &two.ball(0));
                if may {
                    let nearest = one.face_to_face(1, two, 0);
                    if one.faces_count(1, two, 0, &nearest, tolerance) {
                        limit = keep(nearest.answer(links, [&one.link, &two.link]))?;
                    }
                }
            }
            if !is_at_face {
                return Some(limit);
            }
            for (on_face, other) in [(0, 1), (1, 0)] {
                let [face, beside] = [&joined[on_face], &joined[other]];
                for end in [0, 1] {
                    // The ball around a face contains it: the test excludes most links.
                    if !face.is_face(end)
                        || !face.ball(end).may_be_within(bound(limit), &beside.link)
                    {
                        continue;
                    }
                    let nearest = face.face_to_link(end, &beside.link);
                    if face.face_counts(end, beside, &nearest, tolerance) {
                        let places = [links[on_face], links[other]];
                        limit = keep(in_order(places, [&face.link, &beside.link], &nearest))?;
                    }
                }
            }
            Some(limit)
        })
    }
}

/// Returns, per link, the first link queried with it.
fn queried_from(turns: &TurnSums) -> impl Fn(usize) -> usize {
    |link| turns.queried_from[link]
}

/// Returns the answer with the lower link first.
fn in_order(
    links: [usize; 2],
    placed: [&PlacedLink; 2],
    nearest: &NearestOfLinks,
) -> RobotProximity {
    if links[0] < links[1] {
        return nearest.answer(links, placed);
    }
    nearest.swapped().answer([links[1], links[0]], [placed[1], placed[0]])
}

#[cfg(test)]
mod tests {
    use super::*;
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
