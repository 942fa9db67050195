//! A link in the mesh's frame, and its distance from a triangle.

use super::coordinates::{BOUND_ROUNDING, Nearest, Pair, Placed, offset_from_axis};
use crate::answer::{LinkProximity, Witness};
use crate::distance::{DoubleDouble, Face, Link, Scalar, Vec3, segment_segment, single};
use crate::robot::{ModifiedCylinder, share_along};
use parry3d_f64::math::{Pose, Real, Vector};

/// A link in the mesh's frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlacedLink {
    start: Vector,
    end: Vector,
    /// The vector from start to end.
    along: Vector,
    /// The unit direction of the axis, or zero if it has none.
    axis: Vec3<Real>,
    radius: Real,
    flat: [bool; 2],
    /// The largest coordinate from the start, or the radius.
    extent: Real,
    /// The total length of the links before it.
    before: Real,
    /// The index of the segment of the robot's input that this link represents.
    segment: u32,
}

impl PlacedLink {
    /// Returns the link at `pose`.
    pub(crate) fn new(link: &ModifiedCylinder, pose: &Pose) -> Self {
        Self::of(&link.transformed(pose))
    }

    /// Returns a link that is already in the mesh's frame.
    pub(crate) fn of(link: &ModifiedCylinder) -> Self {
        Self::between(link.start(), link.end(), link.radius(), link.flat())
    }

    pub(crate) fn between(start: Vector, end: Vector, radius: Real, flat: [bool; 2]) -> Self {
        let along = end - start;
        let extent = along.abs().max_element().max(radius);
        let axis = Vec3::from(along).normalised();
        Self { start, end, along, axis, radius, flat, extent, before: 0.0, segment: 0 }
    }

    /// Returns the same link with its place on the robot: the length of the links before it, and
    /// its segment of the robot's input.
    pub(super) fn at(self, before: Real, segment: u32) -> Self {
        Self { before, segment, ..self }
    }

    /// Returns the answer about this link, whose index is `number`.
    pub(crate) fn answer(&self, number: usize, nearest: &Nearest) -> LinkProximity {
        let Nearest { triangle, distance, on_robot, on_mesh } = *nearest;
        let arc_length = self.arc_length_of(on_mesh);
        let witness = Witness { on_robot, on_mesh, triangle, arc_length, segment: self.segment };
        LinkProximity { link: number as u32, distance, witness }
    }

    #[cfg(feature = "tubes")]
    pub(crate) fn is_finite(&self) -> bool {
        self.start.is_finite() && self.end.is_finite() && self.radius.is_finite()
    }

    /// Returns the arc length at which the robot's axis is closest to a point.
    pub(crate) fn arc_length_of(&self, point: Vector) -> Real {
        self.before + self.share_of(point) * self.along.dot(Vector::from(self.axis))
    }

    /// Returns the fraction of the axis, from 0 to 1, that is closest to a point.
    pub(crate) fn share_of(&self, point: Vector) -> Real {
        share_along(point - self.start, self.along)
    }

    pub(crate) fn start(&self) -> Vector {
        self.start
    }

    pub(crate) fn end(&self) -> Vector {
        self.end
    }

    pub(crate) fn along(&self) -> Vector {
        self.along
    }

    pub(crate) fn axis(&self) -> Vec3<Real> {
        self.axis
    }

    pub(crate) fn radius(&self) -> Real {
        self.radius
    }

    pub(crate) fn flat(&self) -> [bool; 2] {
        self.flat
    }

    /// The largest coordinate from the start, or the radius.
    pub(crate) fn extent(&self) -> Real {
        self.extent
    }

    /// Returns the closest points of the link and a triangle.
    pub(crate) fn measure(&self, triangle: u32, corners: [Vector; 3]) -> Nearest {
        let pair = self.pair(corners);
        let face = Face::new(pair.triangle);
        Pair::report(
            pair.unit,
            self.start,
            triangle,
            single::with_caps(&single::axial(&pair.link, &face), &pair.link, &face),
        )
    }

    /// Returns a lower bound on the distance between link and triangle.
    #[cfg(feature = "gpu")]
    pub(crate) fn at_least(&self, corners: [Vector; 3]) -> Real {
        let pair = self.pair(corners);
        pair.at_least() * pair.unit
    }

    /// Returns the closest points if they are at most `bound` apart. Cheaper bounds are tested
    /// first.
    pub(super) fn measure_within(
        &self,
        bound: Real,
        triangle: u32,
        corners: [Vector; 3],
    ) -> Option<Nearest> {
        let pair = self.pair(corners);
        // Convert the bounds to the mesh's unit, and not the reverse: the rounding there is the
        // same for the distance.
        if pair.at_least() * pair.unit > bound {
            return None;
        }
        let face = Face::new(pair.triangle);
        let axial = single::axial(&pair.link, &face);
        let closest = if !axial.beyond_flat_cap() {
            axial.without_caps(&pair.link)
        } else if (axial.cap_bounds(&pair.link, &face).0 - BOUND_ROUNDING) * pair.unit > bound {
            return None;
        } else {
            single::with_caps(&axial, &pair.link, &face)
        };
        let nearest = Pair::report(pair.unit, self.start, triangle, closest);
        (nearest.distance <= bound).then_some(nearest)
    }

    /// Returns whether the link is at most `bound` from the segment between two points.
    pub(crate) fn comes_within(&self, bound: Real, from: Vector, to: Vector) -> bool {
        // The capsule around the link is quick to measure and no farther.
        let pair = self.pair([from, to, to]);
        let [from, to, _] = pair.triangle;
        let axis = segment_segment([Vec3::zero(0.0), pair.link.end], [from, to]).distance;
        if (axis - pair.link.radius - BOUND_ROUNDING) * pair.unit > bound {
            return false;
        }
        let edge = Face::new(pair.triangle);
        let axial = single::axial(&pair.link, &edge);
        single::with_caps(&axial, &pair.link, &edge).distance * pair.unit <= bound
    }

    /// Returns the largest coordinate of link and triangle relative to the link's start, or the
    /// radius.
    pub(crate) fn extent_with(&self, corners: [Vector; 3]) -> Real {
        let [a, b, c] = corners.map(|corner| (corner - self.start).abs());
        a.max(b).max(c).max_element().max(self.extent)
    }

    /// Returns the pair with a triangle, in its own coordinates.
    #[inline(always)]
    pub(super) fn pair(&self, corners: [Vector; 3]) -> Pair<Real> {
        self.in_lanes().with(corners.map(Vec3::from))
    }

    /// Returns the link as a [`Placed`], the form that packs share.
    #[inline(always)]
    pub(super) fn in_lanes(&self) -> Placed<Real> {
        let Self { along, axis, radius, flat, extent, .. } = *self;
        Placed { start: self.start.into(), along: along.into(), axis, radius, flat, extent }
    }

    /// Returns a lower bound on the distance between the link and the contents of a box.
    ///
    /// **Definitions.** `c`: the box's centre. `v`: the vector to `c` from the closest axis point.
    /// `h`: the half extents.
    ///
    /// **Claim.** The axis lies behind a plane with the normal `v` before both of its ends. The box
    /// lies beyond the plane with the same normal through its corner on that side. Before rounding,
    /// the bound is `|v| - <|v|, h> / |v|`, which is below the distance by about `h^2 / |v|`:
    /// little for a small box. The distance between the boxes of link and node is looser, because a
    /// slanted link fills its box badly.
    #[inline(always)]
    pub(crate) fn distance_to_box(&self, mins: Vector, maxs: Vector) -> Real {
        let (low, high) = (mins - self.start, maxs - self.start);
        let scale =
            low.abs().max(high.abs()).max_element().max(self.extent).power_of_two_to_unity();
        let half = (high - low) * (0.5 * scale);
        let centre = Vec3::from(low * scale + half);
        let end = Vec3::from(self.along * scale);
        let link = Link { end, axis: self.axis, radius: self.radius * scale, flat: self.flat };
        let normal = offset_from_axis(&link, centre);
        let corner = half.dot(Vector::from(normal).abs());
        let beyond = normal.dot(centre) - link.reach_along(normal) - corner;
        ((beyond.over(normal.norm()) - link.radius - BOUND_ROUNDING) / scale).max(0.0)
    }
}

/// Returns link and triangle in the coordinates of [`PlacedLink::pair`], in double-double numbers:
/// only the link's direction is rounded.
pub(crate) fn place_exactly(
    link: &PlacedLink,
    corners: [Vector; 3],
) -> ([Vec3<DoubleDouble>; 3], Link<DoubleDouble>) {
    let pair = link.pair(corners);
    let scale = 1.0 / pair.unit;
    let offset = |point: Vector| {
        let coordinate =
            |x: Real, from: Real| DoubleDouble::from(x * scale) - (from * scale).into();
        let (to, from) = (point, link.start());
        Vec3::new(coordinate(to.x, from.x), coordinate(to.y, from.y), coordinate(to.z, from.z))
    };
    let has_axis = pair.link.axis != Vec3::zero(0.0);
    let flat = link.flat().map(|flat| flat && has_axis);
    let placed = Link::new(offset(link.end()), pair.link.radius.into(), flat);
    (corners.map(offset), placed)
}
