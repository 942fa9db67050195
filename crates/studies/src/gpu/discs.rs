//! The routes to the disc of a flat cap on the GPU.

use gpu_batch::Precision;
use parry_continuum::gpu::laboratory::CONVEX;
use real_polynomial_roots::gpu::{Finder, approximate};

/// A route to the disc of a flat cap: the paper's are there for comparison.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Discs {
    /// This crate's, without roots of a polynomial.
    #[default]
    Convex,
    /// The paper's quartic in closed form.
    ClosedForm,
    /// The paper's quartic by the companion matrix.
    Companion,
}

impl Discs {
    /// The route in WGSL, as `GpuExhaustive::compute_every_pair` takes it.
    pub fn route(self, precision: Precision) -> String {
        let finder = match self {
            Self::Convex => return CONVEX.into(),
            Self::ClosedForm => Finder::ClosedForm,
            Self::Companion => Finder::Companion,
        };
        approximate(finder, precision, 4) + include_str!("shaders/quartic.wgsl")
    }
}
