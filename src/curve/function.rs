//! A tube whose centreline is a function of arc length.

use super::centreline::{Curve, TICKS};
use super::section::{CapPersistence, EndFace, Section};
use super::{Tube, check_faces};
use crate::distance::Scalar;
use crate::robot::{RobotError, check_place, check_sections, direction};
use parry3d_f64::math::{Real, Vector};
use std::sync::Arc;

/// A section of a tube with one radius, for [`Tube::from_function`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TubeSection {
    /// Arc length of the centreline, in the tube's unit.
    pub length: Real,
    /// Radius of the tube, in the same unit.
    pub radius: Real,
    /// An upper bound on the curvature of the centreline, 1 / length.
    pub curvature: Real,
}

impl Tube {
    /// Builds the tube around a curve that is evaluated on demand.
    ///
    /// - `sections`: lengths, radii and curvature bounds, base to tip.
    /// - `curve`: maps an arc length, from 0 to the sum of the sections' lengths, to the point in
    ///   the robot's frame and the direction (of any length).
    ///
    /// The direction must be continuous. Within a section it must turn by at most the section's
    /// curvature times arc length. Answers rely on this promise; [`verify`](Self::verify) tests it.
    ///
    /// ```
    /// use parry_continuum::{Tube, TubeSection, parry::math::Vector};
    ///
    /// let section = TubeSection { length: 20.0, radius: 1.0, curvature: 0.05 };
    /// let tube = Tube::from_function(&[section], |s| {
    ///     let (sin, cos) = (0.05 * s).sin_cos();
    ///     (Vector::new(1.0 - cos, 0.0, sin) * 20.0, Vector::new(sin, 0.0, cos))
    /// })?;
    /// tube.verify(100)?;
    /// # Ok::<(), parry_continuum::RobotError>(())
    /// ```
    ///
    /// # Errors
    /// - no section;
    /// - a length that is not positive, a negative radius or curvature, or a number that is not
    ///   finite;
    /// - a curve that is not finite or out of range at the end of a section;
    /// - a section with a flat end whose curvature times radius is 1 or more.
    pub fn from_function(
        sections: &[TubeSection],
        curve: impl Fn(Real) -> (Vector, Vector) + Send + Sync + 'static,
    ) -> Result<Self, RobotError> {
        let numbers = |given: &TubeSection| [given.length, given.radius, given.curvature];
        check_sections("sections", sections.iter().map(numbers))?;
        let mut tube = Self::empty();
        let mut start = 0.0;
        for (index, given) in sections.iter().enumerate() {
            let end = start + given.length;
            let face = |end: usize, arc_length: Real| {
                let (centre, tangent) = curve(arc_length);
                check_place("curve", index, centre)?;
                if !(tangent.length_squared() > 0.0 && tangent.is_finite()) {
                    return Err(RobotError::BadTangent {
                        parameter: "curve",
                        index,
                        value: tangent,
                    });
                }
                let outward = direction(if end == 0 { -tangent } else { tangent });
                Ok(Some(EndFace {
                    centre,
                    outward,
                    tilt: 0.0,
                    persistence: CapPersistence::Either,
                }))
            };
            // Covers the rounding of the sections' ends.
            let curvature = given.curvature * (1.0 + 8.0 * Real::UNIT_ROUNDOFF);
            tube.sections.push(Section {
                first: 0,
                last: TICKS,
                start,
                end,
                radius: given.radius,
                curvature,
                mean_curvature: curvature,
                curvature_at: [curvature; 2],
                shown_at: [curvature; 2],
                is_even: true,
                stretch: 1.0 + 8.0 * Real::UNIT_ROUNDOFF,
                // Both flat at first; round ends are removed below.
                faces: [face(0, start)?, face(1, end)?],
                fades: false,
            });
            start = end;
        }
        let ends = tube
            .sections
            .iter()
            .flat_map(|section| section.faces)
            .flatten()
            .map(|face| face.centre);
        tube.reach = ends.fold(0.0, |reach, point| point.abs().max_element().max(reach)) + start;
        for end in [0, 1] {
            tube.walk(end, |tube, number, limit| {
                let face = tube.sections[number].faces[end];
                let is_flat = |face: &EndFace| tube.is_flat(end, number, limit, face.centre);
                tube.sections[number].faces[end] = face.filter(is_flat);
            });
        }
        for (index, section) in tube.sections.iter().enumerate() {
            check_faces(section, || index)?;
        }
        tube.mark_persistent_faces();
        tube.curve = Curve::Function(Arc::new(curve));
        Ok(tube)
    }
}

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
