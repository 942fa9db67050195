//! What a motion was made of, so that it can be made again elsewhere.

use numpy::{PyArrayDescrMethods, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

/// The arguments of a motion's class, which nobody else has.
pub(crate) struct Recipe {
    /// A function of the class, if it is not the class itself.
    maker: Option<&'static str>,
    args: Py<PyTuple>,
    more: Py<PyDict>,
}

/// A copy of an argument: an array has no more references than its own numbers.
fn copied<'py>(given: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    if given
        .cast_exact::<PyUntypedArray>()
        .is_ok_and(|array| array.dtype().is_equiv_to(&numpy::dtype::<f64>(given.py())))
    {
        return given.call_method0("copy");
    }
    given.py().import("copy")?.call_method1("deepcopy", (given,))
}

impl Recipe {
    /// Arguments by place, and by name if they are given.
    pub(crate) fn new<'py>(
        py: Python<'py>,
        maker: Option<&'static str>,
        args: &[&Bound<'py, PyAny>],
        more: &[(&str, Option<Bound<'py, PyAny>>)],
    ) -> PyResult<Self> {
        let args = args.iter().map(|given| copied(given)).collect::<PyResult<Vec<_>>>()?;
        let named = PyDict::new(py);
        for (name, given) in more {
            if let Some(given) = given {
                named.set_item(name, copied(given)?)?;
            }
        }
        Ok(Self { maker, args: PyTuple::new(py, args)?.unbind(), more: named.unbind() })
    }

    /// What pickle stores: a function and its arguments.
    pub(crate) fn reduced<'py>(
        &self,
        class: Bound<'py, PyAny>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let py = class.py();
        let make = py.import("parry_continuum._copies")?.getattr("motion")?;
        let arguments = (class, self.maker, self.args.bind(py), self.more.bind(py));
        Ok((make, arguments.into_pyobject(py)?.into_any()))
    }
}
