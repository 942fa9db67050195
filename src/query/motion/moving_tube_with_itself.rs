//! A robot beside itself during an interval of time, whose shape is the one at its middle.

use super::approach_speed::ApproachSpeed;
use super::relative_motion::RelativeMotion;
use crate::answer::ProximityError;
use crate::distance::Scalar;
use crate::pieces::{BoundedPiece, SelfPair, TubeWithItself};
use crate::robot::Motion;
use parry3d_f64::math::Real;

/// The pieces of a robot that moves, two and two, in an interval of time.
pub(super) struct MovingTubeWithItself<'a, M> {
    pub motion: &'a M,
    pub times: [Real; 2],
    /// How fast the two pieces are that are looked at.
    pub speeds: [Real; 2],
    /// How many pairs of pieces may still be looked at, in this shape and all others.
    pub left: &'a mut u32,
}

impl<'t, M: Motion> RelativeMotion<TubeWithItself<'t>, SelfPair> for MovingTubeWithItself<'_, M> {
    /// Each may come straight towards the other.
    fn speed(
        &mut self,
        pair: &SelfPair,
        _: &SelfPair,
        _: &SelfPair,
        own: &TubeWithItself<'t>,
    ) -> Result<Real, ProximityError> {
        *self.left = self.left.saturating_sub(1);
        for (speed, stretch) in self.speeds.iter_mut().zip(own.section_ranges(pair)) {
            let ApproachSpeed { centreline, rim } =
                ApproachSpeed::of(self.motion, self.times, &stretch)?;
            *speed = centreline + rim;
        }
        Ok((self.speeds[0] + self.speeds[1]) * (1.0 + 4.0 * Real::UNIT_ROUNDOFF))
    }

    fn extra_turn(&self, pair: &SelfPair, own: &TubeWithItself<'t>) -> Real {
        own.extra_turn(pair)
    }

    fn is_exhausted(&self) -> bool {
        *self.left == 0
    }

    fn fastest_section(
        &self,
        near: &BoundedPiece<TubeWithItself<'t>, SelfPair>,
        _: Real,
    ) -> (usize, Real) {
        near.found.faster(self.speeds)
    }
}
