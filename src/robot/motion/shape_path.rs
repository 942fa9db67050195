//! A planner's own shapes, linear between them, and what a stated deviation leaves open.
//!
//! From one shape to the next each vertex moves straight and evenly, and so does each point of a
//! link: at the share u of a link whose ends move at a and b it moves at (1 - u) a + u b, no faster
//! than the larger of what it does at the two ends of a piece, since a length is a convex function.
//!
//! The robot is any tube whose centreline is smooth and within the deviation of that, place by
//! place. Its discs are in the balls around their centres, wherever they are turned, so round
//! bodies hold it; the speed of its own centreline does not matter, since at each moment it is
//! within the deviation of the links of that moment.

use super::{Course, Motion, Speed};
use crate::distance::Scalar;
use crate::robot::{Chain, RobotError, Tube};
use parry3d_f64::math::{Pose, Real, Vector};

/// Shapes one after another.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShapePath<'a> {
    shapes: &'a [Chain],
    deviation: Real,
}

impl<'a> ShapePath<'a> {
    /// # Errors
    /// There are no shapes, or not all have links of the same segments with the same radii; or the
    /// deviation is not finite or negative.
    pub(crate) fn new(shapes: &'a [Chain], deviation: Real) -> Result<Self, RobotError> {
        let Some(first) = shapes.first() else {
            return Err(RobotError::NoMotions { parameter: "shapes" });
        };
        if !(0.0..Real::INFINITY).contains(&deviation) {
            return Err(RobotError::Negative { parameter: "deviation", value: deviation });
        }
        // A chain leaves out segments without length. Were others left out in another shape, links
        // would stand for other stretches.
        let links = |chain: &'a Chain| {
            chain
                .links()
                .iter()
                .enumerate()
                .map(|(number, link)| (chain.segment_of(number), link.radius()))
        };
        match shapes.iter().position(|shape| !links(shape).eq(links(first))) {
            Some(index) => Err(RobotError::ShapesDiffer { index }),
            None => Ok(Self { shapes, deviation }),
        }
    }

    /// The shapes before and behind a time, and where it is between them.
    fn around(&self, t: Real) -> ([&'a Chain; 2], Real) {
        let (legs, last) = (self.legs(), self.shapes.len() - 1);
        let along = t * legs as Real;
        // A number out of range becomes the nearest that is in it.
        let leg = (along as usize).min(legs - 1);
        let share = (along - leg as Real).max(0.0);
        ([leg, leg + 1].map(|shape| &self.shapes[shape.min(last)]), share.min(1.0))
    }
}

/// The two ends of a link.
fn ends(chain: &Chain, link: usize) -> Option<[Vector; 2]> {
    chain.links().get(link).map(|link| [link.start(), link.end()])
}

impl Motion for ShapePath<'_> {
    fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
        let ([from, to], share) = self.around(t);
        let pairs = from.links().iter().zip(to.links()).enumerate();
        let links = pairs.map(|(number, (one, other))| {
            let between = |one: Vector, other: Vector| one + (other - one) * share;
            let ends = [between(one.start(), other.start()), between(one.end(), other.end())];
            (ends, one.radius(), from.segment_of(number) as u32)
        });
        tube.set_loose_links(links, self.deviation);
        Ok(Pose::IDENTITY)
    }

    fn speed(&self, section: usize, shares: [Real; 2], times: [Real; 2]) -> Speed {
        let legs = self.legs();
        // Times are rounded: those of one leg may seem to be another's too.
        let [first, last] = times.map(|t| ((t * legs as Real) as usize).min(legs - 1));
        let mut point: Real = 0.0;
        for leg in first..=last {
            let [from, to] =
                [leg, leg + 1].map(|shape| &self.shapes[shape.min(self.shapes.len() - 1)]);
            let (Some(from), Some(to)) = (ends(from, section), ends(to, section)) else { continue };
            let [start, end] = [to[0] - from[0], to[1] - from[1]];
            let speed = |share: Real| (start + (end - start) * share).length();
            let reach = from
                .into_iter()
                .chain(to)
                .fold(0.0, |most: Real, p| most.max(p.abs().max_element()));
            // Differences and a length; a vertex on its way is rounded as well.
            let rounding = 16.0 * Real::UNIT_ROUNDOFF * reach;
            let up = legs as Real * (1.0 + 32.0 * Real::UNIT_ROUNDOFF);
            point = point.max((speed(shares[0]).max(speed(shares[1])) + rounding) * up);
        }
        Speed { point, turn: 0.0 }
    }

    /// In one leg everything moves straight and evenly.
    fn course(&self, section: usize, shares: [Real; 2], times: [Real; 2]) -> Option<Course> {
        let legs = self.legs() as Real;
        let leg = ((0.5 * (times[0] + times[1]) * legs) as usize).min(self.legs() - 1);
        // Times that are another leg's by more than rounding.
        let unsure = 8.0 * Real::UNIT_ROUNDOFF * legs;
        let is_in =
            |t: Real| (leg as Real - unsure..=leg as Real + 1.0 + unsure).contains(&(t * legs));
        if !times.into_iter().all(is_in) {
            return None;
        }
        let [from, to] = [leg, leg + 1].map(|shape| &self.shapes[shape.min(self.shapes.len() - 1)]);
        let (from, to) = (ends(from, section)?, ends(to, section)?);
        let [start, end] = [to[0] - from[0], to[1] - from[1]];
        let apart = (times[1] - times[0]) * legs;
        let ways = shares.map(|share| (start + (end - start) * share) * apart);
        let reach =
            from.into_iter().chain(to).fold(0.0, |most: Real, p| most.max(p.abs().max_element()));
        // Places, differences and ways; and times off by `unsure`, to a leg that begins where this
        // one ends.
        let off =
            64.0 * Real::UNIT_ROUNDOFF * reach + 4.0 * unsure * start.length().max(end.length());
        Some(Course { ways, off })
    }

    fn legs(&self) -> usize {
        self.shapes.len().max(2) - 1
    }
}
