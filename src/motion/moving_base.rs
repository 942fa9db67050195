//! A motion whose base moves as well.
//!
//! # Definitions
//! - `p(t)`: a point in the frame of the base; `p'`: its velocity there, bounded by the motion.
//! - The frame moves along a path (`rigid_path`): it turns about the axis a by the angle w in total
//!   and moves by v. R is its rotation.
//!
//! # Speed
//! In the mesh's frame the point has the velocity `v + R (w a x p + p')`, at most
//! `|v| + w |a x p| + |p'|`. A direction turns at most at the rate w plus the motion's own.
//!
//! The distance `|a x p|` from the axis is known from the motion's shapes at three times. Until
//! another time it changes by at most the motion's speed bound between the two times, times the
//! difference of the times: two distances from a line differ by at most the distance of the points.
//! The least of the three bounds counts.
//!
//! # Displacement
//! Let the motion move p from p0 by m, up to an error e with `|e| <= off`, from one time to
//! another, T apart. Let `s = w T` and `p1 = p0 + m`.
//!
//! 1. The point moves by `b1 - b0 + R1 p1 - R0 p0`, where b0 and b1 are the origins of the base.
//!    This is linear in p0 and m.
//! 2. A point at `p0 + q m` at the fraction q of the time has the acceleration
//!    `R (w a x (w a x p) + 2 w a x m)`. So it leaves the straight motion by at most
//!    `(s^2 |a x p| + 2 s |m|) / 8`.
//! 3. p is off by e in addition. This counts once, and s times because it is turned.
//! 4. From the end the same holds, but p1 may be off by e, whose turn counts once more.
//! 5. p0 is known from the nearest of the three shapes and the displacement since then. The error
//!    of p0 counts s times.

use super::rigid_path::RigidPath;
use super::rigid_path::rigid_pose;
use super::{CommonFrame, DisplacementBound, Motion, Speed};
use crate::curve::Tube;
use crate::distance::Scalar;
use crate::robot::{RobotError, length};
use parry3d_f64::math::{Pose, Real, Vector};

/// A motion whose base moves at the same time from one pose to another: a robot that is pushed or
/// turned while its sections bend and grow.
///
/// The inner motion must be continuous; its poses are in the frame of the base. The base's origin
/// moves straight at constant speed. The base turns at constant speed about one axis, by the
/// smaller angle, as in a [`RigidMotion`](crate::RigidMotion).
///
/// ```
/// use parry_continuum::parry::math::{Pose, Vector};
/// use parry_continuum::{BendingMotion, BendingSection, MovingBase, verify_motion};
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
    /// Shapes of the inner motion at some times, in the frame of the base.
    known: Vec<(Real, Tube, Pose)>,
}

/// The times of the known shapes.
const KNOWN_AT: [Real; 3] = [0.0, 0.5, 1.0];

impl<M: Motion> MovingBase<M> {
    /// Builds the motion of a robot whose base moves from the first pose to the second, in the
    /// mesh's frame.
    ///
    /// # Errors
    /// - a pose of the base or of the motion is not finite or out of range, or its quaternion is
    ///   not of unit length;
    /// - the motion has no shape at t = 0, 1/2 or 1.
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

    /// Returns the frame of the base, and that of the inner motion on it if it is known.
    fn frames(&self, times: [Real; 2]) -> (CommonFrame, Option<CommonFrame>) {
        let t = 0.5 * times[0] + 0.5 * times[1];
        let base = CommonFrame::of_path(&self.path, t);
        let half = 0.5 * (times[1] - times[0]) + 4.0 * Real::UNIT_ROUNDOFF;
        let inner = self.motion.common_frame(times);
        let on_base = inner.and_then(|inner| inner.on_base(&base, &self.path.pose(t), half));
        (base, on_base)
    }

    /// Returns the speed bound of a piece due to the base alone.
    fn carried(&self, section: usize, shares: [Real; 2], times: [Real; 2]) -> Speed {
        let bounds = self.known.iter().map(|(at, tube, pose)| {
            let Speed { point, turn } = self.path.speed(tube, pose, section, shares);
            // Up to the farther end of the interval.
            let apart = (at - times[0]).max(times[1] - at).max(0.0);
            let since = self.motion.speed(section, shares, [times[0].min(*at), times[1].max(*at)]);
            Speed { point: point + self.path.angle() * since.point * apart, turn }
        });
        let none = Speed { point: Real::INFINITY, turn: Real::INFINITY };
        bounds.fold(none, |least, bound| if bound.point < least.point { bound } else { least })
    }

    /// Returns the ends of a piece in the frame of the base at a time, and the largest distance of
    /// its points from the interpolation between them.
    fn place(&self, section: usize, shares: [Real; 2], t: Real) -> Option<([Vector; 2], Real)> {
        let nearest = self.known.iter().min_by(|a, b| (a.0 - t).abs().total_cmp(&(b.0 - t).abs()));
        let (at, tube, pose) = nearest?;
        let off = RigidPath::beside(tube, tube.sections().get(section)?, shares);
        let known =
            shares.map(|share| *pose * tube.at_share(&tube.sections()[section], share).point);
        if *at == t {
            return Some((known, off));
        }
        let since = self.motion.displacement(section, shares, [at.min(t), at.max(t)])?;
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
        // Covers a few roundings of the terms added here.
        let up = 1.0 + 16.0 * Real::UNIT_ROUNDOFF;
        Speed { point: (carried.point + own.point) * up, turn: (carried.turn + own.turn) * up }
    }

    fn displacement(
        &self,
        section: usize,
        shares: [Real; 2],
        times: [Real; 2],
    ) -> Option<DisplacementBound> {
        let inner = self.motion.displacement(section, shares, times)?;
        let (place, since) = self.place(section, shares, times[0])?;
        let poses = times.map(|t| self.path.pose(t));
        let apart = times[1] - times[0];
        let turn = self.path.angle() * apart;
        let ways =
            [0, 1].map(|end| poses[1] * (place[end] + inner.ways[end]) - poses[0] * place[end]);
        let turning = self.path.of_turning(self.carried(section, shares, times).point) * apart;
        let own = length(inner.ways[0]).max(length(inner.ways[1]));
        let bow = 0.125 * turn * (turning + turn * inner.off + 2.0 * own);
        let places = poses.iter().flat_map(|pose| place.map(|place| *pose * place)).chain(place);
        let reach = places.fold(own, |most: Real, p| most.max(p.abs().max_element()));
        let rounding = 64.0 * Real::UNIT_ROUNDOFF * reach;
        let off = inner.off * (1.0 + 2.0 * turn) + bow + turn * since + rounding;
        Some(DisplacementBound { ways, off: off * (1.0 + 16.0 * Real::UNIT_ROUNDOFF) })
    }

    fn common_frame(&self, times: [Real; 2]) -> Option<CommonFrame> {
        let (base, inner) = self.frames(times);
        Some(inner.unwrap_or(base))
    }

    /// The speed in the frame of the base, or in the inner motion's own frame.
    fn speed_in_frame(&self, section: usize, shares: [Real; 2], times: [Real; 2]) -> Speed {
        if self.frames(times).1.is_some() {
            self.motion.speed_in_frame(section, shares, times)
        } else {
            self.motion.speed(section, shares, times)
        }
    }

    fn time_parts(&self) -> usize {
        self.motion.time_parts()
    }
}
