//! The most that one thread can compute: what Table IV is normalised by.

use fearless_simd::prelude::*;
use fearless_simd::{Level, Simd, dispatch};
use std::hint::black_box;
use std::time::Instant;

/// Independent sums, enough to keep every unit busy while one addition waits for the last.
const SUMS: usize = 16;
const ROUNDS: usize = 1_000_000;

macro_rules! peak {
    ($name:ident, $work:ident, $vector:ident) => {
        /// Operations per second of one thread in this precision: independent fused multiply-adds
        /// of the widest vectors, two operations each. The best of several measurements.
        pub fn $name() -> f64 {
            let level = Level::new();
            let mut best = 0.0_f64;
            for _ in 0..20 {
                let begin = Instant::now();
                let lanes = dispatch!(level, simd => $work(simd));
                let operations = (2 * lanes * SUMS * ROUNDS) as f64;
                best = best.max(operations / begin.elapsed().as_secs_f64());
            }
            best
        }

        #[inline(always)]
        fn $work<S: Simd>(simd: S) -> usize {
            let factor = S::$vector::splat(simd, black_box(0.5));
            let mut sums = [S::$vector::splat(simd, 1.0); SUMS];
            for _ in 0..ROUNDS {
                for sum in &mut sums {
                    *sum = sum.mul_add(factor, factor);
                }
            }
            let mut total = sums[0];
            for sum in &sums[1..] {
                total += *sum;
            }
            let mut lanes = vec![0.0; S::$vector::LEN];
            total.store_slice(&mut lanes);
            black_box(&lanes);
            lanes.len()
        }
    };
}

peak!(single, single_work, f32s);
peak!(double, double_work, f64s);
