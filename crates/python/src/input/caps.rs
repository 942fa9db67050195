//! How the links of a robot end.

use crate::error::Refused;
use pyo3::prelude::*;

/// The model of the robot, as the parameter `caps` names it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Caps {
    Fitted,
    Capsules,
    Cylinders,
}

impl Caps {
    /// The value of the parameter.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Fitted => "fitted",
            Self::Capsules => "capsules",
            Self::Cylinders => "cylinders",
        }
    }
}

impl<'a, 'py> FromPyObject<'a, 'py> for Caps {
    type Error = PyErr;

    fn extract(given: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        match given.extract::<&str>() {
            Ok("fitted") => Ok(Self::Fitted),
            Ok("capsules") => Ok(Self::Capsules),
            Ok("cylinders") => Ok(Self::Cylinders),
            _ => {
                let text = format!(
                    "`caps` is {}; it must be 'fitted', 'capsules' or 'cylinders'",
                    given.repr()?
                );
                Err(Refused::other("bad_caps", text).raise(given.py(), None))
            }
        }
    }
}
