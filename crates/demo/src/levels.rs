//! The instruction sets of this machine that the engines can use.

use fearless_simd::Level;

/// Every one of them with its name, the widest first.
pub fn levels() -> Vec<(&'static str, Level)> {
    let best = Level::new();
    #[cfg(target_arch = "x86_64")]
    {
        let avx512 = best.as_avx512().map(|token| ("AVX-512", Level::Avx512(token)));
        let avx2 = best.as_avx2().map(|token| ("AVX2", Level::Avx2(token)));
        let sse2 = best.as_sse2().map(|token| ("SSE2", Level::Sse2(token)));
        [avx512, avx2, sse2].into_iter().flatten().collect()
    }
    #[cfg(not(target_arch = "x86_64"))]
    vec![(std::env::consts::ARCH, best)]
}
