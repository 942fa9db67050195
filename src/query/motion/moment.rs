//! A piece of the robot during an interval of time, judged by the shape at its middle.
//!
//! **How fast.** A body with two round ends holds the balls around all points of its piece of the centreline, and so
//! whatever the discs become when they turn: V is the speed of the centreline. One with a flat end holds discs, whose
//! points move by the radius times the turn more. The ball at a round end of a section counts with its front half alone:
//! the other half is in the discs behind it, or beyond a face, where it is no part of the tube. That half turns like a
//! disc.

use crate::answer::ProximityError;
use crate::distance::Scalar;
use crate::pieces::{Found, Look, Near, Outer, Part, Piece, PlacedTube, Question, TubeInMesh, Verdict};
use crate::robot::{Motion, RobotError};
use parry3d_f64::math::Real;

/// Into how many intervals time may be divided: in each a point moves by the resolution. Each rounding of a time is 2^-53,
/// far less; and more shapes than this nobody waits for.
const MOST_INTERVALS: Real = (1_u64 << 24) as Real;

/// What is between two shares of a section.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Waiting {
    section: u32,
    shares: [Real; 2],
}

impl Waiting {
    /// What a piece of a shape is in any shape.
    pub(crate) fn of(piece: &Piece, tube: &PlacedTube) -> Self {
        Self { section: piece.section, shares: tube.shares(piece) }
    }
}

impl Part for Waiting {
    fn piece(&self, tube: &PlacedTube) -> Piece {
        tube.between(self.section, self.shares)
    }

    fn halves(self, tube: &PlacedTube, halves: [Piece; 2]) -> [Self; 2] {
        let [_, between] = tube.shares(&halves[0]);
        let [from, to] = self.shares;
        [Self { shares: [from, between.min(to)], ..self }, Self { shares: [between.max(from), to], ..self }]
    }
}

/// What the middle shape of an interval shows.
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
}

impl Default for Seen {
    fn default() -> Self {
        Self { contact: None, is_fine: false, is_undecided: false, is_near: false, still: Real::INFINITY }
    }
}

/// A motion during an interval, and what its middle shape shows.
pub(crate) struct Moment<'a, M> {
    pub motion: &'a M,
    pub times: [Real; 2],
    /// Half of its length, or a little more.
    pub half: Real,
    pub margin: Real,
    pub resolution: Real,
    /// By how much those flat ends that may become round move in that time.
    pub opening: Real,
    /// The triangle that was found last.
    pub last: &'a mut Option<u32>,
    /// Pieces that do not keep the margin during the interval, as far as the shape shows.
    pub failed: &'a mut Vec<Waiting>,
    /// How fast the piece moves that is looked at.
    pub speed: Real,
    pub seen: Seen,
}

impl<M: Motion> Question<Waiting> for Moment<'_, M> {
    const NEARER_FIRST: bool = false;

    fn is_answered(&self) -> bool {
        false
    }

    fn look(
        &mut self,
        tube: &PlacedTube,
        part: &Waiting,
        piece: &Piece,
        outer: &Outer,
    ) -> Result<Look, ProximityError> {
        self.speed = self.speed_of(part, outer, tube.radius(piece))?;
        let reach = self.reach();
        let is_wide = outer.over > 2.0 * reach.max(self.resolution)
            && outer.over > 0.5 * tube.radius(piece).max(self.margin);
        let aim = reach.max(0.5 * self.resolution);
        Ok(Look { bound: self.bound(tube), is_wide, aim, start: *self.last })
    }

    fn keeps_away(&mut self, _: &Piece, _: &Outer, _: Real) {}

    fn judge(&mut self, tube: &TubeInMesh, near: &Near<Waiting>) -> Result<Verdict, ProximityError> {
        *self.last = Some(near.nearest.triangle);
        let upper = near.found.upper;
        if upper <= self.margin {
            self.seen.contact = Some(*near.found);
            (self.seen.is_fine, self.seen.still) = (self.is_fine(), 0.0);
            self.failed.push(*near.part);
            return Ok(Verdict::Answered);
        }
        let is_time_to_blame =
            !self.is_fine() && (upper <= self.bound(&tube.tube) || near.outer.over <= 0.25 * self.reach());
        if is_time_to_blame {
            self.fail(tube, near)?;
            return Ok(Verdict::Settled);
        }
        let apart = upper - near.nearest.distance - tube.tube.stated(near.piece);
        if self.is_fine() && apart <= 0.5 * self.resolution {
            self.seen.is_undecided = true;
            return Ok(Verdict::Settled);
        }
        Ok(Verdict::Halve(0.25 * near.outer.over))
    }

    fn judge_whole(&mut self, tube: &TubeInMesh, near: &Near<Waiting>) -> Result<(), ProximityError> {
        let may_open = tube.tube.may_open(near.piece);
        if self.is_fine() && !may_open {
            let stated = tube.tube.stated(near.piece);
            tube.check_resolved(near.found.upper - near.nearest.distance - stated, self.resolution)?;
        }
        if self.is_fine() && (!may_open || self.reach().max(self.opening) <= self.resolution / 128.0) {
            self.seen.is_undecided = true;
            return Ok(());
        }
        self.fail(tube, near)
    }
}

impl<M: Motion> Moment<'_, M> {
    /// How far the piece that is looked at moves from the middle shape.
    fn reach(&self) -> Real {
        self.half * self.speed
    }

    /// What its body must be farther away than for it to keep the margin all the time.
    fn bound(&self, tube: &PlacedTube) -> Real {
        self.margin + self.reach() + tube.slack()
    }

    /// Whether it moves so little that the shape decides.
    fn is_fine(&self) -> bool {
        self.reach() <= 0.5 * self.resolution
    }

    /// Takes note of a piece that keeps the margin only for a while before and after the middle shape.
    fn fail(&mut self, tube: &TubeInMesh, near: &Near<Waiting>) -> Result<(), ProximityError> {
        let speed = self.speed;
        if speed > MOST_INTERVALS * self.resolution {
            let (section, resolution) = (near.part.section as usize, self.resolution);
            return Err(ProximityError::TooFast { section, speed, resolution });
        }
        let still = still(near.nearest.distance - self.margin - tube.tube.slack(), speed);
        self.seen.still = self.seen.still.min(still);
        self.seen.is_near |= near.found.upper <= self.margin + self.resolution;
        self.failed.push(*near.part);
        Ok(())
    }

    /// How fast what the body has to hold moves.
    fn speed_of(&self, waiting: &Waiting, outer: &Outer, radius: Real) -> Result<Real, RobotError> {
        let section = waiting.section as usize;
        let stated = self.motion.speed(section, waiting.shares, self.times);
        // A wire has no rim.
        let turn = if outer.is_flat() && radius > 0.0 { stated.turn } else { 0.0 };
        for value in [stated.point, turn] {
            if !(0.0..Real::INFINITY).contains(&value) {
                return Err(RobotError::BadSpeed { section, value });
            }
        }
        Ok((stated.point + radius * turn) * (1.0 + 4.0 * Real::UNIT_ROUNDOFF))
    }
}

/// For how long before and after the middle what moves at a speed does not come nearer by more than `room`.
fn still(room: Real, speed: Real) -> Real {
    // The quotient is rounded, and so are times, which are at most 1.
    let time = room.max(0.0) / speed * (1.0 - 8.0 * Real::UNIT_ROUNDOFF) - 8.0 * Real::UNIT_ROUNDOFF;
    time.max(0.0)
}
