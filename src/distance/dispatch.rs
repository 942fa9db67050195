//! The instruction sets that the kernels are compiled for: the levels of `fearless_simd`, with SSE2
//! in place of SSE4.2 on 64-bit x86.
//!
//! SSE2 has as many lanes as SSE4.2. Measured with the exhaustive engine, both are equally fast:
//! 30.2 ns a pair against 30.8 in single precision, 64.0 against 65.2 in double. Each instruction
//! set compiles the narrow phase and the searches again, for both precisions. One without a gain
//! only makes the library larger and slower to compile.

/// Runs `work` with the token of the widest instruction set that `level` proves to be present.
///
/// A constant in front says whether instruction sets above the baseline are compiled at all.
#[cfg(not(all(target_arch = "x86_64", target_feature = "sse2")))]
macro_rules! dispatch {
    ($level:expr, $token:ident => $work:expr) => {
        fearless_simd::dispatch!($level, $token => $work)
    };
    ($is_wide:expr, $level:expr, $token:ident => $work:expr) => {{
        let _ = $is_wide;
        fearless_simd::dispatch!($level, $token => $work)
    }};
}

/// Runs `work` with the token of the widest instruction set that `level` proves to be present.
///
/// A constant in front says whether instruction sets above the baseline are compiled at all.
#[cfg(all(target_arch = "x86_64", target_feature = "sse2"))]
macro_rules! dispatch {
    ($level:expr, $token:ident => $work:expr) => {
        $crate::distance::dispatch!(true, $level, $token => $work)
    };
    ($is_wide:expr, $level:expr, $token:ident => $work:expr) => {{
        use fearless_simd::{Level, Simd};
        let level: Level = $level;
        if $is_wide && let Some($token) = level.as_avx512() {
            $token.vectorize(
                #[inline(always)]
                || $work,
            )
        } else if $is_wide && let Some($token) = level.as_avx2() {
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
