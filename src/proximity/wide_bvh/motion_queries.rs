//! The queries of a motion: whether a margin is kept all the way, or until when.
//!
//! An interval of time is judged by its middle shape. Points of a piece that move at V or slower are within tau V of
//! where they are at the middle, tau being half of the interval; so if a body around the piece, as it is then, keeps more
//! than margin + tau V away, the piece keeps the margin during the whole interval. Its points then are those of the same
//! shares of its section: what bodies hold of them, besides the discs and the balls of the moment, is told in
//! `tube::outer` and below. Pieces that fail are looked at again in what is left of the interval on either side: a piece d
//! away keeps the margin for (d - margin) / V before and after the middle. Where it is the width of the body that fails,
//! and not the motion, the piece is halved instead, in the same shape.
//!
//! **How fast.** A body with two round ends holds the balls around all points of its piece of the centreline, and so
//! whatever the discs become when they turn: V is the speed of the centreline. One with a flat end holds discs, whose
//! points move by the radius times the turn more. The ball at a round end of a section counts with its front half alone:
//! the other half is in the discs behind it, or beyond a face, where it is no part of the tube. That half turns like a
//! disc.
//!
//! **Flat ends.** Those that may become round during the interval (`robot::tube::lasting`) are round here: a ball holds the
//! disc, now and later. The intervals become shorter until the end lasts, or the moment is found at which it becomes
//! round; there the shape itself jumps, and if that is what comes near, nobody can decide.

use super::hierarchy::MeshSearch;
use super::tube_queries::{Found, TubeSearch};
use crate::distance::Scalar;
use crate::proximity::placed::Best;
use crate::proximity::tube::{Outer, Piece, PlacedTube};
use crate::proximity::{FirstContact, MotionAnswer, ProximityError};
use crate::robot::{Motion, RobotError, Sampled, Sections, Tube};
use parry3d_f64::math::{Pose, Real};
use std::collections::VecDeque;
use std::ops::Range;

/// Memory of a query, used again by the next.
#[derive(Clone)]
pub(super) struct MotionMemory {
    tube: Tube,
    sections: Sections,
    /// The last shape and this one.
    sampled: [Sampled; 2],
    /// Pieces that wait for their turn in the present shape, the next one last.
    pieces: Vec<Waiting>,
    /// What `TubeSearch` keeps pieces in.
    begun: Vec<Piece>,
    /// Those that failed, one interval's after another's.
    failed: Vec<Waiting>,
    intervals: VecDeque<Interval>,
}

impl Default for MotionMemory {
    fn default() -> Self {
        Self {
            tube: Tube::empty(),
            sections: Sections::default(),
            sampled: Default::default(),
            pieces: Vec::new(),
            begun: Vec::new(),
            failed: Vec::new(),
            intervals: VecDeque::new(),
        }
    }
}

/// What is between two shares of a section.
#[derive(Clone, Copy, Debug)]
struct Waiting {
    section: u32,
    shares: [Real; 2],
}

/// An interval of time and what has to be proven in it.
#[derive(Clone, Debug)]
struct Interval {
    times: [Real; 2],
    /// Which of the failed pieces.
    pieces: Range<usize>,
}

impl Interval {
    fn middle(&self) -> Real {
        0.5 * self.times[0] + 0.5 * self.times[1]
    }
}

/// A motion on its way through a mesh.
pub(super) struct MotionSearch<'a, M> {
    pub search: MeshSearch<'a>,
    pub memory: &'a mut MotionMemory,
    pub motion: &'a M,
    pub margin: Real,
    pub resolution: Real,
    /// How many shapes were looked at.
    pub shapes: u64,
    /// The triangle that was found last.
    pub last: Option<u32>,
}

/// What the middle shape of an interval tells.
struct Seen {
    /// A place where it is at most the margin away.
    contact: Option<Found>,
    /// Whether that place moves by no more than the resolution.
    is_fine: bool,
    /// Whether a piece is too near to the margin for the resolution.
    is_undecided: bool,
    /// Which pieces failed, and for how long before and after the shape they do not.
    failed: Range<usize>,
    still: Real,
}

impl<M: Motion> MotionSearch<'_, M> {
    /// Whether the margin is kept at all times. Breadth first: contacts that last show early.
    pub(super) fn clears(&mut self) -> Result<MotionAnswer, ProximityError> {
        let mut undecided = None::<[Real; 2]>;
        self.begin();
        while let Some(interval) = self.memory.intervals.pop_front() {
            let seen = self.examine(&interval)?;
            if let Some(found) = seen.contact {
                let t = interval.middle();
                let Found { place, witness, on_mesh } = found;
                return Ok(MotionAnswer::Contact {
                    t,
                    upper: witness.upper,
                    arc_length: witness.arc,
                    section: place.section(),
                    triangle: place.triangle,
                    on_robot: witness.on_robot,
                    on_mesh,
                });
            }
            if seen.is_undecided {
                let is_first = undecided.is_none_or(|first| interval.times[0] < first[0]);
                undecided = if is_first { Some(interval.times) } else { undecided };
            }
            self.memory.intervals.extend(halves(&interval, &seen).into_iter().flatten());
        }
        Ok(undecided.map_or(MotionAnswer::Clear, |interval| MotionAnswer::Undecided { interval }))
    }

    /// Until when the margin is kept. Earlier intervals first; what comes after a contact does not matter.
    pub(super) fn first_contact(&mut self) -> Result<FirstContact, ProximityError> {
        let (mut undecided, mut contact) = (None::<[Real; 2]>, None::<(Real, Found)>);
        let mut clear_until = 1.0;
        self.begin();
        while let Some(interval) = self.memory.intervals.pop_back() {
            let seen = self.examine(&interval)?;
            if seen.is_undecided {
                undecided = undecided.or(Some(interval.times));
            }
            if let Some(found) = seen.contact {
                let t = interval.middle();
                contact = Some((t, found));
                clear_until = if seen.is_fine { interval.times[0] } else { t };
                self.memory.intervals.clear();
                if !seen.is_fine {
                    let before = Interval { times: [interval.times[0], t], pieces: seen.failed };
                    self.memory.intervals.push_back(before);
                }
                continue;
            }
            self.memory.intervals.extend(halves(&interval, &seen).into_iter().rev().flatten());
        }
        let Some((t, Found { place, witness, on_mesh })) = contact else {
            return Ok(undecided.map_or(FirstContact::Never, |interval| FirstContact::Undecided { interval }));
        };
        Ok(FirstContact::Within {
            clear_until: undecided.map_or(clear_until, |interval| interval[0].min(clear_until)),
            t,
            upper: witness.upper,
            arc_length: witness.arc,
            section: place.section(),
            triangle: place.triangle,
            on_robot: witness.on_robot,
            on_mesh,
        })
    }

    fn begin(&mut self) {
        let MotionMemory { sections, intervals, failed, .. } = &mut *self.memory;
        sections.clear();
        intervals.clear();
        failed.clear();
        // The first shape tells its pieces.
        intervals.push_back(Interval { times: [0.0, 1.0], pieces: 0..0 });
    }

    /// Fills the tube with the shape at `t`.
    fn shape(&mut self, t: Real) -> Result<Pose, ProximityError> {
        let MotionMemory { tube, sections, sampled, .. } = &mut *self.memory;
        let pose = self.motion.shape(t, tube)?;
        sections.check(t, tube)?;
        // In debug builds the shapes that come along also try the stated speeds.
        if cfg!(debug_assertions) {
            sampled.swap(0, 1);
            sampled[1].take(t, tube, &pose, 2);
            if self.shapes > 0 {
                let [before, here] = &*sampled;
                here.check_from(before, self.motion)?;
            }
        }
        self.shapes += 1;
        Ok(pose)
    }

    /// Judges an interval by its middle shape.
    fn examine(&mut self, interval: &Interval) -> Result<Seen, ProximityError> {
        let t = interval.middle();
        let is_first = self.shapes == 0;
        let pose = self.shape(t)?;
        let half = 0.5 * (interval.times[1] - interval.times[0]) * (1.0 + 4.0 * Real::UNIT_ROUNDOFF);
        let (motion, times) = (self.motion, interval.times);
        let opening = self.memory.tube.hold_faces(|section, end| {
            // A speed that is not finite or NaN holds nothing; it is refused below.
            half * motion.speed(section, [end as Real; 2], times).point
        });
        let MotionMemory { tube, pieces, begun, failed, .. } = &mut *self.memory;
        let tube = PlacedTube::new(tube, &pose, self.search.hierarchy.reach)?.moving();
        let MeshSearch { level, hierarchy, .. } = self.search;
        let search = MeshSearch { level, hierarchy, scratch: &mut *self.search.scratch };
        let mut search = TubeSearch { search, tube, pieces: begun };
        // Below that, rounding decides.
        search.check_resolved(32.0 * tube.slack(), self.resolution)?;
        pieces.clear();
        if is_first {
            search.begin(self.margin.max(self.resolution));
            pieces.extend(
                search
                    .pieces
                    .iter()
                    .map(|piece| Waiting { section: piece.section, shares: tube.shares(piece) }),
            );
        } else {
            pieces.extend_from_slice(&failed[interval.pieces.clone()]);
        }

        let first = failed.len();
        let mut seen = Seen {
            contact: None,
            is_fine: false,
            is_undecided: false,
            failed: first..first,
            still: Real::INFINITY,
        };
        let moment = Moment { motion, times, half };
        let half_resolution = 0.5 * self.resolution;
        while let Some(waiting) = pieces.pop() {
            let piece = tube.between(waiting.section, waiting.shares);
            let outer = search.outer(&piece)?;
            let speed = moment.speed(&waiting, &outer, tube.radius(&piece))?;
            let reach = moment.half * speed;
            let bound = self.margin + reach + tube.slack();
            let is_wide = outer.over > 2.0 * reach.max(self.resolution)
                && outer.over > 0.5 * tube.radius(&piece).max(self.margin);
            if is_wide && let Some(halves) = search.halves(&piece, &outer, reach.max(half_resolution)) {
                if search.search.may_meet(&outer.body, bound) {
                    pieces.extend(waiting.halves(&tube, halves));
                }
                continue;
            }
            let Some(nearest) =
                search.search.nearest(&outer.body, Best::within(bound), [self.last, None]).nearest()
            else {
                continue;
            };
            self.last = Some(nearest.triangle);
            let found = search.witness(&piece, &outer, &nearest);
            let upper = found.witness.upper;
            let is_fine = reach <= half_resolution;
            if upper <= self.margin {
                seen.contact = Some(found);
                seen.is_fine = is_fine;
                seen.still = 0.0;
                failed.push(waiting);
                failed.append(pieces);
                break;
            }
            let is_time_to_blame = !is_fine && (upper <= bound || outer.over <= 0.25 * reach);
            if !is_time_to_blame {
                let gap = upper - nearest.distance;
                if is_fine && gap <= half_resolution {
                    seen.is_undecided = true;
                    continue;
                }
                if let Some(halves) = search.halves(&piece, &outer, 0.25 * outer.over) {
                    pieces.extend(waiting.halves(&tube, halves));
                    continue;
                }
                let may_open = tube.may_open(&piece);
                if is_fine && !may_open {
                    search.check_resolved(gap, self.resolution)?;
                }
                if is_fine && (!may_open || reach.max(opening) <= half_resolution / 64.0) {
                    seen.is_undecided = true;
                    continue;
                }
            }
            if speed > MOST_INTERVALS * self.resolution {
                let (section, resolution) = (waiting.section as usize, self.resolution);
                return Err(ProximityError::TooFast { section, speed, resolution });
            }
            seen.still = seen.still.min(moment.still(nearest.distance - self.margin - tube.slack(), speed));
            failed.push(waiting);
        }
        seen.failed = first..failed.len();
        Ok(seen)
    }
}

/// Into how many intervals time may be divided: in each a point moves by the resolution. Each rounding of a time is 2^-53,
/// far less; and more shapes than this nobody waits for.
const MOST_INTERVALS: Real = (1_u64 << 24) as Real;

impl Waiting {
    /// Its halves, as the piece that holds it is halved.
    fn halves(self, tube: &PlacedTube, halves: [Piece; 2]) -> [Self; 2] {
        let [_, between] = tube.shares(&halves[0]);
        let [from, to] = self.shares;
        [Self { shares: [from, between.min(to)], ..self }, Self { shares: [between.max(from), to], ..self }]
    }
}

/// A motion during an interval.
struct Moment<'a, M> {
    motion: &'a M,
    times: [Real; 2],
    /// Half of its length, or a little more.
    half: Real,
}

impl<M: Motion> Moment<'_, M> {
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

    /// For how long before and after the middle what moves at a speed does not come nearer by more than `room`.
    fn still(&self, room: Real, speed: Real) -> Real {
        // The quotient is rounded, and so are times, which are at most 1.
        let time = room.max(0.0) / speed * (1.0 - 8.0 * Real::UNIT_ROUNDOFF) - 8.0 * Real::UNIT_ROUNDOFF;
        time.max(0.0)
    }
}

/// What is left of an interval before and after its middle shape.
fn halves(interval: &Interval, seen: &Seen) -> [Option<Interval>; 2] {
    let (t, pieces) = (interval.middle(), &seen.failed);
    let half = |times: [Real; 2]| {
        (!pieces.is_empty() && times[0] < times[1]).then(|| Interval { times, pieces: pieces.clone() })
    };
    [half([interval.times[0], t - seen.still]), half([t + seen.still, interval.times[1]])]
}
