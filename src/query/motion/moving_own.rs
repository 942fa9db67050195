//! A robot beside itself during an interval of time, whose shape is the one at its middle.

use super::fast::Fast;
use super::moves::Moves;
use crate::answer::ProximityError;
use crate::distance::Scalar;
use crate::pieces::{Near, OwnPair, OwnTube};
use crate::robot::Motion;
use parry3d_f64::math::Real;

/// The pieces of a robot that moves, two and two, in an interval of time.
pub(super) struct MovingOwn<'a, M> {
    pub motion: &'a M,
    pub times: [Real; 2],
    /// How fast the two pieces are that are looked at.
    pub speeds: [Real; 2],
    /// How many pairs of pieces may still be looked at, in this shape and all others.
    pub left: &'a mut u32,
}

impl<'t, M: Motion> Moves<OwnTube<'t>, OwnPair> for MovingOwn<'_, M> {
    /// Each may come straight towards the other.
    fn speed(
        &mut self,
        pair: &OwnPair,
        _: &OwnPair,
        _: &OwnPair,
        own: &OwnTube<'t>,
    ) -> Result<Real, ProximityError> {
        *self.left = self.left.saturating_sub(1);
        for (speed, stretch) in self.speeds.iter_mut().zip(own.stretches(pair)) {
            let Fast { centreline, rim } = Fast::of(self.motion, self.times, &stretch)?;
            *speed = centreline + rim;
        }
        Ok((self.speeds[0] + self.speeds[1]) * (1.0 + 4.0 * Real::UNIT_ROUNDOFF))
    }

    fn growth(&self, pair: &OwnPair, own: &OwnTube<'t>) -> Real {
        own.growth(pair)
    }

    fn gives_up(&self) -> bool {
        *self.left == 0
    }

    fn fastest(&self, near: &Near<OwnTube<'t>, OwnPair>, _: Real) -> (usize, Real) {
        near.found.faster(self.speeds)
    }
}
