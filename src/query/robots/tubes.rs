//! Queries about two tubes: bounds on their clearance, and whether they keep a margin; and whether
//! one tube keeps a margin to itself.

use crate::answer::{Decision, PairWitness, ProximityError, RobotClearance};
use crate::curve::{Tube, TubeTurns};
use crate::query::clearance::{BoundedClearance, BoundsSearch, Hint, Wanted, clears_pieces};
use crate::refine::{
    BoundingBody, PairQueue, PairUpperBound, PendingPieces, PiecePair, PlacedTube, Refinable,
    SelfPair, SelfPairQueue, TubePair, TubeWithItself,
};
use parry3d_f64::math::{Pose, Real};

/// State and memory that the next query reuses.
#[derive(Clone, Debug, Default)]
pub(crate) struct TubesMemory {
    beginning: PairQueue,
    pairs: Vec<PiecePair>,
    pending: PendingPieces<PiecePair, [BoundingBody; 2], PairUpperBound>,
    /// The sections and arc lengths of the last answer.
    last: Option<([u32; 2], [Real; 2])>,
}

impl TubesMemory {
    pub fn forget(&mut self) {
        self.last = None;
    }

    /// Returns a first upper bound: at the place of the last answer, if these tubes have it.
    fn first_bound(&self, tubes: &TubePair) -> PairUpperBound {
        match self.last.filter(|(sections, _)| tubes.have(*sections)) {
            Some((sections, arcs)) => tubes.bound_at(sections, arcs),
            None => tubes.first_bound(),
        }
    }
}

/// Places both tubes in one frame.
///
/// # Errors
/// A tube has no section, or its pose is not finite, not rigid, or moves the tube out of range.
/// Errors call the poses `names`.
pub(crate) fn place_tubes<'a>(
    tubes: [&'a Tube; 2],
    poses: [&Pose; 2],
    names: [&'static str; 2],
) -> Result<TubePair<'a>, ProximityError> {
    let placed = |k: usize| {
        PlacedTube::new(tubes[k], poses[k], 0.0).map_err(|error| error.of_robot(names[k]))
    };
    Ok(TubePair::new([placed(0)?, placed(1)?]))
}

/// Returns bounds on the clearance of two tubes that are at most `tolerance` apart if the tubes
/// allow it. A stated turn makes no bound worse.
///
/// # Errors
/// A curve is not finite.
pub(crate) fn clearance_between(
    tubes: &mut TubePair,
    memory: &mut TubesMemory,
    tolerance: Real,
) -> Result<RobotClearance, ProximityError> {
    let ask = |tubes: &mut TubePair| clearance_as_stated(tubes, memory, tolerance);
    for_all_stated(tubes, ask, |known, next| {
        let known = known?;
        Ok(known.and(next()?, tolerance))
    })
}

/// Answers a query for both tubes as they were stated. If a stated turn can be ignored, also
/// answers it without, first of all without both turns.
///
/// `better_of` combines an answer with the next one.
fn for_all_stated<T>(
    tubes: &mut TubePair,
    mut ask: impl FnMut(&mut TubePair) -> T,
    better_of: impl Fn(T, &mut dyn FnMut() -> T) -> T,
) -> T {
    let mut less_known = tubes.less_known();
    let Some(mut first) = less_known.next() else { return ask(tubes) };
    let known = ask(&mut first);
    less_known
        .chain([*tubes])
        .fold(known, |known, mut tubes| better_of(known, &mut || ask(&mut tubes)))
}

fn clearance_as_stated(
    tubes: &mut TubePair,
    memory: &mut TubesMemory,
    tolerance: Real,
) -> Result<RobotClearance, ProximityError> {
    let mut hint = Hint { upper: Real::INFINITY, triangle: None };
    hint.take(&memory.first_bound(tubes));
    let TubesMemory { beginning, pairs, pending, last } = memory;
    tubes.begin_pieces(Real::INFINITY, beginning)?;
    if let Some(bound) = tubes.bound_of_bodies(beginning) {
        hint.take(&bound);
    }
    let best = loop {
        // The margin keeps rounding of the bounds from requiring farther pairs.
        let limit = hint.upper + 4.0 * tubes.slack();
        tubes.begin_pairs(limit, usize::MAX, beginning, pairs);
        pending.clear();
        let mut bounds = BoundsSearch::new(tubes, pending, hint, tolerance);
        while let Some(pair) = pairs.pop() {
            bounds.begin(pair, pair.at_least.max(0.0));
        }
        if bounds.run(limit)?
            && let Some(best) = bounds.best
        {
            break (best, bounds.answer(best.upper));
        }
        if limit == Real::INFINITY {
            return Err(ProximityError::EmptyTube);
        }
        // The answer needs pairs that are farther apart than the hint.
        hint.upper = Real::INFINITY;
    };
    let (best, BoundedClearance { lower, resolved, uncertainty }) = best;
    let PairUpperBound { upper, sections, arcs, points: [on_first, on_second] } = best;
    *last = Some((sections, arcs));
    Ok(RobotClearance {
        lower,
        upper,
        resolved,
        uncertainty,
        sections,
        witness: PairWitness { on_first, on_second, arc_lengths: arcs },
    })
}

/// Decides whether two tubes stay farther apart than `margin`. A stated turn makes no answer worse.
///
/// # Errors
/// A curve is not finite, or the samples allow no decision at that resolution.
pub(crate) fn clears_tubes(
    tubes: &mut TubePair,
    memory: &mut TubesMemory,
    margin: Real,
    resolution: Real,
) -> Result<Decision, ProximityError> {
    let ask = |tubes: &mut TubePair| clear_as_stated(tubes, memory, margin, resolution);
    for_all_stated(tubes, ask, |known, next| Decision::better_of(known, next))
}

fn clear_as_stated(
    tubes: &mut TubePair,
    memory: &mut TubesMemory,
    margin: Real,
    resolution: Real,
) -> Result<Decision, ProximityError> {
    // The decision must not depend on the place of an earlier answer.
    let best = tubes.first_bound();
    let TubesMemory { beginning, pairs, pending, last } = memory;
    tubes.begin(Real::INFINITY, margin, usize::MAX, beginning, pairs)?;
    let wanted = Wanted { margin, resolution, start: None };
    let (decision, found) =
        clears_pieces(tubes, pending, pairs.drain(..).rev(), Some(best), wanted)?;
    if let Some(PairUpperBound { sections, arcs, .. }) = found {
        *last = Some((sections, arcs));
    }
    Ok(decision)
}

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
