//! Whether two robots that move at the same time keep a margin between them.
//!
//! An interval of time is judged by the two shapes at its middle, as for one motion
//! (`motion_search`): a point of a piece that moves at V or slower is within tau V of where it is
//! then, tau being half of the interval, so two pieces come nearer by no more than tau times the
//! sum of their speeds. Pairs for which that is too much are looked at again in what is left of the
//! interval on either side. These are few, and which pieces of one robot are near which of the
//! other is seen at once from their bodies: so each shape begins with all pairs that may
//! come as near as the margin in its interval, instead of a list that the one before left.

use super::approach_bound::{ApproachBound, check_subdivision, half_length, midpoint};
use super::current_shape::CurrentShape;
use super::interval_test::{IntervalResult, IntervalTest, MarginQuery};
use super::intervals;
use super::moving_pair::MovingPair;
use super::relative_motion::RelativeMotion;
use crate::answer::{ProximityError, RobotMotionAnswer};
use crate::distance::Scalar;
use crate::pieces::{
    PairQueue, PairUpperBound, PiecePair, PlacedTube, Refinable, TubePair, refine,
};
use crate::robot::{Motion, check_speed};
use parry3d_f64::math::Real;
use std::collections::VecDeque;

/// So many pairs of pieces are looked at in all shapes together, 2^20.
const MAX_PAIRS: u32 = 1 << 20;

/// Memory of a query, used again by the next.
#[derive(Clone, Debug, Default)]
pub(crate) struct MotionsMemory {
    current: [CurrentShape; 2],
    beginning: PairQueue,
    pairs: Vec<PiecePair>,
    intervals: VecDeque<[Real; 2]>,
}

/// Two motions beside one another.
pub(crate) struct MotionPair<'a, A, B> {
    pub memory: &'a mut MotionsMemory,
    pub motions: (&'a A, &'a B),
    /// What the motions are called.
    pub names: [&'static str; 2],
}

impl<A: Motion, B: Motion> MotionPair<'_, A, B> {
    /// Whether the margin is kept at all times.
    pub(crate) fn clear(
        &mut self,
        wanted: MarginQuery,
    ) -> Result<RobotMotionAnswer, ProximityError> {
        let mut intervals = std::mem::take(&mut self.memory.intervals);
        for current in &mut self.memory.current {
            current.forget();
        }
        intervals::begin(&mut intervals, [self.motions.0.legs(), self.motions.1.legs()]);
        let mut left = MAX_PAIRS;
        let answer =
            intervals::clear(&mut intervals, |times| self.test_interval(times, wanted, &mut left));
        self.memory.intervals = intervals;
        answer
    }

    /// Whether the margin is kept in an interval, as far as its middle shapes show; and for how
    /// long before and after these all pairs keep it, which is for ever where none failed.
    fn test_interval(
        &mut self,
        times: [Real; 2],
        wanted: MarginQuery,
        left: &mut u32,
    ) -> Result<(IntervalResult<PairUpperBound>, Real), ProximityError> {
        let (motions, names) = (self.motions, self.names);
        let MotionsMemory { current: [first, second], beginning, pairs, .. } = &mut *self.memory;
        let [first, second] = [shape(motions.0, first, times), shape(motions.1, second, times)];
        let first = first.map_err(|error| error.of_robot(names[0]))?;
        let second = second.map_err(|error| error.of_robot(names[1]))?;
        let mut tubes = TubePair::new([first.tube, second.tube]);
        // Below that, rounding decides.
        tubes.check_resolved(32.0 * tubes.slack(), wanted.resolution)?;
        let reach =
            half_length(times) * (first.speed + second.speed) * (1.0 + 4.0 * Real::UNIT_ROUNDOFF);
        let MarginQuery { margin, resolution } = wanted;
        let (scale, upper) =
            (margin.max(resolution).max(0.25 * reach), margin + reach + tubes.slack());
        let is_all =
            tubes.begin(scale, upper, intervals::most_pairs(reach, wanted), beginning, pairs)?;
        if !is_all {
            let faster = if second.speed > first.speed { &second } else { &first };
            check_subdivision(faster.speed, resolution, || (faster.fastest, faster.speed))?;
        }
        let approach_bound = ApproachBound::new(times, first.cap_change.max(second.cap_change));
        let moving = MovingPair { motions, names, times, speeds: [0.0; 2], left };
        let mut test =
            IntervalTest { moving, approach_bound, wanted, result: IntervalResult::empty() };
        refine(&mut tubes, pairs, &mut test)?;
        let IntervalTest { moving, approach_bound, mut result, .. } = test;
        if moving.is_exhausted() && result.contact.is_none() {
            (result.is_undecided, result.gives_up) = (true, true);
        }
        Ok((result, if is_all { approach_bound.hold } else { 0.0 }))
    }
}

/// A robot at the middle of an interval.
struct PlacedShape<'a> {
    tube: PlacedTube<'a>,
    cap_change: Real,
    /// How fast any of its points moves at most, and the section of that one.
    speed: Real,
    fastest: usize,
}

fn shape<'p, M: Motion>(
    motion: &M,
    current: &'p mut CurrentShape,
    times: [Real; 2],
) -> Result<PlacedShape<'p>, ProximityError> {
    let pose = current.set_time(motion, midpoint(times))?;
    let cap_change = current.mark_lasting_faces_between(motion, times);
    let tube = PlacedTube::new(&current.tube, &pose, 0.0)?.moving();
    let (mut most, mut fastest) = (0.0, 0);
    for (number, section) in tube.sections().iter().enumerate() {
        let stated = motion.speed(number, [0.0, 1.0], times);
        check_speed(number, stated.point)?;
        // Where no body has a flat end, nobody needs a turn: that of a link without a length is
        // infinite.
        let has_rim = section.radius > 0.0 && tube.faces(section).iter().any(Option::is_some);
        let turn = if has_rim { stated.turn } else { 0.0 };
        check_speed(number, turn)?;
        let speed = stated.point + section.radius * turn;
        if speed > most {
            (most, fastest) = (speed, number);
        }
    }
    Ok(PlacedShape { tube, cap_change, speed: most * (1.0 + 4.0 * Real::UNIT_ROUNDOFF), fastest })
}
