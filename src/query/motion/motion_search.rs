//! The queries of a motion in a mesh: whether it keeps a margin, or until when.
//!
//! # Definitions
//! - **Middle shape** of an interval of time: the robot's shape at its midpoint t. tau: half of the
//!   interval.
//! - **Piece**: a range of shares of a section, the same points of the robot at all times.
//! - V: an upper bound on the speed of a piece relative to the mesh (`approach_bound`).
//! - d: the computed distance of the piece's body in the middle shape, less the slack of its
//!   rounding (`refine::placed_tube`).
//! - **Unresolved** piece: the middle shape does not clear it for the whole interval.
//!
//! # Claim
//! If d > margin + tau V, the piece keeps the margin during the whole interval. Otherwise it keeps
//! the margin for max(0, d - margin) / V before and after t.
//!
//! **Proof.** Points of the piece are within tau V of where they are at t. Which points of the
//! piece a body contains is derived in `refine::bounding_body` and `approach_bound`.
//!
//! # Algorithm
//! 1. **Start** with one interval per part of the motion's time, with all pieces.
//! 2. **Test** the pieces of an interval in its middle shape (`interval_test`). If the width of a
//!    body prevents the decision, and not the motion, the piece is halved in the same shape.
//! 3. **Displacements.** A speed bounds how far a piece moves, not in which direction. If few
//!    pieces are unresolved and the motion bounds their displacements, each is tested on the sides
//!    of t where no piece before it failed. The test separates it from every triangle that is near
//!    enough (`half_displacement`, `separating_planes`). A cleared piece is dropped on that side.
//!    If all are cleared, the side is done. A piece with little room rarely passes this test, so it
//!    is tested rarely, unless it passes.
//! 4. **Divide.** The remaining parts of the interval, before and after t, become intervals with
//!    the unresolved pieces.
//! 5. **Stop** when no interval is left, at a contact, after [`MAX_SHAPES`] shapes, or a fixed
//!    number of shapes after the first one near the margin (`intervals`).
//!
//! **Moving mesh.** The mesh has a place at each time (`search::hierarchy::moving_mesh`). V is then
//! the speed of the piece plus the speed of the fastest vertex, since no point of a triangle is
//! faster than its vertices. If all vertices share a shift, V is also the speed of the piece
//! relative to that shift, plus the largest difference of a vertex from it.
//!
//! **Common frame.** If the motion states a frame that carries the robot (`motion::common_frame`),
//! V follows from the middle shape: the speed in the frame, and the frame's own speed at the piece.
//!
//! **Flat ends** that may become round during the interval count as round
//! (`curve::cap_persistence`): the ball contains the disc at all times. The same holds for a
//! link that may lose its direction. The intervals become shorter until the end stays flat, or
//! until they isolate the instant at which it becomes round. The shape itself jumps there; if that
//! is what comes near, the answer is undecided.

use super::approach_bound::{ApproachBound, half_length};
use super::current_shape::CurrentShape;
use super::interval_test::{IntervalResult, IntervalTest, MarginQuery};
use super::intervals::{self, Interval, MarginAnswer, Sought, TestedInterval};
use super::minimum_rounds::NearestFirst;
use super::moving_tube::{MeshFrames, MovingTube, SmallRooms};
use super::pending_piece::PendingPiece;
use super::pending_piece::{UnresolvedPiece, UnresolvedPieces};
use super::refinement::refine;
use super::separating_planes::SeparatingPlanes;
use crate::answer::{MotionAnswer, ProximityError, ShapeInContact};
use crate::motion::{CarriedMotion, Motion};
use crate::refine::{MeshUpperBound, Piece, PlacedTube, Refinable, TubeInMesh};
use crate::search::hierarchy::{MeshAt, MeshSearch, MeshSpeed, MovingMesh, PlacedMeshSearch};
use parry3d_f64::math::{Real, Vector};
use std::collections::{BinaryHeap, VecDeque};
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
    /// For bounds on the least clearance (`minimum_rounds`).
    pub(super) queue: BinaryHeap<NearestFirst>,
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

/// A motion in a mesh.
pub(crate) struct MotionSearch<'a> {
    pub search: MeshSearch<'a>,
    pub memory: &'a mut MotionMemory,
    pub motion: &'a dyn Motion,
    /// The last triangle found: it starts the next search.
    pub last: Option<u32>,
    /// Whether the mesh moves too, as stored in the memory.
    pub does_mesh_move: bool,
    /// The largest coordinate of the mesh and of its pose, if the motion's poses are products with
    /// the inverse of that pose; and how many products.
    pub frame: Option<(Real, Real)>,
}

impl MotionSearch<'_> {
    /// Decides whether the margin is kept at all times.
    pub(crate) fn decide(
        &mut self,
        wanted: MarginQuery,
        sought: Sought,
    ) -> Result<MotionAnswer, ProximityError> {
        self.begin();
        let mut intervals = std::mem::take(&mut self.memory.intervals);
        let answer = intervals::decide(sought, &mut intervals, |interval| {
            self.test_interval(interval, wanted)
        });
        self.memory.intervals = intervals;
        Ok(match answer? {
            MarginAnswer::Clear => MotionAnswer::clear(),
            MarginAnswer::Undecided(first) => MotionAnswer::undecided(first),
            MarginAnswer::Contact { clear_until, t, found } => {
                let MeshUpperBound { upper, section, witness } = found;
                MotionAnswer::contact(clear_until, ShapeInContact { t, upper, section, witness })
            }
        })
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
        unresolved.clear();
        intervals::begin(intervals, [self.motion.time_parts()]);
    }

    /// Tests the middle shape of an interval.
    fn test_interval(
        &mut self,
        interval: &Interval,
        wanted: MarginQuery,
    ) -> Result<TestedInterval<MeshUpperBound>, ProximityError> {
        let ((result, hold, is_left), unresolved) =
            self.with_middle_shape(interval, |tube, pending, moving, approach_bound| {
                // A finer resolution is below rounding.
                tube.check_resolved(32.0 * tube.tube.slack(), wanted.resolution)?;
                pending.begin(tube, wanted.margin.max(wanted.resolution));
                let mut test = IntervalTest {
                    moving,
                    approach_bound,
                    wanted,
                    result: IntervalResult::empty(),
                };
                refine(tube, pending.pieces, &mut test)?;
                let IntervalTest { mut moving, approach_bound, result, .. } = test;
                let is_contact = result.contact.is_some();
                let is_left = if is_contact {
                    [true; 2]
                } else {
                    moving.clear_by_displacement(tube, wanted.margin).sides
                };
                Ok((result, approach_bound.hold, is_left))
            })?;
        Ok((result, interval.halves(hold, is_left, &unresolved)))
    }

    /// Calls `ask` with the middle shape of an interval. Returns its result and the range of newly
    /// unresolved pieces.
    pub(super) fn with_middle_shape<T>(
        &mut self,
        interval: &Interval,
        ask: impl FnOnce(
            &mut TubeInMesh,
            &mut PendingPieces,
            MovingTube,
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
        let carried = CarriedMotion::new(motion, times, half_length(times));
        let cap_change = current.mark_lasting_faces_in(&carried, carried.turning());
        let approach_bound = ApproachBound::new(times, cap_change);
        let MeshSearch { level, hierarchy, .. } = self.search;
        let search = MeshSearch::new(level, hierarchy, &mut *self.search.scratch);
        let (reach, mesh_speed, search) = if self.does_mesh_move {
            let (reach, speed) = (hierarchy.mesh_reach.max(mesh.reach()), mesh.speed);
            let moved = MeshAt { moving: mesh, share: t };
            (reach, speed, PlacedMeshSearch::moved(search, moved))
        } else {
            (hierarchy.mesh_reach, MeshSpeed::default(), PlacedMeshSearch::at_rest(search))
        };
        let tube = PlacedTube::new(&current.tube, &pose, reach)?.moving();
        let tube = self.frame.map_or(tube, |(size, products)| tube.posed(size, products));
        let mut tube = TubeInMesh { search, tube };
        pieces.clear();
        let left = interval.pieces.clone().map_or(&[][..], |left| &unresolved[left]);
        let left = left.iter().filter(|piece| piece.is_left[usize::from(interval.is_after)]);
        // They are unresolved on both sides of the new middle shape.
        pieces.extend(left.map(|piece| PendingPiece { is_left: [true; 2], ..*piece }));
        let first = unresolved.len();
        unresolved_bodies.clear();
        let moving = MovingTube {
            frames: MeshFrames::new(&carried, &mesh_speed),
            motion: carried,
            mesh: mesh_speed,
            unresolved: UnresolvedPieces {
                pieces: &mut *unresolved,
                first,
                bodies: unresolved_bodies,
            },
            last: &mut self.last,
            planes,
            small_rooms,
        };
        let mut pending =
            PendingPieces { pieces, initial_pieces, is_whole: interval.pieces.is_none() };
        let result = ask(&mut tube, &mut pending, moving, approach_bound)?;
        // A contact leaves pieces untested.
        unresolved.append(pieces);
        Ok((result, first..unresolved.len()))
    }
}
