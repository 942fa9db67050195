//! Segment against disc by the paper's quartic (18), with any of the root finders.
//!
//! Two forms of the same equation, d/ds of the squared distance to the *circle*, squared once:
//!
//! - **As printed**, s from the segment's middle: (m s^2 + 2 k s + p) (s + b)^2 = R^2 (m s + k)^2,
//!   with m = |n x B|^2, p = |n x D0|^2, b = <B, D0>, k = b - <n, B> <n, D0>; and D0 = A - Cc,
//!   which the paper leaves undefined. Its real roots and the ends are the candidates, the distance
//!   is (16), and (19) prefers the plane where it is met inside the disc. A double root splits into
//!   a complex pair by rounding and is then missed, and far from the disc the coefficients lose all
//!   digits.
//! - **Recentred**, s from the foot of the disc's centre and in units of R: with <B, D0> = 0 and N
//!   as in [`LineDisc`], m s^4 + 2 N s^3 + (p - m^2) s^2 - 2 m N s - N^2 = 0. The real parts of all
//!   roots are candidates, any point of the segment being an upper bound, with the ends, the foot
//!   and the plane.
//!
//! Roots are fed in as they come, without the test by which [`RootFinder::roots`] vouches for them:
//! a bad candidate is outdone by a better one. Only where the coefficients are so wide apart that
//! the polynomial is cut are they polished on the whole of it.

use crate::Number;
use parry_continuum::distance::laboratory::{DiscSolver, LineDisc};
use parry_continuum::distance::{Closest, Scalar, Vec3};
use real_polynomial_roots::RootFinder;
use std::marker::PhantomData;

/// The quartic (18) as printed, by the root finder `F`.
#[derive(Clone, Copy, Debug)]
pub struct QuarticAsPrinted<F>(PhantomData<F>);

/// The recentred quartic by the root finder `F`, its best candidate polished by `STEPS` Newton
/// steps.
#[derive(Clone, Copy, Debug)]
pub struct RecentredQuartic<F, const STEPS: usize = 0>(PhantomData<F>);

impl<F: RootFinder, T: Number> DiscSolver<T> for QuarticAsPrinted<F> {
    #[inline]
    fn segment_disc([start, end]: [Vec3<T>; 2], normal: Vec3<T>, radius: T) -> Closest<T> {
        let edge = end - start;
        let direction = edge.normalised();
        let reach = edge.dot(direction) * T::of(0.5);
        let middle = (start + end) * T::of(0.5);

        let m = normal.cross(direction).norm_squared();
        let p = normal.cross(middle).norm_squared();
        let b = direction.dot(middle);
        let k = b - normal.dot(direction) * normal.dot(middle);
        let (two, square) = (T::of(2.0), radius * radius);
        let quartic = [
            p * b * b - square * k * k,
            two * k * b * b + two * p * b - two * square * m * k,
            m * b * b + T::of(4.0) * k * b + p - square * m * m,
            two * m * b + two * k,
            m,
        ];

        // (16), and the point of the circle.
        let circle = |s: T| {
            let point = middle + direction * s;
            let height = point.dot(normal);
            let radial = point + normal * -height;
            let rho = radial.norm();
            let beyond = rho - radius;
            let on_circle = radial * radius.over(rho);
            Closest {
                distance: Scalar::sqrt(height * height + beyond * beyond),
                point1: point,
                point2: on_circle,
            }
        };
        let mut best = nearer(circle(-reach), circle(reach));
        for s in F::approximations(&quartic).real() {
            if Scalar::abs(s) <= reach {
                best = nearer(best, circle(s));
            }
        }
        // (19)
        let (height, slope) = (middle.dot(normal), direction.dot(normal));
        let crossing = if slope == T::ZERO { T::ZERO } else { -(height / slope) };
        let plane = middle + direction * Scalar::min(Scalar::max(crossing, -reach), reach);
        let height = plane.dot(normal);
        let on_disc = plane + normal * -height;
        if on_disc.norm() < radius {
            best = Closest { distance: Scalar::abs(height), point1: plane, point2: on_disc };
        }
        best
    }
}

impl<F: RootFinder, const STEPS: usize, T: Number> DiscSolver<T> for RecentredQuartic<F, STEPS> {
    #[inline]
    fn segment_disc(ends: [Vec3<T>; 2], normal: Vec3<T>, radius: T) -> Closest<T> {
        let line = LineDisc::new(ends, normal);
        // The squared distance is convex along the line, so the best point of the line serves,
        // clamped.
        let mut best = (squared_distance(&line, T::ZERO, radius), T::ZERO);
        let mut consider = |s: T| {
            let squared = squared_distance(&line, s, radius);
            if squared < best.0 {
                best = (squared, s);
            }
        };
        if radius > T::ZERO {
            let (n, p) = (line.n / radius, line.q / (radius * radius));
            let two = T::of(2.0);
            let quartic = [-(n * n), -(two * line.m * n), p - line.m * line.m, two * n, line.m];
            for root in &F::approximations(&quartic) {
                consider(root.re * radius);
            }
        }
        consider(line.h.over(line.lambda));
        for _ in 0..STEPS {
            // A step that leads away is not taken: the derivative's slope may be nothing but
            // rounding.
            let s = newton(&line, best.1, radius);
            let squared = squared_distance(&line, s, radius);
            if squared < best.0 {
                best = (squared, s);
            }
        }
        line.closest_at(best.1, false, normal, radius)
    }
}

/// The squared distance of the line's point from the solid disc.
#[inline]
fn squared_distance<T: Number>(line: &LineDisc<T>, s: T, radius: T) -> T {
    let height = line.lambda * s - line.h;
    let beyond = Scalar::max(line.radial_at(s).0 - radius, T::ZERO);
    height * height + beyond * beyond
}

/// A Newton step on the derivative of the squared distance, where that has a slope.
#[inline]
fn newton<T: Number>(line: &LineDisc<T>, s: T, radius: T) -> T {
    let (rho, w) = line.radial_at(s);
    if rho <= radius {
        return s; // over the disc, where the plane decides
    }
    let (ratio, turn) = (radius / rho, w / rho);
    let k = T::ONE - ratio;
    let g = line.lambda * (line.lambda * s - line.h) + w * k;
    let slope = line.lambda * line.lambda + line.m * k + ratio * turn * turn;
    if slope > T::ZERO { s - g / slope } else { s }
}

#[inline]
fn nearer<T: Number>(one: Closest<T>, other: Closest<T>) -> Closest<T> {
    if other.distance < one.distance { other } else { one }
}
