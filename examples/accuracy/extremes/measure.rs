//! The errors of every kernel on the extreme problems: as plain numbers, and at every instruction set.

use super::problems::{Extreme, Range, Sample, samples};
use crate::common::certificate::{certify, directions, shapes};
use crate::common::kernels::{Distances, Input, KERNELS, NUMBERS};
use crate::common::precision::Precision;
use fearless_simd::Level;
use parry_continuum::distance::{DoubleDouble, Vec3, at_level};

/// The pairs of the tables, and which kernels answer them.
pub const PAIRS: [(&str, &[usize]); 11] = [
    ("segment and segment", &[0]),
    ("point and triangle", &[1]),
    ("segment and triangle", &[2]),
    ("point and disc", &[3]),
    ("segment and disc", &[4]),
    ("plane and disc", &[5]),
    ("triangle and disc", &[6]),
    ("point and modified cylinder", &[7, 8, 9]),
    ("triangle and capsule", &[10]),
    ("triangle and cylinder", &[12]),
    ("triangle and modified cylinder", &[13, 14]),
];

/// A precision that is measured.
pub trait Measured: Precision {
    const NAME: &str;
    const RANGE: Range;
    fn at_level(level: Level, problems: &[[Self; NUMBERS]]) -> Vec<[Self; KERNELS.len()]>;
}

impl Measured for f64 {
    const NAME: &str = "f64";
    const RANGE: Range = Range { digits: 16, scale: 300, smallest: -1074 };
    fn at_level(level: Level, problems: &[[Self; NUMBERS]]) -> Vec<[Self; KERNELS.len()]> {
        at_level::<Distances, Self, NUMBERS, { KERNELS.len() }>(level, problems)
    }
}

impl Measured for f32 {
    const NAME: &str = "f32";
    const RANGE: Range = Range { digits: 8, scale: 90, smallest: -149 };
    fn at_level(level: Level, problems: &[[Self; NUMBERS]]) -> Vec<[Self; KERNELS.len()]> {
        at_level::<Distances, Self, NUMBERS, { KERNELS.len() }>(level, problems)
    }
}

/// A number times 2^exponent, exact unless it falls below the range.
pub fn scaled(number: f64, exponent: i32) -> f64 {
    let power = |exponent: i32| f64::from_bits(((1023 + exponent) as u64) << 52);
    let half = exponent / 2;
    number * power(half) * power(exponent - half)
}

/// What is known of a kernel's distance, in lengths near one.
#[derive(Clone, Copy)]
pub struct Proof {
    pub middle: DoubleDouble,
    /// Between the bounds.
    pub gap: f64,
    /// u x extent, or half the spacing of the precision's numbers where that is more.
    pub unit: f64,
}

impl Proof {
    /// The error of a distance in units; infinite for NaN.
    pub fn error(&self, distance: f64) -> f64 {
        let error = (DoubleDouble::from(distance) - self.middle).rounded().abs();
        if error == 0.0 {
            0.0
        } else if error.is_nan() {
            f64::INFINITY
        } else {
            error / self.unit
        }
    }
}

/// A sample in a precision: what the kernels get, and what they should answer.
pub struct Problem<T> {
    pub extreme: Extreme,
    pub power: i32,
    pub exponent: i32,
    pub input: Input<T>,
    /// The same before it was scaled.
    pub near_one: Input<f64>,
    /// None for a kernel whose normal is 0.
    pub proofs: [Option<Proof>; KERNELS.len()],
}

impl<T: Measured> Problem<T> {
    /// Rounds a sample to the precision and proves its distances.
    pub fn new(sample: &Sample) -> Self {
        let Sample { extreme, power, exponent, .. } = *sample;
        // Rounded near one, scaled, and back again, so that the proof is of the very numbers the kernels get.
        let rounded = sample.input.map(|x| T::from_f64(x).into());
        let input = rounded.map(|x| T::from_f64(scaled(x, exponent)));
        let near_one = input.map(|x| scaled(x.into(), -exponent));
        let spacing = scaled(0.5, T::RANGE.smallest - exponent);
        let units = near_one.extents().map(|extent| (T::UNIT * extent).max(spacing));
        Self { extreme, power, exponent, input, near_one, proofs: proofs(&near_one, units) }
    }

    /// The error of each kernel's distance.
    fn errors(&self, distances: [T; KERNELS.len()]) -> [Option<f64>; KERNELS.len()] {
        std::array::from_fn(|kernel| {
            let distance = scaled(distances[kernel].into(), -self.exponent);
            self.proofs[kernel].map(|proof| proof.error(distance))
        })
    }
}

/// What is known of every kernel's distance, by points and planes that prove it.
fn proofs(input: &Input<f64>, units: [f64; KERNELS.len()]) -> [Option<Proof>; KERNELS.len()] {
    let precise = input.map(DoubleDouble::from);
    let (shapes, answers) = (shapes(&precise), precise.answers());
    let directions = directions(&precise, &answers);
    let zero = Vec3::new(0.0, 0.0, 0.0);
    std::array::from_fn(|kernel| {
        let name = KERNELS[kernel];
        let lacks_normal = (name == "plane-disc" && input.plane_normal == zero)
            || (name.ends_with("disc") && input.disc_normal == zero);
        let bounds = certify(&shapes[kernel], &answers[kernel], &directions);
        let proof = Proof {
            middle: (bounds.lower + bounds.upper) * DoubleDouble::from(0.5),
            gap: (bounds.upper - bounds.lower).rounded(),
            unit: units[kernel],
        };
        (!lacks_normal).then_some(proof)
    })
}

/// The errors of one kernel on one problem.
pub struct Found {
    pub extreme: Extreme,
    pub power: i32,
    /// Index into [`KERNELS`].
    pub kernel: usize,
    pub scalar: f64,
    /// At each instruction set.
    pub levels: Vec<f64>,
}

/// Everything measured in one precision.
pub struct Measurement {
    pub precision: &'static str,
    pub levels: Vec<&'static str>,
    pub found: Vec<Found>,
    /// The widest gap between two bounds, in units.
    pub gap: f64,
}

/// The seeded problems of a precision.
pub fn problems<T: Measured>(each: usize) -> Vec<Problem<T>> {
    samples(T::RANGE, each).iter().map(Problem::new).collect()
}

/// The errors on the given problems.
pub fn measure<T: Measured>(problems: &[Problem<T>], levels: &[(&'static str, Level)]) -> Measurement {
    let numbers: Vec<_> = problems.iter().map(|problem| problem.input.numbers()).collect();
    let packed: Vec<_> = levels.iter().map(|(_, level)| T::at_level(*level, &numbers)).collect();
    let (mut found, mut gap) = (Vec::new(), 0.0_f64);
    for (index, problem) in problems.iter().enumerate() {
        let scalar = problem.errors(problem.input.answers().map(|closest| closest.distance));
        let levels: Vec<_> = packed.iter().map(|answers| problem.errors(answers[index])).collect();
        for kernel in 0..KERNELS.len() {
            let (Some(proof), Some(scalar)) = (problem.proofs[kernel], scalar[kernel]) else { continue };
            gap = gap.max(if proof.gap == 0.0 { 0.0 } else { proof.gap / proof.unit });
            found.push(Found {
                extreme: problem.extreme,
                power: problem.power,
                kernel,
                scalar,
                levels: levels.iter().filter_map(|errors| errors[kernel]).collect(),
            });
        }
    }
    Measurement { precision: T::NAME, levels: levels.iter().map(|(name, _)| *name).collect(), found, gap }
}
