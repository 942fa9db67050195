//! Stands in for `gpu` where the feature `gpu` is off: no mesh is on a GPU.

use crate::error::Refused;
use parry_continuum::parry::math::Vector;
use parry_continuum::proximity::{BvhSearch, ProximityError};
use pyo3::prelude::*;
use std::time::Duration;

/// The type of the search that is never built.
pub(super) type Search = BvhSearch;

/// Whether a GPU can be opened.
pub(crate) fn is_available(_: Python<'_>) -> PyResult<bool> {
    Ok(false)
}

/// Refuses a mesh on the GPU, and says how to turn the GPU on.
pub(super) fn build(py: Python<'_>, _: Vec<Vector>, _: Vec<[u32; 3]>) -> PyResult<Search> {
    let text = "`device` is 'gpu', and this build of parry-continuum has no GPU; give 'cpu', install a released wheel, or build the \
                package with its feature `gpu`: pip install ./crates/python --config-settings=build-args='--features gpu' (with \
                maturin: maturin build --release --features gpu)";
    Err(Refused::other("no_gpu_support", text).raise(py, None))
}

/// The search on the CPU.
pub(super) fn cpu(search: &mut Search) -> BvhSearch {
    search.clone()
}

/// The time that the device searched for the last batch on it.
pub(super) fn time(_: &Search) -> Option<Duration> {
    None
}

/// The error of a batch if the device has failed.
pub(crate) fn device_failure(_: &ProximityError) -> Option<Refused> {
    None
}
