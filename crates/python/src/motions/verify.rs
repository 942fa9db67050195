//! Whether a motion fulfils the speeds that it states.

use super::{Motion, Moving};
use crate::error::Refused;
use crate::input::{object_of, of};
use crate::threads::{interruptible, pool};
use parry_continuum::parry::math::Pose;
use parry_continuum::{DisplacementBound, RobotError, Speed, Tube};
use pyo3::prelude::*;
use rayon::prelude::*;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Tests the speeds and displacements that a motion states, on which every proof about it rests.
///
/// The shapes at even steps of time are compared with one another, at nine places of each section
/// and at its samples: no point moves farther and no direction turns more than stated. The motions
/// of this package fulfil what they state; call it where you doubt it, as for a `MotionPath` of
/// many parts. Finer steps are never harmful.
///
/// Parameters
/// ----------
/// motion : Motion
///     A motion, or a batch.
/// steps : int
///     The number of steps, at least 1.
///
/// Raises
/// ------
/// ContinuumError
///     The motion exceeds a stated speed or displacement, has no shape at some time, or its
///     sections change. The text names the first time and place; of a batch, ``robot`` is the first
///     such motion.
///
/// Examples
/// --------
/// >>> from parry_continuum import LinearMotion, verify_motion
/// >>> verify_motion(LinearMotion([[0, 0, 0], [1, 0, 0]], [[0, 0, 1], [1, 0, 2]], 0.1), steps=100)
#[pyfunction]
pub(crate) fn verify_motion(
    py: Python<'_>,
    #[pyo3(from_py_with = object_of::motion)] motion: Bound<'_, Motion>,
    #[pyo3(from_py_with = of::steps)] steps: u32,
) -> PyResult<()> {
    let (count, motions) = motion.get().parts();
    let (pool, stop) = (pool(py)?, Arc::new(AtomicBool::new(false)));
    let is_to_stop = Arc::clone(&stop);
    let work = move || {
        let verify = |(place, motion): (usize, &Moving)| {
            let motion = Stoppable { motion, stop: &is_to_stop };
            parry_continuum::verify_motion(&motion, steps).err().map(|error| (place, error))
        };
        pool.install(|| motions.par_iter().enumerate().find_map_first(verify))
    };
    let refused = interruptible(py, work).inspect_err(|_| stop.store(true, Ordering::Relaxed))?;
    match refused {
        Some((place, error)) => Err(Refused::from(error).raise(py, count.map(|_| place))),
        None => Ok(()),
    }
}

/// A motion that has no shape any more once it is to stop.
struct Stoppable<'a> {
    motion: &'a Moving,
    stop: &'a AtomicBool,
}

impl parry_continuum::Motion for Stoppable<'_> {
    fn shape(&self, t: f64, tube: &mut Tube) -> Result<Pose, RobotError> {
        if self.stop.load(Ordering::Relaxed) {
            return Err(RobotError::NoShape { t, reason: "stopped" });
        }
        self.motion.shape(t, tube)
    }

    fn speed(&self, section: usize, shares: [f64; 2], times: [f64; 2]) -> Speed {
        self.motion.speed(section, shares, times)
    }

    fn displacement(
        &self,
        section: usize,
        shares: [f64; 2],
        times: [f64; 2],
    ) -> Option<DisplacementBound> {
        self.motion.displacement(section, shares, times)
    }

    fn time_parts(&self) -> usize {
        self.motion.time_parts()
    }
}
