//! Tests that every instruction set of this machine gives the scalar's answers, lane by lane.

use super::*;
use crate::distance::at_level::{Kernel, at_level};
use crate::distance::{Vec3, dispatch, segment_disc, triangle_modified_cylinder};
use fearless_simd::{Level, Simd};

/// The instruction sets of this machine.
pub(crate) fn levels() -> Vec<Level> {
    let best = Level::new();
    #[allow(unused_mut)]
    let mut levels = vec![best];
    #[cfg(target_arch = "x86_64")]
    {
        levels.extend(best.as_avx2().map(Level::Avx2));
        levels.extend(best.as_sse2().map(Level::Sse2));
    }
    levels
}

#[cfg(target_arch = "x86_64")]
#[test]
fn a_level_runs_as_itself_and_sse4_2_as_sse2() {
    let best = Level::new();
    let run = |level: Level| dispatch!(level, simd => Simd::level(simd));
    assert!(best.as_avx512().is_none_or(|token| matches!(run(token.level()), Level::Avx512(_))));
    assert!(best.as_avx2().is_none_or(|token| matches!(run(token.level()), Level::Avx2(_))));
    assert!(best.as_sse4_2().is_none_or(|token| matches!(run(token.level()), Level::Sse2(_))));
    assert!(best.as_sse2().is_some_and(|token| matches!(run(token.level()), Level::Sse2(_))));
}

/// Numbers in [-1, 1), every seventh of them on a coarse lattice, where ties and parallels are
/// common.
fn numbers(count: usize, seed: u64) -> Vec<f64> {
    let mut state = seed;
    (0..count)
        .map(|i| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            let number = (state >> 11) as f64 * 2.0_f64.powi(-52) - 1.0;
            if i / 21 % 7 == 0 { (number * 4.0).round() / 4.0 } else { number }
        })
        .collect()
}

/// Returns the distances of link and triangle, and of segment and disc, for a problem of 17
/// numbers.
struct Distances;

impl Kernel<17, 2> for Distances {
    #[inline(always)]
    fn run<T: Scalar>(number: [T; 17]) -> [T; 2] {
        let point = |i: usize| Vec3::new(number[i], number[i + 1], number[i + 2]);
        let radius = number[15].abs() * number[15].lit(0.25);
        let zero = radius.zero();
        let flat = [zero.lt(number[16]), zero.lt(number[15])];
        let triangle = [point(0), point(3), point(6)];
        [
            triangle_modified_cylinder(triangle, point(9), point(12), radius, flat).distance,
            segment_disc([point(0), point(3)], point(9), point(12), radius).distance,
        ]
    }
}

fn compare<E: Lane>() {
    let count = 4096;
    let numbers = numbers(count * 17, 5);
    let problems: Vec<[E; 17]> =
        numbers.as_chunks().0.iter().map(|problem: &[f64; 17]| problem.map(E::round)).collect();
    let scalar: Vec<_> = problems.iter().map(|&problem| Distances::run(problem)).collect();
    let touching = scalar.iter().filter(|d| d[0].into() == 0.0).count();
    assert!(touching > count / 20 && touching < count / 2, "{touching}");
    for level in levels() {
        let packed = at_level::<Distances, E, 17, 2>(level, &problems);
        for (packed, scalar) in packed.iter().zip(&scalar) {
            for (packed, scalar) in packed.iter().zip(scalar) {
                let error = ((*packed).into() - (*scalar).into()).abs();
                assert!(error <= 16.0 * E::UNIT_ROUNDOFF * 2.0, "{level:?}: {error}");
            }
        }
    }
}

#[test]
fn every_level_agrees_in_single_precision() {
    compare::<f32>();
}

#[test]
fn every_level_agrees_in_double_precision() {
    compare::<f64>();
}

/// Returns the larger and the smaller of two numbers, and their quotient by `Scalar::over`.
#[inline(always)]
fn choices<L: Pack>(token: L::Token, one: L::Element, other: L::Element) -> [L::Element; 3]
where
    L::Element: Default,
{
    let (one, other) = (L::splat(token, one), L::splat(token, other));
    [one.max(other), one.min(other), one.over(other)].map(|pack| {
        let mut lanes = vec![L::Element::default(); L::LANES];
        pack.store(&mut lanes);
        lanes[0]
    })
}

fn compare_choices<E: Lane>() {
    let numbers =
        [0.0, -0.0, 1.0, -1.5, 3.0, f64::INFINITY, f64::NEG_INFINITY, f64::NAN].map(E::round);
    // All NaN compare equal here.
    let bits = |number: E| Some(number.into().to_bits()).filter(|_| !number.into().is_nan());
    for one in numbers {
        for other in numbers {
            let expected = [one.max(other), one.min(other), one.over(other)].map(bits);
            for level in levels() {
                let found =
                    dispatch!(level, simd => choices::<E::Pack<_>>(simd, one, other)).map(bits);
                assert_eq!(found, expected, "{level:?}: {} {}", one.into(), other.into());
            }
        }
    }
}

#[test]
fn lanes_choose_as_single_numbers_do() {
    compare_choices::<f32>();
    compare_choices::<f64>();
}

#[inline(always)]
fn helpers<L: Pack>(token: L::Token, value: L::Element) -> [L::Element; 2]
where
    L::Element: Default,
{
    let pack = L::splat(token, value);
    [pack.cbrt_estimate(), pack.power_of_two_to_unity()].map(|pack| {
        let mut lanes = vec![L::Element::default(); L::LANES];
        pack.store(&mut lanes);
        lanes[0]
    })
}

fn compare_helpers<E: Lane>(exponents: std::ops::Range<i32>) {
    for exponent in exponents {
        for mantissa in [1.0, 1.1, 1.5, 1.99] {
            let value = E::round(mantissa * 2.0_f64.powi(exponent));
            for level in levels() {
                let [root, unity] = dispatch!(level, simd => helpers::<E::Pack<_>>(simd, value));
                let exact = value.into().cbrt();
                assert!(
                    (root.into() / exact - 1.0).abs() < 0.06,
                    "{level:?}: {} {exact}",
                    root.into()
                );
                assert_eq!(unity.into(), value.power_of_two_to_unity().into(), "{level:?}");
                let scaled = unity.into() * value.into();
                assert!((1.0..2.0).contains(&scaled) || exponent.abs() > 120, "{scaled}");
            }
        }
    }
}

#[test]
fn estimates_hold_in_every_lane() {
    compare_helpers::<f32>(-126..128);
    compare_helpers::<f64>(-1022..1023);
}
