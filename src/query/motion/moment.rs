//! Whether a piece of the robot keeps a margin during an interval of time, judged by the shape at its middle.

use super::moving::Moving;
use super::waiting::Waiting;
use crate::answer::ProximityError;
use crate::pieces::{Divided, Found, Look, Near, Outer, Piece, PlacedTube, Question, TubeInMesh, Verdict};
use crate::robot::Motion;
use parry3d_f64::math::Real;

/// Into how many intervals time may be divided: in each a point moves by the resolution. Each rounding of a time is 2^-53,
/// far less; and more shapes than this nobody waits for.
const MOST_INTERVALS: Real = (1_u64 << 24) as Real;

/// The margin that is to be kept, and how near to it an answer may stay open.
#[derive(Clone, Copy)]
pub(crate) struct Wanted {
    pub margin: Real,
    pub resolution: Real,
}

/// What the middle shape of an interval shows.
#[derive(Default)]
pub(crate) struct Seen {
    /// A place where it is at most the margin away.
    pub contact: Option<Found>,
    /// Whether that place moves by no more than half of the resolution.
    pub is_fine: bool,
    /// Whether a piece is too near to the margin for the resolution.
    pub is_undecided: bool,
    /// Whether the shape is above the margin by no more than the resolution.
    pub is_near: bool,
    /// For how long before and after the shape the pieces that failed keep the margin.
    pub still: Real,
    /// Whether any piece is left before the shape, and after it.
    pub is_left: [bool; 2],
}

/// A motion during an interval, and what its middle shape shows.
pub(crate) struct Moment<'a, M> {
    pub moving: Moving<'a, M>,
    pub wanted: Wanted,
    pub seen: Seen,
}

impl<'m, M: Motion> Question<TubeInMesh<'m>, Waiting> for Moment<'_, M> {
    const NEARER_FIRST: bool = false;

    fn is_answered(&self) -> bool {
        false
    }

    fn look(
        &mut self,
        tube: &TubeInMesh<'m>,
        part: &Waiting,
        piece: &Piece,
        outer: &Outer,
    ) -> Result<Look, ProximityError> {
        self.moving.turn_to(part, piece, outer, &tube.tube)?;
        let (reach, Wanted { margin, resolution }) = (self.moving.reach(), self.wanted);
        let is_wide = outer.over > 2.0 * reach.max(resolution)
            && outer.over > 0.5 * tube.tube.radius(piece).max(margin);
        let aim = reach.max(0.5 * resolution);
        Ok(Look { bound: self.bound(&tube.tube), is_wide, aim, start: *self.moving.last })
    }

    fn keeps_away(&mut self, _: &Piece, _: &Outer, _: Real) {}

    fn judge(
        &mut self,
        tube: &TubeInMesh<'m>,
        near: &Near<TubeInMesh<'m>, Waiting>,
    ) -> Result<Verdict, ProximityError> {
        *self.moving.last = Some(near.nearest.triangle);
        let upper = near.found.upper;
        if upper <= self.wanted.margin {
            self.seen.contact = Some(*near.found);
            self.seen.is_fine = self.is_fine();
            self.moving.fail(near, 0.0);
            return Ok(Verdict::Answered);
        }
        let is_time_to_blame = !self.is_fine()
            && (upper <= self.bound(&tube.tube) || near.outer.over <= 0.25 * self.moving.reach());
        if is_time_to_blame {
            self.fail(tube, near)?;
            return Ok(Verdict::Settled);
        }
        let apart = upper - near.nearest.distance - tube.tube.stated(near.piece);
        if self.is_fine() && apart <= 0.5 * self.wanted.resolution {
            self.seen.is_undecided = true;
            return Ok(Verdict::Settled);
        }
        Ok(Verdict::Halve(0.25 * near.outer.over))
    }

    fn judge_whole(
        &mut self,
        tube: &TubeInMesh<'m>,
        near: &Near<TubeInMesh<'m>, Waiting>,
    ) -> Result<(), ProximityError> {
        let (may_open, resolution) = (tube.tube.may_open(near.piece), self.wanted.resolution);
        if self.is_fine() && !may_open {
            let stated = tube.tube.stated(near.piece);
            tube.check_resolved(near.found.upper - near.nearest.distance - stated, resolution)?;
        }
        let moved = self.moving.reach().max(self.moving.opening);
        if self.is_fine() && (!may_open || moved <= resolution / 128.0) {
            self.seen.is_undecided = true;
            return Ok(());
        }
        self.fail(tube, near)
    }
}

impl<M: Motion> Moment<'_, M> {
    /// What the body of a piece must be farther away than for it to keep the margin all the time.
    fn bound(&self, tube: &PlacedTube) -> Real {
        self.wanted.margin + self.moving.reach() + tube.slack()
    }

    /// Whether it moves so little that the shape decides.
    fn is_fine(&self) -> bool {
        self.moving.reach() <= 0.5 * self.wanted.resolution
    }

    /// Takes note of a piece that keeps the margin only for a while before and after the middle shape.
    fn fail(&mut self, tube: &TubeInMesh, near: &Near<TubeInMesh, Waiting>) -> Result<(), ProximityError> {
        let (speed, Wanted { margin, resolution }) = (self.moving.speed, self.wanted);
        if speed > MOST_INTERVALS * resolution {
            return Err(ProximityError::TooFast { section: near.part.section as usize, speed, resolution });
        }
        self.seen.is_near |= near.found.upper <= margin + resolution + tube.tube.stated(near.piece);
        self.moving.fail(near, near.nearest.distance - margin - tube.tube.slack());
        Ok(())
    }
}
