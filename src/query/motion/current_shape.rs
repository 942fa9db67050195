//! The shape of a moving robot at the current time.

use super::approach_bound::midpoint;
use crate::curve::Tube;
use crate::motion::{CarriedMotion, Motion, MotionDrift, SectionSignature};
use crate::robot::RobotError;
use parry3d_f64::math::{Pose, Real};

/// The current shape of a moving robot; its memory is reused.
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

    /// Sets the shape to time `t` and returns its pose.
    ///
    /// # Errors
    /// The motion has no shape at `t`, or its sections differ from earlier ones.
    pub(super) fn set_time(&mut self, motion: &dyn Motion, t: Real) -> Result<Pose, RobotError> {
        // Only an error stated by this shape counts.
        self.tube.forget_error();
        let pose = motion.shape(t, &mut self.tube)?;
        self.sections.check(t, &self.tube)?;
        Ok(pose)
    }

    /// Marks the flat ends that stay flat in an interval, whose middle shape this is. Returns how
    /// far the other flat ends move. `turning`: an upper bound on the angular speed of the motion's
    /// frame, seen from the frame in which distances are bounded.
    pub(super) fn mark_lasting_faces_in(&mut self, motion: &CarriedMotion, turning: Real) -> Real {
        let t = midpoint(motion.times);
        self.tube.mark_lasting_faces_between(&MotionDrift { motion, t, turning })
    }
}
