//! Bounds on the distance of a link from a box and from a triangle, in single precision: the
//! derivation, and the constants of `shaders/search/bounds.wgsl`.
//!
//! # Definitions
//! - u = 2^-24: the unit roundoff of `f32`. R: the reach, the largest of 1, the coordinates of the
//!   link's ends and its radius r. The mesh is centred and scaled ([`SearchFrame`]), so its
//!   coordinates are at most 1.
//! - l: the length of the axis. F: the distance between axis and triangle. d: the distance of link
//!   and triangle. s: the signed distance of some point of the triangle from the link, negative
//!   inside. So `d <= max(s, 0)`.
//! - The **arithmetic of a device**: each operation errs by at most u of its result, a division by
//!   5 u (2.5 ULP), a square root by 10 u (it may be a division by an inverse square root). A
//!   device may add the terms of a sum in any order and fuse a product with a sum. A named value
//!   has one value wherever it is used. Numbers below 2^-126 may count as 0.
//! - e: the link's `error`. It is `128 u R` for a link with round caps and `u R (512 + 4 r / l)`
//!   for one with a flat cap.
//!
//! # Claim
//! 1. `box_distance_squared` is at most `(F + e)^2` for every triangle in the box. So a box whose
//!    bound exceeds `(D + r + e)^2` holds no triangle with `d <= D`.
//! 2. `triangle_bounds`: `lower - e <= d`; `d <= upper + e`, and if `upper + e < 0`, the triangle
//!    reaches into the link.
//!
//! # Proof
//! Neither bound depends on how close the guess of the closest places is: a bad guess makes bounds
//! loose, not wrong.
//!
//! - **A plane bounds from below.** Let n be any vector. Link and triangle are at least
//!   `(min_i <n, T_i> - max_j (<n, E_j> + r k_j)) / |n|` apart, with the triangle's corners `T_i`
//!   and the axis' ends `E_j`. At a round cap `k_j = |n|`. At a flat cap `k_j` is the length of the
//!   part of n across the axis. For a box, `min_i` becomes the centre's value minus `<|n|, h>`,
//!   with h the half extents. Taking `k_j = |n|` at flat caps too is a bound on the capsule around
//!   the link. A cap that may be round or flat ([`SearchCap::Either`]) counts as round here, where
//!   the larger body bounds the smaller.
//! - **The gaps of two boxes bound from below**: the box, and the box around the axis.
//! - **A pair of points bounds from above.** Any point of the triangle and any point of the axis
//!   give `F`, and `d <= F`. A point with height h over a flat cap and distance rho from the axis'
//!   line is at most `hypot(h, max(rho - r, 0))` from the cap. Below all flat caps it is at most
//!   `F - r` from the link, and inside if that and all heights are negative. A cap that may be
//!   round or flat counts as flat here, where the smaller body bounds the larger.
//! - A link too short for a direction (`l < 2^-16 R`, `is_thin`) is bounded by its capsule from
//!   below and by its axis from above.
//!
//! # Rounding
//! In units of u R. A sum of m terms in any order, each a product of k roundings, errs by at most
//! `(m - 1 + k)` times the sum of the terms' magnitudes (Higham, Accuracy and Stability, 4.2). The
//! second order is below 2^-18 of the first. These parts recur:
//!
//! - The square of a vector's length errs by 3 of itself, its root by half of that and 10: 11.5,
//!   written as 12. If the vector is a difference, its own rounding adds 1: 13.
//! - The axis errs by 1 for the difference, 11.5 for its length, 5 for the division and 1 for the
//!   product: by 18.5, written as 22.
//! - The height of a point along the axis: 1 for its difference from the start, 3 for the product,
//!   1 for the difference from the length: 5, written as 7.
//! - The part of that difference across the axis: the height (102 without the axis' length), 22 for
//!   the axis once more, 2 for a product and a difference, 13 for its length.
//! - `n - a <n, a>`, the part across the axis a: `2 x 18.5` for a, 3 for the inner product, 1 for
//!   the product, 1 for the difference, 11.5 for the length, 1 for the product with r. It is added
//!   in two sums: 2 for itself, and `2 sqrt(3)` for their other terms. Together 60.
//!
//! | step | round | flat cap |
//! |---|---|---|
//! | rounded input: vertices, ends, radius; an axis turns by `3.5 u R / l` | 5 | 5 + 3.5 r / l |
//! | **Lower:** `<n, T_i> - <n, E_j>`: 6 terms, magnitudes `2 sqrt(3)` | 21 | 21 |
//! | `r k_j`: the part across the axis | - | 60 |
//! | the length of n and the division: 17 of a distance up to 3.5 | 60 | 60 |
//! | minus r | 2 | 2 |
//! | **sum** | 88 | 148 + 3.5 r / l |
//! | **Upper:** q - p: 5 terms, magnitudes up to 10.4, each of 2 roundings | 63 | 63 |
//! | its length: 12 of a distance up to 3.5 | 42 | - |
//! | height over a cap: 7 of `2 sqrt(3)`; of 3.5 the axis 22, the axis' length 13 | - | 147 |
//! | distance from the axis' line: the same height without the length; 22, 2 and 13 of 3.5 | - | 232 |
//! | both together (at most their sum), the root: 13 of 3.5 | - | 46 |
//! | **sum** | 110 | 493 + 3.5 r / l |
//! | **Box:** 9 terms, magnitudes `3 sqrt(3)`, each of 4 roundings | 63 | |
//! | squares and division: 12 of 3.5, and the limit `(D + r + e)^2`: 3 of 3.5 | 53 | |
//! | vertices and ends | 5 | |
//! | **sum** | 121 | |
//!
//! The comparisons with `D + e` and `D + r + e` round by 2 of 3.5, and the measured distance itself
//! errs by less than 2^-20. The sums stay below 128 and `512 + 4 r / l`. Only the rounded ends turn
//! the axis by more the shorter it is: the axis of the rounded ends errs by 22 for every length.
//! Guards keep every denominator above 2^-80, where the bound 0 is taken instead: that moves no
//! bound by more than 2^-40.

use crate::distance::Vec3;
#[cfg(doc)]
use crate::mesh::SearchFrame;
use std::fmt::Write;

/// Larger than any distance in a search frame.
pub(super) const FAR: f32 = f32::from_bits((127 + 60) << 23);
/// `e / R` of a link with round caps.
pub(super) const ROUND_ERROR: f32 = 128.0 * UNIT;
/// `e / R` of a link with a flat cap is `FLAT_ERROR + TURN_ERROR r / l`.
pub(super) const FLAT_ERROR: f32 = 512.0 * UNIT;
pub(super) const TURN_ERROR: f32 = 4.0 * UNIT;
pub(super) const UNIT: f32 = f32::EPSILON / 2.0;
/// A link with flat caps that is shorter than this, relative to R, has no direction.
pub(super) const THIN: f32 = f32::from_bits((127 - 16) << 23);
/// Denominators, and lengths.
pub(super) const TINY: f32 = f32::from_bits((127 - 80) << 23);
pub(super) const SMALL: f32 = f32::from_bits((127 - 40) << 23);
/// The squared sine below which two segments count as parallel when closest places are guessed.
pub(super) const PARALLEL: f32 = 1e-7;

/// A cap as the device knows it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum SearchCap {
    Round,
    Flat,
    /// The bounds hold for both.
    Either,
}

impl SearchCap {
    const ALL: [(&str, Self); 3] =
        [("ROUND", Self::Round), ("FLAT", Self::Flat), ("EITHER", Self::Either)];

    pub(super) fn of(flat: [bool; 2]) -> [Self; 2] {
        flat.map(|is_flat| if is_flat { Self::Flat } else { Self::Round })
    }

    /// The number that stands for the caps of a link.
    pub(super) fn code([start, end]: [Self; 2]) -> f32 {
        f32::from(start as u8 + 3 * end as u8)
    }
}

/// The constants in WGSL.
pub(super) fn constants() -> String {
    let mut text = String::new();
    for (name, cap) in SearchCap::ALL {
        // Writing to a string does not fail.
        let _ = writeln!(text, "const {name} = {}u;", cap as u8);
    }
    for (name, value) in [
        ("FAR", FAR),
        ("ROUND_ERROR", ROUND_ERROR),
        ("FLAT_ERROR", FLAT_ERROR),
        ("TURN_ERROR", TURN_ERROR),
        ("THIN", THIN),
        ("TINY", TINY),
        ("SMALL", SMALL),
        ("PARALLEL", PARALLEL),
    ] {
        let _ = writeln!(text, "const {name} = {value:e}f;");
    }
    text
}

/// An upper bound on the `error` of every link that was added.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ErrorBound {
    reach: f32,
    /// The largest `(r / l)^2` of a link that has a flat cap and a direction; with room for the
    /// rounding of both.
    thickness: f32,
    has_flat: bool,
}

impl ErrorBound {
    #[inline(always)]
    pub(super) fn add(&mut self, [start, end]: [Vec3<f32>; 2], radius: f32, flat: [bool; 2]) {
        let reach = start.largest().max(end.largest()).max(radius.max(1.0));
        self.reach = self.reach.max(reach);
        let squared = (end - start).dot(end - start);
        let least = THIN * reach;
        if (flat[0] || flat[1]) && squared >= 0.99 * least * least {
            self.has_flat = true;
            self.thickness = self.thickness.max(1.01 * radius * radius / squared);
        }
    }

    /// R of all links.
    pub(super) fn reach(&self) -> f32 {
        self.reach
    }

    pub(super) fn error(&self) -> f32 {
        if self.has_flat {
            self.reach * (FLAT_ERROR + TURN_ERROR * self.thickness.sqrt())
        } else {
            self.reach * ROUND_ERROR
        }
    }
}
