//! The eigenvalues of the companion matrix.
//!
//! z^n + p_(n-1) z^(n-1) + ... + p_0 is the characteristic polynomial of the matrix with ones below
//! the diagonal and -p_k in the last column, which is in Hessenberg form from the start. Its
//! eigenvalues come out of the QR algorithm: balancing by powers of two, then Francis' implicit
//! double shifts (two conjugate shifts at a time, in real arithmetic), the matrix falling apart
//! into blocks of one or two rows (Golub and Van Loan, Matrix Computations, sections 7.4 and 7.5).
//! One sweep costs n^2 operations, and there are about two per root.

use super::method::{Method, Tilt};
use super::{Real, Roots};

/// Eigenvalues of the companion matrix, for any degree.
#[derive(Clone, Copy, Debug)]
pub struct Companion;

/// Sweeps per block before it is given up.
pub(crate) const SWEEPS: usize = 80;

impl Method for Companion {
    const TILT: Tilt = Tilt::Balanced;

    fn approximate<T: Real, const M: usize>(
        monic: &[T; M],
        degree: usize,
        roots: &mut Roots<T, M>,
    ) {
        let mut h = [[T::ZERO; M]; M];
        for k in 0..degree {
            h[k][degree - 1] = -monic[k];
        }
        for k in 1..degree {
            h[k][k - 1] = T::ONE;
        }
        balance(&mut h, degree);
        eigenvalues(&mut h, degree, roots);
    }
}

/// Scales rows and columns by powers of two until they are about equally long: a similarity that
/// leaves the eigenvalues alone and lessens what rounding does to them.
#[allow(clippy::needless_range_loop)] // rows and columns of a matrix
fn balance<T: Real, const M: usize>(h: &mut [[T; M]; M], n: usize) {
    for _ in 0..8 {
        let mut done = true;
        for i in 0..n {
            let (mut row, mut column) = (T::ZERO, T::ZERO);
            for j in (0..n).filter(|&j| j != i) {
                row = row + h[i][j].abs();
                column = column + h[j][i].abs();
            }
            if row == T::ZERO || column == T::ZERO {
                continue;
            }
            let shift = (row.exponent() - column.exponent()) / 2;
            if shift == 0 {
                continue;
            }
            done = false;
            for entry in h.iter_mut().take(n).map(|row| &mut row[i]) {
                *entry = entry.times_power_of_two(shift);
            }
            for entry in &mut h[i][..n] {
                *entry = entry.times_power_of_two(-shift);
            }
        }
        if done {
            break;
        }
    }
}

/// Adds the eigenvalues of a Hessenberg matrix, as many as converge.
fn eigenvalues<T: Real, const M: usize>(h: &mut [[T; M]; M], n: usize, roots: &mut Roots<T, M>) {
    let unit = T::of(T::UNIT_ROUNDOFF);
    let mut end = n; // rows from here on are done
    let mut sweeps = 0;
    while end > 0 {
        let last = end - 1;
        let mut start = last;
        while start > 0 {
            let below = h[start][start - 1].abs();
            if below <= unit * (h[start - 1][start - 1].abs() + h[start][start].abs()) {
                h[start][start - 1] = T::ZERO;
                break;
            }
            start -= 1;
        }
        if start == last {
            roots.push(h[last][last], T::ZERO);
            end -= 1;
            sweeps = 0;
        } else if start + 1 == last {
            block([[h[start][start], h[start][last]], [h[last][start], h[last][last]]], roots);
            end -= 2;
            sweeps = 0;
        } else if sweeps == SWEEPS {
            return;
        } else {
            sweeps += 1;
            sweep(h, start, last, sweeps % 20 == 0);
        }
    }
}

/// Adds the eigenvalues of a block of two rows.
fn block<T: Real, const M: usize>([[a, b], [c, d]]: [[T; 2]; 2], roots: &mut Roots<T, M>) {
    let p = (a - d) * T::of(0.5);
    let bc = b * c;
    let discriminant = p * p + bc;
    if discriminant < T::ZERO {
        roots.push_pair(d + p, (-discriminant).sqrt());
    } else {
        let root = discriminant.sqrt();
        let z = if p >= T::ZERO { p + root } else { p - root };
        roots.push(d + z, T::ZERO);
        roots.push(if z == T::ZERO { d } else { d - bc / z }, T::ZERO);
    }
}

/// One double-shift QR sweep over the rows `start`..=`last`, at least three.
fn sweep<T: Real, const M: usize>(
    h: &mut [[T; M]; M],
    start: usize,
    last: usize,
    exceptional: bool,
) {
    // The shifts are the eigenvalues of the last block: their sum and product.
    let (mut sum, mut product) = (
        h[last - 1][last - 1] + h[last][last],
        h[last - 1][last - 1] * h[last][last] - h[last - 1][last] * h[last][last - 1],
    );
    if exceptional {
        // Any other shift breaks a cycle.
        let size = h[last][last - 1].abs() + h[last - 1][last - 2].abs();
        let corner = h[last][last];
        sum = size * T::of(1.5) + corner + corner;
        product = size * size + corner * (size * T::of(1.5) + corner);
    }
    // The first column of (H - shift 1) (H - shift 2), up to a factor.
    let (h00, h10) = (h[start][start], h[start + 1][start]);
    let mut x = (h00 * (h00 - sum) + product) / h10 + h[start][start + 1];
    let mut y = h00 + h[start + 1][start + 1] - sum;
    let mut z = h[start + 2][start + 1];
    for k in start..last {
        let three = k + 2 <= last;
        if !three {
            z = T::ZERO;
        }
        let size = x.abs().max(y.abs()).max(z.abs());
        if size > T::ZERO {
            // The reflection 1 - v w^T that turns (x, y, z) into (-norm, 0, 0), with v = (1, v1,
            // v2).
            let (sx, sy, sz) = (x / size, y / size, z / size);
            let length = (sx * sx + sy * sy + sz * sz).sqrt();
            let norm = if sx < T::ZERO { -length } else { length };
            let pivot = sx + norm;
            let (v1, v2) = (sy / pivot, sz / pivot);
            let w0 = pivot / norm;
            let (w1, w2) = (w0 * v1, w0 * v2);
            if k > start {
                h[k][k - 1] = -(norm * size);
                h[k + 1][k - 1] = T::ZERO;
                if three {
                    h[k + 2][k - 1] = T::ZERO;
                }
            }
            if let [row0, row1, row2, ..] = &mut h[k..]
                && three
            {
                let columns =
                    row0[k..=last].iter_mut().zip(&mut row1[k..=last]).zip(&mut row2[k..=last]);
                for ((x, y), z) in columns {
                    let along = *x + v1 * *y + v2 * *z;
                    *x = *x - w0 * along;
                    *y = *y - w1 * along;
                    *z = *z - w2 * along;
                }
            } else if let [row0, row1, ..] = &mut h[k..] {
                for (x, y) in row0[k..=last].iter_mut().zip(&mut row1[k..=last]) {
                    let along = *x + v1 * *y;
                    *x = *x - w0 * along;
                    *y = *y - w1 * along;
                }
            }
            for row in &mut h[start..=last.min(k + 3)] {
                if let [x, y, z, ..] = &mut row[k..]
                    && three
                {
                    let along = w0 * *x + w1 * *y + w2 * *z;
                    *x = *x - along;
                    *y = *y - along * v1;
                    *z = *z - along * v2;
                } else if let [x, y, ..] = &mut row[k..] {
                    let along = w0 * *x + w1 * *y;
                    *x = *x - along;
                    *y = *y - along * v1;
                }
            }
        }
        x = h[k + 1][k];
        y = if k + 2 <= last { h[k + 2][k] } else { T::ZERO };
        z = if k + 3 <= last { h[k + 3][k] } else { T::ZERO };
    }
}
