//! Intervals of time, and the loops over them that decide about a margin: for a motion in a mesh,
//! for two motions, and for self contact.

use super::approach_bound::{midpoint, remaining_parts};
use super::interval_test::IntervalResult;
use crate::answer::{ProximityError, UndecidedReason};
use parry3d_f64::math::Real;
use std::array::from_fn;
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

    /// Returns the remaining parts before and after the middle shape, which decides for the time
    /// `hold` on both sides.
    pub(super) fn rest(&self, hold: Real) -> [Option<Self>; 2] {
        remaining_parts(self.times, hold).map(|times| Some(Self { times: times?, ..self.clone() }))
    }

    /// [`rest`](Self::rest), for the newly unresolved `pieces` that are left on either side.
    pub(super) fn halves(
        &self,
        hold: Real,
        is_left: [bool; 2],
        pieces: &Range<usize>,
    ) -> [Option<Self>; 2] {
        let [before, after] = self.rest(hold);
        let rest = |rest: Option<Self>, is_after: bool| {
            let is_left = is_left[usize::from(is_after)] && !pieces.is_empty();
            let pieces = Some(pieces.clone());
            rest.filter(|_| is_left).map(|rest| Self { pieces, is_after, ..rest })
        };
        [rest(before, false), rest(after, true)]
    }
}

/// The result of an interval's middle shape, and the intervals that remain before and after it.
pub(super) type TestedInterval<U> = (IntervalResult<U>, [Option<Interval>; 2]);

/// The answer to a query about a margin. `U`: a place.
pub(super) enum MarginAnswer<U> {
    /// The margin is kept at all times.
    Clear,
    /// The first interval in which that is unknown, and the reason.
    Undecided(([Real; 2], UndecidedReason)),
    /// The margin is kept until `clear_until`, and violated at `t`.
    Contact { clear_until: Real, t: Real, found: U },
}

/// How many more shapes are tested after a shape within the resolution of the margin, or an
/// undecided interval. Deeper contacts and proofs are usually found sooner. A longer near passage
/// would be divided into as many intervals as the resolution allows: a million and more.
pub(super) const PATIENCE: u64 = 256;

/// The most shapes of a query.
pub(super) const MAX_SHAPES: u64 = 1 << 16;

/// The results of the intervals so far.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Progress {
    /// The first undecided interval.
    undecided: Option<[Real; 2]>,
    /// An interval with a shape near the margin, and the number of shapes at which the query stops.
    near: Option<([Real; 2], u64)>,
    /// Whether a limit of work other than the number of shapes is reached.
    is_exhausted: bool,
}

impl Progress {
    /// Records the result of an interval; `shapes` counts all tested shapes.
    pub(super) fn record<F>(&mut self, times: [Real; 2], result: &IntervalResult<F>, shapes: u64) {
        if result.is_near && self.near.is_none() {
            self.near = Some((times, shapes + PATIENCE));
        }
        if result.undecided == Some(UndecidedReason::Work) {
            self.near = Some((times, shapes));
            self.is_exhausted = true;
        }
        if result.undecided.is_some() && self.undecided.is_none_or(|first| times[0] < first[0]) {
            self.undecided = Some(times);
        }
    }

    /// Returns the first undecided interval and the reason, if a limit of work is reached.
    pub(super) fn at_limit(
        &self,
        shapes: u64,
        untested: impl Iterator<Item = [Real; 2]>,
    ) -> Option<([Real; 2], UndecidedReason)> {
        let undecided = untested.chain(self.undecided);
        if let Some((near, _)) = self.near.filter(|(_, most)| shapes >= *most) {
            let earlier = |first: [Real; 2], times: [Real; 2]| {
                if times[0] < first[0] { [times[0], times[1].max(near[1])] } else { first }
            };
            return Some((undecided.fold(near, earlier), self.reason()));
        }
        if shapes < MAX_SHAPES {
            return None;
        }
        let first = undecided.min_by(|a, b| a[0].total_cmp(&b[0]))?;
        Some((first, UndecidedReason::Work))
    }

    /// Returns the first undecided interval and the reason, after all intervals were tested.
    pub(super) fn undecided(&self) -> Option<([Real; 2], UndecidedReason)> {
        self.undecided.map(|first| (first, self.reason()))
    }

    /// Returns why an interval is undecided.
    fn reason(&self) -> UndecidedReason {
        if self.is_exhausted { UndecidedReason::Work } else { UndecidedReason::Near }
    }
}

/// Decides whether a margin is kept in all intervals. `test_interval` tests the middle shape of
/// one.
///
/// # Errors
/// As `test_interval`; or the samples allow no decision.
pub(super) fn decide<U>(
    sought: Sought,
    intervals: &mut VecDeque<Interval>,
    test_interval: impl FnMut(&Interval) -> Result<TestedInterval<U>, ProximityError>,
) -> Result<MarginAnswer<U>, ProximityError> {
    match sought {
        Sought::Any => any_contact(intervals, test_interval),
        Sought::First => first_contact(intervals, test_interval),
    }
}

/// Breadth first: long contacts are found early.
fn any_contact<U>(
    intervals: &mut VecDeque<Interval>,
    mut test_interval: impl FnMut(&Interval) -> Result<TestedInterval<U>, ProximityError>,
) -> Result<MarginAnswer<U>, ProximityError> {
    let (mut progress, mut shapes, mut too_fine) = (Progress::default(), 0, None);
    while let Some(interval) = intervals.pop_front() {
        let untested = intervals.iter().chain([&interval]).map(|interval| interval.times);
        if let Some(first) = progress.at_limit(shapes, untested) {
            return too_fine.map_or(Ok(MarginAnswer::Undecided(first)), Err);
        }
        let (result, rest) = test_interval(&interval)?;
        shapes += 1;
        progress.record(interval.times, &result, shapes);
        if let Some(found) = result.contact {
            // Times before t are not proven clear, so `clear_until` is 0.
            return Ok(MarginAnswer::Contact { clear_until: 0.0, t: interval.midpoint(), found });
        }
        too_fine = too_fine.or(result.too_fine);
        intervals.extend(rest.into_iter().flatten());
    }
    if let Some(error) = too_fine {
        return Err(error);
    }
    Ok(progress.undecided().map_or(MarginAnswer::Clear, MarginAnswer::Undecided))
}

/// Earlier intervals first: nothing after a contact matters.
///
/// An undecided interval limits the answer to its start. The search then looks for a shape in
/// contact: larger intervals first, for at most [`PATIENCE`] more shapes. After [`MAX_SHAPES`]
/// shapes, or another limit of work, the answer ends where the first remaining interval begins.
fn first_contact<U>(
    intervals: &mut VecDeque<Interval>,
    mut test_interval: impl FnMut(&Interval) -> Result<TestedInterval<U>, ProximityError>,
) -> Result<MarginAnswer<U>, ProximityError> {
    let (mut undecided, mut contact) = (None::<([Real; 2], UndecidedReason)>, None);
    let (mut clear_until, mut shapes, mut most, mut too_fine) = (1.0, 0, MAX_SHAPES, None);
    // `pop_back` takes the earliest interval.
    intervals.make_contiguous().reverse();
    while shapes < most {
        let next = if undecided.is_none() { intervals.pop_back() } else { intervals.pop_front() };
        let Some(interval) = next else { break };
        let (result, rest) = test_interval(&interval)?;
        shapes += 1;
        if let (Some(reason), None) = (result.undecided, undecided) {
            undecided = Some((interval.times, reason));
            most = most.min(shapes + PATIENCE);
        }
        if result.undecided == Some(UndecidedReason::Work) {
            intervals.push_back(interval);
            break;
        }
        if let Some(found) = result.contact {
            let t = interval.midpoint();
            contact = Some((t, found));
            clear_until = if result.is_fine { interval.times[0] } else { t };
            intervals.clear();
            if !result.is_fine {
                let times = [interval.times[0], t];
                let [before, _] = rest;
                intervals.push_back(Interval { times, ..before.unwrap_or(interval) });
            }
            continue;
        }
        too_fine = too_fine.or(result.too_fine);
        intervals.extend(rest.into_iter().rev().flatten());
    }
    let untested = intervals.iter().map(|interval| interval.times);
    let first_untested = untested.min_by(|a, b| a[0].total_cmp(&b[0]));
    if let Some((t, found)) = contact {
        let unknown = undecided.map(|(times, _)| times).into_iter().chain(first_untested);
        let clear_until = unknown.fold(clear_until, |first, times| first.min(times[0]));
        return Ok(MarginAnswer::Contact { clear_until, t, found });
    }
    if let Some(error) = too_fine {
        return Err(error);
    }
    let first = undecided.or(first_untested.map(|times| (times, UndecidedReason::Work)));
    Ok(first.map_or(MarginAnswer::Clear, MarginAnswer::Undecided))
}

/// Starts with the common parts of all motions' times; `parts` counts the parts of each motion.
pub(super) fn begin<const N: usize>(intervals: &mut VecDeque<Interval>, parts: [usize; N]) {
    let parts = parts.map(|parts| parts.max(1));
    let (mut start, mut passed) = (0.0, [0; N]);
    intervals.clear();
    while start < 1.0 {
        let ends: [Real; N] = from_fn(|k| (passed[k] + 1) as Real / parts[k] as Real);
        let end = ends.into_iter().fold(1.0, Real::min);
        for (passed, own) in passed.iter_mut().zip(ends) {
            *passed += usize::from(own == end);
        }
        intervals.push_back(Interval {
            times: [start, end],
            part: intervals.len(),
            pieces: None,
            is_after: false,
            lower: Real::NEG_INFINITY,
        });
        start = end;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The last interval of a query reaches a limit of work: the reason is the work, although no
    /// interval is left.
    #[test]
    fn the_last_interval_names_its_reason() {
        for reason in [UndecidedReason::Work, UndecidedReason::Near] {
            let mut progress = Progress::default();
            let mut result = IntervalResult::<()>::empty();
            result.undecided = Some(reason);
            progress.record([0.5, 1.0], &result, 1);
            assert_eq!(progress.undecided(), Some(([0.5, 1.0], reason)));
        }
    }
}
