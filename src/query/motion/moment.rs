//! A piece of the robot during an interval of time, judged by the shape at its middle.
//!
//! **How fast.** A body with two round ends holds the balls around all points of its piece of the centreline, and so
//! whatever the discs become when they turn: V is the speed of the centreline. One with a flat end holds discs, whose
//! points move by the radius times the turn more. The ball at a round end of a section counts with its front half alone:
//! the other half is in the discs behind it, or beyond a face, where it is no part of the tube. That half turns like a
//! disc.

use crate::answer::ProximityError;
use crate::distance::Scalar;
use crate::pair::Best;
use crate::pieces::{Outer, Piece, PlacedTube};
use crate::query::clearance::{Found, TubeSearch};
use crate::robot::{Motion, RobotError};
use parry3d_f64::math::Real;

/// Into how many intervals time may be divided: in each a point moves by the resolution. Each rounding of a time is 2^-53,
/// far less; and more shapes than this nobody waits for.
const MOST_INTERVALS: Real = (1_u64 << 24) as Real;

/// What is between two shares of a section.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Waiting {
    pub section: u32,
    pub shares: [Real; 2],
}

impl Waiting {
    /// Its halves, as the piece that holds it is halved.
    pub(crate) fn halves(self, tube: &PlacedTube, halves: [Piece; 2]) -> [Self; 2] {
        let [_, between] = tube.shares(&halves[0]);
        let [from, to] = self.shares;
        [Self { shares: [from, between.min(to)], ..self }, Self { shares: [between.max(from), to], ..self }]
    }
}

/// What is known of a piece in an interval.
pub(crate) enum Verdict {
    /// It keeps the margin all the time.
    Keeps,
    /// Nothing: its halves have to be judged.
    Part([Piece; 2]),
    /// It is at most the margin away in the middle shape, at a place that, if it is fine, moves by no more than half of
    /// the resolution.
    Contact { found: Found, is_fine: bool },
    /// It is too near to the margin for the resolution.
    Undecided,
    /// It keeps the margin only for so long before and after the middle shape, as far as that tells. `is_near`: there it
    /// is above the margin by no more than the resolution.
    Fails { still: Real, is_near: bool },
}

/// A motion during an interval.
pub(crate) struct Moment<'a, M> {
    pub motion: &'a M,
    pub times: [Real; 2],
    /// Half of its length, or a little more.
    pub half: Real,
    pub margin: Real,
    pub resolution: Real,
    /// By how much those flat ends that may become round move in that time.
    pub opening: Real,
}

impl<M: Motion> Moment<'_, M> {
    /// Judges a piece by the middle shape. `last` is the triangle that was found last.
    pub(crate) fn judge(
        &self,
        search: &mut TubeSearch,
        waiting: &Waiting,
        last: &mut Option<u32>,
    ) -> Result<Verdict, ProximityError> {
        let tube = search.tube;
        let half_resolution = 0.5 * self.resolution;
        let piece = tube.between(waiting.section, waiting.shares);
        let outer = search.outer(&piece)?;
        let speed = self.speed(waiting, &outer, tube.radius(&piece))?;
        let reach = self.half * speed;
        let bound = self.margin + reach + tube.slack();
        let is_wide = outer.over > 2.0 * reach.max(self.resolution)
            && outer.over > 0.5 * tube.radius(&piece).max(self.margin);
        if is_wide && let Some(halves) = search.halves(&piece, &outer, reach.max(half_resolution)) {
            let may_meet = search.search.may_meet(&outer.body, bound);
            return Ok(if may_meet { Verdict::Part(halves) } else { Verdict::Keeps });
        }
        let start = [*last, None];
        let Some(nearest) = search.search.nearest(&outer.body, Best::within(bound), start).nearest() else {
            return Ok(Verdict::Keeps);
        };
        *last = Some(nearest.triangle);
        let found = search.witness(&piece, &outer, &nearest);
        let upper = found.upper;
        let is_fine = reach <= half_resolution;
        if upper <= self.margin {
            return Ok(Verdict::Contact { found, is_fine });
        }
        let is_time_to_blame = !is_fine && (upper <= bound || outer.over <= 0.25 * reach);
        if !is_time_to_blame {
            let gap = upper - nearest.distance;
            if is_fine && gap <= half_resolution {
                return Ok(Verdict::Undecided);
            }
            if let Some(halves) = search.halves(&piece, &outer, 0.25 * outer.over) {
                return Ok(Verdict::Part(halves));
            }
            let may_open = tube.may_open(&piece);
            if is_fine && !may_open {
                search.check_resolved(gap, ("resolution", self.resolution))?;
            }
            if is_fine && (!may_open || reach.max(self.opening) <= half_resolution / 64.0) {
                return Ok(Verdict::Undecided);
            }
        }
        if speed > MOST_INTERVALS * self.resolution {
            let (section, resolution) = (waiting.section as usize, self.resolution);
            return Err(ProximityError::TooFast { section, speed, resolution });
        }
        let still = still(nearest.distance - self.margin - tube.slack(), speed);
        Ok(Verdict::Fails { still, is_near: upper <= self.margin + self.resolution })
    }

    /// How fast what the body has to hold moves.
    fn speed(&self, waiting: &Waiting, outer: &Outer, radius: Real) -> Result<Real, RobotError> {
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
