//! Scalars, whose errors name the parameter: Python adds the name to a TypeError alone.

use crate::error::Refused;
use mesh_files::Frame;
use pyo3::exceptions::{PyOverflowError, PyTypeError, PyValueError};
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

/// A whole number, at least 0.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Whole(pub u32);

impl<'a, 'py> FromPyObject<'a, 'py> for Whole {
    type Error = PyErr;

    fn extract(given: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        match given.extract::<u32>() {
            Ok(number) => Ok(Self(number)),
            Err(error) if !error.is_instance_of::<PyOverflowError>(given.py()) => Err(error),
            Err(_) => Err(out_of_range(&given, "a whole number from 0 to 4294967295")?),
        }
    }
}

/// A frame, as the parameter `frame` names it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FrameName(pub Frame);

impl<'a, 'py> FromPyObject<'a, 'py> for FrameName {
    type Error = PyErr;

    fn extract(given: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        match given.extract::<&str>() {
            Ok("RAS") => Ok(Self(Frame::Ras)),
            Ok("LPS") => Ok(Self(Frame::Lps)),
            _ => {
                let text = format!("`frame` is {}; it must be 'RAS' or 'LPS'", given.repr()?);
                Err(Refused::other("bad_frame", text).raise(given.py(), None))
            }
        }
    }
}

/// A number. An integer beyond all floats, or a text, is a TypeError too.
pub(crate) fn number(given: &Bound<'_, PyAny>) -> PyResult<f64> {
    let py = given.py();
    given.extract::<f64>().map_err(|error| {
        if error.is_instance_of::<PyOverflowError>(py) || error.is_instance_of::<PyValueError>(py) {
            let text = format!("{error} (give a float)");
            PyTypeError::new_err(text)
        } else {
            error
        }
    })
}

/// A number, or None.
pub(crate) fn optional_number(given: &Bound<'_, PyAny>) -> PyResult<Option<f64>> {
    if given.is_none() { Ok(None) } else { number(given).map(Some) }
}

/// Pairs of places in the list of robots.
pub(crate) fn places(given: &Bound<'_, PyAny>) -> PyResult<Vec<[usize; 2]>> {
    given.extract::<Vec<[usize; 2]>>().map_err(|error| {
        if error.is_instance_of::<PyOverflowError>(given.py()) {
            PyTypeError::new_err("a place in a list is negative or too large; places count from 0")
        } else {
            error
        }
    })
}

/// The error about a number that is none of `what`.
fn out_of_range(given: &Bound<'_, PyAny>, what: &str) -> PyResult<PyErr> {
    // Python writes no integer of more than some thousand digits.
    let given = given.repr().map_or_else(|_| "it".to_owned(), |text| text.to_string());
    Ok(PyTypeError::new_err(format!("{given} is not {what}")))
}
