//! The natural cubic spline that goes smoothly near points: of all functions f it makes the sum of
//! |y - f|^2 plus weight times the integral of |f''|^2 least.
//!
//! C. H. Reinsch, "Smoothing by spline functions", Numerische Mathematik 10, 1967. With h the
//! distances of the knots, R the tridiagonal matrix of (h_i-1 + h_i) / 3 and h_i / 6, and Q the
//! second differences, the second derivatives g at the inner knots solve (R + weight Q^T Q) g = Q^T
//! y, and the values are y - weight Q g. The matrix has five diagonals, so the time is proportional
//! to the number of points.
//!
//! How smooth it should be nobody says: generalised cross-validation does (P. Craven, G. Wahba,
//! Numerische Mathematik 31, 1979), which needs the trace of what maps y to the residuals. Of the
//! inverse the five diagonals suffice, and the factors give them (M. F. Hutchinson, F. R. de Hoog,
//! Numerische Mathematik 47, 1985). A parameter of the spline counts 1.4 times, as is usual against
//! the few cases in which cross-validation follows the noise.

use parry3d_f64::math::{Real, Vector};

/// How many times a parameter of the spline counts in the choice of its weight.
const CAUTION: Real = 1.4;

/// A parametric cubic spline.
#[derive(Clone, Debug)]
pub(super) struct SmoothingSpline {
    /// Ascending.
    pub knots: Vec<Real>,
    pub values: Vec<Vector>,
    /// The second derivatives at the knots; none at the two ends.
    pub seconds: Vec<Vector>,
}

/// The matrix with five diagonals as L D L^T.
struct Factors {
    diagonal: Vec<Real>,
    /// Below the diagonal, and below that.
    first: Vec<Real>,
    second: Vec<Real>,
}

/// The three numbers of a column of Q.
fn differences(knots: &[Real], k: usize) -> [Real; 3] {
    let [before, behind] = [knots[k + 1] - knots[k], knots[k + 2] - knots[k + 1]];
    [1.0 / before, -1.0 / before - 1.0 / behind, 1.0 / behind]
}

/// The diagonals of Q^T Q in row k.
fn squared_differences(knots: &[Real], k: usize, count: usize) -> [Real; 3] {
    let own = differences(knots, k);
    let next = if k + 1 < count { differences(knots, k + 1) } else { [0.0; 3] };
    let beyond = if k + 2 < count { differences(knots, k + 2) } else { [0.0; 3] };
    let [a, b, c] = own;
    [a * a + b * b + c * c, b * next[0] + c * next[1], c * beyond[0]]
}

impl Factors {
    fn new(knots: &[Real], weight: Real) -> Self {
        let count = knots.len() - 2;
        let (mut diagonal, mut first, mut second) =
            (vec![0.0; count], vec![0.0; count], vec![0.0; count]);
        for k in 0..count {
            let [whole, next, beyond] = squared_differences(knots, k, count);
            let mut pivot = (knots[k + 2] - knots[k]) / 3.0 + weight * whole;
            let mut below = (knots[k + 2] - knots[k + 1]) / 6.0 + weight * next;
            if k > 0 {
                pivot -= first[k - 1] * first[k - 1] * diagonal[k - 1];
                below -= first[k - 1] * second[k - 1] * diagonal[k - 1];
            }
            if k > 1 {
                pivot -= second[k - 2] * second[k - 2] * diagonal[k - 2];
            }
            diagonal[k] = pivot;
            first[k] = if k + 1 < count { below / pivot } else { 0.0 };
            second[k] = if k + 2 < count { weight * beyond / pivot } else { 0.0 };
        }
        Self { diagonal, first, second }
    }

    fn solve(&self, right: &mut [Vector]) {
        let count = right.len();
        for k in 0..count {
            if k > 0 {
                right[k] -= right[k - 1] * self.first[k - 1];
            }
            if k > 1 {
                right[k] -= right[k - 2] * self.second[k - 2];
            }
        }
        for k in (0..count).rev() {
            right[k] /= self.diagonal[k];
            if k + 1 < count {
                right[k] -= right[k + 1] * self.first[k];
            }
            if k + 2 < count {
                right[k] -= right[k + 2] * self.second[k];
            }
        }
    }

    /// The trace of its inverse times Q^T Q.
    fn trace(&self, knots: &[Real]) -> Real {
        let count = self.diagonal.len();
        // Rows of the inverse: the diagonal, and the two to the right of it.
        let (mut next, mut beyond) = ([0.0; 3], [0.0; 3]);
        let mut sum = 0.0;
        for k in (0..count).rev() {
            let (first, second) = (self.first[k], self.second[k]);
            let one = -first * next[0] - second * next[1];
            let two = -first * next[1] - second * beyond[0];
            let own = [1.0 / self.diagonal[k] - first * one - second * two, one, two];
            let squares = squared_differences(knots, k, count);
            sum += own[0] * squares[0] + 2.0 * (own[1] * squares[1] + own[2] * squares[2]);
            beyond = next;
            next = own;
        }
        sum
    }
}

/// What makes splines of points at some knots.
pub(super) struct Smoother<'a> {
    knots: &'a [Real],
    weight: Real,
    factors: Option<Factors>,
    /// The columns of Q.
    columns: Vec<[Real; 3]>,
}

impl<'a> Smoother<'a> {
    pub(super) fn new(knots: &'a [Real], weight: Real) -> Self {
        // Two points are on a line.
        let factors = (knots.len() > 2).then(|| Factors::new(knots, weight));
        let columns = (2..knots.len()).map(|k| differences(knots, k - 2)).collect();
        Self { knots, weight, factors, columns }
    }

    /// The spline near points.
    pub(super) fn spline(&self, points: &[Vector]) -> SmoothingSpline {
        let mut spline =
            SmoothingSpline { knots: self.knots.to_vec(), values: Vec::new(), seconds: Vec::new() };
        self.fill(points.iter().copied(), &mut spline);
        spline
    }

    /// Makes a spline at the same knots the one near points, in the memory that it has.
    pub(super) fn fill(
        &self,
        points: impl ExactSizeIterator<Item = Vector>,
        spline: &mut SmoothingSpline,
    ) {
        let SmoothingSpline { values, seconds, .. } = spline;
        values.clear();
        values.extend(points);
        seconds.clear();
        seconds.resize(values.len(), Vector::ZERO);
        let Some(factors) = &self.factors else { return };
        let last = values.len() - 1;
        let bends = &mut seconds[1..last];
        for ((bend, points), [a, b, c]) in
            bends.iter_mut().zip(values.windows(3)).zip(&self.columns)
        {
            *bend = points[0] * *a + points[1] * *b + points[2] * *c;
        }
        factors.solve(bends);
        for (k, (&bend, column)) in bends.iter().zip(&self.columns).enumerate() {
            for (value, factor) in values[k..].iter_mut().zip(column) {
                *value -= bend * (self.weight * factor);
            }
        }
    }

    /// How little its spline may be trusted: the score of cross-validation.
    pub(super) fn score(&self, points: &[Vector]) -> Real {
        let Some(factors) = &self.factors else { return 0.0 };
        let values = self.spline(points).values;
        let squares: Real =
            points.iter().zip(&values).map(|(a, b)| (*a - *b).length_squared()).sum();
        let (count, free) = (points.len() as Real, self.weight * factors.trace(self.knots));
        let counted = count - CAUTION * (count - free);
        // Where more parameters are counted than there are points, nothing can be said for it.
        if counted > 0.0 { squares / (counted * counted) } else { Real::INFINITY }
    }
}

impl SmoothingSpline {
    /// The value and the first derivative between knot k and the next, at a share of the way.
    pub(super) fn at(&self, k: usize, share: Real) -> [Vector; 2] {
        let h = self.knots[k + 1] - self.knots[k];
        let (a, b) = (1.0 - share, share);
        let [from, to] = [self.values[k], self.values[k + 1]];
        let [m, n] = [self.seconds[k], self.seconds[k + 1]];
        let value = from * a + to * b + (m * (a * a * a - a) + n * (b * b * b - b)) * (h * h / 6.0);
        let slope =
            (to - from) / h + (n * (3.0 * b * b - 1.0) - m * (3.0 * a * a - 1.0)) * (h / 6.0);
        [value, slope]
    }

    /// How far it is from the points at most.
    pub(super) fn largest_residual(&self, points: &[Vector]) -> Real {
        points.iter().zip(&self.values).fold(0.0, |most: Real, (a, b)| most.max((*a - *b).length()))
    }
}
