//! Whether a robot that moves keeps a margin to itself.
//!
//! An interval of time is judged by the shape at its middle, as for two motions (`motion_pair`).
//! Which of its parts are asked about changes with time as well: what may be asked about at any
//! time of the interval is kept (`pieces::section_motions`), and a contact counts if it is one of
//! the shape. The shorter the interval, the less there is between the two.

use super::approach_bound::{ApproachBound, check_subdivision, half_length, midpoint};
use super::current_shape::CurrentShape;
use super::interval_test::{IntervalResult, IntervalTest, MarginQuery};
use super::intervals;
use super::moving_tube_with_itself::MovingTubeWithItself;
use super::relative_motion::RelativeMotion;
use crate::answer::{ProximityError, RobotMotionAnswer};
use crate::distance::Scalar;
use crate::pieces::{
    MAX_EXTRA_TURN, PairUpperBound, Refinable, SectionMotion, SectionMotions, SelfPair,
    SelfPairQueue, TubeWithItself, refine,
};
use crate::robot::{Motion, Section, TubeTurns, check_speed};
use parry3d_f64::math::Real;
use std::collections::VecDeque;

/// A direction that turns faster than this, in rad, would have time divided into a million
/// intervals at once.
const FASTEST_TURN: Real = (1_u64 << 18) as Real;

/// So many pairs of pieces are looked at in all shapes together, 2^18: about a second. Where the
/// margin is as wide as a bend, there may be no end of pairs of which nobody knows whether they are
/// asked about.
const MAX_PAIRS: u32 = 1 << 18;

/// Memory of a query, used again by the next.
#[derive(Clone, Debug, Default)]
pub(crate) struct SelfMotionMemory {
    current: CurrentShape,
    turns: TubeTurns,
    moves: SectionMotions,
    beginning: SelfPairQueue,
    pairs: Vec<SelfPair>,
    intervals: VecDeque<[Real; 2]>,
}

/// Whether a robot that moves keeps the margin to itself at all times.
///
/// # Errors
/// The motion has no shape at some time, or one that bends too sharply, or changes its sections; a
/// stated speed is not finite or too large; or samples do not allow a decision at that resolution.
pub(crate) fn self_clears_motion<M: Motion>(
    motion: &M,
    memory: &mut SelfMotionMemory,
    wanted: MarginQuery,
) -> Result<RobotMotionAnswer, ProximityError> {
    let mut intervals = std::mem::take(&mut memory.intervals);
    memory.current.forget();
    intervals::begin(&mut intervals, [motion.legs()]);
    let mut left = MAX_PAIRS;
    let answer = intervals::clear(&mut intervals, |times| {
        test_interval(motion, memory, times, wanted, &mut left)
    });
    memory.intervals = intervals;
    answer
}

/// Whether the margin is kept in an interval, as far as its middle shape shows; and for how long
/// before and after it all pairs keep it.
fn test_interval<M: Motion>(
    motion: &M,
    memory: &mut SelfMotionMemory,
    times: [Real; 2],
    wanted @ MarginQuery { margin, resolution }: MarginQuery,
    left: &mut u32,
) -> Result<(IntervalResult<PairUpperBound>, Real), ProximityError> {
    let SelfMotionMemory { current, turns, moves, beginning, pairs, .. } = memory;
    let pose = current.set_time(motion, midpoint(times))?;
    let cap_change = current.mark_lasting_faces_between(motion, times);
    measure_moves(motion, current.tube.sections(), times, moves)?;
    if moves.max_extra_turn() > MAX_EXTRA_TURN {
        return Ok((IntervalResult::empty(), 0.0));
    }
    current.tube.measure_turns(turns)?;
    let mut own = TubeWithItself::moving(&current.tube, turns, moves)?;
    // Below that, rounding decides.
    own.check_resolved(32.0 * own.slack(), resolution)?;
    let (fastest, points) = moves.farthest();
    let reach = 2.0 * points * (1.0 + 4.0 * Real::UNIT_ROUNDOFF);
    let (scale, upper) = (margin.max(resolution).max(0.25 * reach), margin + reach + own.slack());
    let is_all = own.begin(scale, upper, intervals::most_pairs(reach, wanted), beginning, pairs)?;
    if !is_all {
        let speed = points / half_length(times);
        check_subdivision(speed, resolution, || (fastest, speed))?;
    }
    let moving = MovingTubeWithItself { motion, times, speeds: [0.0; 2], left };
    let mut test = IntervalTest {
        moving,
        approach_bound: ApproachBound::new(times, cap_change),
        wanted,
        result: IntervalResult::empty(),
    };
    refine(&mut own, pairs, &mut test)?;
    let IntervalTest { moving, approach_bound, mut result, .. } = test;
    if moving.is_exhausted() && result.contact.is_none() {
        (result.is_undecided, result.gives_up) = (true, true);
    }
    if let Some(found) = &mut result.contact {
        found.points = found.points.map(|point| pose * point);
    }
    Ok((result, if is_all { approach_bound.hold } else { 0.0 }))
}

/// How far all sections move from the middle of an interval on.
fn measure_moves<M: Motion>(
    motion: &M,
    sections: &[Section],
    times: [Real; 2],
    moves: &mut SectionMotions,
) -> Result<(), ProximityError> {
    moves.clear();
    let half_length = half_length(times);
    for (number, section) in sections.iter().enumerate() {
        let stated = motion.speed(number, [0.0, 1.0], times);
        check_speed(number, stated.point)?;
        check_speed(number, stated.turn)?;
        if stated.turn > FASTEST_TURN {
            return Err(ProximityError::TurnsTooFast {
                section: number,
                turn: stated.turn,
                limit: FASTEST_TURN,
            });
        }
        let upwards = 1.0 + 4.0 * Real::UNIT_ROUNDOFF;
        let points = half_length * (stated.point + section.radius * stated.turn) * upwards;
        moves.push(SectionMotion { points, turn: half_length * stated.turn * upwards });
    }
    Ok(())
}
