//! Whether a motion fulfils the speeds that it states.

use super::Motion;
use crate::error::Refused;
use crate::input::{object_of, of};
use crate::threads::compute;
use pyo3::prelude::*;

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
    for (place, motion) in motions.iter().enumerate() {
        compute(py, || parry_continuum::verify_motion(motion, steps))?
            .map_err(|error| Refused::from(error).raise(py, count.map(|_| place)))?;
        py.check_signals()?;
    }
    Ok(())
}
