//! Bounds on the least clearance of a motion in a mesh: the rounds of `minimum_rounds`.
//!
//! An interval has the pieces that its parent left unresolved, as for a margin (`motion_search`).
//! Displacements settle pieces on one side of the middle shape.

use super::intervals::Interval;
use super::minimum_policy::MinimumPolicy;
use super::minimum_rounds::{Minimized, Minimum, MinimumBounds, RoundMemory, minimum};
use super::motion_search::MotionSearch;
use super::moving_tube::Left;
use super::refinement::refine;
use crate::answer::{MotionClearance, ProximityError};
use crate::refine::{MeshUpperBound, Refinable, TubeInMesh};
use parry3d_f64::math::Real;

impl MotionSearch<'_> {
    /// Returns bounds on the least clearance that are at most `tolerance` apart if possible; or a
    /// lower bound of at least `limit`.
    pub(crate) fn clearance(
        &mut self,
        tolerance: Real,
        limit: Real,
    ) -> Result<MotionClearance, ProximityError> {
        let Minimum { lower, uncertainty, resolved, best, t } = minimum(self, tolerance, limit)?;
        let MeshUpperBound { upper, section, witness } = best;
        Ok(MotionClearance { lower, upper, resolved, uncertainty, t, section, witness })
    }
}

fn seed(known: &mut MinimumBounds<MeshUpperBound>, tube: &mut TubeInMesh, t: Real) {
    known.seed(tube.position_uncertainty(), t, |best| match best {
        Some(MeshUpperBound { section, witness, .. }) => {
            tube.bound_at(section, witness.arc_length, witness.triangle)
        }
        None => tube.first_bound(),
    });
}

impl Minimized for MotionSearch<'_> {
    type Upper = MeshUpperBound;

    fn memory(&mut self) -> RoundMemory<'_> {
        let memory = &mut *self.memory;
        RoundMemory {
            intervals: &mut memory.intervals,
            queue: &mut memory.queue,
            part_bounds: &mut memory.part_bounds,
            settled: &mut memory.settled,
        }
    }

    fn begin(&mut self) {
        MotionSearch::begin(self);
    }

    fn seed(
        &mut self,
        interval: &Interval,
        known: &mut MinimumBounds<MeshUpperBound>,
    ) -> Result<(), ProximityError> {
        self.with_middle_shape(interval, |tube, _, _, _| {
            seed(known, tube, interval.midpoint());
            Ok(())
        })?;
        Ok(())
    }

    fn refine(
        &mut self,
        interval: Interval,
        known: &mut MinimumBounds<MeshUpperBound>,
    ) -> Result<[Option<Interval>; 2], ProximityError> {
        let t = interval.midpoint();
        let ((nearest, hold, is_left), pieces) =
            self.with_middle_shape(&interval, |tube, pending, moving, approach_bound| {
                seed(known, tube, t);
                pending.begin(tube, known.upper().max(known.tolerance));
                let slack = tube.slack();
                let mut policy = MinimumPolicy::new(moving, approach_bound, known, t, slack);
                refine(tube, pending.pieces, &mut policy)?;
                // A clearance below 0 does not exist.
                let wanted = policy.wanted();
                let is_left = if wanted < 0.0 {
                    policy.settle(0.0);
                    [true; 2]
                } else {
                    // `wanted` may have fallen since a piece was recorded.
                    let Left { sides, is_any_cleared } =
                        policy.moving.clear_by_displacement(tube, wanted);
                    if is_any_cleared {
                        policy.settle(wanted);
                    }
                    sides
                };
                Ok((policy.nearest, policy.approach_bound.hold, is_left))
            })?;
        Ok(interval.with_lower_bound(nearest).halves(hold, is_left, &pieces))
    }
}
