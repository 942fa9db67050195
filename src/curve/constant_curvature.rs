//! A robot of sections of constant curvature as a tube.

use super::{Tube, TubeSection};
use crate::robot::{Arc, BendingSection, ConstantCurvature, RobotError};
use parry3d_f64::math::{Real, Vector};

impl ConstantCurvature {
    /// Returns the robot as a curve.
    ///
    /// # Errors
    /// A section with a flat end whose curvature times radius is 1 or more; a section that ends out
    /// of range.
    pub fn tube(&self) -> Result<Tube, RobotError> {
        self.clone().into_tube()
    }

    pub(crate) fn into_tube(self) -> Result<Tube, RobotError> {
        let sections: Vec<_> = self.arcs.iter().map(|arc| stated(&arc.section)).collect();
        Tube::from_function(&sections, move |arc_length| {
            let frame = self.frame(arc_length);
            (frame.translation, frame.rotation * Vector::Z)
        })
    }

    /// Returns the point at `share` (0 to 1) of a section, or the base if there is no such section.
    pub(crate) fn at_share(&self, section: usize, share: Real) -> Vector {
        let point = |arc: &Arc| arc.frame(arc.start + arc.section.length * share).translation;
        self.arcs.get(section).map_or(Vector::ZERO, point)
    }
}

/// Returns the section in the form that a tube takes: curvature without direction.
fn stated(section: &BendingSection) -> TubeSection {
    TubeSection { length: section.length, radius: section.radius, curvature: section.curvature() }
}
