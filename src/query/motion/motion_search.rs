//! The queries of a motion: whether a margin is kept all the way, or until when.
//!
//! An interval of time is judged by its middle shape. Points of a piece that move at V or slower
//! are within tau V of where they are at the middle, tau being half of the interval; so if a body
//! around the piece, as it is then, keeps more than margin + tau V away, the piece keeps the margin
//! during the whole interval. Its points then are those of the same shares of its section: what
//! bodies hold of them, besides the discs and the balls of the moment, is derived in
//! `pieces::bounding_body` and in `test`. Pieces that fail are looked at again in what is left of
//! the interval on either side: a piece d away keeps the margin for (d - margin) / V before and
//! after the middle. Where it is the width of the body that fails, and not the motion, the piece is
//! halved instead, in the same shape.
//!
//! **Courses.** A speed leads anywhere. If the pieces that failed are few and the motion knows
//! their courses, each is asked about both sides of the middle by where it goes
//! (`half_displacement`), against all triangles that are near enough, each in a direction of its
//! own (`separating_planes`). What keeps the margin on one side is not looked at there again; where
//! all do, that side is settled.
//!
//! What has little room seldom goes so much along the wall, so it is asked seldom, unless it was
//! not in vain.
//!
//! **A limit.** A question ends after `MAX_SHAPES` shapes: `progress`.
//!
//! **A mesh that moves** has a place for each time too (`search::hierarchy::moving_mesh`), and V is
//! the piece's speed and that of the fastest vertex: no point of a triangle is faster than its
//! vertices, and the two approach each other by no more.
//!
//! **Flat ends.** Those that may become round during the interval (`robot::tube::cap_persistence`)
//! are round here: a ball holds the disc, now and later. So are those of a link that may lose its
//! direction. The intervals become shorter until the end lasts, or the moment is found at which it
//! becomes round; there the shape itself jumps, and if that is what comes near, nobody can decide.

use super::approach_bound::{ApproachBound, midpoint, remaining_parts};
use super::current_shape::CurrentShape;
use super::interval_test::{IntervalResult, IntervalTest, MarginQuery};
use super::moving_tube::{MovingTube, SmallRooms};
use super::pending_piece::PendingPiece;
use super::progress::{MAX_SHAPES, PATIENCE, Progress};
use super::separating_planes::SeparatingPlanes;
use super::unresolved_piece::UnresolvedPiece;
use crate::answer::{MotionAnswer, ProximityError, ShapeInContact, UndecidedReason};
use crate::pieces::{MeshUpperBound, Piece, PlacedTube, Refinable, TubeInMesh, refine};
use crate::robot::Motion;
use crate::search::hierarchy::{MeshAt, MeshSearch, MovingMesh};
use parry3d_f64::math::{Real, Vector};
use std::collections::VecDeque;
use std::ops::Range;

/// Memory of a query, used again by the next.
#[derive(Clone, Default)]
pub(crate) struct MotionMemory {
    current: CurrentShape,
    /// Pieces that wait for their turn in the present shape, the next one last.
    pieces: Vec<PendingPiece>,
    /// Those that the first shape begins with.
    initial_pieces: Vec<Piece>,
    /// Those that failed, one interval's after another's.
    unresolved: Vec<PendingPiece>,
    /// More about those of the present interval.
    unresolved_bodies: Vec<UnresolvedPiece>,
    pub(super) intervals: VecDeque<Interval>,
    /// Where the vertices go, if the mesh moves.
    mesh: MovingMesh,
    planes: SeparatingPlanes,
    /// Forgotten with each question: answers do not depend on earlier ones.
    small_rooms: SmallRooms,
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
    pub(super) fn midpoint(&self) -> Real {
        midpoint(self.times)
    }

    /// The same, in which the pieces are known to come no nearer than this.
    pub(super) fn with_lower_bound(self, lower: Real) -> Self {
        Self { lower: self.lower.max(lower), ..self }
    }

    /// What is left of it before and after its middle shape, which decides for a while what becomes
    /// of the pieces.
    pub(super) fn halves(
        &self,
        hold: Real,
        is_left: [bool; 2],
        pieces: &Range<usize>,
    ) -> [Option<Self>; 2] {
        let [before, after] = remaining_parts(self.times, hold);
        let rest = |times: Option<[Real; 2]>, is_after: bool| {
            let is_left = is_left[usize::from(is_after)] && !pieces.is_empty();
            let pieces = Some(pieces.clone());
            times.filter(|_| is_left).map(|times| Self {
                times,
                pieces,
                is_after,
                lower: self.lower,
            })
        };
        [rest(before, false), rest(after, true)]
    }
}

/// The pieces that have their turn in a shape.
pub(super) struct PendingPieces<'a> {
    pub pieces: &'a mut Vec<PendingPiece>,
    initial_pieces: &'a mut Vec<Piece>,
    is_whole: bool,
}

impl PendingPieces<'_> {
    /// Begins with the pieces of the whole robot, unless some have failed before. `scale` is what
    /// is to be decided.
    pub(super) fn begin(&mut self, tube: &TubeInMesh, scale: Real) {
        if self.is_whole {
            tube.begin(scale, self.initial_pieces);
            self.pieces.extend(
                self.initial_pieces.iter().map(|piece| PendingPiece::of(piece, &tube.tube)),
            );
        }
    }
}

/// What the middle shape of an interval shows, and for how long.
struct IntervalOutcome {
    result: IntervalResult<MeshUpperBound>,
    /// For how long before and after it the pieces keep the margin that failed.
    hold: Real,
    /// Whether any of these is left before the shape, and after it.
    is_left: [bool; 2],
    /// Which of the failed pieces these are.
    unresolved: Range<usize>,
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

impl<M: Motion> MotionSearch<'_, M> {
    /// Whether the margin is kept at all times. Breadth first: contacts that last show early.
    pub(crate) fn clears(&mut self, wanted: MarginQuery) -> Result<MotionAnswer, ProximityError> {
        let (mut progress, mut too_fine) = (Progress::default(), None);
        self.begin();
        while let Some(interval) = self.memory.intervals.pop_front() {
            let left =
                self.memory.intervals.iter().chain([&interval]).map(|interval| interval.times);
            if let Some(first) = progress.is_exhausted(self.shapes, left) {
                return too_fine.map_or_else(|| Ok(MotionAnswer::undecided(first)), Err);
            }
            let IntervalOutcome { result, hold, is_left, unresolved } =
                self.test_interval(&interval, wanted)?;
            progress.record(interval.times, &result, self.shapes);
            if let Some(found) = result.contact {
                // Of the shapes before it nothing is proven yet but what was asked first.
                return Ok(MotionAnswer::contact(
                    0.0,
                    self.shape_in_contact(interval.midpoint(), &found),
                ));
            }
            too_fine = too_fine.or(result.too_fine);
            self.memory
                .intervals
                .extend(interval.halves(hold, is_left, &unresolved).into_iter().flatten());
        }
        if let Some(error) = too_fine {
            return Err(error);
        }
        Ok(progress.undecided().map_or_else(MotionAnswer::clear, MotionAnswer::undecided))
    }

    /// Until when the margin is kept. Earlier intervals first; what comes after a contact does not
    /// matter. Where an interval stays undecided, the answer cannot begin any later. What is
    /// left then is a shape that does not keep the margin: the larger intervals first, and with
    /// patience. After [`MAX_SHAPES`] shapes the answer begins where the rest does.
    pub(crate) fn first_contact(
        &mut self,
        wanted: MarginQuery,
    ) -> Result<MotionAnswer, ProximityError> {
        let (mut undecided, mut contact) = (None::<[Real; 2]>, None::<(Real, MeshUpperBound)>);
        let (mut clear_until, mut most, mut too_fine) = (1.0, MAX_SHAPES, None);
        self.begin();
        // The last one comes first.
        self.memory.intervals.make_contiguous().reverse();
        while self.shapes < most {
            let intervals = &mut self.memory.intervals;
            let next =
                if undecided.is_none() { intervals.pop_back() } else { intervals.pop_front() };
            let Some(interval) = next else { break };
            let IntervalOutcome { result, hold, is_left, unresolved } =
                self.test_interval(&interval, wanted)?;
            if result.is_undecided && undecided.is_none() {
                undecided = Some(interval.times);
                most = most.min(self.shapes + PATIENCE);
            }
            if let Some(found) = result.contact {
                let t = interval.midpoint();
                contact = Some((t, found));
                clear_until = if result.is_fine { interval.times[0] } else { t };
                self.memory.intervals.clear();
                if !result.is_fine {
                    let before = Interval {
                        times: [interval.times[0], t],
                        pieces: Some(unresolved),
                        is_after: false,
                        ..interval
                    };
                    self.memory.intervals.push_back(before);
                }
                continue;
            }
            too_fine = too_fine.or(result.too_fine);
            let halves = interval.halves(hold, is_left, &unresolved);
            self.memory.intervals.extend(halves.into_iter().rev().flatten());
        }
        let left = self.memory.intervals.iter().map(|interval| interval.times);
        let left = left.min_by(|a, b| a[0].total_cmp(&b[0]));
        let Some((t, found)) = contact else {
            if let Some(error) = too_fine {
                return Err(error);
            }
            let near = undecided.map(|interval| (interval, UndecidedReason::Near));
            let first = near.or(left.map(|interval| (interval, UndecidedReason::Work)));
            return Ok(first.map_or_else(MotionAnswer::clear, MotionAnswer::undecided));
        };
        let unknown = undecided.into_iter().chain(left).map(|interval| interval[0]);
        let clear_until = unknown.fold(clear_until, Real::min);
        Ok(MotionAnswer::contact(clear_until, self.shape_in_contact(t, &found)))
    }

    /// A place that was found on the shape at `t`, which the tube is.
    fn shape_in_contact(&self, t: Real, found: &MeshUpperBound) -> ShapeInContact {
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
        let MotionMemory { current, intervals, unresolved, small_rooms, .. } = &mut *self.memory;
        current.forget();
        *small_rooms = SmallRooms::default();
        intervals.clear();
        unresolved.clear();
        let legs = self.motion.legs().max(1);
        let time = |leg: usize| leg as Real / legs as Real;
        intervals.extend((0..legs).map(|leg| Interval {
            times: [time(leg), time(leg + 1)],
            pieces: None,
            is_after: false,
            lower: Real::NEG_INFINITY,
        }));
    }

    /// Whether the margin is kept in an interval, as far as its middle shape shows.
    fn test_interval(
        &mut self,
        interval: &Interval,
        wanted: MarginQuery,
    ) -> Result<IntervalOutcome, ProximityError> {
        let ((result, hold, is_left), unresolved) =
            self.with_middle_shape(interval, |tube, turn, moving, approach_bound| {
                // Below that, rounding decides.
                tube.check_resolved(32.0 * tube.tube.slack(), wanted.resolution)?;
                turn.begin(tube, wanted.margin.max(wanted.resolution));
                let mut test = IntervalTest {
                    moving,
                    approach_bound,
                    wanted,
                    result: IntervalResult::empty(),
                };
                refine(tube, turn.pieces, &mut test)?;
                let IntervalTest { mut moving, approach_bound, result, .. } = test;
                let is_contact = result.contact.is_some();
                let is_left = if is_contact {
                    [true; 2]
                } else {
                    moving.clear_by_displacement(tube, wanted.margin).sides
                };
                Ok((result, approach_bound.hold, is_left))
            })?;
        Ok(IntervalOutcome { result, hold, is_left, unresolved })
    }

    /// Asks a question of the middle shape of an interval; and which of the failed pieces are those
    /// that failed there.
    pub(super) fn with_middle_shape<T>(
        &mut self,
        interval: &Interval,
        ask: impl FnOnce(
            &mut TubeInMesh,
            &mut PendingPieces,
            MovingTube<M>,
            ApproachBound,
        ) -> Result<T, ProximityError>,
    ) -> Result<(T, Range<usize>), ProximityError> {
        let (t, motion, times) = (interval.midpoint(), self.motion, interval.times);
        let MotionMemory {
            current,
            pieces,
            initial_pieces,
            unresolved,
            unresolved_bodies,
            mesh,
            planes,
            small_rooms,
            ..
        } = &mut *self.memory;
        let pose = current.set_time(motion, t)?;
        self.shapes += 1;
        let approach_bound =
            ApproachBound::new(times, current.mark_lasting_faces_between(motion, times));
        let MeshSearch { level, hierarchy, .. } = self.search;
        let mut search = MeshSearch::new(level, hierarchy, &mut *self.search.scratch);
        let (mut reach, mut mesh_speed) = (hierarchy.reach, 0.0);
        if self.does_mesh_move {
            (reach, mesh_speed) = (reach.max(mesh.reach()), mesh.speed());
            search.moved = Some(MeshAt { moving: mesh, share: t });
        }
        let tube = PlacedTube::new(&current.tube, &pose, reach)?.moving();
        let mut tube = TubeInMesh { search, tube };
        pieces.clear();
        let failing = interval.pieces.clone().map_or(&[][..], |failing| &unresolved[failing]);
        let failing = failing.iter().filter(|piece| piece.is_left[usize::from(interval.is_after)]);
        // Of this interval nothing is known.
        pieces.extend(failing.map(|piece| PendingPiece { is_left: [true; 2], ..*piece }));
        let first = unresolved.len();
        unresolved_bodies.clear();
        let moving = MovingTube {
            motion,
            times,
            t,
            mesh_speed,
            unresolved: &mut *unresolved,
            first,
            unresolved_bodies,
            last: &mut self.last,
            beside: 0.0,
            planes,
            small_rooms,
        };
        let mut turn =
            PendingPieces { pieces, initial_pieces, is_whole: interval.pieces.is_none() };
        let result = ask(&mut tube, &mut turn, moving, approach_bound)?;
        // What a contact left unasked.
        unresolved.append(pieces);
        Ok((result, first..unresolved.len()))
    }
}
