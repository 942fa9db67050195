//! A lock that is taken only while the GIL is held, and never across giving it up.

use pyo3::prelude::*;
use std::sync::{Mutex, PoisonError};

/// Data of all threads. Python forks with the GIL held, so no child ever finds this locked.
#[derive(Default)]
pub(crate) struct Held<T>(Mutex<T>);

impl<T> Held<T> {
    pub(crate) const fn new(data: T) -> Self {
        Self(Mutex::new(data))
    }

    /// Looks at the data. `look` must be short, and run no code of Python's.
    pub(crate) fn with<R>(&self, _: Python<'_>, look: impl FnOnce(&mut T) -> R) -> R {
        look(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// The data of an owner who shares them with nobody.
    pub(crate) fn get_mut(&mut self) -> &mut T {
        self.0.get_mut().unwrap_or_else(PoisonError::into_inner)
    }
}
