//! The shape in which a robot is looked at.

use super::approach_bound::{half_length, midpoint};
use crate::robot::{Motion, MotionDrift, RobotError, SectionSignature, Tube};
use parry3d_f64::math::{Pose, Real};

/// The present shape of a robot that moves, in memory that is used again.
#[derive(Clone, Debug)]
pub(super) struct CurrentShape {
    pub tube: Tube,
    sections: SectionSignature,
}

impl Default for CurrentShape {
    fn default() -> Self {
        Self { tube: Tube::empty(), sections: SectionSignature::default() }
    }
}

impl CurrentShape {
    /// Forgets the sections of an earlier motion.
    pub(super) fn forget(&mut self) {
        self.sections.clear();
    }

    /// Turns to the shape at `t`.
    ///
    /// # Errors
    /// There is none, or its sections are others than before.
    pub(super) fn set_time<M: Motion>(&mut self, motion: &M, t: Real) -> Result<Pose, RobotError> {
        // Only what this shape states counts.
        self.tube.forget_error();
        let pose = motion.shape(t, &mut self.tube)?;
        self.sections.check(t, &self.tube)?;
        Ok(pose)
    }

    /// Tells which flat ends stay flat between two times, of which this is the middle shape. By how
    /// much those move that may not is returned.
    pub(super) fn mark_lasting_faces_between<M: Motion>(
        &mut self,
        motion: &M,
        times: [Real; 2],
    ) -> Real {
        self.tube.mark_lasting_faces_between(&MotionDrift {
            motion,
            times,
            t: midpoint(times),
            half_length: half_length(times),
        })
    }
}
