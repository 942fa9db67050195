//! What this project's own studies and tests build on (hidden feature `laboratory`): the shaders'
//! text, for kernels that ask the narrow phase alone, and for whoever checks or translates all of
//! it without a GPU. It is no part of the interface and changes at any time.

use super::wgsl;
use gpu_batch::{Precision, Shader};

pub use super::wgsl::{CONVEX, narrow_phase};

/// Vectors alone.
pub const VECTORS: &str = include_str!("shaders/shared/vec3.wgsl");

/// All that [`Gpu::open`](super::Gpu::open) compiles.
pub fn kernels(precision: Precision) -> Vec<Shader> {
    vec![
        wgsl::prepare(precision),
        wgsl::sample(precision),
        wgsl::nearest(precision, CONVEX),
        wgsl::reduce(precision),
        wgsl::collect(precision),
    ]
}

/// What [`GpuExhaustive::compute_every_pair`](super::GpuExhaustive::compute_every_pair) compiles
/// for a route.
pub fn every_pair(precision: Precision, route: &str) -> Shader {
    wgsl::nearest(precision, route)
}
