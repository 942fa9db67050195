//! Motions of every kind.

use crate::error::{Fault, pc_status};
use crate::robot::{Caps, pc_chain, pc_tube, radii};
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::{
    BendingMotion, BendingSection, CommonFrame, DisplacementBound, LinearMotion, Motion,
    MotionPath, MovingBase, RigidMotion, RobotError, Speed, Tube, verify_motion,
};
use std::sync::Arc;

/// A motion that others can be made of.
#[derive(Clone)]
struct SharedMotion(Arc<dyn Motion + Send + Sync>);

impl Motion for SharedMotion {
    fn shape(&self, t: f64, tube: &mut Tube) -> Result<Pose, RobotError> {
        self.0.shape(t, tube)
    }

    fn speed(&self, section: usize, shares: [f64; 2], times: [f64; 2]) -> Speed {
        self.0.speed(section, shares, times)
    }

    fn displacement(
        &self,
        section: usize,
        shares: [f64; 2],
        times: [f64; 2],
    ) -> Option<DisplacementBound> {
        self.0.displacement(section, shares, times)
    }

    fn common_frame(&self, times: [f64; 2]) -> Option<CommonFrame> {
        self.0.common_frame(times)
    }

    fn speed_in_frame(&self, section: usize, shares: [f64; 2], times: [f64; 2]) -> Speed {
        self.0.speed_in_frame(section, shares, times)
    }

    fn time_parts(&self) -> usize {
        self.0.time_parts()
    }
}

/// A robot that changes with time, from 0 to 1. It never changes itself.
pub struct pc_motion {
    motion: SharedMotion,
    /// How many motions it is made of.
    parts: usize,
    /// How deep they are in one another.
    depth: usize,
}

impl pc_motion {
    fn new(motion: impl Motion + Send + Sync + 'static) -> Self {
        Self { motion: SharedMotion(Arc::new(motion)), parts: 1, depth: 1 }
    }

    /// A motion that is made of others. Each level asks the one below it several times, so size and
    /// depth are limited.
    fn of(motion: impl Motion + Send + Sync + 'static, others: &[&Self]) -> Result<Self, Fault> {
        const MOST_PARTS: usize = 1 << 20;
        const MOST_DEEP: usize = 6;
        let parts = others.iter().fold(0, |sum: usize, other| sum.saturating_add(other.parts));
        let depth = 1 + others.iter().map(|other| other.depth).max().unwrap_or(0);
        if parts <= MOST_PARTS && depth <= MOST_DEEP {
            return Ok(Self { parts, depth, ..Self::new(motion) });
        }
        let text = format!(
            "there are {parts} motions, {depth} deep in one another, more than {MOST_PARTS} or \
             deeper than {MOST_DEEP}; make one path of all motions, and move the base of that"
        );
        Err(Fault::argument("nested_too_deep", text))
    }

    pub(crate) fn motion(&self) -> &(dyn Motion + Send + Sync) {
        &*self.motion.0
    }
}

/// Makes a motion whose points move straight and evenly from `start` to `end`, `point_count` points
/// each. `caps` is `PC_CAPS_FITTED` or `PC_CAPS_CAPSULES`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_motion_linear(
    start: *const f64,
    end: *const f64,
    point_count: usize,
    radii: *const f64,
    radius_count: usize,
    caps: u32,
    motion: *mut *mut pc_motion,
) -> pc_status {
    border!(motion: new_handle, start: points(point_count), end: points(point_count),
        radii: items(radius_count) =>
    {
        let mut memory = Vec::new();
        let each = self::radii(radii, start.len().saturating_sub(1), &mut memory);
        motion.set(pc_motion::new(match Caps::new(caps)? {
            Caps::Fitted => LinearMotion::chain(start, end, each)?,
            Caps::Capsules => LinearMotion::capsules(start, end, each)?,
            Caps::Cylinders => {
                let text = "`caps` is PC_CAPS_CYLINDERS; give PC_CAPS_FITTED or PC_CAPS_CAPSULES";
                return Err(Fault::argument("bad_caps", text.into()));
            }
        }));
        Ok(())
    })
}

/// Makes the motion of a robot that keeps its shape and turns the lesser way, evenly from one pose
/// to another.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_motion_rigid(
    robot: *const pc_chain,
    start_pose: *const f64,
    end_pose: *const f64,
    motion: *mut *mut pc_motion,
) -> pc_status {
    border!(motion: new_handle, robot: shared, start_pose: pose, end_pose: pose => {
        let tube = Tube::from(&robot.chain);
        motion.set(pc_motion::new(RigidMotion::new(tube, [start_pose, end_pose])?));
        Ok(())
    })
}

/// The same for a smooth tube.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_motion_rigid_tube(
    tube: *const pc_tube,
    start_pose: *const f64,
    end_pose: *const f64,
    motion: *mut *mut pc_motion,
) -> pc_status {
    border!(motion: new_handle, tube: shared, start_pose: pose, end_pose: pose => {
        motion.set(pc_motion::new(RigidMotion::new(tube.tube.clone(), [start_pose, end_pose])?));
        Ok(())
    })
}

/// Robots of `count` sections each, one after another, with the same radii.
pub(crate) fn sections(
    numbers: &[Vector],
    radii: &[f64],
    count: usize,
) -> Result<Vec<BendingSection>, Fault> {
    if radii.len() != count {
        let text = format!("`radii` has {} numbers; give 1 or {count}", radii.len());
        return Err(Fault::argument("bad_length", text));
    }
    let section = |(numbers, &radius): (&Vector, &f64)| BendingSection {
        length: numbers.x,
        bend: [numbers.y, numbers.z],
        radius,
    };
    Ok(numbers.iter().zip(radii.iter().cycle()).map(section).collect())
}

/// Makes the motion of sections of constant curvature, whose lengths and curvatures change evenly.
/// A section is three numbers: its length, and its curvature towards x and towards y. `pose` is
/// that of the base.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_motion_bending(
    start: *const f64,
    end: *const f64,
    section_count: usize,
    radii: *const f64,
    radius_count: usize,
    pose: *const f64,
    motion: *mut *mut pc_motion,
) -> pc_status {
    border!(motion: new_handle, start: points(section_count), end: points(section_count),
        radii: items(radius_count), pose: pose =>
    {
        let mut memory = Vec::new();
        let each = self::radii(radii, start.len(), &mut memory);
        let count = start.len();
        let [start, end] = [sections(start, each, count)?, sections(end, each, count)?];
        motion.set(pc_motion::new(BendingMotion::new(&start, &end, pose)?));
        Ok(())
    })
}

/// Makes a motion whose base moves at the same time, evenly from one pose to another.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_motion_moving_base(
    moved: *const pc_motion,
    start_pose: *const f64,
    end_pose: *const f64,
    motion: *mut *mut pc_motion,
) -> pc_status {
    border!(motion: new_handle, moved: shared, start_pose: pose, end_pose: pose => {
        let on_base = MovingBase::new(moved.motion.clone(), [start_pose, end_pose])?;
        motion.set(pc_motion::of(on_base, &[moved])?);
        Ok(())
    })
}

/// Makes a motion of several, one after another. Each begins where the one before ends, and has the
/// same share of the time.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_motion_path(
    motions: *const *const pc_motion,
    count: usize,
    motion: *mut *mut pc_motion,
) -> pc_status {
    border!(motion: new_handle, motions: handles(count) => {
        let path = MotionPath::new(motions.iter().map(|part| part.motion.clone()).collect())?;
        motion.set(pc_motion::of(path, &motions)?);
        Ok(())
    })
}

/// Compares a motion with the speeds that it states, at `steps` times.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_motion_verify(motion: *const pc_motion, steps: u32) -> pc_status {
    border!(motion: shared => Ok(verify_motion(&motion.motion, steps)?))
}

/// Frees a motion. Motions that are made of it stay.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_motion_free(motion: *mut pc_motion) {
    free!(motion);
}
