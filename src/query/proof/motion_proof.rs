//! The proof of a motion: intervals of time, each proven by its middle shape with free space for
//! the motion until the interval ends.

use super::plane_search::PlaneSearch;
use super::text::{Kind, ProvenShape, size_of};
use super::tube_shape::tube_shape;
use crate::answer::ProximityError;
use crate::curve::Tube;
use crate::distance::Scalar;
use crate::motion::{Motion, MotionDrift, SectionSignature, check_speed};
use crate::refine::PlacedTube;
use parry3d_f64::math::Real;

/// The most shapes tested for a proof.
const MAX_SHAPES: usize = 1 << 16;

/// The longest text of a proof, in bytes: 16 MiB.
const MOST_BYTES: usize = 1 << 24;

/// Returns shapes in the order of time, each with the steps that separate it from the mesh during
/// its interval. `reach` is the mesh's largest coordinate.
///
/// Returns `None` if a shape is within the margin, or so near that a motion of `resolution`
/// matters, or if the proof would be too large.
///
/// # Errors
/// The motion has no shape at some time, or its sections change; a shape is out of range; or a
/// stated speed is negative or not finite.
pub(crate) fn motion_proof(
    plane_search: &mut PlaneSearch,
    reach: Real,
    motion: &impl Motion,
    margin: Real,
    resolution: Real,
) -> Result<Option<Vec<ProvenShape>>, ProximityError> {
    let (mut tube, mut sections) = (Tube::empty(), SectionSignature::default());
    let (mut proven, mut waiting) = (Vec::new(), vec![[0.0, 1.0]]);
    let (mut shapes, mut bytes) = (0, 0);
    while let Some(times @ [from, to]) = waiting.pop() {
        let t = 0.5 * from + 0.5 * to;
        let half = 0.5 * (to - from);
        tube.forget_error();
        let pose = motion.shape(t, &mut tube)?;
        sections.check(t, &tube)?;
        shapes += 1;
        tube.mark_lasting_faces_between(&MotionDrift { motion, times, t, half_length: half });
        let placed = PlacedTube::new(&tube, &pose, reach)?.moving();
        let fastest = (0..placed.sections().len()).map(|section| {
            let speed = motion.speed(section, [0.0, 1.0], times).point;
            check_speed(section, speed)
        });
        let fastest = fastest.collect::<Result<Vec<_>, _>>()?.into_iter().fold(0.0, Real::max);
        let mut moves = half * fastest;
        // The bodies' excess takes less of the free space than the motion.
        let over = (0.25 * moves).max(0.25 * resolution).max(placed.slack());
        let (mut shape, places) = tube_shape(&placed, over, true);
        shape.times = times;
        for (piece, place) in shape.pieces.iter_mut().zip(&places) {
            let section = place.section as usize;
            let speed = motion.speed(section, placed.shares(place), times);
            let rounded = 1.0 + 8.0 * Real::UNIT_ROUNDOFF;
            piece.speed = check_speed(section, speed.point)? * rounded;
            // Balls need no turn. The turn of a link that loses its length is infinite.
            let is_unbounded = piece.flat == [false; 2] && speed.turn == Real::INFINITY;
            let turn = if is_unbounded { Real::MAX } else { speed.turn };
            piece.turn = (check_speed(section, turn)? * rounded).min(Real::MAX);
            if piece.flat != [false; 2] {
                // The rims move with the turn, even if the centreline rests.
                moves = moves.max(half * (piece.speed + piece.radius * piece.turn));
            }
        }
        if let Some(steps) = plane_search.steps(&shape.bodies(margin)) {
            let parted = (shape, steps);
            bytes += size_of(Kind::Motion, &parted);
            if bytes > MOST_BYTES {
                return Ok(None);
            }
            proven.push(parted);
            continue;
        }
        let is_fine = moves <= resolution.max(placed.slack()) || !(from < t && t < to);
        if is_fine || shapes >= MAX_SHAPES {
            return Ok(None);
        }
        waiting.extend([[t, to], [from, t]]);
    }
    Ok(Some(proven))
}
