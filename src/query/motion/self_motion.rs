//! Whether a moving robot keeps a margin to itself.
//!
//! An interval of time is tested by its middle shape, as for two motions (`motion_pair`). The set
//! of queried pairs depends on time, too. All pairs that may be queried at some time of the
//! interval are kept (`refine::section_motions`). A contact counts if the middle shape queries it.
//! The difference between both sets vanishes as the interval becomes shorter.

use super::approach_bound::{ApproachBound, check_subdivision, half_length, midpoint};
use super::current_shape::CurrentShape;
use super::interval_test::{IntervalResult, IntervalTest, MarginQuery};
use super::intervals::{self, Interval, MarginAnswer, Sought, TestedInterval};
use super::motion_pair::most_pairs;
use super::moving_tube_with_itself::MovingTubeWithItself;
use super::refinement::refine;
use super::relative_motion::RelativeMotion;
use crate::answer::{ProximityError, RobotMotionAnswer, UndecidedReason};
use crate::curve::{Section, TubeTurns};
use crate::distance::Scalar;
use crate::motion::{CarriedMotion, Motion, check_speed};
use crate::refine::{
    MAX_EXTRA_TURN, PairUpperBound, Refinable, SectionMotion, SectionMotions, SelfPair,
    SelfPairQueue, TubeWithItself,
};
use parry3d_f64::math::Real;
use std::collections::VecDeque;

/// The fastest turn of a direction, in rad per unit of time. A faster one would divide time into a
/// million intervals at once.
const FASTEST_TURN: Real = (1_u64 << 18) as Real;

/// The most pairs of pieces tested in all shapes together: about a second. If the margin is as wide
/// as a bend, arbitrarily many pairs may stay that may or may not be queried.
const MAX_PAIRS: u32 = 1 << 18;

/// State and memory that the next query reuses.
#[derive(Clone, Debug, Default)]
pub(crate) struct SelfMotionMemory {
    current: CurrentShape,
    turns: TubeTurns,
    moves: SectionMotions,
    beginning: SelfPairQueue,
    pairs: Vec<SelfPair>,
    intervals: VecDeque<Interval>,
}

/// Decides whether a moving robot keeps the margin to itself at all times.
///
/// # Errors
/// - The motion has no shape at some time, or one that bends too sharply, or changes its sections.
/// - A stated speed is not finite or too large.
/// - The samples allow no decision at that resolution.
pub(crate) fn self_decides_motion(
    motion: &dyn Motion,
    memory: &mut SelfMotionMemory,
    wanted: MarginQuery,
    sought: Sought,
) -> Result<RobotMotionAnswer, ProximityError> {
    let mut intervals = std::mem::take(&mut memory.intervals);
    memory.current.forget();
    intervals::begin(&mut intervals, [motion.time_parts()]);
    let mut left = MAX_PAIRS;
    let answer = intervals::decide(sought, &mut intervals, |interval| {
        test_interval(motion, memory, interval, wanted, &mut left)
    });
    memory.intervals = intervals;
    answer.map(MarginAnswer::of_robots)
}

/// Tests the middle shape of an interval.
fn test_interval(
    motion: &dyn Motion,
    memory: &mut SelfMotionMemory,
    interval: &Interval,
    wanted @ MarginQuery { margin, resolution }: MarginQuery,
    left: &mut u32,
) -> Result<TestedInterval<PairUpperBound>, ProximityError> {
    let times = interval.times;
    let SelfMotionMemory { current, turns, moves, beginning, pairs, .. } = memory;
    let pose = current.set_time(motion, midpoint(times))?;
    let carried = CarriedMotion::new(motion, times, half_length(times));
    let cap_change = current.mark_lasting_faces_in(&carried, 0.0);
    measure_moves(&carried, current.tube.sections(), moves)?;
    if moves.max_extra_turn() > MAX_EXTRA_TURN {
        return Ok((IntervalResult::empty(), interval.rest(0.0)));
    }
    current.tube.measure_turns(turns)?;
    let mut own = TubeWithItself::moving(&current.tube, turns, moves)?;
    // A finer resolution is below rounding.
    own.check_resolved(32.0 * own.slack(), resolution)?;
    let (fastest, points) = moves.farthest();
    let reach = 2.0 * points * (1.0 + 4.0 * Real::UNIT_ROUNDOFF);
    let (scale, upper) = (margin.max(resolution).max(0.25 * reach), margin + reach + own.slack());
    let is_all = own.begin(scale, upper, most_pairs(reach, wanted), beginning, pairs)?;
    if !is_all {
        let speed = points / half_length(times);
        check_subdivision(speed, resolution, || (fastest, speed))?;
    }
    let moving = MovingTubeWithItself { motion: carried, left };
    let mut test = IntervalTest {
        moving,
        approach_bound: ApproachBound::new(times, cap_change),
        wanted,
        result: IntervalResult::empty(),
    };
    refine(&mut own, pairs, &mut test)?;
    let IntervalTest { moving, approach_bound, mut result, .. } = test;
    if moving.is_exhausted() && result.contact.is_none() {
        result.undecided = Some(UndecidedReason::Work);
    }
    if let Some(found) = &mut result.contact {
        found.points = found.points.map(|point| pose * point);
    }
    Ok((result, interval.rest(if is_all { approach_bound.hold } else { 0.0 })))
}

/// Computes how far all sections move and turn from the midpoint of an interval, relative to the
/// frame that carries them all.
fn measure_moves(
    motion: &CarriedMotion,
    sections: &[Section],
    moves: &mut SectionMotions,
) -> Result<(), ProximityError> {
    moves.clear();
    let half_length = motion.half;
    for (number, section) in sections.iter().enumerate() {
        let stated = motion.stated(number, [0.0, 1.0]);
        check_speed(number, stated.point)?;
        // Infinite for a link that loses its length, which is no mistake of the motion.
        if stated.turn > FASTEST_TURN {
            return Err(ProximityError::TurnsTooFast {
                section: number,
                turn: stated.turn,
                limit: FASTEST_TURN,
            });
        }
        check_speed(number, stated.turn)?;
        let upwards = 1.0 + 4.0 * Real::UNIT_ROUNDOFF;
        let points = half_length * (stated.point + section.radius * stated.turn) * upwards;
        moves.push(SectionMotion { points, turn: half_length * stated.turn * upwards });
    }
    Ok(())
}
