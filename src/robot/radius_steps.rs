//! Where the radius steps up along a robot.

use parry3d_f64::math::Real;

/// Radii that differ by no more than this share, 2^-32, are one: what a simulator's many steps
/// leave of a constant. What is meant to be a step is larger by far.
const SAME: Real = 1.0 / (1_u64 << 32) as Real;

/// A walk along a robot's radii.
#[derive(Default)]
pub(super) struct RadiusSteps {
    /// The first of the radii that are one. (Not the last, so that a slow taper is a taper.)
    first: Option<Real>,
}

impl RadiusSteps {
    /// Whether the next radius begins a wider tube than the one before. The first does.
    pub(super) fn is_up(&mut self, radius: Real) -> bool {
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

/// Whether a radius is that of a tube whose first is given, but for rounding.
pub(super) fn is_same(first: Real, radius: Real) -> bool {
    (radius - first).abs() <= SAME * first
}

/// Whether a tube of the one radius goes on in a wider one of the other.
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
        // Each is the last one but for rounding, and the sum is not.
        let taper: Vec<_> = (0..200).map(|k| r * (1.0 + 1e-11 * Real::from(k))).collect();
        let found = ups(&taper);
        assert!((5..=10).contains(&found.iter().filter(|up| **up).count()), "{found:?}");
        assert_eq!(ups(&[0.0, 0.0, 0.1]), [true, false, true]);
    }
}
