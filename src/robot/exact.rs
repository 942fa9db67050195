//! Comparisons of distances that are decided as if by real arithmetic.
//!
//! A joint exactly one radius from the limit takes a round cap (Algorithm 1), and a vertex exactly one tolerance
//! from a chord may go (`simplify`). Such ties are common in hand-made robots, and rounding would decide them by
//! chance. So a sign that f64 leaves open is taken again on exact sums of f64, Shewchuk's expansions ("Adaptive
//! precision floating-point arithmetic and fast robust geometric predicates", 1997). Everything is first scaled by
//! a power of two to a size near 1. Exact holds as long as no product underflows then, that is while the lengths
//! in one comparison differ by less than a factor of about 1e75.

use super::scale::to_unit;
use parry3d_f64::math::{Real, Vector};
use std::cmp::Ordering;

/// The relative rounding error that no f64 evaluation below exceeds, with room to spare.
const FILTER: Real = 64.0 * Real::EPSILON;

/// Whether `p` and `q` are at least `radius` apart.
pub(super) fn at_least_apart(p: Vector, q: Vector, radius: Real) -> bool {
    let d = Difference::new(p, q);
    let scale = to_unit(d.rounded.abs().max_element().max(radius));
    d.scaled(scale).compare_length(radius * scale).is_ge()
}

/// Whether `p` is within `tolerance` of the segment from `a` to `b`, which has a length.
///
/// The points that are make up two balls around the ends and a cylinder between them.
pub(super) fn is_within(p: Vector, a: Vector, b: Vector, tolerance: Real) -> bool {
    let [from_a, from_b, chord] = [(p, a), (p, b), (b, a)].map(|(p, q)| Difference::new(p, q));
    let scale = to_unit(from_a.rounded.abs().max(chord.rounded.abs()).max_element().max(tolerance));
    let [from_a, from_b, chord] = [from_a, from_b, chord].map(|d| d.scaled(scale));
    let tolerance = tolerance * scale;
    from_a.compare_length(tolerance).is_le()
        || from_b.compare_length(tolerance).is_le()
        || (from_a.sign_of_dot(&chord).is_gt()
            && from_b.sign_of_dot(&chord).is_lt()
            && from_a.is_within_of_line(&chord, tolerance))
}

/// The exact difference of two points: its rounded value, and what rounding lost.
struct Difference {
    rounded: Vector,
    error: Vector,
}

impl Difference {
    /// Taken before scaling: two coordinates of any size may lie close together.
    fn new(p: Vector, q: Vector) -> Self {
        let rounded = p - q;
        let error = Vector::from([0, 1, 2].map(|i| two_sum(p[i], -q[i]).1));
        Self { rounded, error }
    }

    fn scaled(&self, scale: Real) -> Self {
        Self { rounded: self.rounded * scale, error: self.error * scale }
    }

    fn exact(&self) -> [Exact; 3] {
        [0, 1, 2].map(|i| Exact::sum(self.error[i], self.rounded[i]))
    }

    /// The length against `radius`.
    fn compare_length(&self, radius: Real) -> Ordering {
        let (squared, limit) = (self.rounded.length_squared(), radius * radius);
        sign(squared - limit, squared + limit, || {
            let d = self.exact();
            dot(&d, &d).minus(&Exact::product(radius, radius)).sign()
        })
    }

    fn sign_of_dot(&self, other: &Self) -> Ordering {
        let (w, e) = (self.rounded, other.rounded);
        sign(w.dot(e), w.length_squared() + e.length_squared(), || dot(&self.exact(), &other.exact()).sign())
    }

    /// Whether the point at this difference from a line's origin is within `tolerance` of the line along `e`:
    /// |w x e| <= tolerance |e|.
    fn is_within_of_line(&self, e: &Self, tolerance: Real) -> bool {
        let limit = tolerance * tolerance * e.rounded.length_squared();
        let size = self.rounded.length_squared() * e.rounded.length_squared() + limit;
        sign(self.rounded.cross(e.rounded).length_squared() - limit, size, || {
            let (w, e) = (self.exact(), e.exact());
            let normal = [(1, 2), (2, 0), (0, 1)].map(|(j, k)| w[j].times(&e[k]).minus(&w[k].times(&e[j])));
            if tolerance == 0.0 {
                // No square: it could underflow to a 0 that the component is not.
                return if normal.iter().all(|n| n.sign().is_eq()) {
                    Ordering::Equal
                } else {
                    Ordering::Greater
                };
            }
            dot(&normal, &normal).minus(&dot(&e, &e).times(&Exact::product(tolerance, tolerance))).sign()
        })
        .is_le()
    }
}

/// The sign of a number from its f64 value and the size of the terms that were added up to it, or, where rounding
/// or underflow could have made that value, from `exact`.
fn sign(value: Real, size: Real, exact: impl FnOnce() -> Ordering) -> Ordering {
    if value.abs() > FILTER * size + Real::MIN_POSITIVE { value.total_cmp(&0.0) } else { exact() }
}

/// A sum of f64 that stands for its exact value: no two terms overlap, none is zero, the last is the largest.
struct Exact(Vec<Real>);

impl Exact {
    fn zero() -> Self {
        Self(vec![])
    }

    fn sum(a: Real, b: Real) -> Self {
        Self::zero().plus_term(a).plus_term(b)
    }

    fn product(a: Real, b: Real) -> Self {
        let rounded = a * b;
        Self::sum(a.mul_add(b, -rounded), rounded)
    }

    /// One term more: it passes along the others from the smallest, leaving its rounding errors behind.
    fn plus_term(self, term: Real) -> Self {
        let mut sum = term;
        let mut terms = Vec::with_capacity(self.0.len() + 1);
        for other in self.0 {
            let (rounded, error) = two_sum(sum, other);
            if error != 0.0 {
                terms.push(error);
            }
            sum = rounded;
        }
        if sum != 0.0 {
            terms.push(sum);
        }
        Self(terms)
    }

    fn plus(self, other: &Self) -> Self {
        other.0.iter().fold(self, |sum, &term| sum.plus_term(term))
    }

    fn minus(self, other: &Self) -> Self {
        other.0.iter().fold(self, |sum, &term| sum.plus_term(-term))
    }

    fn times(&self, other: &Self) -> Self {
        let pairs = self.0.iter().flat_map(|&a| other.0.iter().map(move |&b| Self::product(a, b)));
        pairs.fold(Self::zero(), |sum, product| sum.plus(&product))
    }

    fn sign(&self) -> Ordering {
        self.0.last().map_or(Ordering::Equal, |largest| largest.total_cmp(&0.0))
    }
}

/// `a + b` rounded, and the exact error of that (Knuth).
fn two_sum(a: Real, b: Real) -> (Real, Real) {
    let sum = a + b;
    let part = sum - a;
    (sum, (a - (sum - part)) + (b - part))
}

fn dot(a: &[Exact; 3], b: &[Exact; 3]) -> Exact {
    a.iter().zip(b).fold(Exact::zero(), |sum, (a, b)| sum.plus(&a.times(b)))
}
