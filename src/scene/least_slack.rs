//! The least slack of many queries, between bounds: for tubes and motions.
//!
//! # Definitions
//! - [l, u]: the bounds on the clearance of one query; m: its margin. The slack is within
//!   [l - m, u - m].
//! - `lower` and `upper`: the least l - m and the least u - m so far.
//!
//! # Claim
//! `lower <= least slack <= upper`. If every query meets a tolerance, so does `upper - lower`.
//!
//! **Proof.** Let query k have the least l - m. Then `upper - lower <= u_k - l_k`. A query may stop
//! at l >= `upper` + m ([`LeastSlack::limit`]): the other bounds then decide.
//!
//! **Rounding.** Differences are rounded outward, unless they are exact.

use crate::distance::{DoubleDouble, Scalar};
use parry3d_f64::math::Real;

/// The bounds so far. `P` names a place.
pub(super) struct LeastSlack<P> {
    lower: Real,
    /// The uncertainty of the query with the least lower bound.
    uncertainty: Real,
    /// The least upper bound, the number of its query, and its place.
    best: Option<(Real, [usize; 3], P)>,
}

/// The bounds of the answer, and its place.
pub(super) struct BoundedSlack<P> {
    pub lower: Real,
    pub upper: Real,
    pub resolved: bool,
    pub uncertainty: Real,
    pub place: P,
}

impl<P> LeastSlack<P> {
    pub fn new() -> Self {
        Self { lower: Real::INFINITY, uncertainty: 0.0, best: None }
    }

    /// The slack from which queries do not matter.
    pub fn upper(&self) -> Real {
        self.best.as_ref().map_or(Real::INFINITY, |best| best.0)
    }

    /// The clearance from which a query with this margin does not matter.
    pub fn limit(&self, margin: Real) -> Real {
        (self.upper() + margin).next_up()
    }

    /// Adds the bounds of a query. Of equal upper bounds that of the lowest number counts.
    pub fn offer(
        &mut self,
        number: [usize; 3],
        margin: Real,
        [lower, upper]: [Real; 2],
        uncertainty: Real,
        place: P,
    ) {
        let (lower, upper) = (difference(lower, margin).0, difference(upper, margin).1);
        if lower < self.lower {
            (self.lower, self.uncertainty) = (lower, uncertainty);
        }
        let is_less = self
            .best
            .as_ref()
            .is_none_or(|(least, first, _)| upper < *least || (upper == *least && number < *first));
        if is_less {
            self.best = Some((upper, number, place));
        }
    }

    /// The answer; `None` without a query.
    pub fn answer(self, tolerance: Real) -> Option<BoundedSlack<P>> {
        let Self { lower, uncertainty, best } = self;
        let (upper, _, place) = best?;
        // Both may be infinite.
        let resolved = lower == upper || upper - lower <= tolerance + uncertainty;
        Some(BoundedSlack { lower: lower.min(upper), upper, resolved, uncertainty, place })
    }
}

/// The clearance minus the margin, which may be infinite, rounded down and up.
fn difference(clearance: Real, margin: Real) -> (Real, Real) {
    if margin == Real::INFINITY {
        return (Real::NEG_INFINITY, Real::NEG_INFINITY);
    }
    let exact = DoubleDouble::from(clearance) - margin.into();
    let rounded = exact.rounded();
    let down = if exact.lt(rounded.into()) { rounded.next_down() } else { rounded };
    let up = if DoubleDouble::from(rounded).lt(exact) { rounded.next_up() } else { rounded };
    (down, up)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slacks_are_rounded_outward_unless_they_are_exact() {
        assert_eq!(difference(3.0, 1.0), (2.0, 2.0));
        let (down, up) = difference(1.0, 1e-20);
        assert_eq!((down, up), (1.0_f64.next_down(), 1.0));
        let (down, up) = difference(1e-20, 1.0);
        assert_eq!((down, up), (-1.0, (-1.0_f64).next_up()));
        assert_eq!(difference(5.0, Real::INFINITY), (Real::NEG_INFINITY, Real::NEG_INFINITY));
    }

    #[test]
    fn the_least_of_each_bound_counts() {
        let mut least = LeastSlack::new();
        assert_eq!(least.limit(1.0), Real::INFINITY);
        least.offer([0, 1, 0], 1.0, [3.0, 5.0], 0.5, "second");
        least.offer([1, 0, 1], 1.0, [4.0, 5.0], 0.0, "later");
        least.offer([0, 0, 0], 2.0, [5.5, 6.0], 0.0, "first");
        assert!(least.limit(1.0) >= 5.0 && least.limit(1.0) < 5.0 + 1e-9);
        let found = least.answer(1.5).unwrap();
        assert_eq!((found.lower, found.upper, found.place), (2.0, 4.0, "first"));
        assert!(found.resolved && found.uncertainty == 0.5);
        assert!(LeastSlack::<()>::new().answer(1.0).is_none());
    }
}
