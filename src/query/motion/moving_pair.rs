//! Two robots during an interval of time, whose shapes are those at its middle.

use super::approach_speed::ApproachSpeed;
use super::relative_motion::RelativeMotion;
use crate::answer::ProximityError;
use crate::distance::Scalar;
use crate::pieces::{BoundedPiece, BoundingBody, PiecePair, TubePair};
use crate::robot::{Motion, RobotError};
use parry3d_f64::math::Real;

/// The pieces of two robots that move, in an interval of time.
pub(super) struct MovingPair<'a, A, B> {
    pub motions: (&'a A, &'a B),
    /// What the motions are called.
    pub names: [&'static str; 2],
    pub times: [Real; 2],
    /// How fast the two pieces are that are looked at.
    pub speeds: [Real; 2],
    /// How many pairs of pieces may still be looked at, in these shapes and all others.
    pub left: &'a mut u32,
}

impl<'t, A: Motion, B: Motion> RelativeMotion<TubePair<'t>, PiecePair> for MovingPair<'_, A, B> {
    /// Each may come straight towards the other.
    fn speed(
        &mut self,
        pair: &PiecePair,
        _: &PiecePair,
        _: &[BoundingBody; 2],
        tubes: &TubePair<'t>,
    ) -> Result<Real, ProximityError> {
        *self.left = self.left.saturating_sub(1);
        let [first, second] = tubes.section_ranges(pair);
        let (a, b) = self.motions;
        let fast =
            [ApproachSpeed::of(a, self.times, &first), ApproachSpeed::of(b, self.times, &second)];
        for ((speed, fast), name) in self.speeds.iter_mut().zip(fast).zip(self.names) {
            let named = |error: RobotError| ProximityError::Motion(error).of_robot(name);
            let ApproachSpeed { centreline, rim } = fast.map_err(named)?;
            *speed = centreline + rim;
        }
        Ok((self.speeds[0] + self.speeds[1]) * (1.0 + 4.0 * Real::UNIT_ROUNDOFF))
    }

    fn is_exhausted(&self) -> bool {
        *self.left == 0
    }

    fn fastest_section(
        &self,
        near: &BoundedPiece<TubePair<'t>, PiecePair>,
        _: Real,
    ) -> (usize, Real) {
        near.found.faster(self.speeds)
    }
}
