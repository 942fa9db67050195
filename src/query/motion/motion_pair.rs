//! Two robots that move at the same time: whether they keep a margin, and bounds on their least
//! clearance.
//!
//! # Algorithm
//! 1. Test an interval by the two shapes at its middle, as for one motion (`motion_search`). Let
//!    tau be half of the interval and V1, V2 bounds on the speeds of two pieces, seen from one
//!    frame. Then the pieces come nearer by at most tau (V1 + V2). The frame is at rest, or carries
//!    one of the robots (`motion::common_frame`): for each interval the frame in which the sum of
//!    both robots' greatest speeds is least ([`PairSpeeds`]). Each bound holds by itself, so the
//!    bound of a half need not be below the bound of its piece.
//! 2. Pairs for which that is too much are tested again in the remaining parts of the interval.
//! 3. Each shape starts with all pairs that may reach the margin in its interval, not with a list
//!    of unresolved pairs. Such pairs are few, and their bodies show at once which pieces are near
//!    each other.
//! 4. **Least clearance**: the rounds of `minimum_rounds`. Pairs beyond `upper + approach` do not
//!    matter. If more pairs are nearer than are tested per interval, the interval proves nothing
//!    and is halved.

use super::approach_bound::{ApproachBound, check_subdivision, half_length, midpoint};
use super::current_shape::CurrentShape;
use super::interval_test::{IntervalResult, IntervalTest, MarginQuery};
use super::intervals::MAX_SHAPES;
use super::intervals::{self, Interval, MarginAnswer, Sought, TestedInterval};
use super::minimum_policy::MinimumPolicy;
use super::minimum_rounds::{
    Minimized, Minimum, MinimumBounds, NearestFirst, RoundMemory, minimum,
};
use super::moving_pair::{MovingPair, SeenFrom};
use super::refinement::refine;
use super::relative_motion::RelativeMotion;
use crate::answer::{
    PairWitness, ProximityError, RobotMotionAnswer, RobotMotionClearance, RobotsInContact,
    UndecidedReason,
};
use crate::distance::Scalar;
use crate::motion::{CarriedMotion, CarriedPiece, Motion, check_speed};
use crate::refine::{PairQueue, PairUpperBound, PiecePair, PlacedTube, Refinable, TubePair};
use crate::robot::RobotError;
use parry3d_f64::math::Real;
use std::collections::{BinaryHeap, VecDeque};

/// The most pairs of pieces that a query about a margin tests in all shapes together. Two long
/// robots side by side need 160,000 for each shape.
const MAX_PAIRS: u32 = 1 << 24;

/// The same for bounds on the least clearance: a few seconds. A distance that stays nearly constant
/// needs 50 to 100 times as many for a tenth of the tolerance.
pub(crate) const MAX_PAIRS_FOR_BOUNDS: u32 = 1 << 20;

/// State and memory that the next query reuses.
#[derive(Clone, Debug, Default)]
pub(crate) struct MotionsMemory {
    current: [CurrentShape; 2],
    beginning: PairQueue,
    pairs: Vec<PiecePair>,
    intervals: VecDeque<Interval>,
    /// For bounds on the least clearance (`minimum_rounds`).
    queue: BinaryHeap<NearestFirst>,
    part_bounds: Vec<Real>,
    settled: Vec<Real>,
}

impl MarginAnswer<PairUpperBound> {
    pub(super) fn of_robots(self) -> RobotMotionAnswer {
        match self {
            Self::Clear => RobotMotionAnswer::clear(),
            Self::Undecided(first) => RobotMotionAnswer::undecided(first),
            Self::Contact { clear_until, t, found } => {
                let PairUpperBound { upper, sections, arcs, points: [on_first, on_second] } = found;
                let witness = PairWitness { on_first, on_second, arc_lengths: arcs };
                let contact = RobotsInContact { t, upper, sections, witness };
                RobotMotionAnswer::contact(clear_until, contact)
            }
        }
    }
}

/// Returns the most pairs of pieces that are tested per interval, the nearest ones. If the motion
/// exceeds margin and resolution it is 2^16, since a shorter interval has fewer pairs.
pub(super) fn most_pairs(approach: Real, MarginQuery { margin, resolution }: MarginQuery) -> usize {
    if approach > margin.max(resolution) { 1 << 16 } else { usize::MAX }
}

/// Two motions beside one another.
pub(crate) struct MotionPair<'a> {
    pub memory: &'a mut MotionsMemory,
    pub motions: [&'a dyn Motion; 2],
    /// The names of the motions in error messages.
    pub names: [&'static str; 2],
}

impl MotionPair<'_> {
    /// Decides whether the margin is kept at all times.
    pub(crate) fn decide(
        &mut self,
        wanted: MarginQuery,
        sought: Sought,
    ) -> Result<RobotMotionAnswer, ProximityError> {
        self.begin();
        let mut intervals = std::mem::take(&mut self.memory.intervals);
        let mut left = MAX_PAIRS;
        let answer = intervals::decide(sought, &mut intervals, |interval| {
            self.test_interval(interval, wanted, &mut left)
        });
        self.memory.intervals = intervals;
        answer.map(MarginAnswer::of_robots)
    }

    /// Starts with one interval per common part of both motions' times.
    fn begin(&mut self) {
        let MotionsMemory { current, intervals, .. } = &mut *self.memory;
        current.iter_mut().for_each(CurrentShape::forget);
        intervals::begin(intervals, self.motions.map(|motion| motion.time_parts()));
    }

    /// Returns bounds on the least clearance that are at most `tolerance` apart if possible; or a
    /// lower bound of at least `limit`. Tests at most `left` pairs of pieces, and subtracts them.
    pub(crate) fn clearance(
        &mut self,
        tolerance: Real,
        limit: Real,
        left: &mut u32,
    ) -> Result<RobotMotionClearance, ProximityError> {
        let mut search = PairClearance { pair: self, left };
        let Minimum { lower, uncertainty, resolved, best, t } =
            minimum(&mut search, tolerance, limit)?;
        let PairUpperBound { upper, sections, arcs, points: [on_first, on_second] } = best;
        let witness = PairWitness { on_first, on_second, arc_lengths: arcs };
        Ok(RobotMotionClearance { lower, upper, resolved, uncertainty, t, sections, witness })
    }

    /// Tests the middle shapes of an interval.
    fn test_interval(
        &mut self,
        interval: &Interval,
        wanted: MarginQuery,
        left: &mut u32,
    ) -> Result<TestedInterval<PairUpperBound>, ProximityError> {
        let (motions, names, times) = (self.motions, self.names, interval.times);
        let MotionsMemory { current, beginning, pairs, .. } = &mut *self.memory;
        let MiddleShapes { mut tubes, motions, speeds, approach_bound, approach } =
            MiddleShapes::new(motions, names, current, times)?;
        // A finer resolution is below rounding.
        tubes.check_resolved(32.0 * tubes.slack(), wanted.resolution)?;
        let MarginQuery { margin, resolution } = wanted;
        let (scale, upper) =
            (margin.max(resolution).max(0.25 * approach), margin + approach + tubes.slack());
        let is_all = tubes.begin(scale, upper, most_pairs(approach, wanted), beginning, pairs)?;
        if !is_all {
            let (fastest, speed) = speeds.fastest();
            check_subdivision(speed, resolution, || (fastest, speed))?;
        }
        let moving = MovingPair { motions, seen_from: speeds.seen_from, names, left };
        let mut test =
            IntervalTest { moving, approach_bound, wanted, result: IntervalResult::empty() };
        refine(&mut tubes, pairs, &mut test)?;
        let IntervalTest { moving, approach_bound, mut result, .. } = test;
        if moving.is_exhausted() && result.contact.is_none() {
            result.undecided = Some(UndecidedReason::Work);
        }
        Ok((result, interval.rest(if is_all { approach_bound.hold } else { 0.0 })))
    }
}

/// A search for the least clearance of two motions.
struct PairClearance<'s, 'a> {
    pair: &'s mut MotionPair<'a>,
    /// How many pairs of pieces may still be tested.
    left: &'s mut u32,
}

fn seed(known: &mut MinimumBounds<PairUpperBound>, tubes: &TubePair, t: Real) {
    known.seed(tubes.position_uncertainty(), t, |best| match best {
        Some(PairUpperBound { sections, arcs, .. }) => tubes.bound_at(sections, arcs),
        None => tubes.first_bound(),
    });
}

impl Minimized for PairClearance<'_, '_> {
    type Upper = PairUpperBound;

    fn memory(&mut self) -> RoundMemory<'_> {
        let MotionsMemory { intervals, queue, part_bounds, settled, .. } = &mut *self.pair.memory;
        RoundMemory { intervals, queue, part_bounds, settled }
    }

    fn begin(&mut self) {
        self.pair.begin();
    }

    fn is_exhausted(&self, shapes: u64) -> bool {
        shapes >= MAX_SHAPES || *self.left == 0
    }

    fn seed(
        &mut self,
        interval: &Interval,
        known: &mut MinimumBounds<PairUpperBound>,
    ) -> Result<(), ProximityError> {
        let MotionPair { memory, motions, names } = &mut *self.pair;
        let placed = place_both(*motions, *names, &mut memory.current, interval.times)?;
        seed(known, &TubePair::new(placed.tubes), interval.midpoint());
        Ok(())
    }

    fn refine(
        &mut self,
        interval: Interval,
        known: &mut MinimumBounds<PairUpperBound>,
    ) -> Result<[Option<Interval>; 2], ProximityError> {
        let left = &mut *self.left;
        let MotionPair { memory, motions, names } = &mut *self.pair;
        let MotionsMemory { current, beginning, pairs, .. } = &mut **memory;
        let t = interval.midpoint();
        let MiddleShapes { mut tubes, motions, speeds, approach_bound, approach } =
            MiddleShapes::new(*motions, *names, current, interval.times)?;
        seed(known, &tubes, t);
        let slack = tubes.slack();
        let upper = known.upper();
        let scale = upper.max(known.tolerance).max(0.25 * approach);
        let moving = MovingPair { motions, seen_from: speeds.seen_from, names: *names, left };
        let mut policy = MinimumPolicy::new(moving, approach_bound, known, t, slack);
        let most = if approach > policy.aim() { MAX_PAIRS_PER_INTERVAL } else { usize::MAX };
        let is_all = tubes.begin(scale, upper + approach + slack, most, beginning, pairs)?;
        // The pairs that `begin` leaves out.
        policy.settle(upper);
        refine(&mut tubes, pairs, &mut policy)?;
        let (nearest, hold) = (policy.nearest, policy.approach_bound.hold);
        // A clearance below 0 does not exist.
        if policy.wanted() < 0.0 {
            policy.settle(0.0);
            return Ok([None, None]);
        }
        if *left == 0 {
            // No later interval is tested either.
            known.lower = known.lower.min(interval.lower.max(0.0));
            return Ok([None, None]);
        }
        if is_all && nearest == Real::INFINITY {
            return Ok([None, None]);
        }
        let (hold, lower) = if is_all { (hold, nearest) } else { (0.0, Real::NEG_INFINITY) };
        Ok(interval.with_lower_bound(lower).rest(hold))
    }
}

/// The most pairs of pieces that are tested per interval, if the motion exceeds the gap between the
/// bounds: a shorter interval has fewer pairs.
const MAX_PAIRS_PER_INTERVAL: usize = 1 << 16;

/// Both robots in the middle of an interval, and how they move in it.
struct MiddleShapes<'p> {
    tubes: TubePair<'p>,
    motions: [CarriedMotion<'p>; 2],
    speeds: PairSpeeds,
    approach_bound: ApproachBound,
    /// How much nearer the robots come in half of the interval at most.
    approach: Real,
}

impl<'p> MiddleShapes<'p> {
    fn new(
        motions: [&'p dyn Motion; 2],
        names: [&'static str; 2],
        current: &'p mut [CurrentShape; 2],
        times: [Real; 2],
    ) -> Result<Self, ProximityError> {
        let placed = place_both(motions, names, current, times)?;
        let speeds = PairSpeeds::new(&placed, names)?;
        let approach = half_length(times) * speeds.sum();
        let PlacedShapes { tubes, cap_change, carried } = placed;
        let approach_bound = ApproachBound::new(times, cap_change);
        Ok(Self { tubes: TubePair::new(tubes), motions: carried, speeds, approach_bound, approach })
    }
}

/// Both robots in their middle shapes.
struct PlacedShapes<'p> {
    tubes: [PlacedTube<'p>; 2],
    /// How far ends that may become round move.
    cap_change: Real,
    carried: [CarriedMotion<'p>; 2],
}

/// Places both robots in their middle shapes.
fn place_both<'p>(
    motions: [&'p dyn Motion; 2],
    names: [&'static str; 2],
    [first, second]: &'p mut [CurrentShape; 2],
    times: [Real; 2],
) -> Result<PlacedShapes<'p>, ProximityError> {
    let carried = motions.map(|motion| CarriedMotion::new(motion, times, half_length(times)));
    let turning = CarriedMotion::least_turning(&carried);
    let [first, second] =
        [place(&carried[0], turning[0], first), place(&carried[1], turning[1], second)];
    let (first, change) = first.map_err(|error| error.of_robot(names[0]))?;
    let (second, other) = second.map_err(|error| error.of_robot(names[1]))?;
    Ok(PlacedShapes { tubes: [first, second], cap_change: change.max(other), carried })
}

/// Places a robot in its middle shape.
fn place<'p>(
    carried: &CarriedMotion,
    turning: Real,
    current: &'p mut CurrentShape,
) -> Result<(PlacedTube<'p>, Real), ProximityError> {
    let pose = current.set_time(carried.motion, midpoint(carried.times))?;
    let cap_change = current.mark_lasting_faces_in(carried, turning);
    Ok((PlacedTube::new(&current.tube, &pose, 0.0)?.moving(), cap_change))
}

/// Upper bounds on the speeds of all points of two robots, in the frame in which their sum is
/// least.
struct PairSpeeds {
    seen_from: SeenFrom,
    /// For each robot the speed, and the section where it occurs.
    speeds: [(usize, Real); 2],
}

impl PairSpeeds {
    /// # Errors
    /// A stated speed is negative or not finite.
    fn new(shapes: &PlacedShapes, names: [&'static str; 2]) -> Result<Self, ProximityError> {
        let mut best = Self::seen_from(SeenFrom::Rest, shapes, names)?;
        for (number, carried) in shapes.carried.iter().enumerate() {
            // Without a frame it is the frame at rest.
            if carried.has_frame() {
                let other = Self::seen_from(SeenFrom::Robot(number), shapes, names)?;
                if other.sum() < best.sum() {
                    best = other;
                }
            }
        }
        Ok(best)
    }

    fn seen_from(
        seen_from: SeenFrom,
        shapes: &PlacedShapes,
        names: [&'static str; 2],
    ) -> Result<Self, ProximityError> {
        let mut speeds = [(0, 0.0); 2];
        for (number, fastest) in speeds.iter_mut().enumerate() {
            *fastest = fastest_section(seen_from, shapes, number)
                .map_err(|error| ProximityError::Motion(error).of_robot(names[number]))?;
        }
        Ok(Self { seen_from, speeds })
    }

    /// The speed at which the robots approach one another at most.
    fn sum(&self) -> Real {
        let [(_, first), (_, second)] = self.speeds;
        (first + second) * (1.0 + 4.0 * Real::UNIT_ROUNDOFF)
    }

    /// The section of the faster robot, and its speed.
    fn fastest(&self) -> (usize, Real) {
        let [first, second] = self.speeds;
        if second.1 > first.1 { second } else { first }
    }
}

/// Returns the fastest section of a robot, and an upper bound on the speed of its points.
///
/// # Errors
/// A stated speed is negative or not finite.
fn fastest_section(
    seen_from: SeenFrom,
    shapes: &PlacedShapes,
    robot: usize,
) -> Result<(usize, Real), RobotError> {
    let (tube, carried) = (&shapes.tubes[robot], &shapes.carried[robot]);
    let (mut most, mut fastest) = (0.0, 0);
    for (number, section) in tube.sections().iter().enumerate() {
        let shares = [0.0, 1.0];
        let stated = carried.stated(number, shares);
        let stated = seen_from.speed(&shapes.carried, robot, stated, || {
            CarriedPiece::new(tube.tube, &tube.pose, section, shares, true)
        });
        check_speed(number, stated.point)?;
        // A body without a flat end needs no turn. The turn of a link of length 0 is infinite. A
        // turn that is no speed at all is an error in every body.
        let has_rim = section.radius > 0.0 && tube.faces(section).iter().any(Option::is_some);
        let is_needed = has_rim || stated.turn.is_nan() || stated.turn < 0.0;
        let turn = if is_needed { stated.turn } else { 0.0 };
        check_speed(number, turn)?;
        let speed = stated.point + section.radius * turn;
        if speed > most {
            (most, fastest) = (speed, number);
        }
    }
    Ok((fastest, most * (1.0 + 4.0 * Real::UNIT_ROUNDOFF)))
}
