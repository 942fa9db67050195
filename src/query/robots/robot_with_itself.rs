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
//! another face. It also decides whether two links with a turn of pi count, with or without faces:
//! the robot must lead nowhere nearer from their closest places.
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

use super::descent::{Descent, PairLimit, measure_pair};
use super::own_faces::{Band, OwnFaces};
use super::turn_sums::TurnSums;
use crate::answer::{ProximityError, RobotProximity};
use crate::pair::{JoinedLink, NearestOfLinks, PlacedLink, PlacedRobot};
use crate::robot::Chain;
use parry3d_f64::math::{Pose, Real};

/// With more rejected pairs the nodes of [`OwnFaces`] are cheaper.
const MOST_REFUSED: usize = 64;

/// The most moves from a rejected pair, counting those that lead nowhere nearer.
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
        let [one, two] = links.map(|link| JoinedLink::alone(self.robot.link(link)));
        one.counts_beside(&two, one.tolerance(&two), || links.map(|link| self.joined(link)))
    }

    /// Moves from a rejected pair to nearer ones. Returns the last pair if it counts. Of the
    /// rejected pairs, only the first, second, fourth and so on are moved.
    ///
    /// A move changes one of the two links by `stride`. The stride doubles after each move and
    /// halves if no move leads nearer, so a distance of n links takes about 2 log n moves.
    fn slide(
        &self,
        turns: &TurnSums,
        found: RobotProximity,
        refused: usize,
    ) -> Option<RobotProximity> {
        if !refused.is_power_of_two() {
            return None;
        }
        let gap = |[one, two]: [usize; 2]| {
            let [one, two] = [self.robot.link(one), self.robot.link(two)];
            one.nearest_on_axes(&two).1 - one.radius() - two.radius()
        };
        let is_queried = |[one, two]: &[usize; 2]| {
            *two < turns.queried_from.len()
                && turns.queried_from.get(*one).is_some_and(|from| from <= two)
        };
        let mut links = found.links.map(|link| link as usize);
        let (mut nearest, mut stride) = (gap(links), 1);
        for _ in 0..MOST_MOVES {
            let [one, two] = links;
            let beside = [
                [one.wrapping_sub(stride), two],
                [one + stride, two],
                [one, two.wrapping_sub(stride)],
                [one, two + stride],
            ];
            let next = beside.into_iter().filter(is_queried).map(|links| (gap(links), links));
            match next.min_by(|a, b| a.0.total_cmp(&b.0)).filter(|next| next.0 < nearest) {
                Some(next) => ((nearest, links), stride) = (next, 2 * stride),
                None if stride == 1 => break,
                None => stride /= 2,
            }
        }
        self.counts(links).then(|| measure_pair([&self.robot; 2], links))
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
        // Consecutive pairs often have a link in common.
        let mut known: [Option<(usize, JoinedLink)>; 2] = [None; 2];
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
            for (known, link) in known.iter_mut().zip(links) {
                if known.is_none_or(|(other, _)| other != link) {
                    *known = Some((link, self.joined(link)));
                }
            }
            let [Some((_, one)), Some((_, two))] = &known else { return Some(limit) };
            let joined = [one, two];
            let tolerance = one.tolerance(two);
            let bound = |limit: PairLimit| limit.distance() + tolerance.of_distance();
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
                let [face, beside] = [joined[on_face], joined[other]];
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
