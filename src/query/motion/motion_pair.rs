//! Whether two robots that move at the same time keep a margin between them.
//!
//! # Algorithm
//! 1. Test an interval by the two shapes at its middle, as for one motion (`motion_search`). Let
//!    tau be half of the interval and V1, V2 the speeds of two pieces. Then the pieces come nearer
//!    by at most tau (V1 + V2).
//! 2. Pairs for which that is too much are tested again in the remaining parts of the interval.
//! 3. Each shape starts with all pairs that may reach the margin in its interval, not with a list
//!    of unresolved pairs. Such pairs are few, and their bodies show at once which pieces are near
//!    each other.

use super::approach_bound::{ApproachBound, check_subdivision, half_length, midpoint};
use super::current_shape::CurrentShape;
use super::interval_test::{IntervalResult, IntervalTest, MarginQuery};
use super::intervals;
use super::moving_pair::MovingPair;
use super::relative_motion::RelativeMotion;
use crate::answer::{ProximityError, RobotMotionAnswer};
use crate::distance::Scalar;
use crate::motion::{Motion, check_speed};
use crate::refine::{
    PairQueue, PairUpperBound, PiecePair, PlacedTube, Refinable, TubePair, refine,
};
use parry3d_f64::math::Real;
use std::collections::VecDeque;

/// The most pairs of pieces tested in all shapes together.
const MAX_PAIRS: u32 = 1 << 24;

/// State and memory that the next query reuses.
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
    /// The names of the motions in error messages.
    pub names: [&'static str; 2],
}

impl<A: Motion, B: Motion> MotionPair<'_, A, B> {
    /// Decides whether the margin is kept at all times.
    pub(crate) fn clear(
        &mut self,
        wanted: MarginQuery,
    ) -> Result<RobotMotionAnswer, ProximityError> {
        let mut intervals = std::mem::take(&mut self.memory.intervals);
        for current in &mut self.memory.current {
            current.forget();
        }
        intervals::begin(
            &mut intervals,
            [self.motions.0.time_parts(), self.motions.1.time_parts()],
        );
        let mut left = MAX_PAIRS;
        let answer =
            intervals::clear(&mut intervals, |times| self.test_interval(times, wanted, &mut left));
        self.memory.intervals = intervals;
        answer
    }

    /// Tests the middle shapes of an interval. Returns the result, and how long before and after
    /// the midpoint all pairs are decided; infinity if none is unresolved.
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
        // A finer resolution is below rounding.
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

/// A robot in its middle shape.
struct PlacedShape<'a> {
    tube: PlacedTube<'a>,
    cap_change: Real,
    /// An upper bound on the speed of its points, and the section where it occurs.
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
        // A body without a flat end needs no turn. The turn of a link of length 0 is infinite. A
        // turn that is no speed at all is an error in every body.
        let has_rim = section.radius > 0.0 && tube.faces(section).iter().any(Option::is_some);
        let is_needed = has_rim || stated.turn.is_nan() || stated.turn < 0.0;
        let turn = if is_needed { stated.turn } else { 0.0 };
        check_speed(number, turn)?;
        let speed = stated.point + section.radius * turn;
        if speed > most {
            (most, fastest) = (speed, number);
        }
    }
    Ok(PlacedShape { tube, cap_change, speed: most * (1.0 + 4.0 * Real::UNIT_ROUNDOFF), fastest })
}
