//! Where the radius steps up along a robot.

use parry3d_f64::math::Real;

/// Radii that differ by at most this relative difference, 2^-32, are equal. It exceeds the rounding
/// that many steps of a simulator add to a constant radius; intended steps are far larger.
const SAME: Real = 1.0 / (1_u64 << 32) as Real;

/// Finds the steps up while walking along a robot's radii.
#[derive(Default)]
pub(crate) struct RadiusSteps {
    /// The first of the current equal radii. (Comparing with the last would hide a slow taper.)
    first: Option<Real>,
}

impl RadiusSteps {
    /// Returns whether the next radius begins a wider tube than the one before. The first always
    /// does.
    pub(crate) fn is_up(&mut self, radius: Real) -> bool {
        match self.first {
            Some(first) if radius <= first * (1.0 + SAME) => {
                if !is_same(first, radius) {
                    self.first = Some(radius);
                }
                false
            }
            _ => {
                self.first = Some(radius);
                true
            }
        }
    }
}

/// Returns whether `radius` equals the radius `first` of a tube, up to rounding.
pub(crate) fn is_same(first: Real, radius: Real) -> bool {
    (radius - first).abs() <= SAME * first
}

/// Returns whether a tube of radius `from` meets a wider one of radius `to`.
pub(crate) fn is_step(from: Real, to: Real) -> bool {
    to > from && !is_same(to, from)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_is_no_step_and_a_taper_is_one() {
        let ups = |radii: &[Real]| {
            let mut steps = RadiusSteps::default();
            radii.iter().map(|&radius| steps.is_up(radius)).collect::<Vec<_>>()
        };
        let r: Real = 0.3;
        assert_eq!(
            ups(&[r, r.next_up(), r.next_down(), r * (1.0 + 1e-11), r]),
            [true, false, false, false, false]
        );
        assert_eq!(ups(&[r, 0.9 * r, r]), [true, false, true]);
        assert_eq!(ups(&[r, r * (1.0 + 1e-9)]), [true, true]);
        // Neighbours are equal up to rounding; their accumulated difference is a step.
        let taper: Vec<_> = (0..200).map(|k| r * (1.0 + 1e-11 * Real::from(k))).collect();
        let found = ups(&taper);
        assert!((5..=10).contains(&found.iter().filter(|up| **up).count()), "{found:?}");
        assert_eq!(ups(&[0.0, 0.0, 0.1]), [true, false, true]);
    }
}
