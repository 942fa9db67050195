//! The text of the shaders, for this project's own studies and tests (hidden feature `laboratory`).
//!
//! Kernels can use the narrow phase alone, and the text can be checked or translated without a GPU.
//! This module is no part of the interface and changes at any time.

use super::wgsl;
use gpu_batch::{Precision, Shader};

pub use super::wgsl::{CONVEX, narrow_phase};

/// The functions for vectors alone.
pub const VECTORS: &str = include_str!("shaders/shared/vec3.wgsl");

/// The kernels that [`Gpu::open`](super::Gpu::open) compiles.
pub fn kernels(precision: Precision) -> Vec<Shader> {
    vec![
        wgsl::prepare(precision),
        wgsl::sample(precision),
        wgsl::nearest(precision, CONVEX),
        wgsl::reduce(precision),
        wgsl::collect(precision),
    ]
}

/// The kernel that [`GpuExhaustive::compute_every_pair`](super::GpuExhaustive::compute_every_pair)
/// compiles for a route.
pub fn every_pair(precision: Precision, route: &str) -> Shader {
    wgsl::nearest(precision, route)
}

/// The kernels of [`GpuSearch`](super::GpuSearch), which compute in single precision on every GPU.
pub fn search_kernels() -> Vec<Shader> {
    super::search::kernels::all()
}
