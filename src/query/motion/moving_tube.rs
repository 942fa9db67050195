//! The pieces of one moving robot in an interval of time: their speeds and displacements, relative
//! to the middle shape.

use super::approach_bound::ApproachSpeed;
use super::approach_bound::{Approach, midpoint};
use super::half_displacement::HalfDisplacement;
use super::pending_piece::PendingPiece;
use super::pending_piece::{MAX_DISPLACED_PIECES, UnresolvedPiece, UnresolvedPieces};
use super::refinement::BoundedPiece;
use super::relative_motion::RelativeMotion;
use super::separating_planes::{PlaneTest, SeparatingPlanes};
use crate::answer::ProximityError;
use crate::distance::Scalar;
use crate::motion::{CarriedMotion, CarriedPiece, CommonFrame, DisplacementBound, FramePair};
use crate::pair::Nearest;
use crate::refine::{Body, BoundingBody, Piece, Refinable, SectionRange, TubeInMesh};
use crate::search::hierarchy::MeshSpeed;
use parry3d_f64::math::{Real, Vector};

/// A piece whose room is at most this share of its approach rarely passes the displacement test,
/// unless it slides along the wall. Such pieces are tested only when [`SmallRooms`] is due.
const MIN_ROOM: Real = 0.1;

/// The pieces of a moving robot in an interval of time.
pub(crate) struct MovingTube<'a> {
    pub motion: CarriedMotion<'a>,
    pub mesh: MeshSpeed,
    pub frames: MeshFrames,
    pub unresolved: UnresolvedPieces<'a>,
    /// The last triangle found.
    pub last: &'a mut Option<u32>,
    pub planes: &'a mut SeparatingPlanes,
    pub small_rooms: &'a mut SmallRooms,
}

/// The frame that carries the robot, if the motion states one, beside two frames of the mesh.
pub(crate) struct MeshFrames {
    at_rest: Option<FramePair>,
    /// Beside the shift that the vertices of the mesh share.
    shifting: Option<FramePair>,
}

impl MeshFrames {
    pub(crate) fn new(motion: &CarriedMotion, mesh: &MeshSpeed) -> Self {
        let beside = |frame| motion.has_frame().then(|| motion.beside(&frame));
        let shifting = (mesh.shift != Vector::ZERO).then(|| CommonFrame::shifting(mesh.shift));
        Self { at_rest: beside(CommonFrame::REST), shifting: shifting.and_then(beside) }
    }
}

impl<'m> RelativeMotion<TubeInMesh<'m>, PendingPiece> for MovingTube<'_> {
    /// The speed of the centreline, with the shift of the mesh; and how much faster a point of the
    /// body may be, plus the speed of the mesh beside its shift.
    fn speeds(
        &mut self,
        pending: &PendingPiece,
        piece: &Piece,
        outer: &BoundingBody,
        tube: &TubeInMesh<'m>,
    ) -> Result<[Real; 2], ProximityError> {
        let PendingPiece { section, shares, .. } = *pending;
        let range = SectionRange { section, shares, outer, radius: tube.radius(piece) };
        let MeshSpeed { most, apart, .. } = self.mesh;
        let mut speed = self.motion.stated(section as usize, shares);
        let mut with_shift = Real::INFINITY;
        if let Some(at_rest) = &self.frames.at_rest {
            let placed = &tube.tube;
            let has_rim = outer.is_flat();
            let of = || {
                let section = placed.section(section);
                CarriedPiece::new(placed.tube, &placed.pose, section, shares, has_rim)
            };
            if let Some(shifting) = &self.frames.shifting {
                with_shift = shifting.speeds(speed, of).seen.point;
            }
            speed = at_rest.speeds(speed, of).seen;
        }
        let ApproachSpeed { centreline, rim } = ApproachSpeed::of(speed, &range)?;
        let up = 1.0 + 2.0 * Real::UNIT_ROUNDOFF;
        Ok([(centreline + (most - apart)).min(with_shift) * up, (rim + apart) * up])
    }

    fn seed_triangle(&self) -> Option<u32> {
        *self.last
    }

    fn record(&mut self, bounded: &BoundedPiece<TubeInMesh<'m>, PendingPiece>) {
        *self.last = Some(bounded.nearest.triangle);
    }

    fn record_unresolved(
        &mut self,
        bounded: &BoundedPiece<TubeInMesh<'m>, PendingPiece>,
        approach: &Approach,
    ) {
        let UnresolvedPieces { pieces, bodies, .. } = &mut self.unresolved;
        pieces.push(PendingPiece { is_left: [true; 2], ..*bounded.part });
        if bodies.len() <= MAX_DISPLACED_PIECES {
            let Nearest { distance: away, on_robot, on_mesh, .. } = *bounded.nearest;
            let normal = (on_robot - on_mesh).normalize_or_zero();
            let [_, beside] = approach.speeds;
            bodies.push(UnresolvedPiece {
                body: bounded.outer.body,
                away,
                normal,
                approach: approach.distance,
                beside: beside * self.motion.half,
            });
        }
    }

    fn fastest_section(
        &self,
        bounded: &BoundedPiece<TubeInMesh<'m>, PendingPiece>,
        approach: &Approach,
    ) -> (usize, Real) {
        (bounded.part.section as usize, approach.speed)
    }
}

/// On which sides of the middle shape unresolved pieces are left.
pub(crate) struct Left {
    /// Before the shape, and after it.
    pub sides: [bool; 2],
    /// Whether a piece was cleared on some side.
    pub is_any_cleared: bool,
}

impl MovingTube<'_> {
    /// Tests the displacements of the unresolved pieces on both sides of the middle shape, and
    /// drops the pieces that keep the margin there.
    ///
    /// The nearest piece is tested first. After the first unresolved on a side the other pieces are
    /// skipped: that side must be searched anyway.
    pub(crate) fn clear_by_displacement(&mut self, tube: &mut TubeInMesh, margin: Real) -> Left {
        let UnresolvedPieces { pieces, first, bodies } = &mut self.unresolved;
        let nearest = bodies.iter().enumerate().min_by(|a, b| a.1.away.total_cmp(&b.1.away));
        let mut left = Left { sides: [false; 2], is_any_cleared: false };
        let Some((nearest, _)) = nearest else { return left };
        if bodies.len() > MAX_DISPLACED_PIECES {
            left.sides = [true; 2];
            return left;
        }
        let slack = tube.tube.slack();
        let room = |unresolved: &UnresolvedPiece| unresolved.away - margin - slack;
        let is_small =
            |unresolved: &UnresolvedPiece| room(unresolved) <= MIN_ROOM * unresolved.approach;
        let has_small = bodies.iter().any(is_small);
        let asks_small =
            has_small && bodies.iter().all(|it| room(it) > 0.0) && self.small_rooms.is_due();
        bodies.swap(0, nearest);
        let pieces = &mut pieces[*first..];
        pieces.swap(0, nearest);
        let (motion, mesh, whole) = (self.motion.motion, self.mesh, self.motion.times);
        let t = midpoint(whole);
        for (part, unresolved) in pieces.iter_mut().zip(&**bodies) {
            if is_small(unresolved) && !asks_small {
                left.sides = [true; 2];
                return left;
            }
            for (side, is_left) in
                left.sides.iter_mut().enumerate().filter(|(_, is_left)| !**is_left)
            {
                let times = if side == 0 { [whole[0], t] } else { [t, whole[1]] };
                let bound = motion.displacement(part.section as usize, part.shares, times);
                let is_clear = bound
                    .map(|bound| beside_shift(bound, mesh.shift * (times[1] - times[0])))
                    .and_then(|bound| HalfDisplacement::of(&bound, side, unresolved.beside))
                    .is_some_and(|side| {
                        let asked =
                            PlaneTest { body: &unresolved.body, side: &side, margin, slack };
                        self.planes.clears(&mut tube.search, &asked, unresolved)
                    });
                part.is_left[side] = !is_clear;
                *is_left = !is_clear;
                left.is_any_cleared |= is_clear;
            }
            if left.sides == [true; 2] {
                break;
            }
        }
        if asks_small {
            self.small_rooms.note(left.sides != [true; 2]);
        }
        left
    }
}

/// Returns a displacement relative to a mesh that is shifted in the same time.
fn beside_shift(bound: DisplacementBound, shift: Vector) -> DisplacementBound {
    if shift == Vector::ZERO {
        return bound;
    }
    let rounding = 16.0 * Real::UNIT_ROUNDOFF * shift.abs().max_element();
    DisplacementBound { ways: bound.ways.map(|way| way - shift), off: bound.off + rounding }
}

/// Decides when pieces with little room are tested: rarely after unresolveds.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SmallRooms {
    /// How many shapes are skipped after the last test.
    pause: u32,
    /// How many skipped shapes are left.
    left: u32,
}

/// The longest pause, in shapes. A displacement test costs up to as much as a shape, so it adds at
/// most 1/8 of the time if it always fails.
const LONGEST_PAUSE: u32 = 15;

impl SmallRooms {
    /// Whether the next shape is tested.
    fn is_due(&mut self) -> bool {
        let is_due = self.left == 0;
        self.left = self.left.saturating_sub(1);
        is_due
    }

    /// Records the result of a test.
    fn note(&mut self, is_settled: bool) {
        self.pause = if is_settled { 0 } else { (2 * self.pause + 1).min(LONGEST_PAUSE) };
        self.left = self.pause;
    }
}
