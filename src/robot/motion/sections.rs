//! What must stay the same during a motion.

use crate::robot::{Lasting, RobotError, Tube};
use parry3d_f64::math::Real;

/// The sections of the shapes so far: their radii, and which of their ends are always flat.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sections(Vec<(Real, [bool; 2])>);

impl Sections {
    pub(crate) fn clear(&mut self) {
        self.0.clear();
    }

    /// Takes note of the first shape, and compares the others with it.
    ///
    /// # Errors
    /// The shape at `t` has other sections.
    pub(crate) fn check(&mut self, t: Real, tube: &Tube) -> Result<(), RobotError> {
        let found = tube.sections().iter().map(|section| {
            let lasts = |end: usize| section.faces[end].is_some_and(|face| face.lasting == Lasting::Always);
            (section.radius, [lasts(0), lasts(1)])
        });
        if self.0.is_empty() {
            self.0.extend(found);
        } else if !found.eq(self.0.iter().copied()) {
            return Err(RobotError::SectionsChange { t });
        }
        Ok(())
    }
}
