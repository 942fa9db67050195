//! Bounds on how far a motion goes from the middle of an interval of time, from its stated speeds.

use super::Motion;
use crate::curve::Drift;
use parry3d_f64::math::Real;

/// A direction that turns faster than this, in rad, is taken to change at one instant: no shorter
/// interval can follow it.
const FASTEST_TURN: Real = (1_u64 << 24) as Real;

/// An interval of time around a shape.
pub(crate) struct MotionDrift<'a, M> {
    pub motion: &'a M,
    pub times: [Real; 2],
    /// The time of the shape.
    pub t: Real,
    /// Half of the interval's length, rounded up.
    pub half_length: Real,
}

impl<M: Motion> Drift for MotionDrift<'_, M> {
    fn moves(&self, section: usize, end: usize) -> Real {
        // An invalid speed bounds nothing here; `check_speed` refuses it elsewhere.
        let speed = self.motion.speed(section, [end as Real; 2], self.times).point;
        self.half_length * if speed >= 0.0 { speed } else { Real::INFINITY }
    }

    /// Uses the displacements of both ends if they are known, otherwise their speeds.
    fn stretches(&self, section: usize) -> Real {
        let [from, to] = self.times;
        let sides = [[from, self.t], [self.t, to]].map(|times| {
            let course = self.motion.displacement(section, [0.0, 1.0], times)?;
            let change = (course.ways[1] - course.ways[0]).length() + 2.0 * course.off;
            (change >= 0.0).then_some(change)
        });
        let by_speed = self.moves(section, 0) + self.moves(section, 1);
        match sides {
            [Some(before), Some(after)] => before.max(after).min(by_speed),
            _ => by_speed,
        }
    }

    fn turns(&self, section: usize) -> Real {
        let turn = self.motion.speed(section, [0.0, 1.0], self.times).turn;
        self.half_length * if turn >= 0.0 { turn } else { Real::INFINITY }
    }

    fn can_follow(&self, turn: Real) -> bool {
        turn <= FASTEST_TURN * self.half_length
    }
}
