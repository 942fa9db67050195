//! Objects of this package, and lists of them. The error of another type names the parameter and,
//! in a list, the entry.

use super::scalars::is_of_value;
use pyo3::PyTypeInfo;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyMapping, PyString};

/// The error about a value that is not `what`.
fn refuse(given: &Bound<'_, PyAny>, name: &str, what: &str) -> PyErr {
    let is = match given.get_type().name() {
        _ if given.is_none() => "None".to_owned(),
        Ok(class) => format!("of the type {class}"),
        Err(error) => return error,
    };
    PyTypeError::new_err(format!("`{name}` is {is}; give {what}"))
}

/// A value of a class of this package.
fn object<'py, T: PyTypeInfo>(
    given: &Bound<'py, PyAny>,
    name: &str,
    what: &str,
) -> PyResult<Bound<'py, T>> {
    given.cast::<T>().cloned().map_err(|_| refuse(given, name, what))
}

/// The entries of a list or of another sequence. A text and a dict are none.
fn entries<'py>(
    given: &Bound<'py, PyAny>,
    name: &str,
    what: &str,
) -> PyResult<Vec<Bound<'py, PyAny>>> {
    let py = given.py();
    if given.is_instance_of::<PyString>()
        || given.is_instance_of::<PyBytes>()
        || given.cast::<PyMapping>().is_ok()
    {
        return Err(refuse(given, name, what));
    }
    given.extract().map_err(
        |error| {
            if is_of_value(py, &error) { refuse(given, name, what) } else { error }
        },
    )
}

/// A value of each parameter that is an object, by the parameter's name.
pub(crate) mod of {
    use super::*;
    use crate::mesh::Mesh;
    use crate::motions::Motion;

    type Motions<'py> = Vec<Bound<'py, Motion>>;

    const A_MOTION: &str = "a Motion, such as a LinearMotion";

    pub(crate) fn motion<'py>(given: &Bound<'py, PyAny>) -> PyResult<Bound<'py, Motion>> {
        object(given, "motion", A_MOTION)
    }

    pub(crate) fn a<'py>(given: &Bound<'py, PyAny>) -> PyResult<Bound<'py, Motion>> {
        object(given, "a", A_MOTION)
    }

    pub(crate) fn b<'py>(given: &Bound<'py, PyAny>) -> PyResult<Bound<'py, Motion>> {
        object(given, "b", A_MOTION)
    }

    pub(crate) fn motions<'py>(given: &Bound<'py, PyAny>) -> PyResult<Motions<'py>> {
        let all = entries(given, "motions", "a list of motions")?;
        let entry = |(place, motion): (usize, &Bound<'py, PyAny>)| {
            object(motion, &format!("motions[{place}]"), A_MOTION)
        };
        all.iter().enumerate().map(entry).collect()
    }

    pub(crate) fn robots<'py>(given: &Bound<'py, PyAny>) -> PyResult<Vec<Bound<'py, PyAny>>> {
        entries(given, "robots", "a list of tuples (points, radii) or (points, radii, pose)")
    }

    pub(crate) fn mesh(given: &Bound<'_, PyAny>) -> PyResult<Py<Mesh>> {
        object(given, "mesh", "a Mesh").map(Bound::unbind)
    }

    pub(crate) fn ends<'py>(given: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyDict>> {
        object(given, "ends", "a dict from the numbers of structures to poses or vertices")
    }

    fn text(given: &Bound<'_, PyAny>, parameter: &str) -> PyResult<String> {
        match given.cast::<PyString>() {
            Ok(text) => text.extract(),
            Err(_) => Err(refuse(given, parameter, "a text")),
        }
    }

    pub(crate) fn name(given: &Bound<'_, PyAny>) -> PyResult<String> {
        text(given, "name")
    }

    pub(crate) fn unit(given: &Bound<'_, PyAny>) -> PyResult<Option<String>> {
        if given.is_none() { Ok(None) } else { text(given, "unit").map(Some) }
    }
}
