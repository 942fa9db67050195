//! A body around a piece of the robot, and whether a plane has it on one side.
//!
//! # Rounding
//! A plane is given by whole numbers q below 2^53, so q is exact. Its level, the least q . v of
//! some vertices, and a height q . p err by 3 u |q|_1 m each, with m the largest coordinate and
//! |q|_1 the sum of the magnitudes of q. What ball or disc reach and what must be free around are
//! sums and products of a few numbers that are not negative, and err by 12 u of themselves. Of a
//! disc the product q x w is divided by |w|: it errs by 8 u |q| |w|, as w is rounded too, so
//! that the disc reaches farther by 8 u r |q|. So a body is below a plane for certain if 16 u of
//! each are added. What vanishes below the range of numbers is less than the least normal number,
//! times |q|_1.

use crate::distance::Scalar;
use parry3d_f64::math::{Real, Vector};

/// The hull of two ends, each a disc across the line between them or the half of a ball beyond that
/// disc, and what must be free around it. Of two ends at one place both are round: the ball.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ProofBody {
    pub ends: [Vector; 2],
    pub flat: [bool; 2],
    pub radius: Real,
    pub around: Real,
}

impl ProofBody {
    /// Whether all of it, with what must be free around, certainly lies below the plane q . x =
    /// level. No coordinate of a point on the plane or of an end is above `most`.
    pub(super) fn is_below(&self, q: Vector, level: Real, most: Real) -> bool {
        let slack = 16.0 * f64::UNIT_ROUNDOFF;
        let (length, sum) = (q.length(), q.abs().element_sum());
        let axis = self.ends[1] - self.ends[0];
        if axis == Vector::ZERO && self.flat != [false; 2] {
            // A disc without a direction is refused by whoever checks the proof.
            return false;
        }
        let across = q.cross(axis).length() / axis.length();
        // Which ends the way to the plane leads out of, where both halves of a ball would count if
        // there is no axis.
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
