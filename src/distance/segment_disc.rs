//! The distance between a segment and a solid disc: section III.C of the paper, with a convex
//! iteration in place of its quartic.
//!
//! ```text
//!        n ^
//!          |            o s = 0, the foot of the centre
//!          |          .   `-._
//!          |        .         `-._   p(s) = D + s B
//!          |      . D             `-._
//!          |    .                     `-._
//!     =====o=====                         `-._
//!       centre, R        plane of the disc
//! ```
//!
//! # Definitions
//! - `n`, `R`: the unit normal and the radius of the disc, whose centre is the origin.
//! - `p(s) = D + s B`: the line, with `|B| = 1` and `s` measured from the foot of the centre:
//!   `<D, B> = 0`. The algorithm depends on this choice of origin.
//! - `l = <p, n>`: the height of `p` over the disc's plane. `rho`: the distance of `p` from the
//!   disc's axis.
//! - `F(s) = l^2 + max(0, rho - R)^2`: the squared distance of `p(s)` from the solid disc.
//! - `h = |<D, n>|`, `L = |<B, n>|`.
//! - `q`, `P`: the parts of `D` and `B` in the disc's plane. `m = <P, P>`, `tau = |<D, n x P>|`.
//! - `N = <q, P>`, with `B` directed so that `N >= 0`. Since `D` and `B` are orthogonal, `N = h L`.
//! - `w = N + m s` and `k = 1 - R / rho`. Then `rho^2 = |q|^2 + s (N + w)`.
//!
//! # Algorithm
//! `F` is convex and once differentiable on the whole line. So minimise `F` on the line and clamp
//! the result to the segment. (The paper's quartic (18) belongs to the circle. Squaring gives it
//! false and double roots, which cost half of the digits or all of them.)
//!
//! The line approaches the plane while its distance from the axis grows, so the minimiser lies in
//! `[0, top]`. There
//!
//! ```text
//! g   = F' / 2  = L (L s - h) + w k
//! g'            = L^2 + m k + R w^2 / rho^3           >= 0
//! g''           = 3 R w (m rho^2 - w^2) / rho^5       >= 0
//! ```
//!
//! `g` is convex and increasing, so Halley's method converges cubically from any start. From the
//! starts below, a fixed number of steps reaches rounding level.
//!
//! 1. **The line meets the plane inside the disc**, at `s = h / L`: `F = 0` there.
//! 2. **The line does not**: `top = min(R sqrt m, h / L)`, since `g >= 0` at both.
//! 3. **Start from the left**: Newton's step from `s = 0`, where `g = -R N / rho`.
//! 4. **Start at the cusp**: a line nearly parallel to the plane and nearly tangent to the circle,
//!    where `g` bends like a cube root. Take `w = tau x` with `x = sqrt(K^2 - 1) + cbrt(2 N / tau)`
//!    and `K = R m^1.5 / tau`. Away from the cusp this start is too small, even below 0. But
//!    `L^2 + m = 1` gives `g = s - R w / rho`, and `w / rho` grows with `s`. So the minimiser is at
//!    least `R N / |q|`, and the start is raised to that value.
//! 5. **Along the normal**, `m = 0`: all points of the line have the same `rho`; `s = 0` lies in
//!    the disc's plane.
//! 6. **A point**, `B = 0`: `N = 0` and `s = 0`; `|q|` is computed from `q` itself.
//!
//! The start is the least of 2, 3 and 4.
//!
//! # Rounding
//! The signs of `g` bracket every step. Near the cusp `g'` is as small as its own rounding; without
//! the bracket a step could jump to the far end of the interval.

use super::{Closest, Convex, DiscSolver, Mask, Scalar, Vec3, frame::Frame};

/// Returns the distance between a segment and a solid disc, and the closest points; (13) to (19).
///
/// ```text
///        ^ normal           _.- segment[1]
///        |              _.-'
///        |          _.-'
///        |         * point1 = segment[0]
///        |        /
///        |       / distance
///   =====o=====* point2
///      centre
///        <-----> radius
/// ```
///
/// - `segment`, `centre`, `radius`: in one frame and unit.
/// - `normal`: of any length except 0.
#[inline(always)]
pub fn segment_disc<T: Scalar>(
    segment: [Vec3<T>; 2],
    centre: Vec3<T>,
    normal: Vec3<T>,
    radius: T,
) -> Closest<T> {
    segment_disc_by::<Convex, T>(segment, centre, normal, radius)
}

/// Same as [`segment_disc`], with the solver `S`.
#[inline(always)]
pub fn segment_disc_by<S: DiscSolver<T>, T: Scalar>(
    segment: [Vec3<T>; 2],
    centre: Vec3<T>,
    normal: Vec3<T>,
    radius: T,
) -> Closest<T> {
    let frame = Frame::around(centre, segment, radius);
    let ends = segment.map(|point| frame.point(point));
    frame.answer(S::segment_disc(ends, normal.normalised(), frame.length(radius)))
}

impl<T: Scalar> DiscSolver<T> for Convex {
    #[inline(always)]
    fn segment_disc(ends: [Vec3<T>; 2], normal: Vec3<T>, radius: T) -> Closest<T> {
        T::step(
            #[inline(always)]
            || {
                let line = LineDisc::new(ends, normal);
                let (s, pierces) = line.nearest_to_disc(radius);
                line.closest_at(s, pierces, normal, radius)
            },
        )
    }
}

/// A line and a disc around the origin, in the terms of a [`DiscSolver`].
///
/// The point `s = 0` is the foot of the disc's centre. `B` is the line's unit direction, directed
/// so that `N >= 0`.
#[derive(Clone, Copy, Debug)]
pub struct LineDisc<T: Scalar> {
    /// The unit direction of the segment.
    direction: Vec3<T>,
    /// The end nearer to the foot of the disc's centre. Positions along the direction are measured
    /// from this end.
    near: Vec3<T>,
    far: Vec3<T>,
    /// The positions of the foot and of the far end.
    foot: T,
    far_at: T,
    /// -1 if `s` runs against `direction`, otherwise 1.
    sign: T,
    /// The height of the foot above the disc's plane, without sign.
    pub h: T,
    /// `L = |<B, n>|`, with the disc's normal `n`.
    pub lambda: T,
    /// `m`, the squared length of the part of `B` in the disc's plane.
    pub m: T,
    /// `N = <q, P>`, with the parts `q` of the foot and `P` of `B` in the disc's plane.
    pub n: T,
    tau: T,
    /// `|q|^2`.
    pub q: T,
}

impl<T: Scalar> LineDisc<T> {
    /// The line through `start` and `end`, and a disc with the unit vector `normal`.
    #[inline(always)]
    pub fn new([start, end]: [Vec3<T>; 2], normal: Vec3<T>) -> Self {
        let edge = end - start;
        let direction = edge.normalised();
        let length = edge.dot(direction);
        let (from_start, from_end) = (-start.dot(direction), -end.dot(direction));
        let start_nearer = from_start.abs().le(from_end.abs());
        let near = Vec3::select(start_nearer, start, end);
        let far = Vec3::select(start_nearer, end, start);
        let foot = start_nearer.select(from_start, from_end);
        let far_at = start_nearer.select(length, -length);
        let from_centre = near.along(direction, foot);

        let (height, slope) = (from_centre.dot(normal), direction.dot(normal));
        let radial = from_centre.along(normal, -height);
        let flat = direction.along(normal, -slope);
        let m = flat.norm_squared();
        let tau = from_centre.dot(normal.cross(flat)).abs();
        // Two expressions for N and |q|^2, equal in exact arithmetic. Each is accurate on its side
        // of L^2 = 1/2. The first needs a direction: a segment of length 0 has m = 0.
        let shallow = (slope * slope).lt(slope.lit(0.5)) & slope.zero().lt(m);
        let n = shallow.select(-(height * slope), radial.dot(flat));
        let q = shallow.select(n.mul_add(n, tau * tau).over(m), radial.norm_squared());
        let sign = n.lt(n.zero()).select(-n.one(), n.one());
        Self {
            direction,
            near,
            far,
            foot,
            far_at,
            sign,
            h: height.abs(),
            lambda: slope.abs(),
            m,
            n: n.abs(),
            tau,
            q,
        }
    }

    /// Returns the distance from the disc's axis at `s`, and `w = N + m s`.
    #[inline(always)]
    pub fn radial_at(&self, s: T) -> (T, T) {
        let w = self.m.mul_add(s, self.n);
        (s.mul_add(self.n + w, self.q).max(s.zero()).sqrt(), w)
    }

    /// Returns the `s` that minimises `F`, and whether the line meets the disc there.
    #[inline(always)]
    fn nearest_to_disc(&self, radius: T) -> (T, T::Mask) {
        let zero = radius.zero();
        let one = radius.one();
        let root_m = self.m.sqrt();
        let rim = radius * root_m;
        let reaches_plane = self.h.le(self.lambda * rim);
        let plane = self.h.over(self.lambda);
        let top = reaches_plane.select(plane, rim);

        // Case 3.
        let rho0 = self.q.sqrt();
        let ratio0 = radius.over(rho0);
        let turn0 = self.n.over(rho0);
        let slope0 =
            self.lambda.mul_add(self.lambda, self.m.mul_add(one - ratio0, ratio0 * turn0 * turn0));
        let from_zero = zero.lt(slope0).select((ratio0 * self.n).over(slope0), top);
        // Case 4, as tau x: so tau = 0 is no exception.
        let rim_m = rim * self.m;
        let tangent = ((rim_m - self.tau) * (rim_m + self.tau)).max(zero).sqrt();
        let cusp = (self.n + self.n).over(self.tau).cbrt_estimate().mul_add(self.tau, tangent);
        let from_cusp = (cusp - self.n).over(self.m).max(ratio0 * self.n);
        let mut s = top.min(from_zero).min(from_cusp);
        let (mut low, mut high) = (zero, top);
        for _ in 0..T::HALLEY_STEPS {
            let (rho, w) = self.radial_at(s);
            let inverse = one.over(rho);
            let ratio = radius * inverse;
            let turn = w * inverse;
            let k = one - ratio;
            let g = self.lambda.mul_add(self.lambda.mul_add(s, -self.h), w * k);
            let g1 = self.lambda.mul_add(self.lambda, self.m.mul_add(k, ratio * turn * turn));
            let g2 = one.lit(3.0) * ratio * turn * turn.mul_add(-turn, self.m) * inverse;
            let halley = (g1 * g1) * one.lit(2.0) - g * g2;
            let step = zero.lt(halley).select((g * g1 * one.lit(2.0)).over(halley), g.over(g1));
            let below = g.lt(zero);
            low = below.select(s, low);
            high = below.select(high, s);
            s = (s - step).max(low).min(high);
        }

        // Case 1.
        let (rho_plane, _) = self.radial_at(plane);
        let pierces = reaches_plane & rho_plane.le(radius);
        (pierces.select(plane, s), pierces)
    }

    /// Returns the closest points for the line's minimiser `s`, clamped to the segment.
    ///
    /// If the line meets the disc at `s` and `s` lies on the segment, this point is a common point,
    /// even if rounding puts it off the plane.
    #[inline(always)]
    pub fn closest_at(&self, s: T, pierces: T::Mask, normal: Vec3<T>, radius: T) -> Closest<T> {
        let zero = radius.zero();
        let along = s.mul_add(self.sign, self.foot);
        let (low, high) = (self.far_at.min(zero), self.far_at.max(zero));
        let pierced = pierces & low.le(along) & along.le(high);
        let t = along.max(low).min(high);
        // Measure from the nearer end: the rounding of a long segment's direction then counts
        // least.
        let by_near_end = (t + t).abs().le(self.far_at.abs());
        let point = Vec3::select(
            by_near_end,
            self.near.along(self.direction, t),
            self.far.along(self.direction, t - self.far_at),
        );
        let (distance, on_disc) = super::point_disc::from_centre(point, normal, radius);
        let point1 = Vec3::select(pierced, on_disc, point);
        Closest { distance: pierced.select(zero, distance), point1, point2: on_disc }
    }
}
