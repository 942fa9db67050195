//! The proof of a motion: intervals of time, each proven by the shape at its middle, with room for what the robot may move
//! until the interval ends.

use super::parting::Parting;
use super::text::Parted;
use super::tube_shape::tube_shape;
use crate::answer::ProximityError;
use crate::distance::Scalar;
use crate::pieces::PlacedTube;
use crate::robot::{Motion, Sections, Tube, check_speed};
use parry3d_f64::math::Real;

/// More shapes are in no proof.
const MOST_SHAPES: usize = 1 << 16;

/// Shapes, each with the steps that part it from the mesh while its interval lasts, in the order of time; none where a shape
/// comes as near as the margin, or so near that moving by `resolution` matters. `reach` is the mesh's largest coordinate.
pub(crate) fn motion_proof(
    parting: &mut Parting,
    reach: Real,
    motion: &impl Motion,
    margin: Real,
    resolution: Real,
) -> Result<Option<Vec<Parted>>, ProximityError> {
    let (mut tube, mut sections) = (Tube::empty(), Sections::default());
    let (mut proven, mut waiting, mut shapes) = (Vec::new(), vec![[0.0, 1.0]], 0);
    while let Some(times @ [from, to]) = waiting.pop() {
        let t = 0.5 * from + 0.5 * to;
        let half = 0.5 * (to - from);
        tube.forget_error();
        let pose = motion.shape(t, &mut tube)?;
        sections.check(t, &tube)?;
        shapes += 1;
        let placed = PlacedTube::new(&tube, &pose, reach)?;
        let fastest = (0..placed.sections().len()).map(|section| {
            let speed = motion.speed(section, [0.0, 1.0], times).point;
            check_speed(section, speed)
        });
        let fastest = fastest.collect::<Result<Vec<_>, _>>()?.into_iter().fold(0.0, Real::max);
        let moves = half * fastest;
        // What bends takes less of the room than what moves.
        let over = (0.25 * moves).max(0.25 * resolution).max(placed.slack());
        let (mut shape, places) = tube_shape(&placed, over, true);
        shape.times = times;
        for (piece, place) in shape.pieces.iter_mut().zip(&places) {
            let section = place.section as usize;
            let speed = motion.speed(section, placed.shares(place), times);
            let rounded = 1.0 + 8.0 * Real::UNIT_ROUNDOFF;
            piece.speed = check_speed(section, speed.point)? * rounded;
            piece.turn = check_speed(section, speed.turn)? * rounded;
        }
        if let Some(steps) = parting.steps(&shape.bodies(margin)) {
            proven.push((shape, steps));
            continue;
        }
        let is_fine = moves <= resolution.max(placed.slack()) || !(from < t && t < to);
        if is_fine || shapes >= MOST_SHAPES {
            return Ok(None);
        }
        waiting.extend([[t, to], [from, t]]);
    }
    Ok(Some(proven))
}
