//! Poses, as matrices describe them.

use super::counts::broadcast;
use super::numbers::{Numbers, shape_text};
use crate::error::Refused;
use crate::output::array;
use numpy::PyUntypedArray;
use parry_continuum::parry::math::Pose;
use parry_continuum::pose_from_matrix;
use pyo3::prelude::*;
use pyo3::types::{PyList, PySequence, PyTuple};
use std::ops::Range;

/// The poses of a batch.
pub(crate) enum Poses<'py> {
    Identity,
    Shared(Numbers<'py>),
    Each(Numbers<'py>),
}

impl<'py> Poses<'py> {
    /// The poses of `count` robots, and the number of poses: one for all, (4, 4), or one for each
    /// robot of a batch. One robot takes any number of poses.
    pub(crate) fn new(
        given: &Bound<'py, PyAny>,
        count: Option<usize>,
        name: &str,
    ) -> PyResult<(Self, Option<usize>)> {
        let numbers = matrices(given, name)?;
        match *numbers.shape() {
            [4, 4] => Ok((Self::Shared(numbers), None)),
            [1, 4, 4] => Ok((Self::Shared(numbers), Some(1))),
            [poses, 4, 4] if broadcast(count, Some(poses)).is_some() => {
                Ok((Self::Each(numbers), Some(poses)))
            }
            ref shape => {
                let fit = match count {
                    None | Some(1) => " or (B, 4, 4)".to_owned(),
                    Some(count) => format!(" or ({count}, 4, 4)"),
                };
                let text = format!(
                    "`{name}` has the shape {}; give None, or the shape (4, 4){fit}",
                    shape_text(shape)
                );
                Err(Refused::other("bad_shape", text).raise(given.py(), None))
            }
        }
    }

    /// One pose, or many, and how many of those.
    pub(crate) fn batch(given: &Bound<'py, PyAny>, name: &str) -> PyResult<(Self, Option<usize>)> {
        let numbers = matrices(given, name)?;
        match *numbers.shape() {
            [4, 4] => Ok((Self::Shared(numbers), None)),
            [count, 4, 4] => Ok((Self::Each(numbers), Some(count))),
            ref shape => {
                let text = format!(
                    "`{name}` has the shape {}; give (4, 4) or (B, 4, 4)",
                    shape_text(shape)
                );
                Err(Refused::other("bad_shape", text).raise(given.py(), None))
            }
        }
    }

    /// Refuses poses whose array has changed since it was given.
    pub(crate) fn check_unchanged(&self, name: &str) -> Result<(), Refused> {
        match self {
            Self::Identity => Ok(()),
            Self::Shared(numbers) | Self::Each(numbers) => numbers.check_unchanged(name),
        }
    }

    /// Whether one stands for all.
    pub(crate) fn is_one(&self) -> bool {
        matches!(self, Self::Shared(_))
    }

    /// The matrices of some of the batch: one where one stands for all, and none where all are the
    /// identity.
    pub(crate) fn matrices(&self, range: Range<usize>) -> &[[f64; 16]] {
        match self {
            Self::Identity => &[],
            Self::Shared(pose) => pose.values().as_chunks().0,
            Self::Each(poses) => &poses.values().as_chunks().0[range],
        }
    }
}

/// The matrices of poses, from an array or from scipy's `RigidTransform` or `Rotation`.
pub(crate) fn matrices<'py>(given: &Bound<'py, PyAny>, name: &str) -> PyResult<Numbers<'py>> {
    if given.cast_exact::<PyUntypedArray>().is_ok() {
        return Numbers::new(given, name);
    }
    let found = match given.getattr_opt("as_matrix")? {
        Some(as_matrix) => as_matrix.call0()?,
        None => match matrices_in(given)? {
            Some(list) => list.into_any(),
            None => return Numbers::new(given, name),
        },
    };
    let numbers = Numbers::new(&found, name)?;
    let [before @ .., 3, 3] = numbers.shape() else { return Ok(numbers) };
    let shape: Vec<_> = before.iter().copied().chain([4, 4]).collect();
    let whole = numbers.values().as_chunks::<9>().0.iter().flat_map(|turn| {
        let [a, b, c, d, e, f, g, h, i] = *turn;
        [a, b, c, 0.0, d, e, f, 0.0, g, h, i, 0.0, 0.0, 0.0, 0.0, 1.0]
    });
    Numbers::new(array(given.py(), shape, whole.collect())?.as_any(), name)
}

/// The matrices of a list that has a transform of scipy's in each entry.
fn matrices_in<'py>(given: &Bound<'py, PyAny>) -> PyResult<Option<Bound<'py, PyList>>> {
    let Ok(entries) = given.cast::<PySequence>() else { return Ok(None) };
    if !given.is_instance_of::<PyList>() && !given.is_instance_of::<PyTuple>() {
        return Ok(None);
    }
    let list = PyList::empty(given.py());
    for entry in entries.try_iter()? {
        let Some(as_matrix) = entry?.getattr_opt("as_matrix")? else { return Ok(None) };
        list.append(as_matrix.call0()?)?;
    }
    Ok((!list.is_empty()).then_some(list))
}

/// The pose of one matrix, (4, 4), beside its numbers; none of another shape.
pub(crate) fn pose_if_one(
    py: Python<'_>,
    numbers: &Numbers<'_>,
    name: &str,
) -> PyResult<Option<(Pose, [f64; 16])>> {
    let (&[4, 4], Some(matrix)) = (numbers.shape(), numbers.values().as_chunks().0.first()) else {
        return Ok(None);
    };
    let pose = pose_of(matrix).map_err(|refused| refused.of(name).raise(py, None))?;
    Ok(Some((pose, *matrix)))
}

/// The pose that a matrix is.
pub(crate) fn pose_of(matrix: &[f64; 16]) -> Result<Pose, Refused> {
    let row = |row: usize| std::array::from_fn(|column| matrix[4 * row + column]);
    Ok(pose_from_matrix(std::array::from_fn(row))?)
}
