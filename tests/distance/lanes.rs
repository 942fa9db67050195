//! Every kernel is one text for scalars and for packs of them: run on two problems at once, it
//! answers each as if the other were not there. A branch, or a select that mixes lanes, would show.

use continuum_testing::distance_cases;
use continuum_testing::kernels::{Input, KERNELS};
use parry_continuum::distance::laboratory::{Mask, Sealed};
use parry_continuum::distance::{Scalar, Vec3};
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// Two numbers that know nothing of each other.
#[derive(Clone, Copy, Debug)]
struct Pair([f64; 2]);

#[derive(Clone, Copy, Debug)]
struct PairMask([bool; 2]);

impl Pair {
    fn each(self, of: impl Fn(f64) -> f64) -> Self {
        Self(self.0.map(of))
    }

    fn with(self, other: Self, of: impl Fn(f64, f64) -> f64) -> Self {
        Self([of(self.0[0], other.0[0]), of(self.0[1], other.0[1])])
    }

    fn compare(self, other: Self, of: impl Fn(f64, f64) -> bool) -> PairMask {
        PairMask([of(self.0[0], other.0[0]), of(self.0[1], other.0[1])])
    }
}

impl Add for Pair {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        self.with(other, |a, b| a + b)
    }
}

impl Sub for Pair {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self.with(other, |a, b| a - b)
    }
}

impl Mul for Pair {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        self.with(other, |a, b| a * b)
    }
}

impl Div for Pair {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        self.with(other, |a, b| a / b)
    }
}

impl Neg for Pair {
    type Output = Self;
    fn neg(self) -> Self {
        self.each(|a| -a)
    }
}

impl BitAnd for PairMask {
    type Output = Self;
    fn bitand(self, other: Self) -> Self {
        Self([self.0[0] & other.0[0], self.0[1] & other.0[1]])
    }
}

impl BitOr for PairMask {
    type Output = Self;
    fn bitor(self, other: Self) -> Self {
        Self([self.0[0] | other.0[0], self.0[1] | other.0[1]])
    }
}

impl Not for PairMask {
    type Output = Self;
    fn not(self) -> Self {
        Self(self.0.map(|lane| !lane))
    }
}

impl Sealed for PairMask {}
impl Sealed for Pair {}

impl Mask<Pair> for PairMask {
    fn select(self, yes: Pair, no: Pair) -> Pair {
        Pair([0, 1].map(|lane| if self.0[lane] { yes.0[lane] } else { no.0[lane] }))
    }
}

impl Scalar for Pair {
    type Mask = PairMask;
    const UNIT_ROUNDOFF: f64 = f64::UNIT_ROUNDOFF;
    const FACE_PASSES: usize = f64::FACE_PASSES;
    const HALLEY_STEPS: usize = f64::HALLEY_STEPS;

    fn lit(self, value: f64) -> Self {
        Self([value; 2])
    }
    fn lt(self, other: Self) -> PairMask {
        self.compare(other, |a, b| a < b)
    }
    fn le(self, other: Self) -> PairMask {
        self.compare(other, |a, b| a <= b)
    }
    fn abs(self) -> Self {
        self.each(f64::abs)
    }
    fn sqrt(self) -> Self {
        self.each(f64::sqrt)
    }
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        self * factor + addend
    }
    fn cbrt_estimate(self) -> Self {
        self.each(Scalar::cbrt_estimate)
    }
    fn power_of_two_to_unity(self) -> Self {
        self.each(Scalar::power_of_two_to_unity)
    }
}

fn together(first: &Input<f64>, second: &Input<f64>) -> Input<Pair> {
    let pair = |a: Vec3<f64>, b: Vec3<f64>| {
        Vec3::new(Pair([a.x, b.x]), Pair([a.y, b.y]), Pair([a.z, b.z]))
    };
    Input {
        triangle: [0, 1, 2].map(|i| pair(first.triangle[i], second.triangle[i])),
        plane_normal: pair(first.plane_normal, second.plane_normal),
        start: pair(first.start, second.start),
        end: pair(first.end, second.end),
        disc_normal: pair(first.disc_normal, second.disc_normal),
        radius: Pair([first.radius, second.radius]),
    }
}

#[test]
fn two_lanes_give_the_scalar_answers_bit_for_bit() {
    let inputs: Vec<Input<f64>> = distance_cases().iter().map(Input::from).collect();
    let answers: Vec<_> = inputs.iter().map(Input::answers).collect();
    for i in 0..inputs.len() {
        // A neighbour of another category, so that the lanes take different cases.
        let j = (i * 7 + 501) % inputs.len();
        let pairs = together(&inputs[i], &inputs[j]).answers();
        for (lane, case) in [i, j].into_iter().enumerate() {
            for (kernel, (pair, scalar)) in pairs.iter().zip(&answers[case]).enumerate() {
                let bits = |x: f64| x.to_bits();
                let lanes = |v: Vec3<Pair>| [v.x, v.y, v.z].map(|x| bits(x.0[lane]));
                let name = KERNELS[kernel];
                assert_eq!(bits(pair.distance.0[lane]), bits(scalar.distance), "{name} {case}");
                assert_eq!(
                    lanes(pair.point1),
                    <[f64; 3]>::from(scalar.point1).map(bits),
                    "{name} {case}"
                );
                assert_eq!(
                    lanes(pair.point2),
                    <[f64; 3]>::from(scalar.point2).map(bits),
                    "{name} {case}"
                );
            }
        }
    }
}

/// The two lanes disagree in every comparison that a kernel makes about whether shapes meet.
#[test]
fn the_lanes_take_different_cases() {
    let inputs: Vec<Input<f64>> = distance_cases().iter().map(Input::from).collect();
    for (kernel, name) in KERNELS.iter().enumerate() {
        let meets: Vec<_> =
            inputs.iter().map(|input| input.answers()[kernel].distance == 0.0).collect();
        let differ =
            (0..meets.len()).filter(|&i| meets[i] != meets[(i * 7 + 501) % meets.len()]).count();
        assert!(differ > meets.len() / 100, "{name}: {differ}");
    }
}
