//! A polynomial in pieces whose roots are of comparable size.
//!
//! The upper hull of the points (k, log2 |a_k|), Newton's polygon, tells the roots' sizes: an edge
//! from i to j stands for j - i roots of magnitude about (|a_i| / |a_j|)^(1 / (j - i)). Where two
//! edges meet at k and their magnitudes lie far apart, the roots on either side are nearly the
//! roots of a_i .. a_k and of a_k .. a_j by themselves, off by about the ratio of their sizes; the
//! polish on the whole polynomial removes that. So the polynomial is cut there, and each piece is
//! scaled by powers of two, in x and in value, until nothing in it overflows or vanishes. That
//! makes every range of coefficients the same to a finder.

use super::Real;

/// How a piece is scaled in x.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Tilt {
    /// Its largest root is about 1, so no coefficient is large.
    LargestRoot,
    /// Its first and last coefficients are about 1, so that many roots of spread sizes do not
    /// vanish.
    Balanced,
}

/// A polynomial in y with x = 2^`shift` y.
#[derive(Clone, Copy)]
pub(super) struct Piece<T, const M: usize> {
    /// Lowest power first; the coefficient of y^`degree` is 1, those beyond are 0.
    pub monic: [T; M],
    pub degree: usize,
    pub shift: i32,
}

/// The exponents of the coefficients, `None` for 0.
pub(super) struct Exponents<const M: usize>([Option<i32>; M]);

impl<const M: usize> Exponents<M> {
    pub(super) fn of<T: Real>(coefficients: &[T; M]) -> Self {
        Self(coefficients.map(|a| if a == T::ZERO { None } else { Some(a.exponent()) }))
    }

    /// Whether the coefficients are so close in size that cutting and scaling are unnecessary.
    pub(super) fn are_close<T: Real>(&self) -> bool {
        let (mut low, mut high) = (i32::MAX, i32::MIN);
        for &e in self.0.iter().flatten() {
            low = low.min(e);
            high = high.max(e);
        }
        high - low <= T::MANTISSA_BITS / 2
    }

    /// The power of two that brings the largest of the coefficients to 1 where x = 2^`shift` y.
    pub(super) fn scale_to_one(&self, shift: i32) -> i32 {
        let scaled = (0..M).filter_map(|k| self.0[k].map(|e| e + shift * k as i32));
        -scaled.max().unwrap_or(0)
    }

    fn at(&self, index: usize) -> i32 {
        // The ends of an edge and of a piece are never 0.
        self.0[index].unwrap_or(0)
    }

    /// Where Newton's polygon goes next from `from`, at most to `to`: along the steepest way up.
    fn next_vertex(&self, from: usize, to: usize) -> usize {
        let mut best = to;
        for k in from + 1..to {
            if let Some(e) = self.0[k] {
                let (rise, run) = (e - self.at(from), (k - from) as i32);
                let (best_rise, best_run) = (self.at(best) - self.at(from), (best - from) as i32);
                if rise * best_run > best_rise * run {
                    best = k;
                }
            }
        }
        best
    }

    /// The end of the first piece of `from`..=`to`.
    pub(super) fn piece_end<T: Real>(&self, from: usize, to: usize, tilt: Tilt) -> usize {
        let mut end = to;
        loop {
            let Some((gap, vertex)) = self.widest_gap(from, end) else { return end };
            let spans = self.height(from, end, tilt);
            // Sizes 2^13 or 2^6 apart.
            if gap <= T::MANTISSA_BITS / 4 && spans <= T::SAFE_EXPONENT {
                return end;
            }
            end = vertex;
        }
    }

    /// The vertex inside `from`..`to` where the sizes of the roots differ most, and by how many
    /// powers of two.
    fn widest_gap(&self, from: usize, to: usize) -> Option<(i32, usize)> {
        let mut widest: Option<(i32, usize)> = None;
        let mut start = from;
        let mut vertex = self.next_vertex(start, to);
        while vertex < to {
            let next = self.next_vertex(vertex, to);
            let slope = |i: usize, j: usize| (self.at(j) - self.at(i)) / (j - i) as i32;
            let gap = slope(start, vertex) - slope(vertex, next);
            if widest.is_none_or(|(most, _)| gap > most) {
                widest = Some((gap, vertex));
            }
            (start, vertex) = (vertex, next);
        }
        widest
    }

    /// The largest exponent among the scaled coefficients of the monic piece, or for
    /// [`Tilt::LargestRoot`] the smallest, negated.
    fn height(&self, from: usize, to: usize, tilt: Tilt) -> i32 {
        let shift = self.shift(from, to, tilt);
        let scaled = |k: usize| self.0[k].map(|e| e - self.at(to) - shift * (to - k) as i32);
        match tilt {
            Tilt::LargestRoot => -scaled(from).unwrap_or(0),
            Tilt::Balanced => (from..=to).filter_map(scaled).max().unwrap_or(0),
        }
    }

    /// The power of two in x for the piece.
    fn shift(&self, from: usize, to: usize, tilt: Tilt) -> i32 {
        let slope = |k: usize| self.0[k].map(|e| (e - self.at(to)).div_euclid((to - k) as i32) + 1);
        match tilt {
            Tilt::LargestRoot => (from..to).filter_map(slope).max().unwrap_or(0),
            Tilt::Balanced => slope(from).unwrap_or(0),
        }
    }

    /// The piece `from`..=`to` of the polynomial.
    pub(super) fn piece<T: Real>(
        &self,
        coefficients: &[T; M],
        from: usize,
        to: usize,
        tilt: Tilt,
    ) -> Piece<T, M> {
        let shift = self.shift(from, to, tilt);
        let leading = coefficients[to].times_power_of_two(-self.at(to));
        let mut monic = [T::ZERO; M];
        for (k, place) in monic.iter_mut().enumerate().take(to - from) {
            let scale = -self.at(to) - shift * (to - from - k) as i32;
            *place = coefficients[from + k].times_power_of_two(scale) / leading;
        }
        monic[to - from] = T::ONE;
        Piece { monic, degree: to - from, shift }
    }
}

/// The polynomial `from`..=`to` as it is, made monic.
#[inline]
pub(super) fn whole<T: Real, const M: usize>(
    coefficients: &[T; M],
    from: usize,
    to: usize,
) -> Piece<T, M> {
    let mut monic = [T::ZERO; M];
    let leading = coefficients[to];
    for k in 0..to - from {
        monic[k] = coefficients[from + k] / leading;
    }
    monic[to - from] = T::ONE;
    Piece { monic, degree: to - from, shift: 0 }
}
