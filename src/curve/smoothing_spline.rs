//! The natural cubic smoothing spline: of all functions f it minimises the sum of `m |y - f|^2`
//! plus `weight` times the integral of `|f''|^2`.
//!
//! # Definitions
//! - `y`: the points at the knots. `h_i`: the distances of the knots.
//! - `m`: how many measured points a knot stands for; `y` is then their mean. `M`: the diagonal
//!   matrix of all `m`.
//! - `R`: the tridiagonal matrix of `(h_i-1 + h_i) / 3` and `h_i / 6`. `Q`: the second differences.
//! - `g`: the second derivatives at the inner knots.
//!
//! # Algorithm
//! 1. **Solve** `(R + weight Q^T M^-1 Q) g = Q^T y`. The matrix has five diagonals, so the time is
//!    proportional to the number of knots. The values are `y - weight M^-1 Q g`. (C. H. Reinsch,
//!    "Smoothing by spline functions", Numerische Mathematik 10, 1967.)
//! 2. **Score** a weight by generalised cross-validation (P. Craven, G. Wahba, Numerische
//!    Mathematik 31, 1979). It needs the trace of the map from y to the residuals. The sum of
//!    squares is taken over all measured points.
//! 3. **Trace.** Five diagonals of the inverse suffice, and the factors yield them (M. F.
//!    Hutchinson, F. R. de Hoog, Numerische Mathematik 47, 1985).
//!
//! A parameter of the spline counts [`CAUTION`] times. This is the usual remedy for the few cases
//! in which cross-validation follows the noise.

use parry3d_f64::math::{Real, Vector};

/// The weight of a parameter of the spline in the score.
const CAUTION: Real = 1.4;

/// A parametric cubic spline.
#[derive(Clone, Debug)]
pub(super) struct SmoothingSpline {
    /// Ascending parameters.
    pub knots: Vec<Real>,
    pub values: Vec<Vector>,
    /// The second derivatives at the knots; zero at both ends.
    pub seconds: Vec<Vector>,
}

/// The knots of a spline.
#[derive(Clone, Debug)]
pub(super) struct Knots {
    /// Ascending parameters.
    pub places: Vec<Real>,
    /// How many measured points each knot stands for.
    pub counts: Vec<Real>,
}

/// The matrix with five diagonals, factored as L D L^T.
struct Factors {
    diagonal: Vec<Real>,
    /// The first and the second diagonal below the main one.
    first: Vec<Real>,
    second: Vec<Real>,
}

/// Returns the three entries of column k of Q.
fn differences(knots: &[Real], k: usize) -> [Real; 3] {
    let [before, behind] = [knots[k + 1] - knots[k], knots[k + 2] - knots[k + 1]];
    [1.0 / before, -1.0 / before - 1.0 / behind, 1.0 / behind]
}

/// Returns the diagonals of Q^T M^-1 Q in row k.
fn squared_differences(Knots { places, counts }: &Knots, k: usize) -> [Real; 3] {
    let rows = places.len() - 2;
    let own = differences(places, k);
    let next = if k + 1 < rows { differences(places, k + 1) } else { [0.0; 3] };
    let beyond = if k + 2 < rows { differences(places, k + 2) } else { [0.0; 3] };
    let [a, b, c] = own;
    let [d, e, f] = [0, 1, 2].map(|point: usize| own[point] / counts[k + point]);
    [a * d + b * e + c * f, e * next[0] + f * next[1], f * beyond[0]]
}

impl Factors {
    fn new(knots: &Knots, weight: Real) -> Self {
        let places = &knots.places;
        let count = places.len() - 2;
        let (mut diagonal, mut first, mut second) =
            (vec![0.0; count], vec![0.0; count], vec![0.0; count]);
        for k in 0..count {
            let [whole, next, beyond] = squared_differences(knots, k);
            let mut pivot = (places[k + 2] - places[k]) / 3.0 + weight * whole;
            let mut below = (places[k + 2] - places[k + 1]) / 6.0 + weight * next;
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

    /// Returns the trace of the inverse times Q^T M^-1 Q (step 3).
    fn trace(&self, knots: &Knots) -> Real {
        let count = self.diagonal.len();
        // Rows of the inverse: the diagonal and the two entries to the right.
        let (mut next, mut beyond) = ([0.0; 3], [0.0; 3]);
        let mut sum = 0.0;
        for k in (0..count).rev() {
            let (first, second) = (self.first[k], self.second[k]);
            let one = -first * next[0] - second * next[1];
            let two = -first * next[1] - second * beyond[0];
            let own = [1.0 / self.diagonal[k] - first * one - second * two, one, two];
            let squares = squared_differences(knots, k);
            sum += own[0] * squares[0] + 2.0 * (own[1] * squares[1] + own[2] * squares[2]);
            beyond = next;
            next = own;
        }
        sum
    }
}

/// Computes splines of points at fixed knots with a fixed weight.
pub(super) struct Smoother<'a> {
    knots: &'a Knots,
    weight: Real,
    factors: Option<Factors>,
    /// The columns of Q, and of weight M^-1 Q.
    columns: Vec<[Real; 3]>,
    pulls: Vec<[Real; 3]>,
}

impl<'a> Smoother<'a> {
    pub(super) fn new(knots: &'a Knots, weight: Real) -> Self {
        let places = &knots.places;
        // Two points are on a line.
        let factors = (places.len() > 2).then(|| Factors::new(knots, weight));
        let columns: Vec<_> = (2..places.len()).map(|k| differences(places, k - 2)).collect();
        let pull = |(column, counts): (&[Real; 3], &[Real])| {
            [0, 1, 2].map(|point: usize| weight * column[point] / counts[point])
        };
        let pulls = columns.iter().zip(knots.counts.windows(3)).map(pull).collect();
        Self { knots, weight, factors, columns, pulls }
    }

    /// Returns the spline near `points` (step 1).
    pub(super) fn spline(&self, points: &[Vector]) -> SmoothingSpline {
        let knots = self.knots.places.clone();
        let mut spline = SmoothingSpline { knots, values: Vec::new(), seconds: Vec::new() };
        self.fill(points.iter().copied(), &mut spline);
        spline
    }

    /// As [`spline`](Self::spline), in the memory of `spline`.
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
        for (k, (&bend, pull)) in bends.iter().zip(&self.pulls).enumerate() {
            for (value, pull) in values[k..k + 3].iter_mut().zip(pull) {
                *value -= bend * *pull;
            }
        }
    }

    /// Returns the score of cross-validation; less is better (step 2). `scatter`: the sum of the
    /// squared distances of all measured points from the means of their knots.
    pub(super) fn score(&self, points: &[Vector], scatter: Real) -> Real {
        let Some(factors) = &self.factors else { return 0.0 };
        let values = self.spline(points).values;
        let pairs = points.iter().zip(&values).zip(&self.knots.counts);
        let squares: Real = pairs.map(|((a, b), count)| (*a - *b).length_squared() * count).sum();
        let squares = squares + scatter;
        let (knots, free) = (points.len() as Real, self.weight * factors.trace(self.knots));
        let counted = self.knots.counts.iter().sum::<Real>() - CAUTION * (knots - free);
        // Without degrees of freedom the weight cannot be chosen.
        if counted > 0.0 { squares / (counted * counted) } else { Real::INFINITY }
    }
}

impl SmoothingSpline {
    /// Returns value and first derivative at a share of the interval between knots k and k + 1.
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

    /// Returns the largest distance of the spline from the points.
    pub(super) fn largest_residual(&self, points: &[Vector]) -> Real {
        let squares = points.iter().zip(&self.values).map(|(a, b)| (*a - *b).length_squared());
        squares.fold(0.0, Real::max).sqrt()
    }
}
