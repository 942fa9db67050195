//! Whether a piece of the robot keeps a margin during an interval of time, judged by the shape at its middle.

use super::moves::Moves;
use super::pace::{Pace, check_pace};
use crate::answer::ProximityError;
use crate::pieces::{Body, Bound, Divided, Look, Near, Question, Verdict};
use parry3d_f64::math::Real;

/// What may turn by no more than this beyond what a shape shows, in rad, is decided by the shape.
const LEAST_GROWTH: Real = 1.0 / 64.0;

/// The margin that is to be kept, and how near to it an answer may stay open.
#[derive(Clone, Copy)]
pub(crate) struct Wanted {
    pub margin: Real,
    pub resolution: Real,
}

/// What the middle shape of an interval shows.
pub(crate) struct Seen<F> {
    /// A place where it is at most the margin away.
    pub contact: Option<F>,
    /// Whether that place moves by no more than half of the resolution.
    pub is_fine: bool,
    /// Whether a piece is too near to the margin for the resolution.
    pub is_undecided: bool,
    /// Whether the shape is above the margin by no more than the resolution.
    pub is_near: bool,
    /// Whether it was not looked at to the end, nor is any other shape to be.
    pub gives_up: bool,
    /// Why samples do not allow a decision for a piece. A contact elsewhere counts more.
    pub too_fine: Option<ProximityError>,
}

impl<F> Seen<F> {
    /// Nothing, before anything is looked at.
    pub(super) fn nothing() -> Self {
        let (is_fine, is_undecided, is_near, gives_up) = (false, false, false, false);
        Self { contact: None, is_fine, is_undecided, is_near, gives_up, too_fine: None }
    }
}

/// What moves during an interval, and what its middle shape shows.
pub(crate) struct Moment<V, F> {
    pub moving: V,
    pub pace: Pace,
    pub wanted: Wanted,
    pub seen: Seen<F>,
}

impl<D: Divided, P, V: Moves<D, P>> Question<D, P> for Moment<V, D::Found> {
    const NEARER_FIRST: bool = false;

    fn is_answered(&self) -> bool {
        self.moving.gives_up()
    }

    fn look(
        &mut self,
        tube: &D,
        part: &P,
        piece: &D::Piece,
        outer: &D::Body,
    ) -> Result<Look, ProximityError> {
        self.pace.speed = self.moving.speed(part, piece, outer, tube)?;
        self.pace.growth = self.moving.growth(part, tube);
        let (reach, Wanted { margin, resolution }) = (self.pace.reach(), self.wanted);
        let is_wide =
            outer.over() > 2.0 * reach.max(resolution) && outer.over() > 0.5 * tube.radius(piece).max(margin);
        let aim = reach.max(0.5 * resolution);
        Ok(Look { bound: self.bound(tube.slack()), is_wide, aim, start: self.moving.start() })
    }

    fn keeps_away(&mut self, _: &D::Piece, _: &D::Body, _: Real) {}

    fn judge(&mut self, tube: &D, near: &Near<D, P>) -> Result<Verdict, ProximityError> {
        self.moving.note(near);
        let upper = near.found.upper();
        if upper <= self.wanted.margin {
            self.seen.contact = Some(*near.found);
            self.seen.is_fine = self.is_fine();
            self.pace.lasts(0.0);
            self.moving.fail(near, &self.pace);
            return Ok(Verdict::Answered);
        }
        let is_time_to_blame = !self.is_fine()
            && (upper <= self.bound(tube.slack()) || near.outer.over() <= 0.25 * self.pace.reach());
        if is_time_to_blame {
            self.fail(tube, near)?;
            return Ok(Verdict::Settled);
        }
        let apart = upper - D::distance(near.nearest) - tube.stated(near.piece);
        if self.is_fine() && apart <= 0.5 * self.wanted.resolution {
            self.seen.is_undecided = true;
            return Ok(Verdict::Settled);
        }
        Ok(Verdict::Halve(0.25 * near.outer.over()))
    }

    fn judge_whole(&mut self, tube: &D, near: &Near<D, P>) -> Result<(), ProximityError> {
        let (may_open, resolution) = (tube.may_open(near.piece), self.wanted.resolution);
        if self.is_fine() && !may_open && tube.is_surely_asked(near.piece, near.found) {
            let stated = tube.stated(near.piece);
            let possible = near.found.upper() - D::distance(near.nearest) - stated;
            if let Err(error) = tube.check_resolved(possible, resolution) {
                self.seen.too_fine.get_or_insert(error);
                (self.seen.is_undecided, self.seen.is_near) = (true, true);
                return Ok(());
            }
        }
        let moved = self.pace.reach().max(self.pace.opening);
        let is_open_end_decided = moved <= resolution / 128.0 || self.pace.opens_too_fast(resolution);
        if self.is_fine() && (!may_open || is_open_end_decided) {
            self.seen.is_undecided = true;
            return Ok(());
        }
        self.fail(tube, near)
    }
}

impl<V, F> Moment<V, F> {
    /// What the body of a piece must be farther away than for it to keep the margin all the time.
    fn bound(&self, slack: Real) -> Real {
        self.wanted.margin + self.pace.reach() + slack
    }

    /// Whether it moves so little that the shape decides.
    fn is_fine(&self) -> bool {
        self.pace.reach() <= 0.5 * self.wanted.resolution && self.pace.growth <= LEAST_GROWTH
    }

    /// Takes note of a piece that keeps the margin only for a while before and after the middle shape.
    fn fail<D: Divided, P>(&mut self, tube: &D, near: &Near<D, P>) -> Result<(), ProximityError>
    where
        V: Moves<D, P>,
    {
        let (speed, Wanted { margin, resolution }) = (self.pace.speed, self.wanted);
        check_pace(speed, resolution, || self.moving.fastest(near, speed))?;
        self.seen.is_near |= near.found.upper() <= margin + resolution + tube.stated(near.piece);
        self.pace.lasts(D::distance(near.nearest) - margin - tube.slack());
        self.moving.fail(near, &self.pace);
        Ok(())
    }
}
