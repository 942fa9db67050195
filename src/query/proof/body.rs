//! A body around a piece of the robot, and whether a plane certainly has it on one side.
//!
//! # Definitions
//! - q: the normal of a plane, of whole numbers below 2^53, so q is exact. |q|_1: the sum of the
//!   magnitudes of its coordinates.
//! - level: the least q . v over some vertices. m: the largest coordinate. r: the radius of a disc.
//!   w: the axis of the body.
//!
//! # Rounding
//! 1. The level and a height q . p err by 3 u |q|_1 m each.
//! 2. The reach of a ball or disc, and the free space around it, are sums and products of a few
//!    nonnegative numbers. They err by 12 u of themselves.
//! 3. For a disc, q x w is divided by |w|. It errs by 8 u |q| |w|, as w is rounded too, so the disc
//!    reaches farther by 8 u r |q|.
//! 4. Underflow is less than the least normal number times |q|_1.
//!
//! So a body is certainly below a plane if 16 u of each term are added.

use crate::distance::Scalar;
use parry3d_f64::math::{Real, Vector};

/// The convex hull of two ends, and the free space required around it.
///
/// An end is a disc perpendicular to the axis, or the half ball beyond that disc. If both ends
/// coincide, the body is a ball and both must be round.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ProofBody {
    pub ends: [Vector; 2],
    pub flat: [bool; 2],
    pub radius: Real,
    pub around: Real,
}

impl ProofBody {
    /// Whether the body and the free space around it certainly lie below the plane q . x = level.
    /// `most` bounds the coordinates of the ends and of points on the plane.
    pub(super) fn is_below(&self, q: Vector, level: Real, most: Real) -> bool {
        let slack = 16.0 * f64::UNIT_ROUNDOFF;
        let (length, sum) = (q.length(), q.abs().element_sum());
        let axis = self.ends[1] - self.ends[0];
        if axis == Vector::ZERO && self.flat != [false; 2] {
            // The checker rejects a disc without a direction.
            return false;
        }
        let across = q.cross(axis).length() / axis.length();
        // Which ends face the plane. Without an axis both halves of the ball count.
        let out = [q.dot(axis) <= 0.0, q.dot(axis) >= 0.0];
        self.ends.iter().zip(self.flat).zip(out).all(|((end, flat), is_out)| {
            let is_disc = (flat || !is_out) && axis != Vector::ZERO;
            let reach = self.radius * if is_disc { across.min(length) } else { length };
            let needed =
                (reach + self.around * length) * (1.0 + slack) + self.radius * length * slack;
            let below = level - q.dot(*end);
            below > needed + slack * sum * most + sum * Real::MIN_POSITIVE
        })
    }
}
