//! The choice of a route from a segment to a disc, the one hard step of the narrow phase.
//!
//! A flat cap meets a triangle's edges in segment-disc, and there the routes differ in speed and in digits.
//! Everything above it takes the route as a type parameter, so that the paper's own engines can be built and
//! compared.

use super::{Closest, Scalar, Vec3};

/// A route to the closest points of a segment and a solid disc.
pub trait DiscSolver<T: Scalar> {
    /// The closest points of the segment between `ends` (`point1`) and the solid disc around the origin with
    /// the unit vector `normal` (`point2`). The caller has scaled the problem, so that products of lengths
    /// stay finite.
    fn segment_disc(ends: [Vec3<T>; 2], normal: Vec3<T>, radius: T) -> Closest<T>;
}

/// The convex route, without roots of a polynomial: the default. `segment_disc.rs` derives it.
#[derive(Clone, Copy, Debug)]
pub struct Convex;
