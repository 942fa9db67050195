//! A small seeded generator (xorshift64*): every run has the same sample, on every machine.

use parry_continuum::parry::math::{Pose, Vector};

/// A seeded generator.
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

    /// Returns a number uniform in `[0, 1)`.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * 2.0_f64.powi(-53)
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    pub fn below(&mut self, count: u32) -> u32 {
        (self.bits() >> 32) as u32 % count
    }

    /// Returns a point uniform in a cube of half width 1.
    pub fn point(&mut self) -> Vector {
        Vector::new(self.between(-1.0, 1.0), self.between(-1.0, 1.0), self.between(-1.0, 1.0))
    }

    /// Returns a unit vector.
    pub fn direction(&mut self) -> Vector {
        loop {
            let point = self.point();
            let length = point.length();
            if length > 0.1 && length <= 1.0 {
                return point / length;
            }
        }
    }

    /// Returns a pose with any rotation, and a translation of up to `size` in each coordinate.
    pub fn pose(&mut self, size: f64) -> Pose {
        let angle = self.between(0.0, std::f64::consts::PI);
        Pose::new(self.point() * size, self.direction() * angle)
    }
}
