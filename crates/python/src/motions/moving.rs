//! Any of the library's motions.

use parry_continuum::parry::math::Pose;
use parry_continuum::{
    BendingMotion, CommonFrame, DisplacementBound, LinearMotion, Motion, MotionPath, MovingBase,
    RigidMotion, RobotError, Speed, Tube,
};

/// One motion of a batch, of any kind.
#[derive(Clone, Debug)]
pub(crate) enum Moving {
    Linear(LinearMotion),
    Rigid(Box<RigidMotion>),
    Bending(BendingMotion),
    OnBase(Box<MovingBase<Moving>>),
    Path(MotionPath<Moving>),
}

impl Motion for Moving {
    fn shape(&self, t: f64, tube: &mut Tube) -> Result<Pose, RobotError> {
        match self {
            Self::Linear(motion) => motion.shape(t, tube),
            Self::Rigid(motion) => motion.shape(t, tube),
            Self::Bending(motion) => motion.shape(t, tube),
            Self::OnBase(motion) => motion.shape(t, tube),
            Self::Path(motion) => motion.shape(t, tube),
        }
    }

    fn speed(&self, section: usize, shares: [f64; 2], times: [f64; 2]) -> Speed {
        match self {
            Self::Linear(motion) => motion.speed(section, shares, times),
            Self::Rigid(motion) => motion.speed(section, shares, times),
            Self::Bending(motion) => motion.speed(section, shares, times),
            Self::OnBase(motion) => motion.speed(section, shares, times),
            Self::Path(motion) => motion.speed(section, shares, times),
        }
    }

    fn displacement(
        &self,
        section: usize,
        shares: [f64; 2],
        times: [f64; 2],
    ) -> Option<DisplacementBound> {
        match self {
            Self::Linear(motion) => motion.displacement(section, shares, times),
            Self::Rigid(motion) => motion.displacement(section, shares, times),
            Self::Bending(motion) => motion.displacement(section, shares, times),
            Self::OnBase(motion) => motion.displacement(section, shares, times),
            Self::Path(motion) => motion.displacement(section, shares, times),
        }
    }

    fn common_frame(&self, times: [f64; 2]) -> Option<CommonFrame> {
        match self {
            Self::Linear(motion) => motion.common_frame(times),
            Self::Rigid(motion) => motion.common_frame(times),
            Self::Bending(motion) => motion.common_frame(times),
            Self::OnBase(motion) => motion.common_frame(times),
            Self::Path(motion) => motion.common_frame(times),
        }
    }

    fn speed_in_frame(&self, section: usize, shares: [f64; 2], times: [f64; 2]) -> Speed {
        match self {
            Self::Linear(motion) => motion.speed_in_frame(section, shares, times),
            Self::Rigid(motion) => motion.speed_in_frame(section, shares, times),
            Self::Bending(motion) => motion.speed_in_frame(section, shares, times),
            Self::OnBase(motion) => motion.speed_in_frame(section, shares, times),
            Self::Path(motion) => motion.speed_in_frame(section, shares, times),
        }
    }

    fn time_parts(&self) -> usize {
        match self {
            Self::Linear(motion) => motion.time_parts(),
            Self::Rigid(motion) => motion.time_parts(),
            Self::Bending(motion) => motion.time_parts(),
            Self::OnBase(motion) => motion.time_parts(),
            Self::Path(motion) => motion.time_parts(),
        }
    }
}
