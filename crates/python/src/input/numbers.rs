//! An array of any type and memory order, as `f64` one after the other.

use crate::error::Refused;
use numpy::{
    PyArrayDescrMethods, PyArrayDyn, PyArrayMethods, PyUntypedArray, PyUntypedArrayMethods,
};
use parry_continuum::parry::math::Vector;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyFloat, PyList, PyTuple, PyType};

/// Numbers with a shape. The array belongs to Python: hold the GIL to read the array, since another
/// thread may write to it.
pub(crate) struct Numbers<'py> {
    array: Bound<'py, PyArrayDyn<f64>>,
    /// How many there were when the array was given.
    count: usize,
}

impl<'py> Numbers<'py> {
    /// What is an array already is taken as it is; else numpy makes one. `name` is the parameter's.
    pub(crate) fn new(given: &Bound<'py, PyAny>, name: &str) -> PyResult<Self> {
        if given.cast_exact::<PyUntypedArray>().is_err() {
            refuse_masked(given, name)?;
            refuse_misordered(given, name)?;
        }
        if let Ok(array) = given.cast::<PyArrayDyn<f64>>()
            && array.is_c_contiguous()
            && is_aligned(array)
        {
            return Ok(Self::of(array.clone()));
        }
        let py = given.py();
        let refuse = |text: String| Refused::other("bad_type", text).raise(py, None);
        let array = as_array(given, name)?;
        if !matches!(array.dtype().kind(), b'f' | b'i' | b'u') {
            let dtype = array.dtype();
            return Err(refuse(format!("`{name}` has the type {dtype}; give an array of floats")));
        }
        let array = numpy(py)?.call_method1("require", (array, "float64", "CA"))?;
        match array.cast_into::<PyArrayDyn<f64>>() {
            Ok(array) => Ok(Self::of(array)),
            Err(_) => {
                Err(refuse(format!("`{name}` is no array of numbers; give an array of floats")))
            }
        }
    }

    fn of(array: Bound<'py, PyArrayDyn<f64>>) -> Self {
        let count = array.len();
        Self { array, count }
    }

    /// Refuses an array whose size or type has changed since it was given. Another thread can
    /// change an array, and so can Python code that another argument runs, such as `__array__`.
    pub(crate) fn check_unchanged(&self, name: &str) -> Result<(), Refused> {
        if self.array.len() == self.count && self.is_double() {
            return Ok(());
        }
        let text = format!(
            "`{name}` has changed its size or type while it was read; give a copy that nobody changes"
        );
        Err(Refused::other("changed", text))
    }

    fn is_double(&self) -> bool {
        self.array.dtype().num() == numpy::npyffi::NPY_TYPES::NPY_DOUBLE as i32
    }

    /// A single number, where it is one.
    pub(crate) fn single(given: &Bound<'py, PyAny>) -> Option<f64> {
        given.cast_exact::<PyFloat>().ok().map(|number| number.value())
    }

    pub(crate) fn shape(&self) -> &[usize] {
        self.array.shape()
    }

    /// All numbers, in the order of the last index first.
    pub(crate) fn values(&self) -> &[f64] {
        if !self.is_double() {
            return &[];
        }
        // SAFETY: the array is of doubles, contiguous and aligned. Nothing writes to the array
        // during the borrow: the caller holds the GIL, and drops the numbers before Python's code
        // runs again.
        unsafe { self.array.as_slice() }.unwrap_or_default()
    }

    /// The numbers as points. Their shape must end in 3.
    pub(crate) fn points(&self) -> &[[f64; 3]] {
        self.values().as_chunks::<3>().0
    }
}

/// Whether numbers lie where the machine wants them: a field of a packed structure need not.
fn is_aligned(array: &Bound<'_, PyArrayDyn<f64>>) -> bool {
    array.data().is_aligned()
}

/// Points as the crate's vectors.
pub(crate) fn vectors(points: &[[f64; 3]]) -> Vec<Vector> {
    points.iter().map(|&point| Vector::from_array(point)).collect()
}

/// The module `numpy`.
pub(crate) fn numpy(py: Python<'_>) -> PyResult<&Bound<'_, PyAny>> {
    static NUMPY: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    let module =
        NUMPY.get_or_try_init(py, || Ok::<_, PyErr>(py.import("numpy")?.into_any().unbind()))?;
    Ok(module.bind(py))
}

/// A shape as numpy writes it.
pub(crate) fn shape_text(shape: &[usize]) -> String {
    match shape {
        [one] => format!("({one},)"),
        _ => format!("({})", shape.iter().map(usize::to_string).collect::<Vec<_>>().join(", ")),
    }
}

/// Refuses a masked array, or one within lists: numpy would drop the mask.
pub(super) fn refuse_masked<'py>(given: &Bound<'py, PyAny>, name: &str) -> PyResult<()> {
    static MASKED: PyOnceLock<Py<PyType>> = PyOnceLock::new();
    let is_plain = |it: &Bound<'py, PyAny>| {
        it.cast_exact::<PyUntypedArray>().is_ok() || it.cast::<PyUntypedArray>().is_err()
    };
    let is_masked = |it: &Bound<'py, PyAny>| -> PyResult<bool> {
        Ok(!is_plain(it) && it.is_instance(MASKED.import(it.py(), "numpy.ma", "MaskedArray")?)?)
    };
    if !any_within(given, &mut Vec::new(), &is_masked)? {
        return Ok(());
    }
    let text = format!(
        "`{name}` is a masked array, and its mask would be lost; leave the masked rows out, or give `{name}.data` if they count"
    );
    Err(Refused::other("bad_type", text).raise(given.py(), None))
}

/// Refuses a table whose three columns are named x, y, z, or r, a, s, or l, p, s, in another order:
/// numpy would drop the names.
fn refuse_misordered(given: &Bound<'_, PyAny>, name: &str) -> PyResult<()> {
    let is_table = given.cast::<PyUntypedArray>().is_err()
        && given.cast::<PyList>().is_err()
        && given.cast::<PyTuple>().is_err();
    let columns = if is_table { given.getattr_opt("columns")? } else { None };
    let names = columns.and_then(|columns| columns.try_iter().ok()).map(|columns| {
        let text = |column: PyResult<Bound<'_, PyAny>>| column.ok()?.extract::<String>().ok();
        columns.take(4).map_while(text).collect::<Vec<_>>()
    });
    let Some([a, b, c]) = names.as_deref() else { return Ok(()) };
    let found = [a, b, c].map(|name| name.to_lowercase());
    for axes in [["x", "y", "z"], ["r", "a", "s"], ["l", "p", "s"]] {
        if found.iter().all(|name| axes.contains(&name.as_str())) && found != axes {
            let [x, y, z] = axes;
            let text = format!(
                "`{name}` has the columns {a}, {b}, {c}; give them in the order {x}, {y}, {z}"
            );
            return Err(Refused::other("bad_type", text).raise(given.py(), None));
        }
    }
    Ok(())
}

/// The most dimensions of an array of numpy: deeper lists are no array.
const DEEPEST: usize = 64;

/// Whether a test holds for an object, or for one within its lists. `around` are the lists that
/// hold the object: a list may hold itself.
fn any_within<'py>(
    given: &Bound<'py, PyAny>,
    around: &mut Vec<Bound<'py, PyAny>>,
    test: &impl Fn(&Bound<'py, PyAny>) -> PyResult<bool>,
) -> PyResult<bool> {
    let entries: Box<dyn Iterator<Item = Bound<'py, PyAny>>> =
        if let Ok(list) = given.cast_exact::<PyList>() {
            Box::new(list.clone().into_iter())
        } else if let Ok(tuple) = given.cast_exact::<PyTuple>() {
            Box::new(tuple.clone().into_iter())
        } else {
            return test(given);
        };
    if around.len() == DEEPEST || around.iter().any(|list| list.is(given)) {
        return Ok(false);
    }
    around.push(given.clone());
    for entry in entries {
        if any_within(&entry, around, test)? {
            return Ok(true);
        }
    }
    around.pop();
    Ok(false)
}

/// An argument of any type, converted by numpy.
pub(crate) fn as_array<'py>(
    given: &Bound<'py, PyAny>,
    name: &str,
) -> PyResult<Bound<'py, PyUntypedArray>> {
    let py = given.py();
    let refuse = |why: String| {
        let text = format!("`{name}` is no array of numbers ({why}); give a numpy array");
        Refused::other("bad_type", text).raise(py, None)
    };
    // What an object's own code raises is its own; what numpy says of lists and the like is said of
    // the parameter.
    let is_numpys = |error: &PyErr| {
        error.is_instance_of::<PyValueError>(py) || error.is_instance_of::<PyTypeError>(py)
    };
    let array = match numpy(py)?.call_method1("asarray", (given,)) {
        Ok(array) => array,
        Err(error) if is_numpys(&error) && given.getattr_opt("__array__")?.is_none() => {
            let refused = refuse(error.to_string());
            refused.set_cause(py, Some(error));
            return Err(refused);
        }
        Err(error) => return Err(error),
    };
    array.cast_into::<PyUntypedArray>().map_err(|error| refuse(error.to_string()))
}
