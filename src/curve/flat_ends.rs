//! Which ends of sections are flat.
//!
//! The tube is the union of its discs. At the end of a section that continues in the next one,
//! without a step or within a wider one, a ball lies in the tube's discs. A bounding body with a
//! round end is cheaper to search than one with a face, so such ends are round. The walks of
//! Algorithm 1 (`algorithm_1`) decide it. A curve needs a stricter test than the printed distance
//! between limit and joint: on a bent centreline, a ball one radius away may stick out of the
//! limit's face.
//!
//! **Definitions.**
//! - `e`: the centre of the end. `r`: its radius. The ball: radius r around e.
//! - `p`: the limit, the centre of the last face. `a`: the tilt of that face.
//! - `x`: a point of the ball behind the plane across the curve at e.
//!
//! **Claim.** The ball lies in the tube if one of two conditions holds:
//!
//! 1. e is at least r behind the plane of the face at p. With a normal known up to the angle a, e
//!    is certainly behind it by the computed depth minus `|e - p| a`.
//! 2. `|e - p| > 2 r`.
//!
//! **Proof.** Radii do not grow from p to e, so each disc between them has at least the radius r.
//! Consider the point of the centreline between p and e that is nearest to x.
//!
//! - An inner point: x lies in the plane of its disc, and no farther from its centre than from e.
//!   So x lies in the disc.
//! - The point e: x lies in the plane of the disc at e.
//! - The point p: x may lie ahead of the plane of the face. Condition 1 excludes this, because the
//!   whole ball is behind that plane. Condition 2 excludes it, because x is within r of e and so
//!   nearer to e than to p.
//!
//! The rest of the ball lies in the section's own discs, or in the ball at its other end. A face at
//! the other end cuts the ball off.
//!
//! Otherwise the end is flat. That is right at any joint, since the tube is its discs.
//!
//! **Rounding.** If rounding makes an end round that is flat, the ball sticks out by that rounding
//! at most.

use super::Tube;
use super::section::EndFace;
use crate::robot::RadiusSteps;
use parry3d_f64::math::Vector;

impl Tube {
    /// One walk of Algorithm 1. Calls `visit` with each section and the section of the last limit,
    /// which comes before it or is the same.
    pub(super) fn walk(&mut self, end: usize, mut visit: impl FnMut(&mut Self, usize, usize)) {
        let count = self.sections.len();
        let (mut limit, mut steps) = (0, RadiusSteps::default());
        for step in 0..count {
            let number = if end == 0 { step } else { count - 1 - step };
            if steps.is_up(self.sections[number].radius) {
                limit = number;
            }
            visit(self, number, limit);
        }
    }

    /// Returns whether a section is flat at an end with this centre, if the last limit is at that
    /// end of the section `limit`.
    pub(super) fn is_flat(&self, end: usize, number: usize, limit: usize, centre: Vector) -> bool {
        let radius = self.sections[number].radius;
        let is_free = |limit: EndFace| {
            let ahead = limit.centre - centre;
            let apart = ahead.length();
            apart > 2.0 * radius || ahead.dot(limit.outward) - apart * limit.tilt >= radius
        };
        number == limit || !self.sections[limit].faces[end].is_some_and(is_free)
    }
}
