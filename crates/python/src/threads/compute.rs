//! Work without the GIL, whose defects are exceptions.

use crate::error::Refused;
use pyo3::prelude::*;
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Does `work` without the GIL. A panic is a defect of the library, and Python is told so by the exception of this package.
pub(crate) fn compute<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    let done = py.detach(|| catch_unwind(AssertUnwindSafe(work)));
    done.map_err(|panic| defect(&*panic).raise(py, None))
}

fn defect(panic: &(dyn Any + Send)) -> Refused {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    let text = text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_default();
    Refused::other(
        "defect",
        format!("this is a defect of parry-continuum, please report it: {text}"),
    )
}
