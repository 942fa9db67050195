//! What several tests share: reading the reference cases.
#![allow(dead_code)] // each test uses its part

pub mod certificate;
#[cfg(feature = "gpu")]
pub mod gpu;
pub mod kernels;
pub mod precision;
pub mod problems;
pub mod rotation;

use parry_continuum::parry::math::{Pose, Vector};
use serde::Deserialize;

/// A reference distance: the inputs of one pair and the distance to 30 digits.
#[derive(Clone, Debug, Deserialize)]
pub struct Case {
    pub id: String,
    pub kind: String,
    pub cat: String,
    #[serde(default)]
    pub tri: [[f64; 3]; 3],
    #[serde(default)]
    pub s0: [f64; 3],
    #[serde(default)]
    pub s1: [f64; 3],
    #[serde(default)]
    pub u0: [f64; 3],
    #[serde(default)]
    pub u1: [f64; 3],
    #[serde(default)]
    pub p: [f64; 3],
    #[serde(default)]
    pub c: [f64; 3],
    #[serde(default)]
    pub n: [f64; 3],
    #[serde(default)]
    pub p0: [f64; 3],
    #[serde(default)]
    pub p1: [f64; 3],
    #[serde(default)]
    pub r: f64,
    #[serde(default)]
    pub caps: Vec<String>,
    pub d: String,
    pub scale: f64,
    pub mag: f64,
    pub f32: bool,
}

impl Case {
    /// The expected distance, rounded to f64.
    pub fn distance(&self) -> f64 {
        self.d.parse().expect("a decimal number")
    }

    /// Which caps are flat, for the kinds that have caps.
    pub fn flat(&self) -> [bool; 2] {
        match self.kind.as_str() {
            "triangle_cylinder" => [true, true],
            "triangle_modified_cylinder" => [self.caps[0] == "flat", self.caps[1] == "flat"],
            _ => [false, false],
        }
    }
}

/// Reads one JSON value a line.
pub fn read_lines<T: for<'a> Deserialize<'a>>(text: &str) -> Vec<T> {
    text.lines().map(|line| serde_json::from_str(line).expect("a line of JSON")).collect()
}

/// The reference distances.
pub fn distance_cases() -> Vec<Case> {
    read_lines(include_str!("../data/distance.jsonl"))
}

/// A small seeded generator (xorshift64*), so that every run tests the same sample.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    pub fn bits(&mut self) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        self.0.wrapping_mul(0x2545_f491_4f6c_dd1d)
    }

    /// Uniform in `[0, 1)`.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * 2.0_f64.powi(-53)
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    pub fn below(&mut self, count: u32) -> u32 {
        (self.bits() >> 32) as u32 % count
    }

    /// Uniform in a cube of half width 1.
    pub fn point(&mut self) -> Vector {
        Vector::new(self.between(-1.0, 1.0), self.between(-1.0, 1.0), self.between(-1.0, 1.0))
    }

    /// A unit vector.
    pub fn direction(&mut self) -> Vector {
        loop {
            let point = self.point();
            let length = point.length();
            if length > 0.1 && length <= 1.0 {
                return point / length;
            }
        }
    }

    /// Any rotation, and a translation of up to `size` in each coordinate.
    pub fn pose(&mut self, size: f64) -> Pose {
        let angle = self.between(0.0, std::f64::consts::PI);
        Pose::new(self.point() * size, self.direction() * angle)
    }
}
