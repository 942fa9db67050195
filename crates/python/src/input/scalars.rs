//! Scalars, whose errors name the parameter: Python adds the name to a TypeError alone.

use pyo3::exceptions::{PyOverflowError, PyTypeError};
use pyo3::prelude::*;

/// A whole number, at least 1.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Count(pub u32);

impl<'a, 'py> FromPyObject<'a, 'py> for Count {
    type Error = PyErr;

    fn extract(given: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        match given.extract::<u32>() {
            Ok(count @ 1..) => Ok(Self(count)),
            Err(error) if !error.is_instance_of::<PyOverflowError>(given.py()) => Err(error),
            _ => Err(out_of_range(&given, "a whole number from 1 to 4294967295")?),
        }
    }
}

/// The error about a number that is none of `what`.
fn out_of_range(given: &Bound<'_, PyAny>, what: &str) -> PyResult<PyErr> {
    Ok(PyTypeError::new_err(format!("{} is not {what}", given.repr()?)))
}
