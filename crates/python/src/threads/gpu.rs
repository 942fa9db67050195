//! Opens the GPU, which all meshes of a process share (feature `gpu`).

use super::compute::interruptible;
use super::fork::forks;
use super::held::Held;
use super::pool::pool;
use crate::error::Refused;
use parry_continuum::gpu::{DeviceError, Gpu, GpuError, GpuSearch, Precision};
use parry_continuum::parry::math::Vector;
use parry_continuum::proximity::{BvhSearch, DeviceFailure, ProximityError};
use pyo3::prelude::*;
use std::time::Duration;

pub(super) type Search = GpuSearch;

/// The GPU, and how often had been forked when it was opened. It is never closed: a child cannot
/// close the GPU of its parent.
static OPENED: Held<Option<(u64, Gpu)>> = Held::new(None);

/// This process's GPU, opened when it is first asked for, or why there is none.
fn open(py: Python<'_>) -> PyResult<Result<Gpu, Refused>> {
    match OPENED.with(py, |opened| opened.clone()) {
        Some((then, gpu)) if then == forks() => return Ok(Ok(gpu)),
        Some(_) => {
            let text = "`device` is 'gpu', and the GPU was opened before this process was forked: it does not work in a child; \
                        start processes with the method 'spawn', or give 'cpu'";
            return Ok(Err(Refused::other("gpu_in_child", text)));
        }
        None => {}
    }
    Ok(match interruptible(py, || Gpu::open(Precision::F32))? {
        // Another thread may have been faster.
        Ok(gpu) => Ok(OPENED.with(py, |opened| opened.get_or_insert((forks(), gpu)).1.clone())),
        Err(error) => Err(refused(error)),
    })
}

/// Whether a GPU can be opened.
pub(crate) fn is_available(py: Python<'_>) -> PyResult<bool> {
    Ok(open(py)?.is_ok())
}

/// Builds the search of a mesh, on all cores. Opens the GPU anew if it was lost.
pub(super) fn build(
    py: Python<'_>,
    vertices: Vec<Vector>,
    faces: Vec<[u32; 3]>,
) -> PyResult<Search> {
    let gpu = open(py)?.map_err(|refused| refused.raise(py, None))?;
    let pool = pool(py)?;
    let build = move || {
        pool.install(|| match GpuSearch::from_triangles(&gpu, &vertices, &faces) {
            Err(GpuError::Device(DeviceError::Failed(DeviceFailure::Lost))) => {
                let gpu = Gpu::open(Precision::F32)?;
                Ok((GpuSearch::from_triangles(&gpu, &vertices, &faces)?, Some(gpu)))
            }
            built => Ok((built?, None)),
        })
    };
    let built = interruptible(py, build)?;
    let (search, reopened) = built.map_err(|error| refused(error).raise(py, None))?;
    if let Some(gpu) = reopened {
        let lost = OPENED.with(py, |opened| opened.replace((forks(), gpu)));
        drop(lost); // not under the lock
    }
    Ok(search)
}

/// The search on the CPU for the mesh as it is now.
pub(super) fn cpu(search: &mut Search) -> BvhSearch {
    search.cpu()
}

/// The time that the device searched for the last batch on it.
pub(super) fn time(search: &Search) -> Option<Duration> {
    search.device_time()
}

/// The error of a batch if the device has failed, with what to do in Python.
pub(crate) fn device_failure(error: &ProximityError) -> Option<Refused> {
    let ProximityError::Device(_) = error else { return None };
    let advice = "`Mesh(mesh.vertices, mesh.faces, device='gpu')` opens it anew, and `Mesh(mesh)` is on the CPU";
    Some(Refused::from(*error).with_advice(advice))
}

fn refused(error: GpuError) -> Refused {
    match error {
        GpuError::Mesh(error) => Refused::Mesh(error),
        error => Refused::other(error.kind(), error.to_string()).of("device"),
    }
}
