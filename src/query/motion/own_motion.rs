//! Whether a robot that moves keeps a margin to itself.
//!
//! An interval of time is judged by the shape at its middle, as for two motions (`two_motions`). Which of its parts are asked about
//! changes with time as well: what may be asked about at any time of the interval is kept (`pieces::own_moves`), and a contact
//! counts if it is one of the shape. The shorter the interval, the less there is between the two.

use super::intervals;
use super::moment::{Moment, Seen, Wanted};
use super::moves::Moves;
use super::moving_own::MovingOwn;
use super::pace::{Pace, check_pace, half, middle};
use super::present::Present;
use crate::answer::{ProximityError, RobotMotionAnswer};
use crate::distance::Scalar;
use crate::pieces::{
    Divided, FoundBetween, MOST_GROWTH, Moved, OwnBeginning, OwnMoves, OwnPair, OwnTube, refine,
};
use crate::robot::{Motion, Section, TubeTurns, check_speed};
use parry3d_f64::math::Real;
use std::collections::VecDeque;

/// A direction that turns faster than this, in rad, would have time divided into a million intervals at once.
const FASTEST_TURN: Real = (1_u64 << 18) as Real;

/// So many pairs of pieces are looked at in all shapes together, 2^18: about a second. Where the
/// margin is as wide as a bend, there may be no end of pairs of which nobody knows whether they are
/// asked about.
const MOST_PAIRS: u32 = 1 << 18;

/// Memory of a query, used again by the next.
#[derive(Clone, Debug, Default)]
pub(crate) struct OwnMotionMemory {
    present: Present,
    turns: TubeTurns,
    moves: OwnMoves,
    beginning: OwnBeginning,
    pairs: Vec<OwnPair>,
    intervals: VecDeque<[Real; 2]>,
}

/// Whether a robot that moves keeps the margin to itself at all times.
///
/// # Errors
/// The motion has no shape at some time, or one that bends too sharply, or changes its sections; a stated speed is not finite or
/// too large; or samples do not allow a decision at that resolution.
pub(crate) fn own_motion_clears<M: Motion>(
    motion: &M,
    memory: &mut OwnMotionMemory,
    wanted: Wanted,
) -> Result<RobotMotionAnswer, ProximityError> {
    let mut intervals = std::mem::take(&mut memory.intervals);
    memory.present.forget();
    intervals::begin(&mut intervals, [motion.legs()]);
    let mut left = MOST_PAIRS;
    let answer = intervals::clear(&mut intervals, |times| judge(motion, memory, times, wanted, &mut left));
    memory.intervals = intervals;
    answer
}

/// Whether the margin is kept in an interval, as far as its middle shape shows; and for how long before and after it all pairs
/// keep it.
fn judge<M: Motion>(
    motion: &M,
    memory: &mut OwnMotionMemory,
    times: [Real; 2],
    wanted @ Wanted { margin, resolution }: Wanted,
    left: &mut u32,
) -> Result<(Seen<FoundBetween>, Real), ProximityError> {
    let OwnMotionMemory { present, turns, moves, beginning, pairs, .. } = memory;
    let pose = present.turn_to(motion, middle(times))?;
    let opening = present.hold_faces(motion, times);
    measure_moves(motion, present.tube.sections(), times, moves)?;
    if moves.most_growth() > MOST_GROWTH {
        return Ok((Seen::nothing(), 0.0));
    }
    present.tube.measure_turns(turns)?;
    let mut own = OwnTube::moving(&present.tube, turns, moves)?;
    // Below that, rounding decides.
    own.check_resolved(32.0 * own.slack(), resolution)?;
    let (fastest, points) = moves.farthest();
    let reach = 2.0 * points * (1.0 + 4.0 * Real::UNIT_ROUNDOFF);
    let (scale, upper) = (margin.max(resolution).max(0.25 * reach), margin + reach + own.slack());
    let is_all = own.begin(scale, upper, intervals::most_pairs(reach, wanted), beginning, pairs)?;
    if !is_all {
        let speed = points / half(times);
        check_pace(speed, resolution, || (fastest, speed))?;
    }
    let moving = MovingOwn { motion, times, speeds: [0.0; 2], left };
    let mut moment = Moment { moving, pace: Pace::new(times, opening), wanted, seen: Seen::nothing() };
    refine(&mut own, pairs, &mut moment)?;
    let Moment { moving, pace, mut seen, .. } = moment;
    if moving.gives_up() && seen.contact.is_none() {
        (seen.is_undecided, seen.gives_up) = (true, true);
    }
    if let Some(found) = &mut seen.contact {
        found.points = found.points.map(|point| pose * point);
    }
    Ok((seen, if is_all { pace.still } else { 0.0 }))
}

/// How far all sections move from the middle of an interval on.
fn measure_moves<M: Motion>(
    motion: &M,
    sections: &[Section],
    times: [Real; 2],
    moves: &mut OwnMoves,
) -> Result<(), ProximityError> {
    moves.clear();
    let half = half(times);
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
        let points = half * (stated.point + section.radius * stated.turn) * upwards;
        moves.push(Moved { points, turn: half * stated.turn * upwards });
    }
    Ok(())
}
