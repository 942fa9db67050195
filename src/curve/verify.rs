//! Tests whether a function fulfils the promises that its tube relies on.

use super::curve::Curve;
use super::{Section, Tube};
use crate::distance::Scalar;
use crate::robot::RobotError;
use parry3d_f64::math::Real;

impl Tube {
    /// Tests the curve of [`from_function`](Self::from_function) at `steps` even steps per section.
    ///
    /// A tube of samples passes without a test. For a function c with the stated curvature k and
    /// the step h, each test allows for rounding and for the stated error:
    ///
    /// 1. The curve is finite.
    /// 2. It bends at most as stated: `|c(s + h) - 2 c(s) + c(s - h)| <= k h^2`.
    /// 3. Its argument is the arc length:
    ///    `h (1 - (k h)^2 / 24) <= |c(s + h) - c(s)| <= h`.
    /// 4. Its direction is that of the points:
    ///    `|c'(s) - (c(s + h) - c(s - h)) / (2 h)| <= k h / 2`.
    ///
    /// # Errors
    /// The first arc length at which a test fails.
    pub fn verify(&self, steps: u32) -> Result<(), RobotError> {
        let Curve::Function(curve) = &self.curve else { return Ok(()) };
        for section in &self.sections {
            let &Section { start, end, curvature, .. } = section;
            let h = (end - start) / Real::from(steps.max(1)) * 0.5;
            let rounding = 64.0 * Real::UNIT_ROUNDOFF * self.reach + 4.0 * self.error();
            for step in 0..steps.max(1) {
                let arc_length = start + (2.0 * Real::from(step) + 1.0) * h;
                let [before, here, behind] =
                    [arc_length - h, arc_length, arc_length + h].map(|s| curve(s));
                if ![before, here, behind]
                    .iter()
                    .all(|(point, tangent)| point.is_finite() && tangent.is_finite())
                {
                    return Err(RobotError::CurveNotFinite { arc_length });
                }
                let bend = (behind.0 - here.0 * 2.0 + before.0).length();
                if bend > curvature * h * h + rounding {
                    let (found, stated) = (bend / (h * h), curvature);
                    return Err(RobotError::BendsMoreThanStated { arc_length, found, stated });
                }
                let ahead = (behind.0 - here.0).length();
                let least = h * (1.0 - (curvature * h).powi(2) / 24.0);
                if !(least - rounding..=h + rounding).contains(&ahead) {
                    return Err(RobotError::NotByArcLength { arc_length, speed: ahead / h });
                }
                let off = (here.1.normalize() - (behind.0 - before.0) / (2.0 * h)).length();
                if off.is_nan() || off > 0.5 * curvature * h + rounding / h {
                    return Err(RobotError::TangentOff { arc_length, off });
                }
            }
        }
        Ok(())
    }
}
