//! The solver for a segment and a disc, as a type parameter.
//!
//! Segment-disc is the one hard step of the narrow phase: a flat cap meets the edges of a triangle
//! in it, and the solvers differ in speed and accuracy. The kernels above it take the solver as a
//! type parameter, so that the paper's own solvers can be built and compared.

use super::{Closest, Scalar, Vec3};

/// Computes the closest points of a segment and a solid disc.
///
/// Use [`Convex`], the default. On a million mostly ill-conditioned problems its largest error was
/// 6.6 u x extent, in 147 ns (`f64`, scalar), or 28 ns if several run at once. The paper's quartic
/// as printed errs by more than 1e-4 of the extent in 2 to 8 % of these problems, with every root
/// finder. Recentred, the quartic is as exact with any root finder (in `f32` with a polish), but
/// takes at least 1.65 times as long (2.27 in `f32`). Its root finders branch, so they cannot run
/// in packs. (Table I of docs/internals/studies.md.)
pub trait DiscSolver<T: Scalar> {
    /// Returns the closest points of the segment between `ends` (`point1`) and the solid disc
    /// around the origin with the unit vector `normal` (`point2`).
    ///
    /// The caller scales the problem, so that products of lengths stay finite.
    fn segment_disc(ends: [Vec3<T>; 2], normal: Vec3<T>, radius: T) -> Closest<T>;
}

/// The convex solver, without roots of a polynomial: the default. `segment_disc.rs` derives it.
#[derive(Clone, Copy, Debug)]
pub struct Convex;
