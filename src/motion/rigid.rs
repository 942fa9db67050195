//! The motion of a tube of constant shape, carried by a frame from one pose to another.

use super::rigid_path::RigidPath;
use super::{CommonFrame, DisplacementBound, Motion, Speed};
use crate::curve::Tube;
use crate::robot::RobotError;
use parry3d_f64::math::{Pose, Real};

/// The motion of a tube of constant shape from one pose to another.
///
/// The robot's origin moves straight at constant speed. The robot turns at constant speed about one
/// axis, by the smaller angle. Poses are the tube's poses in the mesh's frame.
///
/// ```
/// use parry_continuum::{Chain, RigidMotion, Tube, verify_motion};
/// use parry_continuum::parry::math::{Pose, Vector};
///
/// let needle = Chain::capsules(&[Vector::ZERO, 40.0 * Vector::Z], &[0.5])?;
/// let motion = RigidMotion::new(
///     Tube::from(&needle),
///     [Pose::IDENTITY, Pose::new(Vector::Z, Vector::X * 0.3)],
/// )?;
/// verify_motion(&motion, 100)?;
/// # Ok::<(), parry_continuum::RobotError>(())
/// ```
#[derive(Clone, Debug)]
pub struct RigidMotion {
    tube: Tube,
    path: RigidPath,
}

impl RigidMotion {
    /// Builds the motion of `tube` from the first pose to the second.
    ///
    /// # Errors
    /// A pose is not finite or out of range, or its quaternion is not of unit length.
    pub fn new(mut tube: Tube, poses: [Pose; 2]) -> Result<Self, RobotError> {
        tube.mark_constant_faces();
        Ok(Self { tube, path: RigidPath::new(poses)? })
    }
}

impl Motion for RigidMotion {
    fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
        tube.clone_from(&self.tube);
        Ok(self.path.pose(t))
    }

    fn speed(&self, section: usize, shares: [Real; 2], _times: [Real; 2]) -> Speed {
        self.path.speed(&self.tube, &Pose::IDENTITY, section, shares)
    }

    fn displacement(
        &self,
        section: usize,
        shares: [Real; 2],
        times: [Real; 2],
    ) -> Option<DisplacementBound> {
        self.path.displacement(&self.tube, section, shares, times)
    }

    fn common_frame(&self, times: [Real; 2]) -> Option<CommonFrame> {
        Some(CommonFrame::of_path(&self.path, 0.5 * times[0] + 0.5 * times[1]))
    }

    /// The tube is at rest in its frame.
    fn speed_in_frame(&self, _: usize, _: [Real; 2], _: [Real; 2]) -> Speed {
        Speed { point: 0.0, turn: 0.0 }
    }
}
