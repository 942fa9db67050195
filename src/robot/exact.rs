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
    let scale = to_unit((p - q).abs().max_element().max(radius));
    compare_distance(p * scale, q * scale, radius * scale).is_ge()
}

/// Whether `p` is within `tolerance` of the segment from `a` to `b`, which has a length.
///
/// The points that are make up two balls around the ends and a cylinder between them.
pub(super) fn is_within(p: Vector, a: Vector, b: Vector, tolerance: Real) -> bool {
    let size = (p - a).abs().max((b - a).abs()).max_element().max(tolerance);
    let scale = to_unit(size);
    let (p, a, b, tolerance) = (p * scale, a * scale, b * scale, tolerance * scale);
    compare_distance(p, a, tolerance).is_le()
        || compare_distance(p, b, tolerance).is_le()
        || (is_ahead(a, p, b) && is_ahead(b, p, a) && is_within_of_line(p, a, b, tolerance))
}

/// |p - q| against `radius`.
fn compare_distance(p: Vector, q: Vector, radius: Real) -> Ordering {
    let (squared, limit) = ((p - q).length_squared(), radius * radius);
    sign(squared - limit, squared + limit, || {
        let d = differences(p, q);
        dot(&d, &d).minus(&Exact::product(radius, radius))
    })
}

/// Whether `p` lies ahead of `a` when looking from there at `b`.
fn is_ahead(a: Vector, p: Vector, b: Vector) -> bool {
    let (w, e) = (p - a, b - a);
    sign(w.dot(e), w.length_squared() + e.length_squared(), || dot(&differences(p, a), &differences(b, a)))
        .is_gt()
}

/// Whether `p` is within `tolerance` of the line through `a` and `b`: |w x e| <= tolerance |e|.
fn is_within_of_line(p: Vector, a: Vector, b: Vector, tolerance: Real) -> bool {
    let (w, e) = (p - a, b - a);
    let limit = tolerance * tolerance * e.length_squared();
    let size = w.length_squared() * e.length_squared();
    sign(w.cross(e).length_squared() - limit, size + limit, || {
        let (w, e) = (differences(p, a), differences(b, a));
        let normal = [(1, 2), (2, 0), (0, 1)].map(|(j, k)| w[j].times(&e[k]).minus(&w[k].times(&e[j])));
        if tolerance == 0.0 {
            // The largest component decides; squares would only bring underflow nearer.
            let is_zero = normal.iter().all(|component| component.sign().is_eq());
            return Exact(if is_zero { vec![] } else { vec![1.0] });
        }
        dot(&normal, &normal).minus(&dot(&e, &e).times(&Exact::product(tolerance, tolerance)))
    })
    .is_le()
}

/// The sign of a number from its f64 value, the size of the terms that were added up to it, and its exact value.
fn sign(value: Real, size: Real, exact: impl FnOnce() -> Exact) -> Ordering {
    if value.abs() > FILTER * size { value.total_cmp(&0.0) } else { exact().sign() }
}

/// A sum of f64 that stands for its exact value: no two terms overlap, none is zero, the last is the largest.
struct Exact(Vec<Real>);

impl Exact {
    fn difference(a: Real, b: Real) -> Self {
        Self(vec![]).plus_term(a).plus_term(-b)
    }

    fn product(a: Real, b: Real) -> Self {
        let rounded = a * b;
        Self(vec![]).plus_term(a.mul_add(b, -rounded)).plus_term(rounded)
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
        pairs.fold(Self(vec![]), |sum, product| sum.plus(&product))
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

fn differences(p: Vector, q: Vector) -> [Exact; 3] {
    [0, 1, 2].map(|i| Exact::difference(p[i], q[i]))
}

fn dot(a: &[Exact; 3], b: &[Exact; 3]) -> Exact {
    a.iter().zip(b).fold(Exact(vec![]), |sum, (a, b)| sum.plus(&a.times(b)))
}
