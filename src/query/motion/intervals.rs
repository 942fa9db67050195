//! The loop over intervals of time, for pairs of robots and for self contact.

use super::approach_bound::{midpoint, remaining_parts};
use super::interval_test::{IntervalResult, MarginQuery};
use super::progress::Progress;
use crate::answer::{PairWitness, ProximityError, RobotMotionAnswer, RobotsInContact};
use crate::refine::PairUpperBound;
use parry3d_f64::math::Real;
use std::collections::VecDeque;

/// Decides whether a margin is kept in all intervals.
///
/// `test_interval` tests the middle shape of an interval. It returns the result and how long before
/// and after the midpoint the unresolved pairs are decided; infinity if there are none. Breadth
/// first: long contacts are found early.
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
            let witness = PairWitness { on_first, on_second, arc_lengths: arcs };
            let contact = RobotsInContact { t, upper, sections, witness };
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
