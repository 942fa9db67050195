//! The choice of a route from a segment to a disc, the one hard step of the narrow phase.
//!
//! A flat cap meets a triangle's edges in segment-disc, and there the routes differ in speed and in digits.
//! Everything above it takes the route as a type parameter, so that the paper's own engines can be built and
//! compared.

use super::lanes::{Lane, Pack};
use super::{Closest, Scalar, Vec3};

/// A route to the closest points of a segment and a solid disc.
///
/// **Which to choose.** [`Convex`], the default. On a million mostly nasty problems its worst error was 6.6 u x extent,
/// in 147 ns (`f64`, scalar) or 28 ns where several run at once. The paper's quartic as printed is off by more than
/// 1e-4 of the extent in 2 to 8 % of them, whichever root finder serves it. Recentred it is as exact with any finder
/// (in `f32` with a polish), but takes at least 1.65 times as long (2.27 in `f32`), and its finders branch, so that they
/// cannot run in packs. (Table I of docs/STUDIES.md.)
pub trait DiscSolver<T: Scalar> {
    /// The closest points of the segment between `ends` (`point1`) and the solid disc around the origin with
    /// the unit vector `normal` (`point2`). The caller has scaled the problem, so that products of lengths
    /// stay finite.
    fn segment_disc(ends: [Vec3<T>; 2], normal: Vec3<T>, radius: T) -> Closest<T>;

    /// The same for a pack of problems, of which only those `wanted` count: one after the other, unless the route
    /// can compute in packs.
    #[doc(hidden)]
    #[allow(private_bounds, private_interfaces)] // for the exhaustive engine alone
    fn segment_discs<L: Pack<Element = T>>(
        token: L::Token,
        ends: [Vec3<L>; 2],
        normal: Vec3<L>,
        radius: L,
        wanted: L::Mask,
    ) -> Closest<L>
    where
        Self: Sized,
        T: Lane,
    {
        one_by_one::<Self, T, L>(token, ends, normal, radius, wanted)
    }
}

/// The convex route, without roots of a polynomial: the default. `segment_disc.rs` derives it.
#[derive(Clone, Copy, Debug)]
pub struct Convex;

/// The widest pack.
const MOST_LANES: usize = 16;

/// A coordinate of every lane.
type Row<T> = [T; MOST_LANES];

/// [`DiscSolver::segment_discs`] for a route that computes one problem at a time.
#[inline(always)]
fn one_by_one<S: DiscSolver<T>, T: Lane, L: Pack<Element = T>>(
    token: L::Token,
    [start, end]: [Vec3<L>; 2],
    normal: Vec3<L>,
    radius: L,
    wanted: L::Mask,
) -> Closest<L> {
    let [start, end, normal] = [rows(start), rows(end), rows(normal)];
    let mut radii = [T::default(); MOST_LANES];
    radius.store(&mut radii);
    let mut distances = [T::default(); MOST_LANES];
    let [mut points1, mut points2] = [[[T::default(); MOST_LANES]; 3]; 2];
    let mut wanted = L::bits(wanted);
    while wanted != 0 {
        let lane = wanted.trailing_zeros() as usize;
        wanted &= wanted - 1;
        let ends = [at(&start, lane), at(&end, lane)];
        let found = alone::<S, T>(ends, at(&normal, lane), radii[lane]);
        distances[lane] = found.distance;
        for (rows, point) in [(&mut points1, found.point1), (&mut points2, found.point2)] {
            for (row, value) in rows.iter_mut().zip(<[T; 3]>::from(point)) {
                row[lane] = value;
            }
        }
    }
    Closest {
        distance: L::load(token, &distances),
        point1: load(token, &points1),
        point2: load(token, &points2),
    }
}

#[inline(never)] // the same code whatever the instruction set
fn alone<S: DiscSolver<T>, T: Scalar>(ends: [Vec3<T>; 2], normal: Vec3<T>, radius: T) -> Closest<T> {
    S::segment_disc(ends, normal, radius)
}

#[inline(always)]
fn load<T, L: Pack<Element = T>>(token: L::Token, [x, y, z]: &[Row<T>; 3]) -> Vec3<L> {
    Vec3::new(L::load(token, x), L::load(token, y), L::load(token, z))
}

#[inline(always)]
fn rows<T: Lane, L: Pack<Element = T>>(vector: Vec3<L>) -> [Row<T>; 3] {
    let mut rows = [[T::default(); MOST_LANES]; 3];
    for (row, coordinate) in rows.iter_mut().zip(<[L; 3]>::from(vector)) {
        coordinate.store(row);
    }
    rows
}

#[inline(always)]
fn at<T: Copy>([x, y, z]: &[Row<T>; 3], lane: usize) -> Vec3<T> {
    Vec3::new(x[lane], y[lane], z[lane])
}
