//! The search on the GPU that a mesh shares with its copies, wherever their vertices have moved.
//!
//! One thread at a time has the search. The other threads ask the search on the CPU, whose answers
//! are the same. The search follows the vertices of the mesh that asks. A forked child has no
//! search, because no driver survives a fork: the child never asks or drops its parent's search.

use super::fork::forks;
use super::gpu;
use super::held::Held;
use parry_continuum::Chain;
use parry_continuum::parry::math::Vector;
use parry_continuum::proximity::{BvhSearch, MeshError, Proximity};
use pyo3::prelude::*;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// What answers a mesh's large batches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum DeviceKind {
    Cpu,
    Gpu,
}

impl DeviceKind {
    /// The value of the parameter `device`.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Cpu => "cpu",
            Self::Gpu => "gpu",
        }
    }
}

/// Where the vertices are: another number after each move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Place(u64);

impl Place {
    pub(super) fn new() -> Self {
        static NEXT: AtomicU64 = AtomicU64::new(0);
        Self(NEXT.fetch_add(1, Ordering::Relaxed))
    }
}

/// The search on the GPU of a mesh and its copies.
pub(crate) struct Device {
    /// `None` while a thread has it.
    session: Held<Option<DeviceSession>>,
    /// The seconds of the last batch on the device.
    seconds: Held<Option<f64>>,
    /// How often had been forked when the search was built.
    forks: u64,
}

/// The search on the GPU in the hands of one thread, with memory that is used again.
pub(crate) struct DeviceSession {
    pub search: gpu::Search,
    pub chains: Vec<Option<Chain>>,
    place: Place,
}

impl Device {
    /// Builds the searches of a mesh on the CPU and on the GPU.
    pub(super) fn build(
        py: Python<'_>,
        vertices: Vec<Vector>,
        faces: Vec<[u32; 3]>,
    ) -> PyResult<(BvhSearch, (Arc<Self>, Place))> {
        let mut search = gpu::build(py, vertices, faces)?;
        let (base, place, forks) = (gpu::cpu(&mut search), Place::new(), forks());
        let session = DeviceSession { search, chains: Vec::new(), place };
        let device = Self { session: Held::new(Some(session)), seconds: Held::new(None), forks };
        Ok((base, (Arc::new(device), place)))
    }

    pub(super) fn is_of_this_process(&self) -> bool {
        self.forks == forks()
    }

    /// Takes the search, unless another thread has it or this is a child.
    pub(super) fn take(&self, py: Python<'_>) -> Option<DeviceSession> {
        if self.is_of_this_process() { self.session.with(py, Option::take) } else { None }
    }

    /// Gives the search back; `None` after a defect, when all questions go to the CPU.
    pub(super) fn give_back(&self, py: Python<'_>, session: Option<DeviceSession>) {
        if let Some(session) = &session {
            self.seconds.with(py, |seconds| *seconds = session.seconds());
        }
        self.session.with(py, |place| *place = session);
    }

    /// The seconds that the device searched for the last batch on it, without transfers.
    pub(super) fn seconds(&self, py: Python<'_>) -> Option<f64> {
        self.seconds.with(py, |seconds| *seconds)
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        if !self.is_of_this_process() {
            std::mem::forget(self.session.get_mut().take());
        }
    }
}

impl DeviceSession {
    pub(super) fn place(&self) -> Place {
        self.place
    }

    /// Moves the vertices to a new place.
    pub(super) fn set_vertices(&mut self, vertices: &[Vector]) -> Result<Place, MeshError> {
        let place = Place::new();
        self.follow(place, vertices)?;
        Ok(place)
    }

    /// Moves the vertices to a place where a mesh has them.
    pub(super) fn follow(&mut self, place: Place, vertices: &[Vector]) -> Result<(), MeshError> {
        self.search.set_vertices(vertices)?;
        self.place = place;
        Ok(())
    }

    /// The seconds that the device searched for the last batch on it.
    fn seconds(&self) -> Option<f64> {
        gpu::time(&self.search).map(|time| time.as_secs_f64())
    }

    /// The search on the CPU, refitted after a move.
    pub(super) fn cpu(&mut self) -> BvhSearch {
        gpu::cpu(&mut self.search)
    }
}
