//! The queries of a motion in a mesh: whether it keeps a margin, or until when.
//!
//! # Definitions
//! - **Middle shape** of an interval of time: the robot's shape at its midpoint t. tau: half of the
//!   interval.
//! - **Piece**: a range of shares of a section, the same points of the robot at all times.
//! - V: an upper bound on the speed of a piece relative to the mesh (`approach_speed`).
//! - d: the distance of the piece's body in the middle shape.
//! - **Unresolved** piece: the middle shape does not clear it for the whole interval.
//!
//! # Claim
//! If d > margin + tau V, the piece keeps the margin during the whole interval. Otherwise it keeps
//! the margin for (d - margin) / V before and after t.
//!
//! **Proof.** Points of the piece are within tau V of where they are at t. Which points of the
//! piece a body contains is derived in `refine::bounding_body` and `approach_speed`.
//!
//! # Algorithm
//! 1. **Start** with one interval per part of the motion's time, with all pieces.
//! 2. **Test** the pieces of an interval in its middle shape (`interval_test`). If the width of a
//!    body prevents the decision, and not the motion, the piece is halved in the same shape.
//! 3. **Displacements.** A speed bounds how far a piece moves, not in which direction. If few
//!    pieces are unresolved and the motion bounds their displacements, each is tested on both sides
//!    of t. The test separates it from every triangle that is near enough (`half_displacement`,
//!    `separating_planes`). A cleared piece is dropped on that side. If all are cleared, the side
//!    is done. A piece with little room rarely passes this test, so it is tested rarely, unless it
//!    passes.
//! 4. **Divide.** The remaining parts of the interval, before and after t, become intervals with
//!    the unresolved pieces.
//! 5. **Stop** when no interval is left, at a contact, or after [`MAX_SHAPES`] shapes (`progress`).
//!
//! **Moving mesh.** The mesh has a place at each time (`search::hierarchy::moving_mesh`). V is then
//! the speed of the piece plus the speed of the fastest vertex, since no point of a triangle is
//! faster than its vertices.
//!
//! **Flat ends** that may become round during the interval count as round
//! (`curve::cap_persistence`): the ball contains the disc at all times. The same holds for a
//! link that may lose its direction. The intervals become shorter until the end stays flat, or
//! until they isolate the instant at which it becomes round. The shape itself jumps there; if that
//! is what comes near, the answer is undecided.

use super::approach_bound::ApproachBound;
use super::current_shape::CurrentShape;
use super::interval_test::{IntervalResult, IntervalTest, MarginQuery};
use super::intervals::Interval;
use super::moving_tube::{MovingTube, SmallRooms};
use super::pending_piece::PendingPiece;
use super::progress::{MAX_SHAPES, PATIENCE, Progress};
use super::separating_planes::SeparatingPlanes;
use super::unresolved_piece::UnresolvedPiece;
use crate::answer::{MotionAnswer, ProximityError, ShapeInContact, UndecidedReason};
use crate::motion::Motion;
use crate::refine::{MeshUpperBound, Piece, PlacedTube, Refinable, TubeInMesh, refine};
use crate::search::hierarchy::{MeshAt, MeshSearch, MovingMesh, PlacedMeshSearch};
use parry3d_f64::math::{Real, Vector};
use std::collections::VecDeque;
use std::ops::Range;

/// State and memory that the next query reuses.
#[derive(Clone, Default)]
pub(crate) struct MotionMemory {
    current: CurrentShape,
    /// The pending pieces of the current shape, the next one last.
    pieces: Vec<PendingPiece>,
    /// The initial pieces of the first shape.
    initial_pieces: Vec<Piece>,
    /// The unresolved pieces of all intervals, one interval after another.
    unresolved: Vec<PendingPiece>,
    /// The bodies of the unresolved pieces of the current interval.
    unresolved_bodies: Vec<UnresolvedPiece>,
    pub(super) intervals: VecDeque<Interval>,
    /// The displacements of the vertices, if the mesh moves.
    mesh: MovingMesh,
    planes: SeparatingPlanes,
    /// Reset by each query, so that answers do not depend on earlier ones.
    small_rooms: SmallRooms,
    /// The lower bound on the clearance of each part of the motion's time, and the bound that the
    /// current round proves.
    pub(super) part_bounds: Vec<Real>,
    pub(super) settled: Vec<Real>,
}

/// The pending pieces of a shape.
pub(super) struct PendingPieces<'a> {
    pub pieces: &'a mut Vec<PendingPiece>,
    initial_pieces: &'a mut Vec<Piece>,
    is_whole: bool,
}

impl PendingPieces<'_> {
    /// Fills in the pieces of the whole robot, unless the interval has unresolved pieces. `scale`:
    /// the clearance at which the decision falls.
    pub(super) fn begin(&mut self, tube: &TubeInMesh, scale: Real) {
        if self.is_whole {
            tube.begin(scale, self.initial_pieces);
            self.pieces.extend(
                self.initial_pieces.iter().map(|piece| PendingPiece::of(piece, &tube.tube)),
            );
        }
    }
}

/// The result of an interval, and how long it holds.
struct IntervalOutcome {
    result: IntervalResult<MeshUpperBound>,
    /// How long before and after the middle shape the unresolved pieces keep the margin.
    hold: Real,
    /// Whether unresolved pieces are left before the shape, and after it.
    is_left: [bool; 2],
    /// The unresolved pieces, as a range of `MotionMemory::unresolved`.
    unresolved: Range<usize>,
}

/// A motion in a mesh.
pub(crate) struct MotionSearch<'a, M> {
    pub search: MeshSearch<'a>,
    pub memory: &'a mut MotionMemory,
    pub motion: &'a M,
    /// How many shapes were tested.
    pub shapes: u64,
    /// The last triangle found: it starts the next search.
    pub last: Option<u32>,
    /// Whether the mesh moves too, as stored in the memory.
    pub does_mesh_move: bool,
    /// The largest coordinate of the mesh and of its pose, if the motion's poses are products with
    /// the inverse of that pose.
    pub frame: Option<Real>,
}

impl<M: Motion> MotionSearch<'_, M> {
    /// Decides whether the margin is kept at all times. Breadth first: long contacts are found
    /// early.
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
                // Times before t are not proven clear, so `clear_until` is 0.
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

    /// Returns until when the margin is kept. Earlier intervals first: nothing after a contact
    /// matters.
    ///
    /// An undecided interval limits the answer to its start. The search then looks for a shape
    /// in contact: larger intervals first, for at most [`PATIENCE`] more shapes. After
    /// [`MAX_SHAPES`] shapes the answer ends where the first remaining interval begins.
    pub(crate) fn first_contact(
        &mut self,
        wanted: MarginQuery,
    ) -> Result<MotionAnswer, ProximityError> {
        let (mut undecided, mut contact) = (None::<[Real; 2]>, None::<(Real, MeshUpperBound)>);
        let (mut clear_until, mut most, mut too_fine) = (1.0, MAX_SHAPES, None);
        self.begin();
        // `pop_back` takes the earliest interval.
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

    /// Returns a contact found in the shape at `t`.
    fn shape_in_contact(&self, t: Real, found: &MeshUpperBound) -> ShapeInContact {
        ShapeInContact { t, upper: found.upper, section: found.section, witness: found.witness }
    }

    /// Sets the displacements of the mesh during the motion: each vertex moves to its place in
    /// `to`, which was checked.
    pub(crate) fn move_mesh(&mut self, to: &[Vector]) {
        let hierarchy = self.search.hierarchy;
        self.memory.mesh.set(&hierarchy.mesh, hierarchy.single(), to);
        self.does_mesh_move = true;
    }

    /// Starts with one interval per part of the motion's time.
    pub(super) fn begin(&mut self) {
        let MotionMemory { current, intervals, unresolved, small_rooms, .. } = &mut *self.memory;
        current.forget();
        *small_rooms = SmallRooms::default();
        intervals.clear();
        unresolved.clear();
        let legs = self.motion.time_parts().max(1);
        let time = |leg: usize| leg as Real / legs as Real;
        intervals.extend((0..legs).map(|leg| Interval {
            times: [time(leg), time(leg + 1)],
            part: leg,
            pieces: None,
            is_after: false,
            lower: Real::NEG_INFINITY,
        }));
    }

    /// Tests the middle shape of an interval.
    fn test_interval(
        &mut self,
        interval: &Interval,
        wanted: MarginQuery,
    ) -> Result<IntervalOutcome, ProximityError> {
        let ((result, hold, is_left), unresolved) =
            self.with_middle_shape(interval, |tube, turn, moving, approach_bound| {
                // A finer resolution is below rounding.
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

    /// Calls `ask` with the middle shape of an interval. Returns its result and the range of newly
    /// unresolved pieces.
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
        let search = MeshSearch::new(level, hierarchy, &mut *self.search.scratch);
        let (reach, mesh_speed, search) = if self.does_mesh_move {
            let (reach, speed) = (hierarchy.reach.max(mesh.reach()), mesh.speed());
            let moved = MeshAt { moving: mesh, share: t };
            (reach, speed, PlacedMeshSearch::moved(search, moved))
        } else {
            (hierarchy.reach, 0.0, PlacedMeshSearch::at_rest(search))
        };
        let tube = PlacedTube::new(&current.tube, &pose, reach)?.moving();
        let tube = self.frame.map_or(tube, |size| tube.posed(size));
        let mut tube = TubeInMesh { search, tube };
        pieces.clear();
        let failing = interval.pieces.clone().map_or(&[][..], |failing| &unresolved[failing]);
        let failing = failing.iter().filter(|piece| piece.is_left[usize::from(interval.is_after)]);
        // They are unresolved on both sides of the new middle shape.
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
        // A contact leaves pieces untested.
        unresolved.append(pieces);
        Ok((result, first..unresolved.len()))
    }
}
