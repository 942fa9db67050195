//! Bounds on a part of a curve between two samples.

use parry3d_f64::math::Real;

/// Bounds on a part of a curve.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct CurveBound {
    /// Upper bound on the curvature.
    pub curvature: Real,
    /// Upper bound on the distance of the curve's points from their nominal places.
    pub off: Real,
}

impl CurveBound {
    pub(super) fn max(self, other: Self) -> Self {
        Self { curvature: self.curvature.max(other.curvature), off: self.off.max(other.off) }
    }
}
