//! Scalars. Python's own errors do not name the parameter in their text, so that each parameter has
//! a function here.

use crate::error::Refused;
use crate::threads::DeviceKind;
use mesh_files::Frame;
use numpy::{PyArrayDescr, PyArrayDescrMethods};
use parry_continuum::proximity::ProximityError;
use pyo3::exceptions::{PyOverflowError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyFloat, PyInt};

/// A frame, as the parameter `frame` names it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FrameName(pub Frame);

impl<'a, 'py> FromPyObject<'a, 'py> for FrameName {
    type Error = PyErr;

    fn extract(given: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        match given.extract::<&str>() {
            Ok(name) if name.eq_ignore_ascii_case("RAS") => Ok(Self(Frame::Ras)),
            Ok(name) if name.eq_ignore_ascii_case("LPS") => Ok(Self(Frame::Lps)),
            _ => {
                let text = format!("`frame` is {}; it must be 'RAS' or 'LPS'", given.repr()?);
                Err(Refused::other("bad_frame", text).raise(given.py(), None))
            }
        }
    }
}

/// A device, as the parameter `device` names it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DeviceName(pub DeviceKind);

impl DeviceName {
    /// The default.
    pub(crate) const CPU: Self = Self(DeviceKind::Cpu);
}

impl<'a, 'py> FromPyObject<'a, 'py> for DeviceName {
    type Error = PyErr;

    fn extract(given: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        match given.extract::<&str>() {
            Ok("cpu") => Ok(Self(DeviceKind::Cpu)),
            Ok("gpu") => Ok(Self(DeviceKind::Gpu)),
            _ => {
                let text = format!("`device` is {}; it must be 'cpu' or 'gpu'", given.repr()?);
                Err(Refused::other("bad_device", text).raise(given.py(), None))
            }
        }
    }
}

/// Pairs of places in the list of robots, each of two robots.
pub(crate) fn places(given: &Bound<'_, PyAny>) -> PyResult<Vec<[usize; 2]>> {
    let py = given.py();
    let is_bool = |pair: &Bound<'_, PyAny>| -> PyResult<bool> {
        let mut places = pair.try_iter()?;
        places.try_fold(false, |any, place| Ok(any || self::is_bool(&place?)?))
    };
    let places = given.extract::<Vec<[usize; 2]>>().and_then(|places| {
        let pairs = given.try_iter()?;
        let any_bool = pairs.map(|pair| is_bool(&pair?)).try_fold(false, |any, it| Ok(any || it?));
        any_bool.map(|any_bool| (!any_bool).then_some(places))
    });
    let no_pairs = || {
        PyTypeError::new_err("`nested` is no list of pairs of places; give pairs of whole numbers")
    };
    match places {
        Ok(Some(places)) => match places.iter().position(|[one, other]| one == other) {
            None => Ok(places),
            Some(pair) => {
                let text = format!(
                    "`nested[{pair}]` names robot {} twice; give the places of two robots",
                    places[pair][0]
                );
                Err(Refused::other("bad_type", text).raise(py, None))
            }
        },
        Ok(None) => Err(no_pairs()),
        Err(error) if error.is_instance_of::<PyOverflowError>(py) => Err(PyTypeError::new_err(
            "`nested` has a place that is negative or too large; places count from 0",
        )),
        Err(error) if is_of_value(py, &error) => Err(no_pairs()),
        Err(error) => Err(error),
    }
}

/// Refuses a length, if there is one, that is negative or NaN.
pub(crate) fn check_length(
    py: Python<'_>,
    parameter: &'static str,
    length: impl Into<Option<f64>>,
) -> PyResult<()> {
    match length.into() {
        Some(value) if value.is_nan() || value < 0.0 => {
            Err(Refused::Query(ProximityError::Negative { parameter, value }).raise(py, None))
        }
        _ => Ok(()),
    }
}

/// The error about a parameter that is not `what`.
fn refuse(given: &Bound<'_, PyAny>, name: &str, what: &str) -> PyErr {
    // Python writes no integer of more than some thousand digits.
    let text =
        given.repr().map_or_else(|_| "beyond all floats".to_owned(), |text| text.to_string());
    let text =
        if text.chars().count() > 60 { "beyond all floats or no number".to_owned() } else { text };
    PyTypeError::new_err(format!("`{name}` is {text}; give {what}"))
}

/// Whether the error is about the value, and not one of the value's own code.
pub(super) fn is_of_value(py: Python<'_>, error: &PyErr) -> bool {
    error.is_instance_of::<PyTypeError>(py)
        || error.is_instance_of::<PyOverflowError>(py)
        || error.is_instance_of::<PyValueError>(py)
}

/// Whether it is True or False, of Python or of numpy. Python takes them for numbers.
pub(crate) fn is_bool(given: &Bound<'_, PyAny>) -> PyResult<bool> {
    if given.is_instance_of::<PyBool>() {
        return Ok(true);
    }
    if given.is_exact_instance_of::<PyFloat>() || given.is_exact_instance_of::<PyInt>() {
        return Ok(false);
    }
    let Some(dtype) = given.getattr_opt("dtype")? else { return Ok(false) };
    Ok(dtype.cast::<PyArrayDescr>().is_ok_and(|dtype| dtype.kind() == b'b'))
}

fn number(given: &Bound<'_, PyAny>, name: &str) -> PyResult<f64> {
    if is_bool(given)? {
        return Err(refuse(given, name, "a number"));
    }
    given.extract::<f64>().map_err(|error| {
        if is_of_value(given.py(), &error) { refuse(given, name, "a number") } else { error }
    })
}

fn whole(given: &Bound<'_, PyAny>, name: &str, least: u32) -> PyResult<u32> {
    let is_bool = is_bool(given)?;
    match given.extract::<u32>() {
        Ok(number) if number >= least && !is_bool => Ok(number),
        Err(error) if !is_of_value(given.py(), &error) => Err(error),
        _ => Err(refuse(given, name, &format!("a whole number from {least} to {}", u32::MAX))),
    }
}

/// A function for each parameter that is a number.
macro_rules! numbers {
    ($($name:ident),*) => {
        $(pub(crate) fn $name(given: &Bound<'_, PyAny>) -> PyResult<f64> {
            super::number(given, stringify!($name))
        })*
    };
}

/// A function for each parameter that is a number or None.
macro_rules! optional_numbers {
    ($($name:ident),*) => {
        $(pub(crate) fn $name(given: &Bound<'_, PyAny>) -> PyResult<Option<f64>> {
            if given.is_none() { Ok(None) } else { super::super::number(given, stringify!($name)).map(Some) }
        })*
    };
}

/// The values of parameters, by their names.
pub(crate) mod of {
    use pyo3::prelude::*;

    numbers!(
        arc,
        deviation,
        deviation_a,
        deviation_b,
        margin,
        prominence,
        reach,
        resolution,
        scale,
        tolerance
    );

    pub(crate) fn structure(given: &Bound<'_, PyAny>) -> PyResult<u32> {
        super::whole(given, "structure", 0)
    }

    pub(crate) fn robot(given: &Bound<'_, PyAny>) -> PyResult<u32> {
        super::whole(given, "robot", 0)
    }

    pub(crate) fn segments(given: &Bound<'_, PyAny>) -> PyResult<u32> {
        super::whole(given, "segments", 1)
    }

    pub(crate) fn steps(given: &Bound<'_, PyAny>) -> PyResult<u32> {
        super::whole(given, "steps", 1)
    }

    /// Scalars that may be None.
    pub(crate) mod optional {
        use pyo3::prelude::*;

        optional_numbers!(margin, robot_margin, self_arc, self_margin, turn, turn_a, turn_b);

        pub(crate) fn label(given: &Bound<'_, PyAny>) -> PyResult<Option<u32>> {
            if given.is_none() {
                Ok(None)
            } else {
                super::super::whole(given, "label", 0).map(Some)
            }
        }

        pub(crate) fn line(given: &Bound<'_, PyAny>) -> PyResult<Option<u32>> {
            if given.is_none() { Ok(None) } else { super::super::whole(given, "line", 0).map(Some) }
        }
    }
}
