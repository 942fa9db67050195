//! Conversions between parry's vectors and the distance kernels' vectors.

use crate::distance::Vec3;
use parry3d_f64::math::Vector;

impl From<Vector> for Vec3<f64> {
    #[inline(always)]
    fn from(vector: Vector) -> Self {
        Self::new(vector.x, vector.y, vector.z)
    }
}

impl From<Vec3<f64>> for Vector {
    #[inline(always)]
    fn from(vector: Vec3<f64>) -> Self {
        Self::new(vector.x, vector.y, vector.z)
    }
}
