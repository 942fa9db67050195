//! Bounds on the least clearance of a motion, or of two motions: the rounds.
//!
//! # Definitions
//! - `upper`: the least upper bound of all tested shapes. `lower`: the lower bound so far.
//! - **Part**: a part of the motion's time ([`Motion::time_parts`]), with its own lower bound.
//! - **Round**: a search with a tolerance of its own. aim: the permitted gap between its bounds.
//! - wanted = upper - aim: pieces whose lower bound is at least this are **settled**.
//! - d: the distance of a piece's body in the middle shape. reach = tau V: how much nearer the
//!   piece may come in the interval (`motion_search`). For two motions a piece is a pair of pieces.
//! - direction gap: the gap between the bounds that the unknown direction of a face causes.
//!
//! # Algorithm
//! 1. **Begin** with `upper` of one shape and `lower` = 0.
//! 2. **Stop** in any of four cases. The bounds meet the tolerance. `lower` reaches the limit
//!    beyond which the caller needs no bounds. [`MAX_SHAPES`] shapes have been tested. The last
//!    round missed its own tolerance and did not halve the gap.
//! 3. **Round.** Its tolerance is [`SHARE`] of the gap. It takes over `upper` and the lower bounds
//!    of the parts. Repeat from 2.
//!
//! A round begins with one interval per part.
//! 1. **Take** the interval with the least lower bound, the earliest of equals. Stop if it is
//!    settled. So a path of many motions costs little more than its nearest parts; the parts
//!    farther away cost one shape each, or a few, in the first round only.
//! 2. **Seed** `upper` at the place of the nearest shape so far.
//! 3. **Refine** the middle shape (`minimum_policy`). A piece is at least d - reach away in the
//!    whole interval. Unless that settles it, it is tested at other times or halved along the
//!    curve.
//! 4. **Displacements** settle pieces on one side of the middle shape, as for a margin.
//! 5. **Divide** the interval as for a margin. The margin is `wanted`, which falls as nearer shapes
//!    are found.
//!
//! **Termination.** A piece with reach <= aim / 4 is settled as soon as its body fits as closely.
//! If samples or stated errors leave a larger gap, intervals in which the piece moves less than
//! that gap are not divided.
//!
//! # Claim
//! A finer tolerance never gives looser bounds.
//!
//! **Proof.** A round depends only on the rounds before it. So the sequence of rounds is the same
//! for every tolerance, and a finer tolerance stops no earlier. From round to round `upper` never
//! rises, and the lower bound of no part falls.

use super::intervals::Interval;
use super::intervals::MAX_SHAPES;
use crate::answer::ProximityError;
use crate::refine::UpperBound;
use parry3d_f64::math::Real;
use std::cmp::Ordering;
use std::collections::{BinaryHeap, VecDeque};

/// The tolerance of a round, as a share of the gap before it. A smaller share takes fewer rounds,
/// but the last one may be that much finer than the query needs. Measured: twice the time of a
/// single round at the tolerance of the query.
const SHARE: Real = 0.25;

/// The intervals of a round and the bounds of the parts; memory that the next query reuses.
pub(super) struct RoundMemory<'a> {
    /// The intervals that a round begins with.
    pub intervals: &'a mut VecDeque<Interval>,
    /// The intervals of the round.
    pub queue: &'a mut BinaryHeap<NearestFirst>,
    /// The lower bound on the clearance of each part of the motion's time.
    pub part_bounds: &'a mut Vec<Real>,
    /// The bound on each part that the current round proves.
    pub settled: &'a mut Vec<Real>,
}

/// An interval in the order of a round: the least lower bound is the largest, then the earliest.
#[derive(Clone, Debug)]
pub(super) struct NearestFirst(Interval);

impl Ord for NearestFirst {
    fn cmp(&self, other: &Self) -> Ordering {
        let by_bound = other.0.lower.total_cmp(&self.0.lower);
        by_bound.then_with(|| other.0.times[0].total_cmp(&self.0.times[0]))
    }
}

impl PartialOrd for NearestFirst {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for NearestFirst {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for NearestFirst {}

/// One motion or two, in intervals of time.
pub(super) trait Minimized {
    type Upper: UpperBound;

    fn memory(&mut self) -> RoundMemory<'_>;

    /// Starts with one interval per part of the time.
    fn begin(&mut self);

    /// Whether a limit of work is reached. `shapes`: how many middle shapes were refined.
    fn is_exhausted(&self, shapes: u64) -> bool {
        shapes >= MAX_SHAPES
    }

    /// Bounds the middle shape of an interval at one place.
    ///
    /// # Errors
    /// There is no such shape.
    fn seed(
        &mut self,
        interval: &Interval,
        known: &mut MinimumBounds<Self::Upper>,
    ) -> Result<(), ProximityError>;

    /// Steps 2 to 4 of a round. Returns the intervals that remain (step 5).
    ///
    /// # Errors
    /// The shape cannot be tested.
    fn refine(
        &mut self,
        interval: Interval,
        known: &mut MinimumBounds<Self::Upper>,
    ) -> Result<[Option<Interval>; 2], ProximityError>;
}

/// Bounds on the least clearance, and the place and time that realise the upper one.
pub(super) struct Minimum<U> {
    pub lower: Real,
    pub uncertainty: Real,
    pub resolved: bool,
    pub best: U,
    pub t: Real,
}

/// Returns bounds on the least clearance that are at most `tolerance` apart if possible; or a lower
/// bound of at least `limit`.
///
/// # Errors
/// A shape cannot be tested.
pub(super) fn minimum<S: Minimized>(
    search: &mut S,
    tolerance: Real,
    limit: Real,
) -> Result<Minimum<S::Upper>, ProximityError> {
    let mut known = MinimumBounds::new();
    search.begin();
    let RoundMemory { intervals, part_bounds, .. } = search.memory();
    part_bounds.clear();
    part_bounds.resize(intervals.len(), 0.0);
    let mut shapes = 0;
    if let Some(first) = intervals.front().cloned() {
        search.seed(&first, &mut known)?;
        shapes += 1;
    }
    while known.gap() > tolerance && known.lower() < limit && !search.is_exhausted(shapes) {
        let before = known.gap();
        known.tolerance = SHARE * before;
        run_round(search, &mut known, &mut shapes)?;
        if known.gap() > known.tolerance.max(0.5 * before) {
            break;
        }
    }
    known.answer(tolerance)
}

/// Runs one round. Raises the lower bounds of the parts.
fn run_round<S: Minimized>(
    search: &mut S,
    known: &mut MinimumBounds<S::Upper>,
    shapes: &mut u64,
) -> Result<(), ProximityError> {
    known.unresolved = UnresolvedGap { lower: Real::INFINITY, direction_gap: 0.0 };
    search.begin();
    let RoundMemory { intervals, queue, part_bounds, settled } = search.memory();
    queue.clear();
    queue.extend(
        intervals
            .drain(..)
            .zip(&*part_bounds)
            .map(|(interval, &lower)| NearestFirst(Interval { lower, ..interval })),
    );
    // The least lower bound of all pieces of each part that this round settles.
    settled.clear();
    settled.resize(part_bounds.len(), Real::INFINITY);
    while let Some(NearestFirst(interval)) = search.memory().queue.pop() {
        // Step 1.
        if known.is_settled(interval.lower) || search.is_exhausted(*shapes) {
            // All other intervals have larger lower bounds.
            search.memory().queue.push(NearestFirst(interval));
            break;
        }
        *shapes += 1;
        known.lower = Real::INFINITY;
        let part = interval.part;
        let rest = search.refine(interval, known)?;
        let RoundMemory { queue, settled, .. } = search.memory();
        settled[part] = settled[part].min(known.lower);
        queue.extend(rest.into_iter().flatten().map(NearestFirst));
    }
    let RoundMemory { queue, part_bounds, settled, .. } = search.memory();
    for NearestFirst(interval) in &*queue {
        settled[interval.part] = settled[interval.part].min(interval.lower);
    }
    known.lower = Real::INFINITY;
    for (bound, settled) in part_bounds.iter_mut().zip(&*settled) {
        *bound = bound.max(*settled);
        known.lower = known.lower.min(*bound);
    }
    Ok(())
}

/// The bounds on the least clearance so far.
pub(super) struct MinimumBounds<U> {
    /// The tolerance of the round.
    pub tolerance: Real,
    /// The gap that stated errors cause in the shapes so far.
    pub uncertainty: Real,
    /// The upper bound, with its place and time.
    best: Option<(U, Real)>,
    /// During a round, the least lower bound of all settled pieces of the interval; otherwise the
    /// lower bound of the motion.
    pub lower: Real,
    /// The settled pieces with an unknown direction of a face.
    pub unresolved: UnresolvedGap,
}

/// Pieces settled with a larger gap because no more is known.
pub(super) struct UnresolvedGap {
    pub lower: Real,
    /// The additional gap.
    pub direction_gap: Real,
}

impl<U: UpperBound> MinimumBounds<U> {
    fn new() -> Self {
        let nothing = UnresolvedGap { lower: Real::INFINITY, direction_gap: 0.0 };
        Self {
            tolerance: Real::INFINITY,
            uncertainty: 0.0,
            best: None,
            lower: 0.0,
            unresolved: nothing,
        }
    }

    pub fn upper(&self) -> Real {
        self.best.map_or(Real::INFINITY, |(found, _)| found.upper())
    }

    /// Whether pieces with this lower bound do not matter.
    fn is_settled(&self, lower: Real) -> bool {
        let wanted = self.upper() - (self.tolerance + self.uncertainty);
        wanted <= 0.0 || lower >= wanted
    }

    /// Keeps a place of the shape at `t` if it is nearer.
    pub fn offer(&mut self, found: U, t: Real) {
        if found.upper() < self.upper() {
            self.best = Some((found, t));
        }
    }

    /// Tests the shape at `t` at the place where the nearest shape so far is nearest. `uncertainty`
    /// is what the shape states.
    pub fn seed(&mut self, uncertainty: Real, t: Real, bound_at: impl FnOnce(Option<U>) -> U) {
        self.uncertainty = self.uncertainty.max(uncertainty);
        self.offer(bound_at(self.best.map(|(found, _)| found)), t);
    }

    /// The lower bound of the motion, between rounds.
    fn lower(&self) -> Real {
        self.lower.min(self.upper()).max(0.0)
    }

    /// The part of the gap that stated errors and unknown directions cause.
    fn all_uncertainty(&self) -> Real {
        // The direction gap matters only if nothing else is as near.
        let wanted = self.upper() - (self.tolerance + self.uncertainty);
        let matters = self.unresolved.lower < wanted;
        self.uncertainty + if matters { self.unresolved.direction_gap } else { 0.0 }
    }

    /// The rest of the gap between the bounds, which the tolerance limits.
    fn gap(&self) -> Real {
        self.upper() - self.lower() - self.all_uncertainty()
    }

    fn answer(self, tolerance: Real) -> Result<Minimum<U>, ProximityError> {
        let (lower, uncertainty) = (self.lower(), self.all_uncertainty());
        // Every motion has a shape, and every shape a section.
        let Some((best, t)) = self.best else { return Err(ProximityError::EmptyTube) };
        let resolved = best.upper() - lower <= tolerance + uncertainty;
        Ok(Minimum { lower, uncertainty, resolved, best, t })
    }
}
