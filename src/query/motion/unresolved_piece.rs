//! A piece about which the middle shape of an interval decides nothing by its speed.

use crate::pair::PlacedLink;
use parry3d_f64::math::{Real, Vector};

/// What is known of it while that interval is looked at.
#[derive(Clone)]
pub(crate) struct UnresolvedPiece {
    pub body: PlacedLink,
    /// How far the body is away from the nearest triangle.
    pub away: Real,
    /// The direction from there to the body; none where they touch.
    pub normal: Vector,
    /// How much nearer it may come in the interval.
    pub reach: Real,
    /// How much of that is not the centreline's.
    pub beside: Real,
}
