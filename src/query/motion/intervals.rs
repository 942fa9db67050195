//! Intervals of time, and the loop over them for pairs of robots and for self contact.

use super::approach_bound::{midpoint, remaining_parts};
use super::interval_test::{IntervalResult, MarginQuery};
use super::progress::{MAX_SHAPES, PATIENCE, Progress};
use crate::answer::{
    PairWitness, ProximityError, RobotMotionAnswer, RobotsInContact, UndecidedReason,
};
use crate::refine::PairUpperBound;
use parry3d_f64::math::Real;
use std::collections::VecDeque;
use std::ops::Range;

/// Which contact a query about a margin returns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Sought {
    /// Any: large intervals are tested first, which finds long contacts early.
    Any,
    /// The first in time.
    First,
}

/// An interval of time and its unresolved pieces.
#[derive(Clone, Debug)]
pub(super) struct Interval {
    pub times: [Real; 2],
    /// The number of the part of the motion's time that contains the interval.
    pub part: usize,
    /// A range of `MotionMemory::unresolved`; `None` for the whole robot.
    pub pieces: Option<Range<usize>>,
    /// Whether the interval lies after the middle shape in which its pieces were unresolved.
    pub is_after: bool,
    /// A lower bound on the clearance of its pieces.
    pub lower: Real,
}

impl Interval {
    pub(super) fn midpoint(&self) -> Real {
        midpoint(self.times)
    }

    /// Returns the interval with the larger of both lower bounds.
    pub(super) fn with_lower_bound(self, lower: Real) -> Self {
        Self { lower: self.lower.max(lower), ..self }
    }

    /// Returns the remaining parts before and after the middle shape, which decides the pieces for
    /// the time `hold` on both sides.
    pub(super) fn halves(
        &self,
        hold: Real,
        is_left: [bool; 2],
        pieces: &Range<usize>,
    ) -> [Option<Self>; 2] {
        let [before, after] = remaining_parts(self.times, hold);
        let rest = |times: Option<[Real; 2]>, is_after: bool| {
            let is_left = is_left[usize::from(is_after)] && !pieces.is_empty();
            let pieces = Some(pieces.clone());
            times.filter(|_| is_left).map(|times| Self {
                times,
                part: self.part,
                pieces,
                is_after,
                lower: self.lower,
            })
        };
        [rest(before, false), rest(after, true)]
    }
}

/// Decides whether a margin is kept in all intervals.
///
/// `test_interval` tests the middle shape of an interval. It returns the result and how long before
/// and after the midpoint the unresolved pairs are decided; infinity if there are none.
///
/// # Errors
/// As `test_interval`.
pub(super) fn decide(
    sought: Sought,
    intervals: &mut VecDeque<[Real; 2]>,
    test_interval: impl FnMut([Real; 2]) -> TestedInterval,
) -> Result<RobotMotionAnswer, ProximityError> {
    match sought {
        Sought::Any => clear(intervals, test_interval),
        Sought::First => first_contact(intervals, test_interval),
    }
}

type TestedInterval = Result<(IntervalResult<PairUpperBound>, Real), ProximityError>;

/// Any contact: breadth first.
fn clear(
    intervals: &mut VecDeque<[Real; 2]>,
    mut test_interval: impl FnMut([Real; 2]) -> TestedInterval,
) -> Result<RobotMotionAnswer, ProximityError> {
    let (mut progress, mut shapes, mut too_fine) = (Progress::default(), 0, None);
    while let Some(times) = intervals.pop_front() {
        if let Some(first) = progress.is_exhausted(shapes, intervals.iter().copied().chain([times]))
        {
            return too_fine.map_or_else(|| Ok(RobotMotionAnswer::undecided(first)), Err);
        }
        let (result, hold) = test_interval(times)?;
        shapes += 1;
        progress.record(times, &result, shapes);
        if let Some(found) = result.contact {
            // Times before are not proven clear, so `clear_until` is 0.
            return Ok(RobotMotionAnswer::contact(0.0, in_contact(midpoint(times), found)));
        }
        too_fine = too_fine.or(result.too_fine);
        intervals.extend(remaining_parts(times, hold).into_iter().flatten());
    }
    if let Some(error) = too_fine {
        return Err(error);
    }
    Ok(progress.undecided().map_or_else(RobotMotionAnswer::clear, RobotMotionAnswer::undecided))
}

/// The first contact: earlier intervals first, as `MotionSearch::first_contact`.
fn first_contact(
    intervals: &mut VecDeque<[Real; 2]>,
    mut test_interval: impl FnMut([Real; 2]) -> TestedInterval,
) -> Result<RobotMotionAnswer, ProximityError> {
    let (mut undecided, mut contact) = (None::<([Real; 2], UndecidedReason)>, None);
    let (mut clear_until, mut shapes, mut most, mut too_fine) = (1.0, 0, MAX_SHAPES, None);
    // `pop_back` takes the earliest interval.
    intervals.make_contiguous().reverse();
    while shapes < most {
        let next = if undecided.is_none() { intervals.pop_back() } else { intervals.pop_front() };
        let Some(times) = next else { break };
        let (result, hold) = test_interval(times)?;
        shapes += 1;
        if result.is_undecided && undecided.is_none() {
            let is_exhausted = result.gives_up;
            let reason = if is_exhausted { UndecidedReason::Work } else { UndecidedReason::Near };
            undecided = Some((times, reason));
            most = most.min(shapes + PATIENCE);
        }
        if result.gives_up {
            intervals.push_back(times);
            break;
        }
        if let Some(found) = result.contact {
            let t = midpoint(times);
            contact = Some(in_contact(t, found));
            clear_until = if result.is_fine { times[0] } else { t };
            intervals.clear();
            if !result.is_fine {
                intervals.push_back([times[0], t]);
            }
            continue;
        }
        too_fine = too_fine.or(result.too_fine);
        intervals.extend(remaining_parts(times, hold).into_iter().rev().flatten());
    }
    let left = intervals.iter().copied().min_by(|a, b| a[0].total_cmp(&b[0]));
    if let Some(contact) = contact {
        let unknown = undecided.map(|(times, _)| times).into_iter().chain(left);
        let clear_until = unknown.fold(clear_until, |first, times| first.min(times[0]));
        return Ok(RobotMotionAnswer::contact(clear_until, contact));
    }
    if let Some(error) = too_fine {
        return Err(error);
    }
    let first = undecided.or(left.map(|times| (times, UndecidedReason::Work)));
    Ok(first.map_or_else(RobotMotionAnswer::clear, RobotMotionAnswer::undecided))
}

fn in_contact(t: Real, found: PairUpperBound) -> RobotsInContact {
    let PairUpperBound { upper, sections, arcs, points: [on_first, on_second] } = found;
    let witness = PairWitness { on_first, on_second, arc_lengths: arcs };
    RobotsInContact { t, upper, sections, witness }
}

/// Returns the most pairs of pieces that are tested per interval, the nearest ones. If the motion
/// exceeds margin and resolution it is 2^16, since a shorter interval has fewer pairs.
pub(super) fn most_pairs(reach: Real, MarginQuery { margin, resolution }: MarginQuery) -> usize {
    if reach > margin.max(resolution) { 1 << 16 } else { usize::MAX }
}

/// Starts with the common parts of all motions' times; `parts` counts the parts of each motion.
pub(super) fn begin(intervals: &mut VecDeque<[Real; 2]>, parts: impl IntoIterator<Item = usize>) {
    let parts = parts.into_iter().map(|parts| parts.max(1));
    let ends = parts.flat_map(|parts| (0..=parts).map(move |part| part as Real / parts as Real));
    let mut ends: Vec<Real> = ends.collect();
    ends.sort_unstable_by(Real::total_cmp);
    ends.dedup();
    intervals.clear();
    intervals.extend(ends.windows(2).map(|ends| [ends[0], ends[1]]));
}
