//! The loops of exhaustive search for each precision, as functions without type parameters. So they
//! are compiled for every instruction set in this crate, and not again in each crate that uses an
//! engine.

use super::blocks::prepare;
use super::scan::{Job, ThreadFindings};
use crate::distance::dispatch;
use crate::distance::lanes::Lane;
use fearless_simd::Level;

/// A precision with its loops.
pub(crate) trait Kernels: Lane {
    /// [`prepare`].
    fn prepare(level: Level, faces: &mut [Self], spheres: &mut [Self]);
    /// [`Job::first_bounds`].
    fn first_bounds(level: Level, job: &Job<Self>);
    /// [`Job::scan`] with culling.
    fn scan(level: Level, job: &Job<Self>, chunk: usize, findings: &mut ThreadFindings);
    /// [`Job::scan`] without culling.
    fn scan_every_pair(level: Level, job: &Job<Self>, chunk: usize, findings: &mut ThreadFindings);
}

macro_rules! kernels {
    ($element:ty) => {
        impl Kernels for $element {
            #[inline(never)]
            fn prepare(level: Level, faces: &mut [Self], spheres: &mut [Self]) {
                dispatch!(level, simd => prepare::<<Self as Lane>::Pack<_>>(simd, faces, spheres));
            }

            #[inline(never)]
            fn first_bounds(level: Level, job: &Job<Self>) {
                dispatch!(level, simd => job.first_bounds::<<Self as Lane>::Pack<_>>(simd));
            }

            #[inline(never)]
            fn scan(level: Level, job: &Job<Self>, chunk: usize, findings: &mut ThreadFindings) {
                dispatch!(level, simd => job.scan::<<Self as Lane>::Pack<_>, true>(simd, chunk, findings));
            }

            #[inline(never)]
            fn scan_every_pair(level: Level, job: &Job<Self>, chunk: usize, findings: &mut ThreadFindings) {
                dispatch!(level, simd => job.scan::<<Self as Lane>::Pack<_>, false>(simd, chunk, findings));
            }
        }
    };
}

kernels!(f32);
kernels!(f64);
