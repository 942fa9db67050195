//! What is known of a margin while intervals of time are judged one after another.

use super::moment::Seen;
use parry3d_f64::math::Real;

/// How many shapes are looked at after one that is above the margin by no more than the resolution, or that leaves an
/// interval undecided. A contact that is deeper than that, or a proof, shows sooner as a rule; and what stays that near for
/// long would be divided into as many intervals as the resolution has room for, a million and more.
pub(super) const PATIENCE: u64 = 256;

/// What the intervals so far have shown.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Progress {
    /// The first interval that stays undecided.
    pub undecided: Option<[Real; 2]>,
    /// An interval with a shape near the margin, and how many shapes there may be in all then.
    near: Option<([Real; 2], u64)>,
}

impl Progress {
    /// Takes note of what an interval shows; so many shapes were looked at.
    pub(super) fn take<F>(&mut self, times: [Real; 2], seen: &Seen<F>, shapes: u64) {
        if seen.is_near && self.near.is_none() {
            self.near = Some((times, shapes + PATIENCE));
        }
        if seen.gives_up {
            self.near = Some((times, shapes));
        }
        if seen.is_undecided && self.undecided.is_none_or(|first| times[0] < first[0]) {
            self.undecided = Some(times);
        }
    }

    /// The first interval of which nothing is known, if no more shapes are to be looked at; these intervals were not.
    pub(super) fn gives_up(&self, shapes: u64, left: impl Iterator<Item = [Real; 2]>) -> Option<[Real; 2]> {
        let (near, _) = self.near.filter(|(_, most)| shapes >= *most)?;
        let earlier = |first: [Real; 2], times: [Real; 2]| {
            if times[0] < first[0] { [times[0], times[1].max(near[1])] } else { first }
        };
        Some(left.chain(self.undecided).fold(near, earlier))
    }
}
