//! The choice of a route from a segment to a disc, the one hard step of the narrow phase.
//!
//! A flat cap meets a triangle's edges in segment-disc, and there the routes differ in speed and in
//! digits. Everything above it takes the route as a type parameter, so that the paper's own engines
//! can be built and compared.

use super::{Closest, Scalar, Vec3};

/// A route to the closest points of a segment and a solid disc.
///
/// **Which to choose.** [`Convex`], the default. On a million mostly nasty problems its worst error
/// was 6.6 u x extent, in 147 ns (`f64`, scalar) or 28 ns where several run at once. The paper's
/// quartic as printed is off by more than 1e-4 of the extent in 2 to 8 % of them, whichever root
/// finder serves it. Recentred it is as exact with any finder (in `f32` with a polish), but takes
/// at least 1.65 times as long (2.27 in `f32`), and its finders branch, so that they cannot run in
/// packs. (Table I of docs/internals/studies.md.)
pub trait DiscSolver<T: Scalar> {
    /// The closest points of the segment between `ends` (`point1`) and the solid disc around the
    /// origin with the unit vector `normal` (`point2`). The caller has scaled the problem, so
    /// that products of lengths stay finite.
    fn segment_disc(ends: [Vec3<T>; 2], normal: Vec3<T>, radius: T) -> Closest<T>;
}

/// The convex route, without roots of a polynomial: the default. `segment_disc.rs` derives it.
#[derive(Clone, Copy, Debug)]
pub struct Convex;
