//! A robot that changes with time: its shapes, and bounds on how fast its points move.

mod bending;
mod course;
#[cfg(test)]
mod course_tests;
mod drift;
mod linear;
mod motion_path;
mod moving_base;
mod rigid;
mod rigid_path;
mod sampled_shape;
mod section_signature;
mod shape_path;
#[cfg(test)]
mod tests;
mod verify;

pub use bending::{BendingMotion, BendingRates, bending_course, bending_speed};
pub use course::Course;
pub(crate) use drift::MotionDrift;
pub use linear::LinearMotion;
pub use motion_path::MotionPath;
pub use moving_base::MovingBase;
pub use rigid::RigidMotion;
pub(crate) use section_signature::SectionSignature;
pub(crate) use shape_path::ShapePath;
pub use verify::verify_motion;

use super::{COORDINATE_LIMIT, NotRigid, RobotError, Tube, rigid};
use parry3d_f64::math::{Pose, Real};

/// A motion: the robot's shape and pose at each time t from 0 to 1, and an upper bound on how fast
/// it moves.
///
/// [`LinearMotion`], [`RigidMotion`] and [`BendingMotion`] are ready to use; [`MovingBase`] moves
/// the base of any of them, and [`MotionPath`] puts them one after another. For a motion of your
/// own, implement the first two methods. What is proven of a motion relies on the bounds that it
/// states, so let your tests check them by [`verify_motion`].
///
/// Two shapes of a motion must be comparable:
///
/// - They have the same number of sections, with the same radii. A section that is not extended yet
///   has a tiny length.
/// - A point of the centreline is the same point at all times if it is in the same section, at the
///   same share of the section's length.
/// - The flat ends stay flat: the robot's two ends, and the wider side of each step in radius. So
///   the model may not change on the way, from capsules to fitted caps for example.
///
/// ```
/// use parry_continuum::{Motion, RobotError, Speed, Tube, parry::math::{Pose, Real, Vector}, verify_motion};
///
/// /// A straight needle of 30 mm that bends to an arc of 0.02 / mm, 40 points along it.
/// struct Bending;
///
/// impl Motion for Bending {
///     fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
///         let curvature = 0.02 * t.max(1e-9);
///         let point = |k: u32| {
///             let (sin, cos) = (curvature * 30.0 * Real::from(k) / 40.0).sin_cos();
///             Vector::new((1.0 - cos) / curvature, 0.0, sin / curvature)
///         };
///         tube.set_samples(&(0..=40).map(point).collect::<Vec<_>>(), &[0.5; 40], None)?;
///         Ok(Pose::IDENTITY)
///     }
///
///     fn speed(&self, _section: usize, shares: [Real; 2], _times: [Real; 2]) -> Speed {
///         // The curvature changes by 0.02 in all: s from the base that turns the needle by 0.02 s, and moves it by half of that times s.
///         let s = 30.0 * shares[1];
///         Speed { point: 0.01 * s * s, turn: 0.02 * s }
///     }
/// }
///
/// verify_motion(&Bending, 100)?;
/// # Ok::<(), RobotError>(())
/// ```
pub trait Motion {
    /// Makes `tube` the robot's shape at time `t`, and gives its pose in the mesh's frame.
    ///
    /// `tube` holds an earlier shape. [`Tube::set_samples`] and [`Tube::set_chain`] reuse its
    /// memory. An error that was stated by [`Tube::with_error`] is dropped before the call:
    /// each shape states its own.
    ///
    /// # Errors
    /// There is no such shape. [`RobotError::NoShape`] is for kinematics that fail. Queries pass
    /// the error on.
    fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError>;

    /// Upper bounds on how fast the centreline moves and turns, in the mesh's frame: between two
    /// shares of a section's length, and between two times.
    ///
    /// Shares and times are from 0 to 1, the lower one first, and the two may be equal. A bound
    /// that is too large costs time. One that is too small makes answers wrong.
    fn speed(&self, section: usize, shares: [Real; 2], times: [Real; 2]) -> Speed;

    /// Where the centreline goes, in the mesh's frame, between two shares of a section's length and
    /// between two times: if more is known of it than its speed.
    ///
    /// None by default. With it, [`clears_motion`](crate::proximity::BvhSearch::clears_motion) and
    /// the questions like it need fewer shapes: a piece that moves along the wall does not
    /// count as if it moved towards it, nor one that moves away. All ready motions know their
    /// courses; [`bending_course`] helps where sections have a constant curvature. A course that is
    /// wrong makes answers wrong. One that is not finite, or whose `off` is below 0, counts as
    /// none.
    ///
    /// Shares and times are as for [`speed`](Self::speed). What wraps a motion may pass its courses
    /// on if it does not change time or place.
    fn course(&self, section: usize, shares: [Real; 2], times: [Real; 2]) -> Option<Course> {
        let _ = (section, shares, times);
        None
    }

    /// Into how many parts of the same length queries divide time from the beginning: 1, but for a
    /// path of many motions. What wraps a motion passes its `legs` on.
    fn legs(&self) -> usize {
        1
    }
}

/// How fast a centreline moves, per unit of the motion's time. At a steady speed this is how far it
/// moves from t = 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Speed {
    /// The speed of its points, in units of length.
    pub point: Real,
    /// The speed at which its direction turns, in rad. Times the radius, this is how fast the rim
    /// of a disc moves relative to the disc's centre.
    pub turn: Real,
}

/// A speed or a turn that a motion states of a section.
///
/// # Errors
/// It is negative, infinite or NaN.
pub(crate) fn check_speed(section: usize, value: Real) -> Result<Real, RobotError> {
    // Written so that NaN is an error.
    if (0.0..Real::INFINITY).contains(&value) {
        Ok(value)
    } else {
        Err(RobotError::BadSpeed { section, value })
    }
}

/// The pose of a motion with a rotation of unit length, if it is finite, within range and rigid.
fn rigid_pose(parameter: &'static str, pose: &Pose) -> Result<Pose, RobotError> {
    // A rotation that is finite may still be too long: that is another error.
    let is_out = |place: &Real| !place.is_finite() || place.abs() > COORDINATE_LIMIT;
    let places = pose.translation.to_array().into_iter().filter(is_out);
    let parts = pose.rotation.to_array().into_iter().filter(|part| !part.is_finite());
    if let Some(value) = places.chain(parts).next() {
        return Err(RobotError::BadPose { parameter, value, limit: COORDINATE_LIMIT });
    }
    rigid(pose).map_err(|NotRigid { length }| RobotError::PoseNotRigid { parameter, length })
}
