//! A moving robot beside itself in an interval of time, in its middle shape.

use super::approach_bound::Approach;
use super::approach_bound::ApproachSpeed;
use super::refinement::{BoundedPiece, WorkItem};
use super::relative_motion::RelativeMotion;
use crate::answer::ProximityError;
use crate::motion::CarriedMotion;
use crate::refine::{SelfPair, TubeWithItself};
use parry3d_f64::math::Real;

impl WorkItem<TubeWithItself<'_>> for SelfPair {
    fn piece(&self, _: &TubeWithItself) -> SelfPair {
        *self
    }

    fn halves(self, _: &TubeWithItself, halves: [SelfPair; 2]) -> [Self; 2] {
        halves
    }
}

/// Pairs of pieces of a moving robot in an interval of time.
pub(super) struct MovingTubeWithItself<'a> {
    pub motion: CarriedMotion<'a>,
    /// How many pairs of pieces may still be tested in this query.
    pub left: &'a mut u32,
}

impl<'t> RelativeMotion<TubeWithItself<'t>, SelfPair> for MovingTubeWithItself<'_> {
    /// The speeds of both pieces relative to the frame that carries both. They may move straight
    /// towards each other.
    fn speeds(
        &mut self,
        pair: &SelfPair,
        _: &SelfPair,
        _: &SelfPair,
        own: &TubeWithItself<'t>,
    ) -> Result<[Real; 2], ProximityError> {
        *self.left = self.left.saturating_sub(1);
        let mut speeds = [0.0; 2];
        for (speed, range) in speeds.iter_mut().zip(own.section_ranges(pair)) {
            let stated = self.motion.stated(range.section as usize, range.shares);
            let ApproachSpeed { centreline, rim } = ApproachSpeed::of(stated, &range)?;
            *speed = centreline + rim;
        }
        Ok(speeds)
    }

    fn extra_turn(&self, pair: &SelfPair, own: &TubeWithItself<'t>) -> Real {
        own.extra_turn(pair)
    }

    fn is_exhausted(&self) -> bool {
        *self.left == 0
    }

    fn fastest_section(
        &self,
        bounded: &BoundedPiece<TubeWithItself<'t>, SelfPair>,
        approach: &Approach,
    ) -> (usize, Real) {
        bounded.found.faster(approach.speeds)
    }
}
