//! The query whether a tube keeps a margin to itself.

use crate::answer::{Decision, ProximityError};
use crate::curve::{Tube, TubeTurns};
use crate::query::clearance::{Wanted, clears_pieces};
use crate::refine::{PairUpperBound, PendingPieces, SelfPair, SelfPairQueue, TubeWithItself};
use parry3d_f64::math::Real;

/// Memory that the next query reuses.
#[derive(Clone, Debug, Default)]
pub(crate) struct SelfTubeMemory {
    turns: TubeTurns,
    beginning: SelfPairQueue,
    pending: PendingPieces<SelfPair, SelfPair, PairUpperBound>,
}

/// Decides whether all queried pairs of a tube stay farther apart than `margin`. A stated turn
/// makes no answer worse.
///
/// # Errors
/// The tube bends too sharply, its curve is not finite, or the samples allow no decision at that
/// resolution.
pub(crate) fn self_clears_tube(
    tube: &Tube,
    memory: &mut SelfTubeMemory,
    margin: Real,
    resolution: Real,
) -> Result<Decision, ProximityError> {
    let SelfTubeMemory { turns, beginning, pending } = memory;
    tube.measure_turns(turns)?;
    let own = TubeWithItself::new(tube, turns)?;
    let wanted = Wanted { margin, resolution, start: None };
    let mut clears = |mut own: TubeWithItself| -> Result<Decision, ProximityError> {
        // The initial pieces must not depend on the resolution: the order of pieces would.
        let pairs = own.initial_pairs(margin, margin, beginning)?.map(|(.., pair)| pair);
        let (decision, _) = clears_pieces(&mut own, pending, pairs, None, wanted)?;
        Ok(decision)
    };
    match own.less_known() {
        Some(less_known) => {
            let decision = clears(less_known);
            Decision::better_of(decision, || clears(own))
        }
        None => clears(own),
    }
}
