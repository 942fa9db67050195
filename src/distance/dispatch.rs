//! Which instruction sets the kernels are compiled for: those of `fearless_simd`, but SSE4.2 on
//! 64-bit x86.
//!
//! There the kernels run on SSE2 in its place. Both have as many lanes, and the exhaustive engine
//! was measured equally fast on them: 30.2 ns a pair against 30.8 in single precision, 64.0 against
//! 65.2 in double. Each instruction set is the narrow phase and the searches once more, for both
//! precisions: one that gains nothing only makes the library larger, and slower to compile.

#[cfg(not(all(target_arch = "x86_64", target_feature = "sse2")))]
pub(crate) use fearless_simd::dispatch;

/// Does `work` with the token of the widest instruction set that `level` proves to be there.
#[cfg(all(target_arch = "x86_64", target_feature = "sse2"))]
macro_rules! dispatch {
    ($level:expr, $token:ident => $work:expr) => {{
        use fearless_simd::{Level, Simd};
        let level: Level = $level;
        if let Some($token) = level.as_avx512() {
            $token.vectorize(
                #[inline(always)]
                || $work,
            )
        } else if let Some($token) = level.as_avx2() {
            $token.vectorize(
                #[inline(always)]
                || $work,
            )
        } else if let Some($token) = level.as_sse2().or(Level::baseline().as_sse2()) {
            // The level is less only where another crate has `fearless_simd` offer its scalar
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
#[cfg(all(target_arch = "x86_64", target_feature = "sse2"))]
pub(crate) use dispatch;
