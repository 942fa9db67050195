//! The queries of a motion: whether a margin is kept all the way, or until when.
//!
//! An interval of time is judged by its middle shape. Points of a piece that move at V or slower are within tau V of
//! where they are at the middle, tau being half of the interval; so if a body around the piece, as it is then, keeps more
//! than margin + tau V away, the piece keeps the margin during the whole interval. Its points then are those of the same
//! shares of its section: what bodies hold of them, besides the discs and the balls of the moment, is derived in
//! `pieces::outer` and in `moment`. Pieces that fail are looked at again in what is left of the interval on either side: a
//! piece d away keeps the margin for (d - margin) / V before and after the middle. Where it is the width of the body that
//! fails, and not the motion, the piece is halved instead, in the same shape.
//!
//! **Courses.** A speed leads anywhere. If the pieces that failed are few and the motion knows their courses, each is asked about both sides of
//! the middle by where it goes (`side`), against all triangles that are near enough, each in a direction of its own (`own_directions`). What
//! keeps the margin on one side is not looked at there again; where all do, that side is settled.
//!
//! **A mesh that moves** has a place for each time too (`search::hierarchy::moving_mesh`), and V is the piece's speed and that of
//! the fastest vertex: no point of a triangle is faster than its vertices, and the two approach each other by no more.
//!
//! **Flat ends.** Those that may become round during the interval (`robot::tube::lasting`) are round here: a ball holds the
//! disc, now and later. The intervals become shorter until the end lasts, or the moment is found at which it becomes
//! round; there the shape itself jumps, and if that is what comes near, nobody can decide.

use super::failure::Failure;
use super::moment::{Moment, Seen, Wanted};
use super::moving::Moving;
use super::own_directions::OwnDirections;
use super::waiting::Waiting;
use crate::answer::{MotionAnswer, ProximityError, ShapeInContact};
use crate::distance::Scalar;
use crate::pieces::{Divided, Found, Piece, PlacedTube, TubeInMesh, refine};
use crate::robot::{Motion, Sections, Tube};
use crate::search::hierarchy::{MeshAt, MeshSearch, MovingMesh};
use parry3d_f64::math::{Pose, Real, Vector};
use std::collections::VecDeque;
use std::ops::Range;

/// Memory of a query, used again by the next.
#[derive(Clone)]
pub(crate) struct MotionMemory {
    tube: Tube,
    sections: Sections,
    /// Pieces that wait for their turn in the present shape, the next one last.
    pieces: Vec<Waiting>,
    /// Those that the first shape begins with.
    begun: Vec<Piece>,
    /// Those that failed, one interval's after another's.
    failed: Vec<Waiting>,
    /// More about those of the present interval.
    failures: Vec<Failure>,
    pub(super) intervals: VecDeque<Interval>,
    /// Where the vertices go, if the mesh moves.
    mesh: MovingMesh,
    directions: OwnDirections,
}

impl Default for MotionMemory {
    fn default() -> Self {
        Self {
            tube: Tube::empty(),
            sections: Sections::default(),
            pieces: Vec::new(),
            begun: Vec::new(),
            failed: Vec::new(),
            failures: Vec::new(),
            intervals: VecDeque::new(),
            mesh: MovingMesh::default(),
            directions: OwnDirections::default(),
        }
    }
}

/// An interval of time and what has to be looked at in it.
#[derive(Clone, Debug)]
pub(super) struct Interval {
    times: [Real; 2],
    /// Which of the failed pieces; none if it is the whole robot.
    pieces: Option<Range<usize>>,
    /// Whether it is before the middle shape in which they failed or after it.
    is_after: bool,
    /// How near these come in it at least.
    pub lower: Real,
}

impl Interval {
    pub(super) fn middle(&self) -> Real {
        0.5 * self.times[0] + 0.5 * self.times[1]
    }

    /// The same, in which the pieces are known to come no nearer than this.
    pub(super) fn comes_no_nearer(self, lower: Real) -> Self {
        Self { lower: self.lower.max(lower), ..self }
    }

    /// What is left of it before and after its middle shape, which decides for a while what becomes of the pieces.
    pub(super) fn halves(&self, still: Real, is_left: [bool; 2], pieces: &Range<usize>) -> [Option<Self>; 2] {
        let t = self.middle();
        let half = |times: [Real; 2], is_after: bool| {
            let is_left = is_left[usize::from(is_after)] && !pieces.is_empty() && times[0] < times[1];
            is_left.then(|| Self { times, pieces: Some(pieces.clone()), is_after, lower: self.lower })
        };
        [half([self.times[0], t - still], false), half([t + still, self.times[1]], true)]
    }
}

/// The pieces that have their turn in a shape.
pub(super) struct Turn<'a> {
    pub pieces: &'a mut Vec<Waiting>,
    begun: &'a mut Vec<Piece>,
    is_whole: bool,
}

impl Turn<'_> {
    /// Begins with the pieces of the whole robot, unless some have failed before. `scale` is what is to be decided.
    pub(super) fn begin(&mut self, tube: &TubeInMesh, scale: Real) {
        if self.is_whole {
            tube.begin(scale, self.begun);
            self.pieces.extend(self.begun.iter().map(|piece| Waiting::of(piece, &tube.tube)));
        }
    }
}

/// A motion on its way through a mesh.
pub(crate) struct MotionSearch<'a, M> {
    pub search: MeshSearch<'a>,
    pub memory: &'a mut MotionMemory,
    pub motion: &'a M,
    /// How many shapes were looked at.
    pub shapes: u64,
    /// The triangle that was found last.
    pub last: Option<u32>,
    /// Whether the mesh moves as well, as the memory says.
    pub does_mesh_move: bool,
}

/// How many shapes are looked at after one that is above the margin by no more than the resolution, or that leaves an
/// interval undecided. A contact that is deeper than that, or a proof, shows sooner as a rule; and what stays that near for
/// long would be divided into as many intervals as the resolution has room for, a million and more.
const PATIENCE: u64 = 256;

impl<M: Motion> MotionSearch<'_, M> {
    /// Whether the margin is kept at all times. Breadth first: contacts that last show early.
    pub(crate) fn clears(&mut self, wanted: Wanted) -> Result<MotionAnswer, ProximityError> {
        let mut undecided = None::<[Real; 2]>;
        // An interval with a shape near the margin, and how many shapes there may be in all then.
        let mut near = None::<([Real; 2], u64)>;
        self.begin();
        while let Some(interval) = self.memory.intervals.pop_front() {
            if let Some((near, most)) = near
                && self.shapes >= most
            {
                let left = self.memory.intervals.iter().chain([&interval]).map(|interval| interval.times);
                let first = left.chain(undecided).fold(near, |first, times| {
                    if times[0] < first[0] { [times[0], times[1].max(near[1])] } else { first }
                });
                return Ok(MotionAnswer::undecided(first));
            }
            let (seen, failed) = self.judge(&interval, wanted)?;
            if seen.is_near && near.is_none() {
                near = Some((interval.times, self.shapes + PATIENCE));
            }
            if let Some(found) = seen.contact {
                // Of the shapes before it nothing is proven yet but what was asked first.
                return Ok(MotionAnswer::contact(0.0, self.shape_in_contact(interval.middle(), &found)));
            }
            if seen.is_undecided {
                let is_first = undecided.is_none_or(|first| interval.times[0] < first[0]);
                undecided = if is_first { Some(interval.times) } else { undecided };
            }
            self.memory
                .intervals
                .extend(interval.halves(seen.still, seen.is_left, &failed).into_iter().flatten());
        }
        Ok(undecided.map_or_else(MotionAnswer::clear, MotionAnswer::undecided))
    }

    /// Until when the margin is kept. Earlier intervals first; what comes after a contact does not matter. Where an interval
    /// stays undecided, the answer cannot begin any later. What is left then is a shape that does not keep the margin: the
    /// larger intervals first, and with patience.
    pub(crate) fn first_contact(&mut self, wanted: Wanted) -> Result<MotionAnswer, ProximityError> {
        let (mut undecided, mut contact) = (None::<[Real; 2]>, None::<(Real, Found)>);
        let (mut clear_until, mut most) = (1.0, u64::MAX);
        self.begin();
        // The last one comes first.
        self.memory.intervals.make_contiguous().reverse();
        while self.shapes < most {
            let intervals = &mut self.memory.intervals;
            let next = if undecided.is_none() { intervals.pop_back() } else { intervals.pop_front() };
            let Some(interval) = next else { break };
            let (seen, failed) = self.judge(&interval, wanted)?;
            if seen.is_undecided && undecided.is_none() {
                undecided = Some(interval.times);
                most = self.shapes + PATIENCE;
            }
            if let Some(found) = seen.contact {
                let t = interval.middle();
                contact = Some((t, found));
                clear_until = if seen.is_fine { interval.times[0] } else { t };
                self.memory.intervals.clear();
                if !seen.is_fine {
                    let before = Interval {
                        times: [interval.times[0], t],
                        pieces: Some(failed),
                        is_after: false,
                        ..interval
                    };
                    self.memory.intervals.push_back(before);
                }
                continue;
            }
            self.memory
                .intervals
                .extend(interval.halves(seen.still, seen.is_left, &failed).into_iter().rev().flatten());
        }
        let Some((t, found)) = contact else {
            return Ok(undecided.map_or_else(MotionAnswer::clear, MotionAnswer::undecided));
        };
        let clear_until = undecided.map_or(clear_until, |interval| interval[0].min(clear_until));
        Ok(MotionAnswer::contact(clear_until, self.shape_in_contact(t, &found)))
    }

    /// A place that was found on the shape at `t`, which the tube is.
    fn shape_in_contact(&self, t: Real, found: &Found) -> ShapeInContact {
        ShapeInContact { t, upper: found.upper, section: found.section, witness: found.witness }
    }

    /// Moves the mesh during the motion, each vertex to its place here; these were checked.
    pub(crate) fn move_mesh(&mut self, to: &[Vector]) {
        let hierarchy = self.search.hierarchy;
        self.memory.mesh.set(&hierarchy.mesh, hierarchy.single(), to);
        self.does_mesh_move = true;
    }

    /// Begins with each part of the motion's time.
    pub(super) fn begin(&mut self) {
        let MotionMemory { sections, intervals, failed, .. } = &mut *self.memory;
        sections.clear();
        intervals.clear();
        failed.clear();
        let legs = self.motion.legs().max(1);
        let time = |leg: usize| leg as Real / legs as Real;
        intervals.extend((0..legs).map(|leg| Interval {
            times: [time(leg), time(leg + 1)],
            pieces: None,
            is_after: false,
            lower: Real::NEG_INFINITY,
        }));
    }

    /// Fills the tube with the shape at `t`.
    fn shape(&mut self, t: Real) -> Result<Pose, ProximityError> {
        let MotionMemory { tube, sections, .. } = &mut *self.memory;
        // Only what this shape states counts.
        tube.forget_error();
        let pose = self.motion.shape(t, tube)?;
        sections.check(t, tube)?;
        self.shapes += 1;
        Ok(pose)
    }

    /// Whether the margin is kept in an interval, as far as its middle shape shows; and which of the failed pieces are those that
    /// failed there.
    fn judge(&mut self, interval: &Interval, wanted: Wanted) -> Result<(Seen, Range<usize>), ProximityError> {
        self.examine(interval, |tube, turn, moving| {
            // Below that, rounding decides.
            tube.check_resolved(32.0 * tube.tube.slack(), wanted.resolution)?;
            turn.begin(tube, wanted.margin.max(wanted.resolution));
            let mut moment = Moment { moving, wanted, seen: Seen::default() };
            refine(tube, turn.pieces, &mut moment)?;
            let is_left = if moment.seen.contact.is_some() {
                [true; 2]
            } else {
                moment.moving.leave_by_courses(tube, wanted.margin)
            };
            Ok(Seen { still: moment.moving.still, is_left, ..moment.seen })
        })
    }

    /// Asks a question of the middle shape of an interval; and which of the failed pieces are those that failed there.
    pub(super) fn examine<T>(
        &mut self,
        interval: &Interval,
        ask: impl FnOnce(&mut TubeInMesh, &mut Turn, Moving<M>) -> Result<T, ProximityError>,
    ) -> Result<(T, Range<usize>), ProximityError> {
        let t = interval.middle();
        let pose = self.shape(t)?;
        // The middle is rounded, and so is a motion's own time in a path: by less than 4 u, however short the interval.
        let half = 0.5 * (interval.times[1] - interval.times[0]) * (1.0 + 4.0 * Real::UNIT_ROUNDOFF)
            + 4.0 * Real::UNIT_ROUNDOFF;
        let (motion, times) = (self.motion, interval.times);
        let opening = self.memory.tube.hold_faces(|section, end| {
            // A speed that is not finite or NaN holds nothing; it is refused below.
            half * motion.speed(section, [end as Real; 2], times).point
        });
        let MotionMemory { tube, pieces, begun, failed, failures, mesh, directions, .. } = &mut *self.memory;
        let MeshSearch { level, hierarchy, .. } = self.search;
        let mut search = MeshSearch::new(level, hierarchy, &mut *self.search.scratch);
        let (mut reach, mut mesh_speed) = (hierarchy.reach, 0.0);
        if self.does_mesh_move {
            (reach, mesh_speed) = (reach.max(mesh.reach()), mesh.speed());
            search.moved = Some(MeshAt { moving: mesh, share: t });
        }
        let tube = PlacedTube::new(tube, &pose, reach)?.moving();
        let mut tube = TubeInMesh { search, tube };
        pieces.clear();
        let failing = interval.pieces.clone().map_or(&[][..], |failing| &failed[failing]);
        let failing = failing.iter().filter(|piece| piece.is_left[usize::from(interval.is_after)]);
        // Of this interval nothing is known.
        pieces.extend(failing.map(|piece| Waiting { is_left: [true; 2], ..*piece }));
        let first = failed.len();
        failures.clear();
        let moving = Moving {
            motion,
            times,
            t,
            half,
            opening,
            mesh_speed,
            failed: &mut *failed,
            first,
            failures,
            last: &mut self.last,
            speed: 0.0,
            beside: 0.0,
            still: Real::INFINITY,
            directions,
        };
        let mut turn = Turn { pieces, begun, is_whole: interval.pieces.is_none() };
        let seen = ask(&mut tube, &mut turn, moving)?;
        // What a contact left unasked.
        failed.append(pieces);
        Ok((seen, first..failed.len()))
    }
}
