//! Segment against solid disc: the paper's section III.C by a convex route instead of its quartic.
//!
//! For a point p of the line, l = <p, n> is its height over the disc's plane and rho its distance
//! from the disc's axis. F(s) = l^2 + max(0, rho - R)^2 is the squared distance to the *solid*
//! disc: convex and once differentiable on the whole line. So minimise on the line and clamp the
//! result to the segment. (The paper's quartic (18) belongs to the circle; squaring gives it false
//! and double roots, which cost half of the digits or all of them.)
//!
//! Measure s from the foot of the disc's centre: p(s) = D + s B with <D, B> = 0. That choice is
//! essential. Let h = |<D, n>|, L = |<B, n>|, q and P the parts of D and B in the disc's plane, m =
//! <P, P>, and tau = |<D, n x P>|. Direct B so that N = <q, P> >= 0. Because D and B are
//! orthogonal, N = h L; so the line comes down towards the plane as its distance from the axis
//! grows, and the minimiser lies in `[0, top]`. There, with w = N + m s, rho^2 = |q|^2 + s (N + w)
//! and k = 1 - R / rho:
//!
//! ```text
//! g   = F' / 2  = L (L s - h) + w k
//! g'            = L^2 + m k + R w^2 / rho^3           >= 0
//! g''           = 3 R w (m rho^2 - w^2) / rho^5       >= 0
//! ```
//!
//! g is convex and increasing, so Halley's method converges from any start, cubically; from the
//! right start a fixed number of steps reaches rounding level. Cases:
//!
//! 1. **The line meets the plane inside the disc**, at s = h / L: F = 0 there.
//! 2. **It does not**: top = min(R sqrt m, h / L), since g >= 0 at either.
//! 3. **Start from the left**: Newton's step from s = 0, where g = -R N / rho.
//! 4. **Start at the cusp**, a line nearly parallel to the plane and nearly tangent to the circle,
//!    where g bends like a cube root: w = tau x with x = sqrt(K^2 - 1) + cbrt(2 N / tau), K = R
//!    m^1.5 / tau. Away from the cusp that falls short, even below 0. But L^2 + m = 1 makes g = s -
//!    R w / rho, and w / rho grows with s, so the minimiser is never left of R N / |q|: no start
//!    is.
//! 5. **Along the normal**, m = 0: every point of the line has the same rho; s = 0 is in the disc's
//!    plane.
//! 6. **A point**, |e| = 0: B = 0, N = 0 and s = 0; |q| is taken from q itself.
//!
//! The least of 2, 3 and 4 is the start. The signs of g met so far bracket every step: where g' is
//! as small as its own rounding, at the cusp, a step could otherwise leave for the far end of the
//! interval.

use super::{Closest, Convex, DiscSolver, Mask, Scalar, Vec3, frame::Frame};

/// The distance between the segment from `segment[0]` to `segment[1]` and a solid disc with the
/// given centre, normal (of any length but 0) and radius; (13) to (19).
#[inline(always)]
pub fn segment_disc<T: Scalar>(
    segment: [Vec3<T>; 2],
    centre: Vec3<T>,
    normal: Vec3<T>,
    radius: T,
) -> Closest<T> {
    segment_disc_by::<Convex, T>(segment, centre, normal, radius)
}

/// As [`segment_disc`], by the route `S`.
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
        let line = LineDisc::new(ends, normal);
        let (s, pierces) = line.nearest_to_disc(radius);
        line.closest_at(s, pierces, normal, radius)
    }
}

/// A line seen from a disc around the origin, as a [`DiscSolver`] may see it.
///
/// The point s = 0 is the foot of the disc's centre, B the line's unit direction, turned so that N
/// >= 0.
#[derive(Clone, Copy, Debug)]
pub struct LineDisc<T: Scalar> {
    /// Unit direction of the segment.
    direction: Vec3<T>,
    /// The end nearer to the foot of the disc's centre, from which positions along the direction
    /// count.
    near: Vec3<T>,
    far: Vec3<T>,
    /// The positions of the foot and of the far end.
    foot: T,
    far_at: T,
    /// -1 where s runs against the direction.
    sign: T,
    /// How far the foot is above or below the disc's plane.
    pub h: T,
    /// |<B, n>|, n being the disc's normal.
    pub lambda: T,
    /// The squared length of B's part in the disc's plane.
    pub m: T,
    /// N = <q, P>, q and P being the parts of the foot and of B in the disc's plane.
    pub n: T,
    tau: T,
    /// |q|^2
    pub q: T,
}

impl<T: Scalar> LineDisc<T> {
    /// The line through `start` and `end`, and the disc with the unit vector `normal`.
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
        // Two expressions for N and |q|^2, equal in exact arithmetic. Each keeps its digits on its
        // side. The first is for lines; a segment of length 0 has no direction and m = 0.
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

    /// The distance from the disc's axis at s, and w = N + m s.
    #[inline(always)]
    pub fn radial_at(&self, s: T) -> (T, T) {
        let w = self.m.mul_add(s, self.n);
        (s.mul_add(self.n + w, self.q).max(s.zero()).sqrt(), w)
    }

    /// The s at which the line is closest to the solid disc, and whether it meets the disc there.
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
        // Case 4, as tau x, so that tau = 0 needs no exception.
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

    /// The closest points for the line's minimiser `s`, clamped to the segment. If the line meets
    /// the disc there and the segment gets that far, that point is common, whatever rounding
    /// says of its height.
    #[inline(always)]
    pub fn closest_at(&self, s: T, pierces: T::Mask, normal: Vec3<T>, radius: T) -> Closest<T> {
        let zero = radius.zero();
        let along = s.mul_add(self.sign, self.foot);
        let (low, high) = (self.far_at.min(zero), self.far_at.max(zero));
        let pierced = pierces & low.le(along) & along.le(high);
        let t = along.max(low).min(high);
        // From the end nearer to it, so that the rounding of a long segment's direction counts
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
