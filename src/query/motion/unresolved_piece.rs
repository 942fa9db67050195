//! A piece that the middle shape of an interval does not decide by its speed.

use crate::pair::PlacedLink;
use parry3d_f64::math::{Real, Vector};

/// The body of such a piece, while its interval is tested.
#[derive(Clone)]
pub(crate) struct UnresolvedPiece {
    pub body: PlacedLink,
    /// The distance of the body from the nearest triangle.
    pub away: Real,
    /// The direction from that triangle to the body; zero if they touch.
    pub normal: Vector,
    /// How much nearer the piece may come in the interval.
    pub reach: Real,
    /// The part of `reach` that is not the centreline's: rim and mesh.
    pub beside: Real,
}
