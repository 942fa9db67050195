//! Any motion whose base moves as well.
//!
//! In the frame of its base a point moves by p(t), at most at the speed that the motion states
//! there; the frame itself goes along a path (`rigid_path`): it turns about an axis a by the angle
//! w in all and moves by v. In the mesh's frame the point then moves at v + R (w a x p + p'), which
//! is at most |v| + w |a x p| + |p'|, and a direction turns at w and what the motion states.
//!
//! How far p is from the axis is known of the motion's shapes at three times. Until another time it
//! moves away by no more than the motion moves it in between: by its stated speed between the two
//! times, times how far they are apart. Two distances from a line differ by no more than the points
//! are apart. Of the three bounds the least counts.
//!
//! **Courses.** Let the motion know that from one time to another, T apart, p goes from p0 by m but
//! for e, which is at most `off`. With p1 = p0 + m the point goes by the way b1 - b0 + R1 p1 - R0
//! p0, linear in p0 and m. What moves at p0 + q m evenly in the frame has the acceleration R (w a x
//! (w a x p) + 2 w a x m), so it is at most (s^2 |a x p| + 2 s |m|) / 8 off that way, for the turn
//! s = w T; p is off by e besides, which counts once, and s times where it is turned. From the end
//! it is the same, but p1 may be off by e, whose turn counts once more. Where p0 is, is known from
//! the nearest of the three shapes and the course since; what that is off counts s times.

use super::rigid_path::RigidPath;
use super::{Course, Motion, Speed, rigid_pose};
use crate::distance::Scalar;
use crate::robot::{RobotError, Tube};
use parry3d_f64::math::{Pose, Real, Vector};

/// A motion whose base is moved at the same time, evenly from one pose to another: what a robot
/// does that is pushed or turned while its sections bend and grow.
///
/// The motion is any one without a jump, and its poses are in the frame of the base. The base's
/// origin moves straight and evenly while the base turns evenly about one axis by the lesser angle,
/// as in a [`RigidMotion`](crate::RigidMotion).
///
/// ```
/// use parry_continuum::{BendingMotion, BendingSection, MovingBase, parry::math::{Pose, Vector}, verify_motion};
///
/// let straight = BendingSection { length: 30.0, radius: 1.0, bend: [0.0, 0.0] };
/// let bent = BendingSection { length: 32.0, radius: 1.0, bend: [0.03, 0.01] };
/// let bending = BendingMotion::new(&[straight], &[bent], Pose::IDENTITY)?;
/// // Pushed by 5 and rolled by 1 rad.
/// let pushed = Pose::new(Vector::Z * 5.0, Vector::Z);
/// let motion = MovingBase::new(bending, [Pose::IDENTITY, pushed])?;
/// verify_motion(&motion, 100)?;
/// # Ok::<(), parry_continuum::RobotError>(())
/// ```
#[derive(Clone, Debug)]
pub struct MovingBase<M> {
    motion: M,
    path: RigidPath,
    /// Shapes of the motion in the frame of the base, at some times.
    known: Vec<(Real, Tube, Pose)>,
}

/// When shapes are known.
const KNOWN_AT: [Real; 3] = [0.0, 0.5, 1.0];

impl<M: Motion> MovingBase<M> {
    /// The motion of a robot whose base goes from the first pose to the second, in the mesh's
    /// frame.
    ///
    /// # Errors
    /// A pose, of the base or of the motion, is not finite or out of range, or its rotation is not
    /// of unit length; or the motion has no shape at its beginning, in its middle or at its
    /// end.
    pub fn new(motion: M, [from, to]: [Pose; 2]) -> Result<Self, RobotError> {
        let path = RigidPath::new([from, to])?;
        let shape = |t: Real| {
            let mut tube = Tube::empty();
            let pose = rigid_pose("motion", &motion.shape(t, &mut tube)?)?;
            Ok((t, tube, pose))
        };
        let known = KNOWN_AT.map(shape).into_iter().collect::<Result<_, RobotError>>()?;
        Ok(Self { motion, path, known })
    }

    /// How fast the base carries a piece of the robot.
    fn carried(&self, section: usize, shares: [Real; 2], times: [Real; 2]) -> Speed {
        let bounds = self.known.iter().map(|(at, tube, pose)| {
            let Speed { point, turn } = self.path.speed(tube, pose, section, shares);
            // Until the time that is farthest from it.
            let apart = (at - times[0]).max(times[1] - at).max(0.0);
            let since = self.motion.speed(section, shares, [times[0].min(*at), times[1].max(*at)]);
            Speed { point: point + self.path.angle() * since.point * apart, turn }
        });
        let none = Speed { point: Real::INFINITY, turn: Real::INFINITY };
        bounds.fold(none, |least, bound| if bound.point < least.point { bound } else { least })
    }

    /// Where the ends of a piece are in the frame of the base at a time, and how far any point of
    /// it may be off what is between.
    fn place(&self, section: usize, shares: [Real; 2], t: Real) -> Option<([Vector; 2], Real)> {
        let nearest = self.known.iter().min_by(|a, b| (a.0 - t).abs().total_cmp(&(b.0 - t).abs()));
        let (at, tube, pose) = nearest?;
        let off = RigidPath::beside(tube, tube.sections().get(section)?, shares);
        let known =
            shares.map(|share| *pose * tube.at_share(&tube.sections()[section], share).point);
        if *at == t {
            return Some((known, off));
        }
        let since = self.motion.course(section, shares, [at.min(t), at.max(t)])?;
        let sign = if *at < t { 1.0 } else { -1.0 };
        Some(([0, 1].map(|end| known[end] + since.ways[end] * sign), off + since.off))
    }
}

impl<M: Motion> Motion for MovingBase<M> {
    fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
        let pose = rigid_pose("motion", &self.motion.shape(t, tube)?)?;
        let base = self.path.pose(t);
        let rotation = (base.rotation * pose.rotation).normalize();
        Ok(Pose::from_parts(base.translation + base.rotation * pose.translation, rotation))
    }

    fn speed(&self, section: usize, shares: [Real; 2], times: [Real; 2]) -> Speed {
        let (carried, own) =
            (self.carried(section, shares, times), self.motion.speed(section, shares, times));
        // A few roundings of numbers that are added up here.
        let up = 1.0 + 16.0 * Real::UNIT_ROUNDOFF;
        Speed { point: (carried.point + own.point) * up, turn: (carried.turn + own.turn) * up }
    }

    fn course(&self, section: usize, shares: [Real; 2], times: [Real; 2]) -> Option<Course> {
        let inner = self.motion.course(section, shares, times)?;
        let (place, since) = self.place(section, shares, times[0])?;
        let poses = times.map(|t| self.path.pose(t));
        let apart = times[1] - times[0];
        let turn = self.path.angle() * apart;
        let ways =
            [0, 1].map(|end| poses[1] * (place[end] + inner.ways[end]) - poses[0] * place[end]);
        let turning = self.path.of_turning(self.carried(section, shares, times).point) * apart;
        let own = inner.ways[0].length().max(inner.ways[1].length());
        let bow = 0.125 * turn * (turning + turn * inner.off + 2.0 * own);
        let places = poses.iter().flat_map(|pose| place.map(|place| *pose * place)).chain(place);
        let reach = places.fold(own, |most: Real, p| most.max(p.abs().max_element()));
        let rounding = 64.0 * Real::UNIT_ROUNDOFF * reach;
        let off = inner.off * (1.0 + 2.0 * turn) + bow + turn * since + rounding;
        Some(Course { ways, off: off * (1.0 + 16.0 * Real::UNIT_ROUNDOFF) })
    }

    fn legs(&self) -> usize {
        self.motion.legs()
    }
}
