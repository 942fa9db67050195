//! A planner's own shapes with linear interpolation, and a stated deviation from it.
//!
//! # Speed
//! Between two shapes each vertex moves straight at constant speed, and so does each point of a
//! link. At the share u of a link whose ends move at a and b, the velocity is `(1 - u) a + u b`.
//! Its length is convex in u, so between two shares it is at most the larger of the values there.
//!
//! # What the bounds cover
//! Every tube with a smooth centreline that is within the deviation of the links, place by place.
//! For every direction its discs lie in balls around their centres, so round bodies contain it. The
//! speed of its own centreline does not matter: at each instant it is within the deviation of the
//! links.

use super::{DisplacementBound, Motion, Speed};
use crate::curve::Tube;
use crate::distance::Scalar;
use crate::robot::{Chain, RobotError, length};
use parry3d_f64::math::{Pose, Real, Vector};

/// Shapes in sequence.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShapePath<'a> {
    shapes: &'a [Chain],
    deviation: Real,
}

impl<'a> ShapePath<'a> {
    /// Builds the path from shapes in order of time.
    ///
    /// # Errors
    /// No shape; shapes whose links differ in segments or radii; a deviation that is negative or
    /// not finite.
    pub(crate) fn new(shapes: &'a [Chain], deviation: Real) -> Result<Self, RobotError> {
        let Some(first) = shapes.first() else {
            return Err(RobotError::NoMotions { parameter: "shapes" });
        };
        if !(0.0..Real::INFINITY).contains(&deviation) {
            return Err(RobotError::Negative { parameter: "deviation", value: deviation });
        }
        // A chain omits segments without length. If another shape omitted other segments, its links
        // would represent other parts of the robot.
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

    /// Returns the shapes before and behind a time, and its position between them from 0 to 1.
    fn around(&self, t: Real) -> ([&'a Chain; 2], Real) {
        let (parts, last) = (self.time_parts(), self.shapes.len() - 1);
        let along = t * parts as Real;
        // The conversion saturates.
        let part = (along as usize).min(parts - 1);
        let share = (along - part as Real).max(0.0);
        ([part, part + 1].map(|shape| &self.shapes[shape.min(last)]), share.min(1.0))
    }
}

/// Returns the two ends of a link.
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
        let parts = self.time_parts();
        // Rounding may assign the time of one part to its neighbour.
        let [first, last] = times.map(|t| ((t * parts as Real) as usize).min(parts - 1));
        let mut point: Real = 0.0;
        for part in first..=last {
            let [from, to] =
                [part, part + 1].map(|shape| &self.shapes[shape.min(self.shapes.len() - 1)]);
            let (Some(from), Some(to)) = (ends(from, section), ends(to, section)) else { continue };
            let [start, end] = [to[0] - from[0], to[1] - from[1]];
            let speed = |share: Real| length(start + (end - start) * share);
            let reach = from
                .into_iter()
                .chain(to)
                .fold(0.0, |most: Real, p| most.max(p.abs().max_element()));
            // Covers differences, a length, and the rounding of a moving vertex.
            let rounding = 16.0 * Real::UNIT_ROUNDOFF * reach;
            let up = parts as Real * (1.0 + 32.0 * Real::UNIT_ROUNDOFF);
            point = point.max((speed(shares[0]).max(speed(shares[1])) + rounding) * up);
        }
        Speed { point, turn: 0.0 }
    }

    /// Within one part every point moves straight at constant speed.
    fn displacement(
        &self,
        section: usize,
        shares: [Real; 2],
        times: [Real; 2],
    ) -> Option<DisplacementBound> {
        let parts = self.time_parts() as Real;
        let part = ((0.5 * (times[0] + times[1]) * parts) as usize).min(self.time_parts() - 1);
        // Times beyond the part by more than rounding belong to another part.
        let unsure = 8.0 * Real::UNIT_ROUNDOFF * parts;
        let is_in =
            |t: Real| (part as Real - unsure..=part as Real + 1.0 + unsure).contains(&(t * parts));
        if !times.into_iter().all(is_in) {
            return None;
        }
        let [from, to] =
            [part, part + 1].map(|shape| &self.shapes[shape.min(self.shapes.len() - 1)]);
        let (from, to) = (ends(from, section)?, ends(to, section)?);
        let [start, end] = [to[0] - from[0], to[1] - from[1]];
        let apart = (times[1] - times[0]) * parts;
        let ways = shares.map(|share| (start + (end - start) * share) * apart);
        let reach =
            from.into_iter().chain(to).fold(0.0, |most: Real, p| most.max(p.abs().max_element()));
        // Covers places, differences and displacements, and times that are off by `unsure`, into a
        // part that begins where this one ends.
        let off =
            64.0 * Real::UNIT_ROUNDOFF * reach + 4.0 * unsure * length(start).max(length(end));
        Some(DisplacementBound { ways, off })
    }

    fn time_parts(&self) -> usize {
        self.shapes.len().max(2) - 1
    }
}
