use parry3d_f64::math::Real;
use thiserror::Error;

/// Why a link or a chain could not be built. Each message names the value at fault and what to change.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum RobotError {
    /// A point has a coordinate that is NaN or infinite.
    #[error("point {index} has a coordinate that is not finite ({value}); remove or repair that point")]
    PointNotFinite {
        /// Position of the point in the input.
        index: usize,
        /// The offending coordinate.
        value: Real,
    },
    /// A point lies so far out that differences of coordinates could overflow.
    #[error("point {index} has the coordinate {value}, beyond +-{limit:e}; choose a larger unit of length")]
    PointOutOfRange {
        /// Position of the point in the input.
        index: usize,
        /// The offending coordinate.
        value: Real,
        /// The largest magnitude accepted.
        limit: Real,
    },
    /// A radius is NaN, infinite, negative or beyond the accepted range.
    #[error("radius {index} is {value}; a radius must be finite, at least 0 and at most {limit:e}")]
    BadRadius {
        /// Position of the radius in the input.
        index: usize,
        /// The offending radius.
        value: Real,
        /// The largest radius accepted.
        limit: Real,
    },
    /// A flat cap has no direction on a link without length.
    #[error(
        "the link from point {index} has length 0 or nearly so, and the direction of its flat cap is undefined; \
         use two round caps (a ball) or move one end point"
    )]
    FlatCapWithoutAxis {
        /// Position of the link's start point in the input.
        index: usize,
    },
    /// A centreline needs at least two points.
    #[error("a centreline needs at least 2 points, got {count}")]
    TooFewPoints {
        /// How many points were given.
        count: usize,
    },
    /// The number of radii does not fit the number of points.
    #[error("{points} points need {expected} radii, got {radii}")]
    LengthsDiffer {
        /// How many points were given.
        points: usize,
        /// How many radii they need.
        expected: usize,
        /// How many radii were given.
        radii: usize,
    },
    /// Every point of the centreline is the same.
    #[error("all points of the centreline are the same; a chain needs two distinct points")]
    AllPointsEqual,
    /// A tolerance is NaN, infinite or negative.
    #[error("the tolerance is {value}; it must be finite and at least 0")]
    BadTolerance {
        /// The offending tolerance.
        value: Real,
    },
}
