//! The instruction sets that the kernels are compiled for: the levels of `fearless_simd`, with SSE2
//! in place of SSE4.2 on 64-bit x86.
//!
//! Each instruction set compiles a kernel again. One that makes no query at least 10 % faster only
//! makes the library larger and slower to compile, so each kernel states the widest that pays
//! ([`Widest`]). Processor time of queries over that with all instruction sets, measured on an AMD
//! EPYC with AVX-512:
//!
//! | kernels | up to AVX2 | SSE2 alone | widest |
//! |---|---|---|---|
//! | search, single precision | 1.2 to 1.5 | 1.8 to 3.1 | AVX-512 |
//! | exhaustive search, both precisions | 1.15 to 2.2 | 2.0 to 5.0 | AVX-512 |
//! | measuring of links and triangles | up to 1.2 | up to 1.8 | AVX-512 |
//! | measuring of links and links | up to 1.13 | up to 1.46 | AVX-512 |
//! | bounds of the nodes (refit) | 1.0 | 1.0 | SSE2 |
//! | search, double precision | 1.3 to 1.5 | 2.4 to 3.0 | SSE2 |
//!
//! The last row gives up its gain: it is for links that single precision cannot resolve, thousands
//! of times the size of the mesh away from it.
//!
//! SSE2 has as many lanes as SSE4.2. Measured with the exhaustive engine, both are equally fast:
//! 30.2 ns a pair against 30.8 in single precision, 64.0 against 65.2 in double.

/// The widest instruction set that a kernel is compiled for on 64-bit x86.
#[derive(Clone, Copy)]
pub(crate) enum Widest {
    Sse2,
    Avx512,
}

/// Runs `work` with the token of the widest instruction set that `level` proves to be present, or
/// of the given [`Widest`] one.
#[cfg(not(all(target_arch = "x86_64", target_feature = "sse2")))]
macro_rules! dispatch {
    ($level:expr, $token:ident => $work:expr) => {
        fearless_simd::dispatch!($level, $token => $work)
    };
    ($widest:expr, $level:expr, $token:ident => $work:expr) => {{
        let _ = $widest;
        fearless_simd::dispatch!($level, $token => $work)
    }};
}

/// Runs `work` with the token of the widest instruction set that `level` proves to be present, or
/// of the given [`Widest`] one.
#[cfg(all(target_arch = "x86_64", target_feature = "sse2"))]
macro_rules! dispatch {
    ($level:expr, $token:ident => $work:expr) => {
        $crate::distance::dispatch!($crate::distance::Widest::Avx512, $level, $token => $work)
    };
    ($widest:expr, $level:expr, $token:ident => $work:expr) => {{
        use fearless_simd::{Level, Simd};
        use $crate::distance::Widest::Avx512;
        let level: Level = $level;
        if const { matches!($widest, Avx512) } && let Some($token) = level.as_avx512() {
            $token.vectorize(
                #[inline(always)]
                || $work,
            )
        } else if const { matches!($widest, Avx512) } && let Some($token) = level.as_avx2() {
            $token.vectorize(
                #[inline(always)]
                || $work,
            )
        } else if let Some($token) = level.as_sse2().or(Level::baseline().as_sse2()) {
            // The level is lower only if another crate makes `fearless_simd` offer its scalar
            // fallback.
            $token.vectorize(
                #[inline(always)]
                || $work,
            )
        } else {
            unreachable!("the target has SSE2")
        }
    }};
}
pub(crate) use dispatch;
