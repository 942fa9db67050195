//! Whether a motion keeps to the speeds that it states.

use super::{Motion, Sections};
use crate::distance::Scalar;
use crate::robot::{RobotError, Tube};
use parry3d_f64::math::{Pose, Real, Vector};

/// Tries the speeds that a motion states, at `steps` even steps of its time and nine places in each section.
///
/// From one step to the next no point may move farther than its stated speed allows, and no direction may turn more. A
/// bound that is too low only for a moment, or only between two places, shows in steps that are fine enough. Where a tube
/// is given by samples, directions between them are only roughly known, and a turn must be so much larger to be found.
///
/// # Errors
/// The first time and place at which the motion is faster than stated, with both speeds; a shape that cannot be made; or
/// sections that change.
///
/// ```
/// use parry_continuum::{Motion, RobotError, Speed, Tube, parry::math::{Pose, Real, Vector}, verify_motion};
///
/// struct Sideways;
///
/// impl Motion for Sideways {
///     fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
///         tube.set_samples(&[Vector::ZERO, Vector::Z], &[0.1], None)?;
///         Ok(Pose::from_translation(Vector::X * t))
///     }
///     fn speed(&self, _: usize, _: [Real; 2], _: [Real; 2]) -> Speed {
///         Speed { point: 0.9, turn: 0.0 } // it moves by 1
///     }
/// }
///
/// assert!(matches!(verify_motion(&Sideways, 10), Err(RobotError::FasterThanStated { stated: 0.9, .. })));
/// ```
pub fn verify_motion(motion: &impl Motion, steps: u32) -> Result<(), RobotError> {
    let steps = steps.max(1);
    let (mut tube, mut sections) = (Tube::empty(), Sections::default());
    let (mut before, mut here) = (Sampled::default(), Sampled::default());
    for step in 0..=steps {
        let t = Real::from(step) / Real::from(steps);
        tube.forget_error();
        let pose = motion.shape(t, &mut tube)?;
        sections.check(t, &tube)?;
        std::mem::swap(&mut before, &mut here);
        here.take(t, &tube, &pose, 8);
        if step > 0 {
            here.check_from(&before, motion)?;
        }
    }
    Ok(())
}

/// Some places of a shape.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sampled {
    t: Real,
    places: Vec<Place>,
    /// What rounding can do to a point.
    rounding: Real,
}

#[derive(Clone, Copy, Debug)]
struct Place {
    section: usize,
    share: Real,
    point: Vector,
    /// How far off the point may be.
    error: Real,
    direction: Vector,
    /// How far off the direction may be.
    tilt: Real,
}

impl Sampled {
    /// Samples a shape at `parts` + 1 places in each section.
    pub(crate) fn take(&mut self, t: Real, tube: &Tube, pose: &Pose, parts: u32) {
        self.t = t;
        self.places.clear();
        let mut longest: Real = 0.0;
        for (number, section) in tube.sections().iter().enumerate() {
            longest = longest.max(section.end);
            for part in 0..=parts {
                let share = Real::from(part) / Real::from(parts);
                let (point, direction, tilt) = tube.at_share(section, share);
                self.places.push(Place {
                    section: number,
                    share,
                    point: pose * point,
                    error: section.deviation + tube.error(),
                    direction: pose.rotation * direction,
                    tilt: tilt + 32.0 * Real::UNIT_ROUNDOFF,
                });
            }
        }
        // As in queries: a placed point is off by less than 16 roundings of the largest coordinate; a place along the
        // curve by less than one of its length.
        let reach = pose.translation.abs().max_element() + 2.0 * tube.reach() + longest;
        self.rounding = 64.0 * Real::UNIT_ROUNDOFF * reach;
    }

    /// # Errors
    /// Something moved faster than stated on the way from another shape of the same sections.
    pub(crate) fn check_from(&self, before: &Self, motion: &impl Motion) -> Result<(), RobotError> {
        let (times, rounding) =
            ([before.t.min(self.t), before.t.max(self.t)], before.rounding + self.rounding);
        let apart = times[1] - times[0];
        if apart <= 0.0 {
            return Ok(());
        }
        for (from, to) in before.places.iter().zip(&self.places) {
            let &Place { section, share, .. } = to;
            let stated = motion.speed(section, [share; 2], times);
            let t = 0.5 * (times[0] + times[1]);
            let moved = (to.point - from.point).length() - rounding - from.error - to.error;
            // Written so that NaN is too low.
            let keeps = moved <= stated.point * apart;
            if !keeps {
                let (found, stated) = (moved / apart, stated.point);
                return Err(RobotError::FasterThanStated { t, section, share, found, stated });
            }
            // Without length there is no direction.
            if from.direction == Vector::ZERO || to.direction == Vector::ZERO {
                continue;
            }
            let turned = (to.direction - from.direction).length() - from.tilt - to.tilt;
            let keeps = turned <= stated.turn * apart;
            if !keeps {
                let (found, stated) = (turned / apart, stated.turn);
                return Err(RobotError::TurnsFasterThanStated { t, section, share, found, stated });
            }
        }
        Ok(())
    }
}
