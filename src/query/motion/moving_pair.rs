//! Two moving robots in an interval of time, in their middle shapes.

use super::approach_bound::Approach;
use super::approach_speed::ApproachSpeed;
use super::relative_motion::RelativeMotion;
use crate::answer::ProximityError;
use crate::motion::Motion;
use crate::refine::{BoundedPiece, BoundingBody, PiecePair, TubePair};
use crate::robot::RobotError;
use parry3d_f64::math::Real;

/// Pairs of pieces of two moving robots in an interval of time.
pub(super) struct MovingPair<'a> {
    pub motions: [&'a dyn Motion; 2],
    /// The names of the motions in error messages.
    pub names: [&'static str; 2],
    pub times: [Real; 2],
    /// How many pairs of pieces may still be tested in this query.
    pub left: &'a mut u32,
}

impl<'t> RelativeMotion<TubePair<'t>, PiecePair> for MovingPair<'_> {
    /// The speeds of both pieces, which may move straight towards each other.
    fn speeds(
        &mut self,
        pair: &PiecePair,
        _: &PiecePair,
        _: &[BoundingBody; 2],
        tubes: &TubePair<'t>,
    ) -> Result<[Real; 2], ProximityError> {
        *self.left = self.left.saturating_sub(1);
        let [first, second] = tubes.section_ranges(pair);
        let [a, b] = self.motions;
        let fast =
            [ApproachSpeed::of(a, self.times, &first), ApproachSpeed::of(b, self.times, &second)];
        let mut speeds = [0.0; 2];
        for ((speed, fast), name) in speeds.iter_mut().zip(fast).zip(self.names) {
            let named = |error: RobotError| ProximityError::Motion(error).of_robot(name);
            let ApproachSpeed { centreline, rim } = fast.map_err(named)?;
            *speed = centreline + rim;
        }
        Ok(speeds)
    }

    fn is_exhausted(&self) -> bool {
        *self.left == 0
    }

    fn fastest_section(
        &self,
        near: &BoundedPiece<TubePair<'t>, PiecePair>,
        approach: &Approach,
    ) -> (usize, Real) {
        near.found.faster(approach.speeds)
    }
}
