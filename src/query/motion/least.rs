//! How near a motion comes, between bounds.
//!
//! Every shape that is looked at bounds the least clearance from above. A piece whose body is d away in the middle shape of an
//! interval, and moves at V or slower, is at least d - tau V away in all of it, tau being half of the interval: where that is
//! not below the least upper bound so far by more than the tolerance, nothing that matters is there. What is left is halved, in
//! time or along the curve, as for a margin (`motion_search`); the margin is what would still matter, and falls as nearer
//! shapes are found. The interval that may come nearest is looked at first. So a path of many motions costs little more
//! than its nearest parts, and those that stay farther away one shape each, or a few.
//!
//! **When it ends.** A piece that moves by no more than half of the tolerance in its interval is settled as soon as its body fits it
//! as closely. Where samples or stated errors leave more open than that, no interval is worth dividing in which the piece
//! moves less than they leave open.

use super::motion_search::{Interval, MotionSearch};
use super::moves::Moves;
use super::moving::{Left, Moving};
use super::pace::Pace;
use super::progress::MOST_SHAPES;
use super::waiting::Waiting;
use crate::answer::{MotionClearance, ProximityError};
use crate::pieces::{Found, Look, Near, Outer, Piece, PlacedTube, Question, TubeInMesh, Verdict, refine};
use crate::robot::Motion;
use parry3d_f64::math::Real;

/// After so many pieces none is halved any more in a shape.
const MOST_PIECES: u32 = 1 << 16;

impl<M: Motion> MotionSearch<'_, M> {
    /// How near the motion comes, with bounds no farther apart than the tolerance where that can be.
    pub(crate) fn least(&mut self, tolerance: Real) -> Result<MotionClearance, ProximityError> {
        let nothing = Doubtful { lower: Real::INFINITY, doubt: 0.0 };
        let mut known =
            Known { tolerance, uncertainty: 0.0, best: None, lower: Real::INFINITY, doubtful: nothing };
        self.begin();
        while let Some(interval) = self.take_nearest() {
            if known.is_settled(interval.lower) || self.shapes >= MOST_SHAPES {
                // The others come no nearer.
                known.lower = known.lower.min(interval.lower);
                break;
            }
            let t = interval.middle();
            let ((nearest, still, is_left), pieces) =
                self.examine(&interval, |tube, turn, moving, pace| {
                    known.look(tube, t);
                    turn.begin(tube, known.upper().max(tolerance));
                    let mut approach = Approach::new(moving, pace, &mut known, t, tube);
                    refine(tube, turn.pieces, &mut approach)?;
                    if approach.is_answered() {
                        approach.settle(0.0);
                    }
                    let is_left =
                        if approach.is_answered() { [true; 2] } else { approach.leave_by_courses(tube) };
                    Ok((approach.nearest, approach.pace.still, is_left))
                })?;
            let interval = interval.comes_no_nearer(nearest);
            self.memory.intervals.extend(interval.halves(still, is_left, &pieces).into_iter().flatten());
        }
        known.answer()
    }

    /// Takes the interval that may come nearest.
    fn take_nearest(&mut self) -> Option<Interval> {
        let intervals = &mut self.memory.intervals;
        let all = intervals.iter().enumerate();
        let (place, _) = all.min_by(|a, b| a.1.lower.total_cmp(&b.1.lower))?;
        intervals.swap_remove_back(place)
    }
}

/// What is known of the least clearance.
struct Known {
    tolerance: Real,
    /// What stated errors cost in the shapes so far.
    uncertainty: Real,
    /// What bounds it from above, and when.
    best: Option<(Found, Real)>,
    /// Whatever is settled comes no nearer.
    lower: Real,
    /// The part of that where it is not known which way a face stands.
    doubtful: Doubtful,
}

/// What is settled although its bounds are farther apart, because more is not known.
struct Doubtful {
    lower: Real,
    /// How much farther.
    doubt: Real,
}

impl Known {
    fn upper(&self) -> Real {
        self.best.map_or(Real::INFINITY, |(found, _)| found.upper)
    }

    /// Whether what comes no nearer than this does not matter.
    fn is_settled(&self, lower: Real) -> bool {
        let wanted = self.upper() - (self.tolerance + self.uncertainty);
        wanted <= 0.0 || lower >= wanted
    }

    /// Takes note of a place of the shape at `t`.
    fn take(&mut self, found: Found, t: Real) {
        if found.upper < self.upper() {
            self.best = Some((found, t));
        }
    }

    /// A first look at a shape: where the nearest one so far is nearest.
    fn look(&mut self, tube: &mut TubeInMesh, t: Real) {
        self.uncertainty = self.uncertainty.max(tube.tube.uncertainty());
        let found = match self.best {
            Some((Found { section, witness, .. }, _)) => {
                tube.bound_at(section, witness.arc_length, witness.triangle)
            }
            None => tube.first_bound(),
        };
        self.take(found, t);
    }

    fn answer(self) -> Result<MotionClearance, ProximityError> {
        // Every motion has a shape, and every shape a section.
        let Some((Found { upper, section, witness }, t)) = self.best else {
            return Err(ProximityError::EmptyTube);
        };
        let lower = self.lower.min(upper).max(0.0);
        // It matters if nothing else is as near.
        let matters = self.doubtful.lower < upper - (self.tolerance + self.uncertainty);
        let uncertainty = self.uncertainty + if matters { self.doubtful.doubt } else { 0.0 };
        let resolved = upper - lower <= self.tolerance + uncertainty;
        Ok(MotionClearance { lower, upper, resolved, uncertainty, t, section, witness })
    }
}

/// The pieces of the shape at the middle of an interval.
struct Approach<'a, 'b, M> {
    moving: Moving<'a, M>,
    pace: Pace,
    known: &'b mut Known,
    t: Real,
    /// How far apart the bounds of the answer may stay.
    aim: Real,
    /// How near the pieces that failed come at least.
    nearest: Real,
    /// How many pieces may still be halved.
    left: u32,
}

impl<'a, 'b, M: Motion> Approach<'a, 'b, M> {
    fn new(moving: Moving<'a, M>, pace: Pace, known: &'b mut Known, t: Real, tube: &TubeInMesh) -> Self {
        // So that the bounds of the answer are no farther apart than asked for after they are rounded.
        let aim = (known.tolerance + known.uncertainty - 4.0 * tube.tube.slack()).max(0.0);
        Self { moving, pace, known, t, aim, nearest: Real::INFINITY, left: MOST_PIECES }
    }

    /// What comes nearer than this still matters.
    fn wanted(&self) -> Real {
        self.known.upper() - self.aim
    }

    /// How near a piece comes at least whose body is so far away now.
    fn at_least(&self, distance: Real, tube: &PlacedTube) -> Real {
        distance - self.pace.reach() - tube.slack()
    }

    fn settle(&mut self, lower: Real) {
        self.known.lower = self.known.lower.min(lower);
    }

    /// Asks by courses which of the failed pieces come no nearer than `wanted`, and settles these
    /// at that. A piece failed beside a `wanted` of its own, which has fallen since if a nearer
    /// shape was found.
    fn leave_by_courses(&mut self, tube: &mut TubeInMesh) -> [bool; 2] {
        let wanted = self.wanted();
        let Left { sides, is_any_settled } = self.moving.leave_by_courses(tube, wanted);
        if is_any_settled {
            self.settle(wanted);
        }
        sides
    }

    /// Takes note of a piece that has to be looked at at other times.
    fn fail(&mut self, near: &Near<TubeInMesh, Waiting>, tube: &PlacedTube) {
        let wanted = self.wanted();
        self.nearest = self.nearest.min(self.at_least(near.nearest.distance, tube));
        // As long as it is still, it comes no nearer than that.
        self.settle(wanted);
        self.pace.lasts(near.nearest.distance - wanted - tube.slack());
        self.moving.fail(near, &self.pace);
    }
}

impl<'m, M: Motion> Question<TubeInMesh<'m>, Waiting> for Approach<'_, '_, M> {
    const NEARER_FIRST: bool = true;

    /// Nothing below 0 is left to be found.
    fn is_answered(&self) -> bool {
        self.wanted() < 0.0
    }

    fn look(
        &mut self,
        tube: &TubeInMesh<'m>,
        part: &Waiting,
        piece: &Piece,
        outer: &Outer,
    ) -> Result<Look, ProximityError> {
        self.left = self.left.saturating_sub(1);
        self.pace.speed = self.moving.speed(part, piece, outer, tube)?;
        let (reach, upper) = (self.pace.reach(), self.known.upper());
        let is_wide = self.left > 0
            && outer.over > 2.0 * self.aim.max(reach)
            && (outer.is_flat() || outer.over > 0.25 * upper);
        let bound = self.wanted() + reach + tube.tube.slack();
        Ok(Look { bound, is_wide, aim: self.aim.max(reach), start: *self.moving.last })
    }

    fn keeps_away(&mut self, _: &Piece, _: &Outer, _: Real) {
        self.settle(self.wanted());
    }

    fn judge(
        &mut self,
        tube: &TubeInMesh<'m>,
        near: &Near<TubeInMesh<'m>, Waiting>,
    ) -> Result<Verdict, ProximityError> {
        *self.moving.last = Some(near.nearest.triangle);
        self.known.take(*near.found, self.t);
        if self.is_answered() {
            return Ok(Verdict::Answered);
        }
        let (lower, wanted) = (self.at_least(near.nearest.distance, &tube.tube), self.wanted());
        if lower >= wanted || self.left == 0 {
            self.settle(lower);
            return Ok(Verdict::Settled);
        }
        let (reach, doubt) = (self.pace.reach(), tube.tube.doubt(near.piece));
        if doubt > 0.0 && reach <= 0.25 * self.aim && lower >= wanted - doubt {
            let Doubtful { lower: least, doubt: most } = self.known.doubtful;
            self.known.doubtful = Doubtful { lower: least.min(lower), doubt: most.max(doubt) };
            self.settle(lower);
            return Ok(Verdict::Settled);
        }
        if reach > 0.25 * self.aim && (near.found.upper <= wanted + reach || near.outer.over <= 0.25 * reach)
        {
            self.fail(near, &tube.tube);
            return Ok(Verdict::Settled);
        }
        Ok(Verdict::Halve(self.aim.max(0.25 * near.outer.over)))
    }

    fn judge_whole(
        &mut self,
        tube: &TubeInMesh<'m>,
        near: &Near<TubeInMesh<'m>, Waiting>,
    ) -> Result<(), ProximityError> {
        let reach = self.pace.reach();
        let is_fine = if tube.tube.may_open(near.piece) {
            reach.max(self.pace.opening) <= self.aim / 128.0
        } else {
            reach <= (0.25 * self.aim).max(near.found.upper - near.nearest.distance)
        };
        if is_fine {
            self.settle(self.at_least(near.nearest.distance, &tube.tube));
        } else {
            self.fail(near, &tube.tube);
        }
        Ok(())
    }
}
