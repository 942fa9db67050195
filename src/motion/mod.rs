//! Motions: a robot whose shape depends on time, with bounds on how fast its points move.

mod bending;
mod carried_motion;
mod common_frame;
#[cfg(test)]
mod displacement_bound_tests;
mod linear;
mod motion_path;
mod moving_base;
mod rigid;
mod rigid_path;
mod sampled_shape;
mod section_signature;
mod shape_path;
mod speed;
#[cfg(test)]
mod tests;
mod verify;

pub use bending::{BendingMotion, BendingRates, bending_displacement, bending_speed};
pub(crate) use carried_motion::{CarriedMotion, CarriedPiece, FramePair};
pub use common_frame::CommonFrame;
pub use linear::LinearMotion;
pub use motion_path::MotionPath;
pub use moving_base::MovingBase;
pub use rigid::RigidMotion;
#[cfg(feature = "robots")]
pub(crate) use rigid_path::RigidPath;
pub(crate) use section_signature::{MotionDrift, SectionSignature};
pub(crate) use shape_path::ShapePath;
pub(crate) use speed::check_speed;
pub use speed::{DisplacementBound, Speed};
pub use verify::verify_motion;

use crate::curve::Tube;
use crate::robot::RobotError;
use parry3d_f64::math::{Pose, Real};

/// A motion: the robot's shape and pose at each time t from 0 to 1, with an upper bound on its
/// speed.
///
/// Ready to use: [`LinearMotion`], [`RigidMotion`] and [`BendingMotion`]. [`MovingBase`] moves the
/// base of any motion, and [`MotionPath`] joins motions in sequence. For a motion of your own,
/// implement `shape` and `speed`. Proofs about a motion rely on the bounds that it states, so let
/// your tests check them with [`verify_motion`].
///
/// Two shapes of a motion must be comparable:
///
/// - They have the same number of sections with the same radii. A section that is not extended yet
///   has a tiny length.
/// - A point of the centreline is identified at all times by its section and its share of the
///   section's length.
/// - Ends that are flat because of the radii stay flat: the robot's two ends, and the wider side of
///   each step in radius. So the cap model must stay the same; a change from capsules to fitted
///   caps, for example, is refused. Other ends may become flat or round.
/// ```
/// use parry_continuum::parry::math::{Pose, Real, Vector};
/// use parry_continuum::{Motion, RobotError, Speed, Tube, verify_motion};
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
///         // The curvature grows by 0.02. At s from the base this turns the needle by 0.02 s
///         // and moves it by half of that times s.
///         let s = 30.0 * shares[1];
///         Speed { point: 0.01 * s * s, turn: 0.02 * s }
///     }
/// }
///
/// verify_motion(&Bending, 100)?;
/// # Ok::<(), RobotError>(())
/// ```
pub trait Motion {
    /// Writes the robot's shape at time `t` to `tube` and returns its pose in the mesh's frame.
    ///
    /// `tube` holds an earlier shape. [`Tube::set_samples`] and [`Tube::set_chain`] reuse its
    /// memory. Errors stated by [`Tube::with_error`] are removed before the call: each shape states
    /// its own.
    ///
    /// # Errors
    /// The shape does not exist. Kinematics that fail return [`RobotError::NoShape`]. Queries pass
    /// the error on.
    fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError>;

    /// Returns upper bounds on the linear and angular speed of the centreline in the mesh's frame.
    ///
    /// The bounds hold for every place between two shares of a section's length, at every time
    /// between two times. Shares and times are from 0 to 1, the lower one first; they may be equal.
    /// A bound that is too large costs time. A bound that is too small makes answers wrong.
    fn speed(&self, section: usize, shares: [Real; 2], times: [Real; 2]) -> Speed;

    /// Returns a bound on the displacement of the centreline in the mesh's frame, if more is known
    /// than its speed.
    ///
    /// The bound covers the places between two shares of a section's length, from one time to
    /// another; arguments as for [`speed`](Self::speed). The default is `None`.
    ///
    /// With it, [`clears_motion`](crate::proximity::BvhSearch::clears_motion) and similar queries
    /// need fewer shapes: a piece that moves along the wall, or away from it, does not count as
    /// moving towards it. All ready motions know their displacements. [`bending_displacement`]
    /// helps for sections of constant curvature. A wrong bound makes answers wrong. A bound that is
    /// not finite, or whose `off` is negative, is ignored.
    ///
    /// A motion that wraps another may pass its bound on if it keeps time and place.
    fn displacement(
        &self,
        section: usize,
        shares: [Real; 2],
        times: [Real; 2],
    ) -> Option<DisplacementBound> {
        let _ = (section, shares, times);
        None
    }

    /// Returns a rigid frame that carries the whole robot from one time to another, if the motion
    /// knows one. The default is `None`.
    ///
    /// Two robots that move in the same way, or a robot and its mesh, are then compared in that
    /// frame: what they do together brings them no nearer. A motion that states a frame also states
    /// its speed relative to the frame ([`speed_in_frame`](Self::speed_in_frame)). For the same
    /// times it always states the same frame.
    ///
    /// [`RigidMotion`] and [`MovingBase`] state the frame that they move, [`LinearMotion`] a shift
    /// that all its points share, and [`MotionPath`] what the current motion states.
    fn common_frame(&self, times: [Real; 2]) -> Option<CommonFrame> {
        let _ = times;
        None
    }

    /// Returns upper bounds on the speed relative to [`common_frame`](Self::common_frame) of the
    /// same times; arguments as for [`speed`](Self::speed).
    ///
    /// `point` bounds the velocity of the centreline less the velocity of the frame at the same
    /// place, `turn` the angular speed of its direction seen from the frame. Asked only if there is
    /// a frame. The default is infinite, which queries refuse.
    fn speed_in_frame(&self, section: usize, shares: [Real; 2], times: [Real; 2]) -> Speed {
        let _ = (section, shares, times);
        Speed { point: Real::INFINITY, turn: Real::INFINITY }
    }

    /// Returns the number of equal parts into which queries divide time first: 1, except for a path
    /// of several motions. A motion that wraps another passes its value on.
    fn time_parts(&self) -> usize {
        1
    }
}

/// A reference to a motion is that motion.
impl<M: Motion + ?Sized> Motion for &M {
    fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
        (**self).shape(t, tube)
    }

    fn speed(&self, section: usize, shares: [Real; 2], times: [Real; 2]) -> Speed {
        (**self).speed(section, shares, times)
    }

    fn displacement(
        &self,
        section: usize,
        shares: [Real; 2],
        times: [Real; 2],
    ) -> Option<DisplacementBound> {
        (**self).displacement(section, shares, times)
    }

    fn common_frame(&self, times: [Real; 2]) -> Option<CommonFrame> {
        (**self).common_frame(times)
    }

    fn speed_in_frame(&self, section: usize, shares: [Real; 2], times: [Real; 2]) -> Speed {
        (**self).speed_in_frame(section, shares, times)
    }

    fn time_parts(&self) -> usize {
        (**self).time_parts()
    }
}
