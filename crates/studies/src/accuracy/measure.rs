//! The errors of every kernel on the extreme problems: as plain numbers, and at every instruction
//! set.

use super::packed::{self, LinkDistance, NUMBERS};
use super::problems::{Extreme, Range, Sample, samples};
use continuum_testing::certificate::{certify, directions, shapes};
use continuum_testing::kernels::{Input, KERNELS};
use continuum_testing::precision::Precision;
use fearless_simd::Level;
use parry_continuum::distance::laboratory::at_level;
use parry_continuum::distance::{DoubleDouble, Vec3};

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

/// The kernels that engines run on packs, and their caps: first of them in [`KERNELS`] is the
/// capsule.
const PACKED: [(usize, [bool; 2]); 4] =
    [(10, [false; 2]), (12, [true; 2]), (13, [true, false]), (14, [false, true])];

/// A precision that is measured.
pub trait Measured: Precision {
    const NAME: &str;
    const RANGE: Range;
    fn at_level(level: Level, problems: &[[Self; NUMBERS]]) -> Vec<[Self; 1]>;
}

impl Measured for f64 {
    const NAME: &str = "f64";
    const RANGE: Range = Range { digits: 16, scale: 300, smallest: -1074 };
    fn at_level(level: Level, problems: &[[Self; NUMBERS]]) -> Vec<[Self; 1]> {
        at_level::<LinkDistance, Self, NUMBERS, 1>(level, problems)
    }
}

impl Measured for f32 {
    const NAME: &str = "f32";
    const RANGE: Range = Range { digits: 8, scale: 90, smallest: -149 };
    fn at_level(level: Level, problems: &[[Self; NUMBERS]]) -> Vec<[Self; 1]> {
        at_level::<LinkDistance, Self, NUMBERS, 1>(level, problems)
    }
}

/// A number times 2^exponent, exact unless it falls below the range.
pub fn scaled(number: f64, exponent: i32) -> f64 {
    let power = |exponent: i32| f64::from_bits(((1023 + exponent) as u64) << 52);
    let half = exponent / 2;
    number * power(half) * power(exponent - half)
}

/// Bounds on a kernel's distance, in lengths near one.
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
        // Rounded near one, scaled, and back again, so that the proof is of the very numbers the
        // kernels get. The length of a normal does not matter.
        let rounded = sample.input.map(T::from_f64);
        let mut input = rounded.map(|x| T::from_f64(scaled(x.into(), exponent)));
        (input.plane_normal, input.disc_normal) = (rounded.plane_normal, rounded.disc_normal);
        let mut near_one = input.map(|x| scaled(x.into(), -exponent));
        let exact = rounded.map(Into::into);
        (near_one.plane_normal, near_one.disc_normal) = (exact.plane_normal, exact.disc_normal);
        let spacing = scaled(0.5, T::RANGE.smallest - exponent);
        let units = near_one.extents().map(|extent| (T::UNIT * extent).max(spacing));
        Self { extreme, power, exponent, input, near_one, proofs: proofs(&near_one, units) }
    }

    /// The error of a kernel's distance.
    fn error(&self, kernel: usize, distance: T) -> Option<f64> {
        let distance = scaled(distance.into(), -self.exponent);
        self.proofs[kernel].map(|proof| proof.error(distance))
    }
}

/// Bounds on every kernel's distance, proven by points and planes.
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
    /// At each instruction set, for what engines run on packs.
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

/// From which power of two to which a precision answers problems of that size within 16 units: the
/// smallest and the largest exponent around 0 up to which none is worse.
pub fn range<T: Measured>(largest: i32) -> [i32; 2] {
    let smallest = T::RANGE.smallest;
    let near_one: Vec<_> = samples(Range { scale: 0, ..T::RANGE }, 1)
        .into_iter()
        .filter(|sample| sample.extreme <= Extreme::Crossing && sample.power <= 2)
        .take(12)
        .collect();
    let holds = |exponent: &i32| {
        near_one.iter().all(|sample| {
            let sample = Sample { input: sample.input, exponent: *exponent, ..*sample };
            let problem = Problem::<T>::new(&sample);
            let answers = problem.input.answers().into_iter().enumerate();
            let mut errors =
                answers.filter_map(|(kernel, answer)| problem.error(kernel, answer.distance));
            errors.all(|error| error <= 16.0)
        })
    };
    // Every exponent near the ends of the range, every tenth between.
    let step = |exponent: &i32| {
        exponent % 10 == 0 || *exponent < smallest + 60 || largest - 10 < *exponent
    };
    let low = (smallest..=0).rev().filter(step).take_while(holds).last().unwrap_or(0);
    let high = (0..=largest).filter(step).take_while(holds).last().unwrap_or(0);
    [low, high]
}

/// The errors on the given problems.
pub fn measure<T: Measured>(
    problems: &[Problem<T>],
    levels: &[(&'static str, Level)],
) -> Measurement {
    let packed: Vec<_> = PACKED
        .map(|(kernel, flat)| {
            let numbers: Vec<_> =
                problems.iter().map(|problem| packed::numbers(&problem.input, flat)).collect();
            let answers = levels.iter().map(|(_, level)| T::at_level(*level, &numbers));
            (kernel, answers.collect::<Vec<_>>())
        })
        .into();
    let (mut found, mut gap) = (Vec::new(), 0.0_f64);
    for (index, problem) in problems.iter().enumerate() {
        for (kernel, answer) in problem.input.answers().into_iter().enumerate() {
            let Some(scalar) = problem.error(kernel, answer.distance) else { continue };
            let at_levels = packed
                .iter()
                .filter(|(packed, _)| *packed == kernel)
                .flat_map(|(_, levels)| levels);
            let levels =
                at_levels.filter_map(|answers| problem.error(kernel, answers[index][0])).collect();
            found.push(Found {
                extreme: problem.extreme,
                power: problem.power,
                kernel,
                scalar,
                levels,
            });
            gap = problem.proofs[kernel]
                .iter()
                .map(|proof| proof.gap / proof.unit)
                .fold(gap, f64::max);
        }
    }
    Measurement {
        precision: T::NAME,
        levels: levels.iter().map(|(name, _)| *name).collect(),
        found,
        gap,
    }
}
