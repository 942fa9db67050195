//! Two placed links, and their distance.
//!
//! As with a link and a triangle, each pair is measured in its own coordinates: relative to the
//! first link's start, scaled by the power of two that brings the largest of them near one.

use super::coordinates::{Placed, SLACK};
use super::placed_link::PlacedLink;
use crate::answer::{PairWitness, RobotProximity};
use crate::distance::{Closest, Link, Scalar, TwoLinks, Vec3, gives_direction, single};
use parry3d_f64::math::{Real, Vector};

/// The distance of two links and their closest points; if they meet, one common point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NearestOfLinks {
    pub distance: Real,
    pub on_first: Vector,
    pub on_second: Vector,
}

impl NearestOfLinks {
    /// Returns the same result with the links exchanged.
    pub(crate) fn swapped(self) -> Self {
        Self { on_first: self.on_second, on_second: self.on_first, ..self }
    }

    /// Returns the answer about two links with these indices.
    pub(crate) fn answer(
        &self,
        links: [usize; 2],
        [first, second]: [&PlacedLink; 2],
    ) -> RobotProximity {
        let Self { distance, on_first, on_second } = *self;
        let arc_lengths = [first.arc_length_of(on_second), second.arc_length_of(on_first)];
        RobotProximity {
            links: links.map(|link| link as u32),
            distance,
            witness: PairWitness { on_first, on_second, arc_lengths },
        }
    }
}

impl PlacedLink {
    /// Returns the closest points of two links.
    pub(crate) fn measure_link(&self, other: &Self) -> NearestOfLinks {
        let (pair, unit) = self.with_link(other);
        self.nearest_of_links(unit, &single::two_links(&pair, &pair.axes()))
    }

    /// Returns the closest points of the flat face at an end of this link and another link.
    ///
    /// A link whose length underflows beside the other has no direction: it is measured whole.
    pub(crate) fn face_to_link(&self, end: usize, other: &Self) -> NearestOfLinks {
        let (pair, unit) = self.with_link(other);
        let has_direction = pair.first.axis.norm_squared() > 0.0;
        let closest = if has_direction {
            pair.closest_to_cap(end_of(&pair.first, end), |mask| mask)
        } else {
            single::two_links(&pair, &pair.axes())
        };
        self.nearest_of_links(unit, &closest)
    }

    /// Returns the closest points of the flat faces at one end of each link. A link without a
    /// direction is measured whole.
    pub(crate) fn face_to_face(&self, ends: [usize; 2], other: &Self) -> NearestOfLinks {
        let (pair, unit) = self.with_link(other);
        let [first, second] =
            [pair.first.axis, pair.second.axis].map(|axis| axis.norm_squared() > 0.0);
        if !second {
            return self.face_to_link(ends[0], other);
        }
        if !first {
            return other.face_to_link(ends[1], self).swapped();
        }
        let centres =
            [end_of(&pair.first, ends[0]), pair.second_start + end_of(&pair.second, ends[1])];
        self.nearest_of_links(unit, &pair.closest_caps(centres))
    }

    fn nearest_of_links(&self, unit: Real, closest: &Closest<Real>) -> NearestOfLinks {
        let place = |point: Vec3<Real>| self.start() + Vector::from(point) * unit;
        let (distance, on_first) = (closest.distance * unit, place(closest.point1));
        let on_second = if distance > 0.0 { place(closest.point2) } else { on_first };
        NearestOfLinks { distance, on_first, on_second }
    }

    /// Returns the closest points of two links if they are at most `bound` apart. The capsules
    /// around the links are tested first.
    pub(crate) fn measure_link_within(&self, bound: Real, other: &Self) -> Option<NearestOfLinks> {
        let (pair, unit) = self.with_link(other);
        let axes = pair.axes();
        if capsules_apart(&pair, axes.gap.norm()) * unit > bound {
            return None;
        }
        let nearest = self.nearest_of_links(unit, &single::two_links(&pair, &axes));
        (nearest.distance <= bound).then_some(nearest)
    }

    /// Returns whether the capsules around two links may be at most `bound` apart.
    pub(crate) fn may_be_within(&self, bound: Real, other: &Self) -> bool {
        let (pair, unit) = self.with_link(other);
        capsules_apart(&pair, pair.axes().gap.norm()) * unit <= bound
    }

    /// Returns the closest points of two axes, and their distance.
    pub(crate) fn nearest_on_axes(&self, other: &Self) -> ([Vector; 2], Real) {
        let (pair, unit) = self.with_link(other);
        let axes = pair.axes();
        let feet = [self.start() + self.along() * axes.s, other.start() + other.along() * axes.t];
        (feet, axes.gap.norm() * unit)
    }

    /// Returns both links in the pair's coordinates, and the length of 1 there.
    fn with_link(&self, other: &Self) -> (TwoLinks<Real>, Real) {
        self.in_lanes().with_link(&other.in_lanes())
    }
}

impl<T: Scalar> Placed<T> {
    /// Returns both links in the pair's coordinates, and the length of 1 there.
    #[inline(always)]
    pub(super) fn with_link(&self, other: &Self) -> (TwoLinks<T>, T) {
        let start = other.start - self.start;
        let end = start + other.along;
        let extent = start.largest().max(end.largest()).max(self.extent).max(other.radius);
        let scale = extent.power_of_two_to_unity();
        let (first, second) = (self.scaled(scale), other.scaled(scale));
        (TwoLinks { first, second, second_start: start * scale }, scale.one() / scale)
    }

    /// Returns the link relative to its start, scaled. A length whose square underflows beside the
    /// pair's extent gives no direction.
    #[inline(always)]
    fn scaled(&self, scale: T) -> Link<T> {
        let end = self.along * scale;
        let has_direction = gives_direction(end.norm_squared());
        let axis = Vec3::select(has_direction, self.axis, Vec3::zero(scale));
        Link { end, axis, radius: self.radius * scale, flat: self.flat }
    }
}

/// Returns a lower bound on the distance of the capsules around two links. `axes` is the distance
/// of the axes.
#[inline(always)]
pub(super) fn capsules_apart<T: Scalar>(pair: &TwoLinks<T>, axes: T) -> T {
    axes - pair.first.radius - pair.second.radius - axes.lit(SLACK)
}

/// Returns an end of a link, relative to its start.
fn end_of(link: &Link<Real>, end: usize) -> Vec3<Real> {
    if end == 0 { Vec3::zero(0.0) } else { link.end }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The axes are 3 √2 apart and the radii are 2, in units of the smallest number. Less than half
    /// of a unit remains between them, and the closest points round to places on both sides of it.
    #[test]
    fn links_whose_distance_rounds_to_0_have_one_point_in_common() {
        let unit = Real::from_bits(1);
        let along = Vector::new(0.0, 0.0, 1000.0 * unit);
        let apart = Vector::new(3.0 * unit, 3.0 * unit, 0.0);
        let first = PlacedLink::between(Vector::ZERO, along, 2.0 * unit, [false; 2]);
        let second = PlacedLink::between(apart, apart + along, 2.0 * unit, [false; 2]);
        let nearest = first.measure_link(&second);
        assert_eq!(nearest.distance, 0.0);
        assert_eq!(nearest.on_first, nearest.on_second);
    }
}
