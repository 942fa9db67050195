//! Bounds on the distance of a link from a box and from a triangle, in single precision: the
//! derivation, and the twin of `shaders/search/bounds.wgsl`.
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
//! 1. [`SearchedLink::box_distance_squared`] is at most `(F + e)^2` for every triangle in the
//!    box. So a box whose bound exceeds `(D + r + e)^2` holds no triangle with `d <= D`.
//! 2. [`SearchedLink::bounds`]: `lower - e <= d`; `d <= upper + e`, and if `upper + e < 0`, the
//!    triangle reaches into the link. Then `PlacedLink::measure` returns 0.
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
//! second order is below 2^-18 of the first.
//!
//! | step | round | flat cap |
//! |---|---|---|
//! | rounded input: vertices, ends, radius; an axis turns by `3.5 u R / l` | 5 | 5 + 3.5 r / l |
//! | **Lower:** `<n, T_i> - <n, E_j>`: 6 terms, magnitudes `2 sqrt(3)` | 21 | 21 |
//! | `r k_j`: the part across the axis errs by 61 | - | 61 |
//! | the length of n and the division: 16 of a distance up to 3.5 | 56 | 56 |
//! | minus r | 2 | 2 |
//! | **sum** | 84 | 145 + 3.5 r / l |
//! | **Upper:** q - p: 5 terms, magnitudes up to 10.4, each of 2 roundings | 63 | 63 |
//! | its length: 12 of a distance up to 3.5 | 42 | - |
//! | height over a cap: 7 of `2 sqrt(3)`; 22 for the axis, 13 for its length, of 3.5 | - | 147 |
//! | distance from the axis' line: 102 of the height; 22 and 2 for parts, 13 for length | - | 232 |
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
const THIN: f32 = f32::from_bits((127 - 16) << 23);
/// Denominators, and lengths.
const TINY: f32 = f32::from_bits((127 - 80) << 23);
const SMALL: f32 = f32::from_bits((127 - 40) << 23);
/// The squared sine below which two segments count as parallel when closest places are guessed.
const PARALLEL: f32 = 1e-7;

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

type Point = Vec3<f32>;

/// The inner product, as devices may compute it: in order, or fused and in reverse.
fn dot<const FUSED: bool>(a: Point, b: Point) -> f32 {
    if FUSED {
        return a.x.mul_add(b.x, a.y.mul_add(b.y, a.z * b.z));
    }
    a.x * b.x + a.y * b.y + a.z * b.z
}

/// The function `op` of each coordinate.
#[cfg(test)]
fn map2(a: Point, b: Point, op: impl Fn(f32, f32) -> f32) -> Point {
    Vec3::new(op(a.x, b.x), op(a.y, b.y), op(a.z, b.z))
}

#[cfg(test)]
fn abs(a: Point) -> Point {
    Vec3::new(a.x.abs(), a.y.abs(), a.z.abs())
}

/// Bounds on the signed distance of a triangle from a link.
#[cfg(test)]
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    pub lower: f32,
    pub upper: f32,
}

/// A place on the axis (from 0 to 1) and one on a triangle, as shares of two edges.
#[cfg(test)]
#[derive(Clone, Copy)]
struct Places {
    s: f32,
    v: f32,
    w: f32,
}

/// A link as the device sees it. `FUSED`: whether products are fused with sums.
#[cfg(test)]
#[derive(Clone, Copy, Debug)]
pub(super) struct SearchedLink<const FUSED: bool = false> {
    start: Point,
    end: Point,
    axis: Point,
    low: Point,
    high: Point,
    pub radius: f32,
    length: f32,
    inverse: f32,
    pub error: f32,
    /// Whether a cap is flat or may be.
    flat_start: bool,
    flat_end: bool,
    /// Whether a cap is round or may be.
    round_start: bool,
    round_end: bool,
    is_thin: bool,
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
    pub(super) fn add(&mut self, [start, end]: [Point; 2], radius: f32, flat: [bool; 2]) {
        let reach = start.largest().max(end.largest()).max(radius.max(1.0));
        self.reach = self.reach.max(reach);
        let squared = dot::<false>(end - start, end - start);
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

#[cfg(test)]
impl<const FUSED: bool> SearchedLink<FUSED> {
    pub(super) fn new([start, end]: [Point; 2], radius: f32, caps: [SearchCap; 2]) -> Self {
        let along = end - start;
        let squared = dot::<FUSED>(along, along);
        let length = squared.sqrt();
        let reach = start.largest().max(end.largest()).max(radius.max(1.0));
        let has_flat = caps != [SearchCap::Round; 2];
        let is_thin = has_flat && length < THIN * reach;
        let short = 1.0 / length.max(TINY);
        let error = if has_flat && !is_thin {
            reach * (FLAT_ERROR + TURN_ERROR * radius * short)
        } else {
            ROUND_ERROR * reach
        };
        Self {
            start,
            end,
            axis: along * short,
            low: map2(start, end, f32::min),
            high: map2(start, end, f32::max),
            radius,
            length,
            inverse: 1.0 / squared.max(TINY),
            error,
            flat_start: !is_thin && caps[0] != SearchCap::Round,
            flat_end: !is_thin && caps[1] != SearchCap::Round,
            round_start: is_thin || caps[0] != SearchCap::Flat,
            round_end: is_thin || caps[1] != SearchCap::Flat,
            is_thin,
        }
    }
}

#[cfg(test)]
impl<const FUSED: bool> SearchedLink<FUSED> {
    /// The square of a lower bound on the distance between the axis and a box.
    pub(super) fn box_distance_squared(&self, low: Point, high: Point) -> f32 {
        // 1. The gaps between two boxes.
        let gap = map2(low - self.high, self.low - high, f32::max);
        let gap = map2(gap, Vec3::zero(0.0), f32::max);
        // 2. The plane across the vector from the axis to the centre.
        let centre = (low + high) * 0.5;
        let half = high - centre;
        let along = self.end - self.start;
        let s = (dot::<FUSED>(centre - self.start, along) * self.inverse).clamp(0.0, 1.0);
        let normal = centre - (self.start + along * s);
        let behind = dot::<FUSED>(normal, self.start).max(dot::<FUSED>(normal, self.end));
        let reach = dot::<FUSED>(abs(normal), half);
        let ahead = (dot::<FUSED>(normal, centre) - reach - behind).max(0.0);
        let squared = dot::<FUSED>(normal, normal);
        let plane = if squared > TINY { ahead * ahead / squared } else { 0.0 };
        dot::<FUSED>(gap, gap).max(plane)
    }

    /// The limit on [`SearchedLink::box_distance_squared`] for a bound on the distance.
    pub(super) fn box_limit(&self, bound: f32) -> f32 {
        let limit = bound + self.radius + self.error;
        limit * limit
    }

    /// How far the triangle lies ahead of the link along a normal. `caps`: the reach of a flat
    /// start and a flat end along that normal, beyond the ends of the axis.
    fn ahead_of_plane(&self, [a, b, c]: [Point; 3], normal: Point, caps: [f32; 2]) -> f32 {
        let at = |point| dot::<FUSED>(normal, point);
        let triangle = at(a).min(at(b).min(at(c)));
        triangle - (at(self.start) + caps[0]).max(at(self.end) + caps[1])
    }

    pub(super) fn bounds(&self, corners: [Point; 3]) -> Bounds {
        let [a, b, c] = corners;
        let along = self.end - self.start;
        let (e1, e2) = (b - a, c - a);
        let Places { s, v, w } = close_places::<FUSED>(along, a - self.start, e1, e2);
        let on_triangle = a + e1 * v + e2 * w;
        let between = on_triangle - (self.start + along * s);
        let axis = dot::<FUSED>(between, between).sqrt();
        let axis_ahead = self.ahead_of_plane(corners, between, [0.0; 2]).max(0.0);
        let axis_lower = if axis > SMALL { axis_ahead / axis } else { 0.0 };
        let radius = if self.is_thin { 0.0 } else { self.radius };
        let mut bounds = Bounds { lower: axis_lower - self.radius, upper: axis - radius };
        if !self.flat_start && !self.flat_end {
            return bounds;
        }
        // The height of the point over the cap that is nearer to it.
        let from_start = on_triangle - self.start;
        let along_axis = dot::<FUSED>(from_start, self.axis);
        let below_start = if self.flat_start { -along_axis } else { -FAR };
        let above_end = if self.flat_end { along_axis - self.length } else { -FAR };
        let height = below_start.max(above_end);
        if height <= 0.0 {
            bounds.upper = bounds.upper.max(height);
            return bounds;
        }
        let outward = if above_end > below_start { self.axis } else { -self.axis };
        let radial = from_start - self.axis * along_axis;
        let rho = dot::<FUSED>(radial, radial).sqrt();
        let beside = (rho - self.radius).max(0.0);
        bounds.upper = (height * height + beside * beside).sqrt();
        let normal = outward * height + radial * (beside / rho.max(SMALL));
        let length = dot::<FUSED>(normal, normal).sqrt();
        let across = normal - self.axis * dot::<FUSED>(normal, self.axis);
        let flat_reach = self.radius * dot::<FUSED>(across, across).sqrt();
        let round_reach = self.radius * length;
        let caps = [self.round_start, self.round_end]
            .map(|is_round| if is_round { round_reach } else { flat_reach });
        if length > SMALL {
            let lower = self.ahead_of_plane(corners, normal, caps) / length;
            bounds.lower = bounds.lower.max(lower);
        }
        bounds
    }
}

/// Places where a segment from 0 to `along` and the segment from `a` to `a + edge` are close.
#[cfg(test)]
fn close_segments<const FUSED: bool>(along: Point, a: Point, edge: Point) -> [f32; 2] {
    let (aa, ee) = (dot::<FUSED>(along, along), dot::<FUSED>(edge, edge));
    let ae = dot::<FUSED>(along, edge);
    let (c, f) = (-dot::<FUSED>(along, a), -dot::<FUSED>(edge, a));
    let determinant = aa * ee - ae * ae;
    let is_skew = determinant > PARALLEL * aa * ee;
    let s = if is_skew { ((ae * f - c * ee) / determinant).clamp(0.0, 1.0) } else { 0.0 };
    let t = ((ae * s + f) / ee.max(TINY)).clamp(0.0, 1.0);
    [((ae * t - c) / aa.max(TINY)).clamp(0.0, 1.0), t]
}

/// A guess at the closest places of an axis from 0 to `along` and a triangle.
#[cfg(test)]
fn close_places<const FUSED: bool>(along: Point, a: Point, e1: Point, e2: Point) -> Places {
    let squared_between = |Places { s, v, w }: Places| {
        let d = a + e1 * v + e2 * w - along * s;
        dot::<FUSED>(d, d)
    };
    let ab = close_segments::<FUSED>(along, a, e1);
    let ac = close_segments::<FUSED>(along, a, e2);
    let bc = close_segments::<FUSED>(along, a + e1, e2 - e1);
    let normal = e1.cross(e2);
    let squared = dot::<FUSED>(normal, normal);
    let has_face = squared > TINY;
    let inverse = 1.0 / if has_face { squared } else { 1.0 };
    let start_height = dot::<FUSED>(a, normal);
    let end_height = dot::<FUSED>(a - along, normal);
    let crosses = (start_height < 0.0) != (end_height < 0.0);
    let difference = start_height - end_height;
    let crossing = if crosses && difference != 0.0 { start_height / difference } else { 0.0 };
    let on_face = |s: f32| {
        let point = along * s - a;
        let v = dot::<FUSED>(point.cross(e2), normal) * inverse;
        let w = dot::<FUSED>(e1.cross(point), normal) * inverse;
        (has_face && v >= 0.0 && w >= 0.0 && v + w <= 1.0).then(|| {
            let v = v.clamp(0.0, 1.0);
            Places { s, v, w: w.clamp(0.0, 1.0 - v) }
        })
    };
    let edges = [
        Places { s: ab[0], v: ab[1], w: 0.0 },
        Places { s: ac[0], v: 0.0, w: ac[1] },
        Places { s: bc[0], v: 1.0 - bc[1], w: bc[1] },
    ];
    let crossing = if crosses { on_face(crossing.clamp(0.0, 1.0)) } else { None };
    let faces = [on_face(0.0), on_face(1.0), crossing];
    let (mut best, mut least) = (edges[0], squared_between(edges[0]));
    for other in edges.into_iter().skip(1).chain(faces.into_iter().flatten()) {
        let squared = squared_between(other);
        if squared < least {
            (best, least) = (other, squared);
        }
    }
    best
}
