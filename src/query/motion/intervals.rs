//! The loop over intervals of time, for robots beside robots.

use super::approach_bound::{midpoint, remaining_parts};
use super::interval_test::{IntervalResult, MarginQuery};
use super::progress::Progress;
use crate::answer::{ProximityError, RobotMotionAnswer, RobotsInContact};
use crate::pieces::PairUpperBound;
use parry3d_f64::math::Real;
use std::collections::VecDeque;

/// Whether a margin is kept in all intervals. `test_interval` looks at the middle of one, and says
/// for how long before and after it what failed there is decided: for ever where nothing did.
/// Breadth first: contacts that last show early.
///
/// # Errors
/// As `test_interval`.
pub(super) fn clear(
    intervals: &mut VecDeque<[Real; 2]>,
    mut test_interval: impl FnMut(
        [Real; 2],
    ) -> Result<(IntervalResult<PairUpperBound>, Real), ProximityError>,
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
        if let Some(PairUpperBound { upper, sections, arcs, points: [on_first, on_second] }) =
            result.contact
        {
            let t = midpoint(times);
            let contact =
                RobotsInContact { t, upper, sections, on_first, on_second, arc_lengths: arcs };
            return Ok(RobotMotionAnswer::contact(contact));
        }
        too_fine = too_fine.or(result.too_fine);
        intervals.extend(remaining_parts(times, hold).into_iter().flatten());
    }
    if let Some(error) = too_fine {
        return Err(error);
    }
    Ok(progress.undecided().map_or_else(RobotMotionAnswer::clear, RobotMotionAnswer::undecided))
}

/// So many pairs of pieces are looked at in an interval, the nearest ones, unless it is not for the
/// motion that there are more: 2^16. A shorter interval has fewer.
pub(super) fn most_pairs(reach: Real, MarginQuery { margin, resolution }: MarginQuery) -> usize {
    if reach > margin.max(resolution) { 1 << 16 } else { usize::MAX }
}

/// Begins with each part of the time of all motions, which have so many.
pub(super) fn begin(intervals: &mut VecDeque<[Real; 2]>, legs: impl IntoIterator<Item = usize>) {
    let legs = legs.into_iter().map(|legs| legs.max(1));
    let ends = legs.flat_map(|legs| (0..=legs).map(move |leg| leg as Real / legs as Real));
    let mut ends: Vec<Real> = ends.collect();
    ends.sort_unstable_by(Real::total_cmp);
    ends.dedup();
    intervals.clear();
    intervals.extend(ends.windows(2).map(|ends| [ends[0], ends[1]]));
}
