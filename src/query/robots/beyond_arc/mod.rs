//! A robot and itself, by arc length: the least distance of two cross-sections whose places are at
//! least an arc length apart along the centreline.
//!
//! # Definitions
//! - **Place** s: an arc length along the centreline, from the base. **Cross-section** of s: the
//!   disc of the robot's radius there, perpendicular to the centreline.
//! - At a joint of a chain the cross-sections are the discs of both links, at a step the discs of
//!   both radii. A round end of the robot, half a ball, belongs to the place of the end.
//! - **Distance beyond `arc`**: the least distance of two cross-sections with s' - s >= `arc`.
//!
//! # What follows
//! - A link that is cut in two has the same cross-sections: the joint of the two does not turn. So
//!   the distance does not depend on how links are cut.
//! - The set of pairs of places is closed and shrinks as `arc` grows. So the distance never
//!   decreases with `arc`. A place moves by at most the change of `arc`. So the distance of a tube
//!   is continuous in `arc`. That of a chain is, too, unless two joints are exactly `arc` apart:
//!   there the discs turn, and the distance jumps by at most the radius times the angles.
//! - The wedge on the outside of a round joint of radius r and angle a belongs to no disc. It is
//!   within r sin(a / 2) of the discs.
//! - The centres of two places `arc` apart are at most `arc` apart, and discs contain their
//!   centres. So the distance is at most `arc`, and exactly `arc` for a straight robot.
//!
//! # Algorithm
//! 1. Build a tree of parts ([`Parts`]) with bounds on their discs.
//! 2. Measure some places that are `arc` apart: the first upper bound.
//! 3. Take the pair of parts with the least lower bound ([`measure`]). Stop if it reaches the least
//!    upper bound within the tolerance and what the tube leaves uncertain, if a margin is decided,
//!    or after `MOST_PAIRS` pairs of pieces.
//! 4. Divide both parts, or one if the other is a leaf. Two straight links are measured exactly
//!    instead ([`polish`]).
//!
//! # Correctness
//! Each pair of places belongs to a pair in the queue or to one that is settled: its lower bound was
//! good enough, or it cannot be divided. So the least of the upper bound and of the lower bounds of
//! the queue and of settled pairs is a lower bound on the distance.
//!
//! **Rounding.** `arc` is reduced by `arc_slack`, which admits all pairs of places. `slack` covers
//! all other rounding and the change of the distance by `arc_slack`.

mod pairs;
mod parts;

use crate::answer::{Decision, PairWitness, ProximityError, RobotClearance};
use crate::curve::Tube;
use crate::refine::PlacedTube;
use crate::robot::Chain;
use pairs::{NearPlaces, measure, near_places, polish};
use parry3d_f64::math::{Pose, Real};
use parts::Parts;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Pairs of pieces of a tube after which a query ends with the bounds found so far.
const MOST_PAIRS: usize = 1 << 16;

/// Memory that the next query reuses.
#[derive(Clone, Debug, Default)]
pub(crate) struct BeyondMemory {
    parts: Parts,
    pairs: BinaryHeap<Pair>,
}

/// A pair of parts in the queue; the least lower bound comes first, of equals the lowest parts.
#[derive(Clone, Copy, Debug)]
struct Pair {
    lower: Real,
    parts: [u32; 2],
    is_polished: bool,
}

impl Ord for Pair {
    fn cmp(&self, other: &Self) -> Ordering {
        other.lower.total_cmp(&self.lower).then_with(|| other.parts.cmp(&self.parts))
    }
}

impl PartialOrd for Pair {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Pair {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Pair {}

/// Returns bounds on the distance of a chain from itself beyond `arc`, or `None` if the chain is
/// shorter.
pub(crate) fn chain_minimum(
    chain: &Chain,
    memory: &mut BeyondMemory,
    arc: Real,
) -> Result<Option<RobotClearance>, ProximityError> {
    memory.parts.set_chain(chain);
    BeyondArc::new(memory, arc, 0.0, None).clearance()
}

/// Decides whether a chain is farther than `margin` from itself beyond `arc`.
pub(crate) fn chain_clears(
    chain: &Chain,
    memory: &mut BeyondMemory,
    [arc, margin]: [Real; 2],
) -> Result<Decision, ProximityError> {
    memory.parts.set_chain(chain);
    BeyondArc::new(memory, arc, 0.0, None).decide(margin)
}

/// Returns bounds on the distance of a tube from itself beyond `arc`, or `None` if the tube is
/// shorter.
///
/// # Errors
/// The tube has no section or is out of range, or its curve is not finite.
pub(crate) fn tube_clearance(
    tube: &Tube,
    memory: &mut BeyondMemory,
    arc: Real,
    tolerance: Real,
) -> Result<Option<RobotClearance>, ProximityError> {
    let placed = PlacedTube::new(tube, &Pose::IDENTITY, 0.0)?;
    memory.parts.set_tube(&placed)?;
    BeyondArc::new(memory, arc, tolerance, Some(placed)).clearance()
}

/// Decides whether a tube is farther than `margin` from itself beyond `arc`.
///
/// # Errors
/// As [`tube_clearance`].
pub(crate) fn tube_clears(
    tube: &Tube,
    memory: &mut BeyondMemory,
    [arc, margin]: [Real; 2],
    resolution: Real,
) -> Result<Decision, ProximityError> {
    let placed = PlacedTube::new(tube, &Pose::IDENTITY, 0.0)?;
    memory.parts.set_tube(&placed)?;
    BeyondArc::new(memory, arc, resolution, Some(placed)).decide(margin)
}

/// One query. All lengths are scaled.
struct BeyondArc<'a> {
    parts: &'a mut Parts,
    pairs: &'a mut BinaryHeap<Pair>,
    tube: Option<PlacedTube<'a>>,
    arc: Real,
    tolerance: Real,
    /// An upper bound on the distance.
    upper: Real,
    /// The least lower bound of the pairs that need not or cannot be divided.
    settled: Real,
    /// By how much the bounds may differ because the tube states errors.
    uncertainty: Real,
    best: Option<([u32; 2], NearPlaces)>,
}

impl<'a> BeyondArc<'a> {
    fn new(
        memory: &'a mut BeyondMemory,
        arc: Real,
        tolerance: Real,
        tube: Option<PlacedTube<'a>>,
    ) -> Self {
        let BeyondMemory { parts, pairs } = memory;
        pairs.clear();
        Self {
            arc: (arc * parts.scale - parts.arc_slack).max(0.0),
            tolerance: tolerance * parts.scale,
            upper: Real::INFINITY,
            settled: Real::INFINITY,
            uncertainty: 0.0,
            best: None,
            parts,
            pairs,
            tube,
        }
    }

    fn clearance(mut self) -> Result<Option<RobotClearance>, ProximityError> {
        let lower = self.run(None)?;
        Ok(self.best.map(|best| self.answer(lower, best)))
    }

    fn decide(mut self, margin: Real) -> Result<Decision, ProximityError> {
        let margin = margin * self.parts.scale;
        let lower = self.run(Some(margin))?;
        // A margin may be infinite; that of a robot without two such places is kept.
        Ok(if self.best.is_none() || lower - self.parts.slack > margin {
            Decision::Clear
        } else if self.upper_bound() <= margin {
            Decision::Contact
        } else {
            Decision::Undecided
        })
    }

    /// Returns a lower bound on the distance, infinite if there is no pair of places. It is as near
    /// to `upper` as the tolerance asks for, or proves with `upper` on which side of the margin the
    /// distance is, if the robot allows it.
    ///
    /// # Errors
    /// The curve is not finite.
    fn run(&mut self, margin: Option<Real>) -> Result<Real, ProximityError> {
        self.seed();
        if self.best.is_none() {
            return Ok(Real::INFINITY);
        }
        self.offer([self.parts.root(); 2], 0.0);
        let slack = self.parts.slack;
        self.uncertainty = self.uncertainty_of([self.parts.root(); 2]);
        let mut examined = 0;
        while let Some(pair) = self.pairs.pop() {
            let lower = self.settled.min(pair.lower).min(self.upper);
            let is_decided =
                margin.is_some_and(|margin| lower - slack > margin || self.upper_bound() <= margin);
            self.uncertainty = self.uncertainty_of(pair.parts);
            let reached = pair.lower + self.tolerance + self.uncertainty;
            let is_near = reached + 2.0 * slack >= self.upper;
            if is_decided || is_near || examined == MOST_PAIRS {
                return Ok(lower);
            }
            if !self.divide(pair)? {
                self.settled = self.settled.min(pair.lower);
            }
            examined += usize::from(self.tube.is_some());
        }
        Ok(self.upper.min(self.settled))
    }

    /// Returns by how much the bounds may differ because the tube states errors: those of the
    /// places, and the doubts about directions of these parts or of the best ones.
    fn uncertainty_of(&self, parts: [u32; 2]) -> Real {
        let Some(tube) = &self.tube else { return 0.0 };
        let doubt = |parts: [u32; 2]| parts.iter().map(|&part| self.parts.part(part).doubt).sum();
        let of_best: Real = self.best.map_or(0.0, |(parts, _)| doubt(parts));
        2.0 * tube.position_uncertainty() * self.parts.scale + of_best.max(doubt(parts))
    }

    /// Measures the first upper bounds: the places `arc` beyond the start of each leaf.
    fn seed(&mut self) {
        let leaves = self.parts.leaves();
        let mut last = 0;
        for first in 0..leaves {
            let place = self.parts.part(first).arcs[0] + self.arc;
            last = last.max(first);
            while last < leaves && self.parts.part(last).arcs[1] < place {
                last += 1;
            }
            if last == leaves {
                return;
            }
            let pair = [first, last].map(|part| self.parts.part(part));
            self.take([first, last], near_places(pair, [0.0, pair[1].share_of(place)]));
        }
    }

    /// Returns the upper bound with the rounding of its distance. Places with a common point touch.
    fn upper_bound(&self) -> Real {
        if self.upper > 0.0 { self.upper + self.parts.slack } else { 0.0 }
    }

    /// Divides a pair, or improves its bounds. Returns false if neither is possible.
    ///
    /// # Errors
    /// The curve is not finite.
    fn divide(&mut self, pair: Pair) -> Result<bool, ProximityError> {
        let [i, j] = pair.parts;
        let [one, two] = [i, j].map(|part| self.parts.part(part));
        if one.is_straight() && two.is_straight() && !pair.is_polished {
            // The bounds of one pair need not be nearer than the query's.
            let enough = self.upper - 2.0 * self.parts.slack - self.tolerance;
            if let Some((lower, places)) =
                polish([one, two], self.arc, self.parts.slack, [pair.lower, enough])
            {
                self.take([i, j], places);
                self.pairs.push(Pair { lower, is_polished: true, ..pair });
            }
            return Ok(true);
        }
        if i != j
            && let (Some(of_one), Some(of_two)) = (one.children, two.children)
        {
            for first in of_one {
                for second in of_two {
                    self.offer([first, second], pair.lower);
                }
            }
            return Ok(true);
        }
        let by_size = |part: &parts::Part| (part.loss(), part.length());
        let first = if by_size(one) >= by_size(two) { 0 } else { 1 };
        for k in [first, 1 - first] {
            let Some(halves) = self.parts.halves(pair.parts[k], self.tube.as_ref())? else {
                continue;
            };
            if i == j {
                let [low, high] = halves;
                for parts in [[low, low], [low, high], [high, high]] {
                    self.offer(parts, pair.lower);
                }
            } else {
                for half in halves {
                    self.offer(if k == 0 { [half, j] } else { [i, half] }, pair.lower);
                }
            }
            return Ok(true);
        }
        Ok(false)
    }

    /// Adds a pair to the queue, unless its lower bound is good enough or it has no two places that
    /// are `arc` apart.
    fn offer(&mut self, parts: [u32; 2], of_parent: Real) {
        let pair = parts.map(|part| self.parts.part(part));
        // The query's bounds need not be nearer.
        let enough = self.upper - 2.0 * self.parts.slack - self.tolerance;
        let Some((lower, places)) = measure(pair, self.arc, enough) else { return };
        if let Some(places) = places {
            self.take(parts, places);
        }
        let lower = lower.max(of_parent);
        if lower >= enough {
            self.settled = self.settled.min(lower);
        } else {
            self.pairs.push(Pair { lower, parts, is_polished: false });
        }
    }

    fn take(&mut self, parts: [u32; 2], places: NearPlaces) {
        let is_nearer = match self.best {
            Some((_, best)) => places.distance < best.distance,
            None => true,
        };
        if is_nearer {
            self.upper = self.upper.min(places.distance);
            self.best = Some((parts, places));
        }
    }

    /// Returns the bounds in the robot's unit.
    fn answer(&self, lower: Real, (numbers, places): ([u32; 2], NearPlaces)) -> RobotClearance {
        let (scale, slack) = (self.parts.scale, self.parts.slack);
        let parts = numbers.map(|part| self.parts.part(part));
        let lower = (lower.min(places.distance) - slack).max(0.0) / scale;
        let upper = if places.distance > 0.0 { (places.distance + slack) / scale } else { 0.0 };
        let uncertainty = self.uncertainty / scale;
        let tolerance = (self.tolerance + 4.0 * slack) / scale;
        RobotClearance {
            lower,
            upper,
            resolved: upper - lower <= tolerance + uncertainty,
            uncertainty,
            sections: parts.map(|part| part.piece.section),
            witness: PairWitness {
                on_first: places.points[0] / scale,
                on_second: places.points[1] / scale,
                arc_lengths: [0, 1].map(|k| parts[k].arc(places.shares[k]) / scale),
            },
        }
    }
}
