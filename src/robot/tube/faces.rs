//! Which ends of a curve's sections are flat.
//!
//! The tube is its discs. Where one section goes on in the next, without a step or within a wider
//! one, a ball at the end lies in discs of the tube, and a body with a round end is cheaper to find
//! than one with a face. So the walks of Algorithm 1 (`algorithm_1`) decide here too, but a curve
//! asks for more than the printed distance between limit and joint: a ball one radius away on a
//! bent centreline sticks out of the limit's face.
//!
//! Let the ball have the radius r and the centre e, let p be the limit, the centre of the last
//! face, and x a point of the ball behind the plane across the curve at e. Radii do not grow from p
//! to e, so each disc between them is as wide as r or wider. If the centreline between p and e is
//! nearest to x inside, x is in the plane of a disc, and no farther from its centre than from e: x
//! is in it. If it is nearest at e, x is in the plane there. What remains is an x that is nearest
//! to p and ahead of the face's plane. There is none
//! - if the whole ball is behind that plane: e is at least r behind it. Of a normal known to an
//!   angle a, |e - p| a less is certain;
//! - if |e - p| > 2 r: x is within r of e, so it is nearer to e than to p.
//!
//! The rest of the ball is in the section's own discs, in the ball at its other end, or ahead of
//! its other face, which cuts the ball off.
//!
//! Otherwise the end is flat. That is right at any joint, since discs are all that there is. If
//! rounding takes for round what is not, the ball sticks out by that rounding, and by no more from
//! the discs behind the plane.

use super::Tube;
use super::section::EndFace;
use crate::robot::radius_steps::RadiusSteps;
use parry3d_f64::math::Vector;

impl Tube {
    /// One walk of Algorithm 1: each section with the one at whose end the last limit is, which
    /// comes before it.
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

    /// Whether a section of a curve is flat at an end with this centre, if the last limit is at
    /// that end of `limit`.
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
