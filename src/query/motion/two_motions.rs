//! Whether two robots that move at the same time keep a margin between them.
//!
//! An interval of time is judged by the two shapes at its middle, as for one motion (`motion_search`): a point of a piece that moves at V or
//! slower is within tau V of where it is then, tau being half of the interval, so two pieces come nearer by no more than tau times the sum of
//! their speeds. Pairs for which that is too much are looked at again in what is left of the interval on either side. These are few,
//! and which pieces of one robot are near which of the other is seen at once from their bodies: so each shape begins with all pairs that may
//! come as near as the margin in its interval, instead of a list that the one before left.

use super::intervals;
use super::moment::{Moment, Seen, Wanted};
use super::moves::Moves;
use super::moving_pair::MovingPair;
use super::pace::{Pace, check_pace, half, middle};
use super::present::Present;
use crate::answer::{ProximityError, RobotMotionAnswer};
use crate::distance::Scalar;
use crate::pieces::{Beginning, Divided, FoundBetween, PiecePair, PlacedTube, TwoTubes, refine};
use crate::robot::{Motion, check_speed};
use parry3d_f64::math::Real;
use std::collections::VecDeque;

/// So many pairs of pieces are looked at in all shapes together, 2^20.
const MOST_PAIRS: u32 = 1 << 20;

/// Memory of a query, used again by the next.
#[derive(Clone, Debug, Default)]
pub(crate) struct MotionsMemory {
    present: [Present; 2],
    beginning: Beginning,
    pairs: Vec<PiecePair>,
    intervals: VecDeque<[Real; 2]>,
}

/// Two motions beside one another.
pub(crate) struct TwoMotions<'a, A, B> {
    pub memory: &'a mut MotionsMemory,
    pub motions: (&'a A, &'a B),
    /// What the motions are called.
    pub names: [&'static str; 2],
}

impl<A: Motion, B: Motion> TwoMotions<'_, A, B> {
    /// Whether the margin is kept at all times.
    pub(crate) fn clear(&mut self, wanted: Wanted) -> Result<RobotMotionAnswer, ProximityError> {
        let mut intervals = std::mem::take(&mut self.memory.intervals);
        for present in &mut self.memory.present {
            present.forget();
        }
        intervals::begin(&mut intervals, [self.motions.0.legs(), self.motions.1.legs()]);
        let mut left = MOST_PAIRS;
        let answer = intervals::clear(&mut intervals, |times| self.judge(times, wanted, &mut left));
        self.memory.intervals = intervals;
        answer
    }

    /// Whether the margin is kept in an interval, as far as its middle shapes show; and for how long before and after these all
    /// pairs keep it, which is for ever where none failed.
    fn judge(
        &mut self,
        times: [Real; 2],
        wanted: Wanted,
        left: &mut u32,
    ) -> Result<(Seen<FoundBetween>, Real), ProximityError> {
        let (motions, names) = (self.motions, self.names);
        let MotionsMemory { present: [first, second], beginning, pairs, .. } = &mut *self.memory;
        let [first, second] = [shape(motions.0, first, times), shape(motions.1, second, times)];
        let first = first.map_err(|error| error.of_robot(names[0]))?;
        let second = second.map_err(|error| error.of_robot(names[1]))?;
        let mut tubes = TwoTubes::new([first.tube, second.tube]);
        // Below that, rounding decides.
        tubes.check_resolved(32.0 * tubes.slack(), wanted.resolution)?;
        let reach = half(times) * (first.speed + second.speed) * (1.0 + 4.0 * Real::UNIT_ROUNDOFF);
        let Wanted { margin, resolution } = wanted;
        let (scale, upper) = (margin.max(resolution).max(0.25 * reach), margin + reach + tubes.slack());
        let is_all = tubes.begin(scale, upper, intervals::most_pairs(reach, wanted), beginning, pairs)?;
        if !is_all {
            let faster = if second.speed > first.speed { &second } else { &first };
            check_pace(faster.speed, resolution, || (faster.fastest, faster.speed))?;
        }
        let pace = Pace::new(times, first.opening.max(second.opening));
        let moving = MovingPair { motions, names, times, speeds: [0.0; 2], left };
        let mut moment = Moment { moving, pace, wanted, seen: Seen::nothing() };
        refine(&mut tubes, pairs, &mut moment)?;
        let Moment { moving, pace, mut seen, .. } = moment;
        if moving.gives_up() && seen.contact.is_none() {
            (seen.is_undecided, seen.gives_up) = (true, true);
        }
        Ok((seen, if is_all { pace.still } else { 0.0 }))
    }
}

/// A robot at the middle of an interval.
struct Middle<'a> {
    tube: PlacedTube<'a>,
    opening: Real,
    /// How fast any of its points moves at most, and the section of that one.
    speed: Real,
    fastest: usize,
}

fn shape<'p, M: Motion>(
    motion: &M,
    present: &'p mut Present,
    times: [Real; 2],
) -> Result<Middle<'p>, ProximityError> {
    let pose = present.turn_to(motion, middle(times))?;
    let opening = present.hold_faces(motion, times);
    let tube = PlacedTube::new(&present.tube, &pose, 0.0)?.moving();
    let (mut most, mut fastest) = (0.0, 0);
    for (number, section) in tube.sections().iter().enumerate() {
        let stated = motion.speed(number, [0.0, 1.0], times);
        check_speed(number, stated.point)?;
        // Where no body has a flat end, nobody needs a turn: that of a link without a length is infinite.
        let has_rim = section.radius > 0.0 && tube.faces(section).iter().any(Option::is_some);
        let turn = if has_rim { stated.turn } else { 0.0 };
        check_speed(number, turn)?;
        let speed = stated.point + section.radius * turn;
        if speed > most {
            (most, fastest) = (speed, number);
        }
    }
    Ok(Middle { tube, opening, speed: most * (1.0 + 4.0 * Real::UNIT_ROUNDOFF), fastest })
}
