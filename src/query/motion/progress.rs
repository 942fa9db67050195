//! The state of a margin query over intervals of time, and its limits of work.

use super::interval_test::IntervalResult;
use crate::answer::UndecidedReason;
use parry3d_f64::math::Real;

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
