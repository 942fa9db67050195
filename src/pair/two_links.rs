//! Two placed links, and their distance.
//!
//! As with a link and a triangle, each pair is measured in its own coordinates: relative to the
//! first link's start, scaled by the power of two that brings the largest of them near one.

use super::coordinates::Placed;
use super::placed_link::PlacedLink;
use crate::distance::{Closest, Link, Scalar, TwoLinks, Vec3, gives_direction, single};
use parry3d_f64::math::{Real, Vector};

/// The distance of two links and their closest points; if they meet, one common point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NearestOfLinks {
    pub distance: Real,
    pub on_first: Vector,
    pub on_second: Vector,
}

impl PlacedLink {
    /// Returns the closest points of two links.
    pub(crate) fn measure_link(&self, other: &Self) -> NearestOfLinks {
        let (pair, unit) = self.with_link(other);
        self.nearest_of_links(unit, &single::two_links(&pair, &pair.axes()))
    }

    pub(super) fn nearest_of_links(&self, unit: Real, closest: &Closest<Real>) -> NearestOfLinks {
        let place = |point: Vec3<Real>| self.start() + Vector::from(point) * unit;
        let (distance, on_first) = (closest.distance * unit, place(closest.point1));
        let on_second = if distance > 0.0 { place(closest.point2) } else { on_first };
        NearestOfLinks { distance, on_first, on_second }
    }

    /// Returns both links in the pair's coordinates, and the length of 1 there.
    pub(super) fn with_link(&self, other: &Self) -> (TwoLinks<Real>, Real) {
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
