//! One test text for double and single precision.

use parry_continuum::distance::{Scalar, Vec3};
use parry_continuum::parry::math::Vector;

/// A precision under test.
pub trait Precision: Scalar<Mask = bool> + Into<f64> + PartialEq + std::fmt::Debug {
    /// Half the spacing of numbers at 1.
    const UNIT: f64;

    fn from_f64(value: f64) -> Self;

    fn vec3(point: Vector) -> Vec3<Self> {
        Vec3::from(point.to_array().map(Self::from_f64))
    }
}

impl Precision for f64 {
    const UNIT: f64 = f64::EPSILON / 2.0;
    fn from_f64(value: f64) -> Self {
        value
    }
}

impl Precision for f32 {
    const UNIT: f64 = f32::EPSILON as f64 / 2.0;
    fn from_f64(value: f64) -> Self {
        value as f32
    }
}

/// Returns the point in `f64`.
pub fn vector<T: Into<f64>>(point: Vec3<T>) -> Vector {
    Vector::new(point.x.into(), point.y.into(), point.z.into())
}

/// Returns the largest coordinate difference of two points, or `length` if that is larger.
pub fn extent(points: &[Vector], length: f64) -> f64 {
    let low = points.iter().copied().reduce(Vector::min).unwrap_or_default();
    let high = points.iter().copied().reduce(Vector::max).unwrap_or_default();
    (high - low).max_element().max(length)
}
