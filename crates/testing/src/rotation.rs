//! Rotations of integer points without rounding: R(q) of an integer quaternion q, times |q|^2.

use crate::Random;
use parry_continuum::parry::math::Vector;

/// A rotation times `scale`.
#[derive(Clone, Copy, Debug)]
pub struct Rotation {
    rows: [Vector; 3],
    /// The factor by which lengths grow.
    pub scale: f64,
}

impl Rotation {
    pub fn new([a, b, c, d]: [i32; 4]) -> Self {
        let row = |x, y, z| Vector::new(f64::from(x), f64::from(y), f64::from(z));
        Self {
            rows: [
                row(a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c)),
                row(2 * (b * c + a * d), a * a - b * b + c * c - d * d, 2 * (c * d - a * b)),
                row(2 * (b * d - a * c), 2 * (c * d + a * b), a * a - b * b - c * c + d * d),
            ],
            scale: f64::from(a * a + b * b + c * c + d * d),
        }
    }

    /// Returns the point rotated and scaled. Exact while every product and sum is an integer below
    /// 2^53.
    pub fn apply(&self, point: Vector) -> Vector {
        let [x, y, z] = self.rows;
        Vector::new(x.dot(point), y.dot(point), z.dot(point))
    }
}

impl Random {
    /// Returns a rotation by an integer quaternion with components of magnitude up to `bound`, not
    /// along an axis.
    pub fn rotation(&mut self, bound: i32) -> Rotation {
        loop {
            let q = [0; 4].map(|_| self.below(2 * bound as u32 + 1) as i32 - bound);
            if q.iter().filter(|&&component| component != 0).count() > 2 {
                return Rotation::new(q);
            }
        }
    }

    /// Returns an integer in `low..=high`, as `f64`.
    pub fn whole(&mut self, low: i64, high: i64) -> f64 {
        (low + (self.bits() % (high - low + 1) as u64) as i64) as f64
    }
}
