//! The properties of a robot that must stay constant during a motion.

use crate::curve::{CapPersistence, Tube};
use crate::robot::RobotError;
use parry3d_f64::math::Real;

/// The sections of the shapes so far: their radii, and which of their ends are always flat. `None`
/// for an end whose cap is not yet known or does not matter.
#[derive(Clone, Debug, Default)]
pub(crate) struct SectionSignature(Vec<(Real, [Option<bool>; 2])>);

impl SectionSignature {
    pub(crate) fn clear(&mut self) {
        self.0.clear();
    }

    /// Records the first shape and compares every later shape with it.
    ///
    /// # Errors
    /// The shape at `t` has different sections.
    pub(crate) fn check(&mut self, t: Real, tube: &Tube) -> Result<(), RobotError> {
        let found = tube.sections().iter().map(|section| {
            // Two kinds of end are not compared: a face that may lose its direction may be round in
            // other shapes, and a section without length has no face.
            let lasts = |end: usize| match section.faces[end].map(|face| face.persistence) {
                Some(CapPersistence::Never) => None,
                _ if section.fades => None,
                None if section.start == section.end => None,
                persistence => Some(persistence == Some(CapPersistence::Always)),
            };
            (section.radius, [lasts(0), lasts(1)])
        });
        if self.0.is_empty() {
            self.0.extend(found);
            return Ok(());
        }
        let is_same = |one: Option<bool>, other: Option<bool>| {
            one.is_none() || other.is_none() || one == other
        };
        let mut count = 0;
        for ((radius, ends), known) in found.zip(&mut self.0) {
            if radius != known.0 || !(0..2).all(|end| is_same(ends[end], known.1[end])) {
                return Err(RobotError::SectionsChange { t });
            }
            known.1 = [0, 1].map(|end| known.1[end].or(ends[end]));
            count += 1;
        }
        if count != self.0.len() || tube.sections().len() != count {
            return Err(RobotError::SectionsChange { t });
        }
        Ok(())
    }
}
