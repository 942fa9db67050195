//! What is known of a margin while intervals of time are judged one after another.

use super::interval_test::IntervalResult;
use crate::answer::UndecidedReason;
use parry3d_f64::math::Real;

/// How many shapes are looked at after one that is above the margin by no more than the resolution,
/// or that leaves an interval undecided. A contact that is deeper than that, or a proof, shows
/// sooner as a rule; and what stays that near for long would be divided into as many intervals as
/// the resolution has room for, a million and more.
pub(super) const PATIENCE: u64 = 256;

/// A question about a motion ends after so many shapes.
pub(super) const MAX_SHAPES: u64 = 1 << 16;

/// What the intervals so far have shown.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Progress {
    /// The first interval that stays undecided.
    undecided: Option<[Real; 2]>,
    /// An interval with a shape near the margin, and how many shapes there may be in all then.
    near: Option<([Real; 2], u64)>,
    /// Whether a limit of work other than the number of shapes is reached.
    is_exhausted: bool,
}

impl Progress {
    /// Takes note of what an interval shows; so many shapes were looked at.
    pub(super) fn record<F>(&mut self, times: [Real; 2], result: &IntervalResult<F>, shapes: u64) {
        if result.is_near && self.near.is_none() {
            self.near = Some((times, shapes + PATIENCE));
        }
        if result.gives_up {
            self.near = Some((times, shapes));
            self.is_exhausted = true;
        }
        if result.is_undecided && self.undecided.is_none_or(|first| times[0] < first[0]) {
            self.undecided = Some(times);
        }
    }

    /// The first interval of which nothing is known, and why, if no more shapes are to be looked
    /// at; these intervals were not.
    pub(super) fn is_exhausted(
        &self,
        shapes: u64,
        left: impl Iterator<Item = [Real; 2]>,
    ) -> Option<([Real; 2], UndecidedReason)> {
        let left = left.chain(self.undecided);
        if let Some((near, _)) = self.near.filter(|(_, most)| shapes >= *most) {
            let earlier = |first: [Real; 2], times: [Real; 2]| {
                if times[0] < first[0] { [times[0], times[1].max(near[1])] } else { first }
            };
            let reason =
                if self.is_exhausted { UndecidedReason::Work } else { UndecidedReason::Near };
            return Some((left.fold(near, earlier), reason));
        }
        if shapes < MAX_SHAPES {
            return None;
        }
        let first = left.min_by(|a, b| a[0].total_cmp(&b[0]))?;
        Some((first, UndecidedReason::Work))
    }

    /// The first interval that stays undecided, and why, after all were looked at.
    pub(super) fn undecided(&self) -> Option<([Real; 2], UndecidedReason)> {
        self.undecided.map(|first| (first, UndecidedReason::Near))
    }
}
