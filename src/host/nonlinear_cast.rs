//! The first hit of two shapes that move and turn: which file answers.
//!
//! 1. **Unit of time.** The time becomes 0 to 1, because parry's tolerances are absolute in time
//!    too, and late times could never meet them.
//! 2. **Links.** [`link_cast`] answers for links against triangles, half-spaces and convex shapes.
//! 3. **Parts.** Shapes with parts are split. Their parts come back to the root dispatcher.
//! 4. **Others** go to the inner dispatcher.

use super::decomposition::Decomposition;
use super::height_field;
use super::link_cast::{self, StartContact};
use super::range::check_pose;
use super::thin_shape::ThinShape;
use parry3d_f64::math::Real;
use parry3d_f64::query::{NonlinearRigidMotion, QueryDispatcher, ShapeCastHit, Unsupported};
use parry3d_f64::shape::Shape;

/// A shape and its motion.
#[derive(Clone, Copy)]
pub(super) struct MovingShape<'a> {
    pub motion: &'a NonlinearRigidMotion,
    pub shape: &'a dyn Shape,
}

/// Returns the first hit of two moving shapes. `root` answers for their parts, `inner` for pairs
/// that this crate leaves to another dispatcher.
///
/// # Errors
/// [`Unsupported`] for numbers that are not finite or out of range, or if a dispatcher refuses.
pub(super) fn cast(
    (root, inner): (&dyn QueryDispatcher, &dyn QueryDispatcher),
    sides: [MovingShape; 2],
    (start_time, end_time): (Real, Real),
    start: StartContact,
) -> Result<Option<ShapeCastHit>, Unsupported> {
    for MovingShape { motion, .. } in sides {
        check_pose(&motion.position_at_time(start_time))?;
        check_pose(&motion.position_at_time(end_time))?;
    }
    if (start_time, end_time) != (0.0, 1.0) {
        let duration = end_time - start_time;
        if duration < 0.0 {
            return Ok(None);
        }
        let [motion1, motion2] = sides.map(|MovingShape { motion, .. }| NonlinearRigidMotion {
            start: motion.position_at_time(start_time),
            linvel: motion.linvel * duration,
            angvel: motion.angvel * duration,
            ..*motion
        });
        let [MovingShape { shape: g1, .. }, MovingShape { shape: g2, .. }] = sides;
        let sides = [
            MovingShape { motion: &motion1, shape: g1 },
            MovingShape { motion: &motion2, shape: g2 },
        ];
        let hit = cast((root, inner), sides, (0.0, 1.0), start)?;
        let at = |share: Real| start_time + share * duration;
        return Ok(hit.map(|hit| ShapeCastHit { time_of_impact: at(hit.time_of_impact), ..hit }));
    }
    let [MovingShape { motion: motion1, .. }, MovingShape { motion: motion2, .. }] = sides;
    let thin = ThinShape::of(sides[0].shape, sides[1].shape);
    let [g1, g2] = thin.pair(sides[0].shape, sides[1].shape);
    let times = (start_time, end_time);
    if let Some(hit) = link_cast::cast(root, (motion1, g1), (motion2, g2), times, start)? {
        return Ok(hit);
    }
    let stops = start == StartContact::Stops;
    match Decomposition::of(g1, g2)? {
        Some(Decomposition::Composite(parts)) => {
            height_field::cast_parts_nonlinear(root, (motion1, parts), (motion2, g2), times, stops)
        }
        Some(Decomposition::Field(field)) => {
            height_field::cast_nonlinear(root, (motion1, field), (motion2, g2), times, stops)
        }
        Some(Decomposition::OfSecond) => {
            let sides = [
                MovingShape { motion: motion2, shape: g2 },
                MovingShape { motion: motion1, shape: g1 },
            ];
            Ok(cast((root, inner), sides, times, start)?.map(ShapeCastHit::swapped))
        }
        None => inner.cast_shapes_nonlinear(motion1, g1, motion2, g2, 0.0, 1.0, stops),
    }
}
