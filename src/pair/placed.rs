//! The robot in the mesh's frame, and how near a triangle is to one of its links: the measurement in double precision
//! by which every engine answers.
//!
//! Each pair of link and triangle is measured in coordinates of its own, from the link's start and multiplied by the
//! power of two that brings the largest of them near one. So neither far parts of the scene nor its place nor its unit
//! play a part in the rounding, and nothing overflows or vanishes. Distances and bounds outside of a pair are plain
//! ones, in the unit of the mesh.

use super::checks::{check_range, rigid_pose};
use crate::answer::{LinkProximity, ProximityError};
use crate::distance::{
    Axial, Closest, DoubleDouble, Face, Link, Scalar, Vec3, gives_direction, segment_segment,
};
use crate::robot::{BoundingCapsule, Chain, LinkNode, ModifiedCylinder};
use parry3d_f64::math::{Pose, Real, Vector};

/// What rounding can add to a bound of a pair, in whose coordinates all numbers are below 2.
const SLACK: Real = 64.0 * f64::UNIT_ROUNDOFF;

/// A robot at a pose in the frame of a mesh, whose links are placed when they are needed.
#[derive(Clone, Copy)]
pub(crate) struct PlacedRobot<'a> {
    robot: &'a Chain,
    /// Its rotation is of unit length.
    pose: Pose,
    /// Base and tip in the mesh's frame.
    ends: [Vector; 2],
    /// By how much a rotation that is not quite of unit length stretches the robot.
    stretch: Real,
    /// What rounding can do to the place of a link in a capsule.
    ///
    /// A rotated point errs by less than 20 u |q|^2 |p| (glam's formula, the length of the error), and a moved one by u more
    /// of where it comes to be. |q|^2 |p| is no longer than that place and the translation together, and a length at most
    /// 1.74 times its largest coordinate: 37 u of the largest coordinates of both. Twice that, for the capsule and for the
    /// link, is less than 128 u.
    slack: Real,
}

impl<'a> PlacedRobot<'a> {
    /// # Errors
    /// The pose is not finite or not rigid, or moves a link out of range.
    pub(crate) fn new(robot: &'a Chain, pose: &Pose) -> Result<Self, ProximityError> {
        let pose = rigid_pose(pose)?;
        let links = robot.links();
        let ends = [pose * links[0].start(), pose * links[links.len() - 1].end()];
        check_range(robot, &pose, ends)?;
        let stretch = pose.rotation.length_squared().max(1.0);
        let around = match robot.link_tree()[0] {
            LinkNode::Inner { bound, .. } => bound.radius * stretch,
            LinkNode::Leaf(_) => 0.0,
        };
        let largest = ends[0].abs().max(ends[1].abs()).max(pose.translation.abs()).max_element();
        let slack = 128.0 * Real::UNIT_ROUNDOFF * (2.0 * largest + around);
        Ok(Self { robot, pose, ends, stretch, slack })
    }

    /// The links in the robot's frame.
    pub(crate) fn links(&self) -> &'a [ModifiedCylinder] {
        self.robot.links()
    }

    /// A link in the mesh's frame.
    pub(crate) fn link(&self, link: usize) -> PlacedLink {
        PlacedLink::new(&self.robot.links()[link], &self.pose)
    }

    /// All links in the mesh's frame.
    pub(crate) fn placed_links(&self) -> impl Iterator<Item = PlacedLink> {
        self.robot.links().iter().map(|link| PlacedLink::new(link, &self.pose))
    }

    /// How long the links before a link are, together.
    pub(crate) fn length_before(&self, link: usize) -> Real {
        self.robot.length_before(link)
    }

    pub(crate) fn link_tree(&self) -> &'a [LinkNode] {
        self.robot.link_tree()
    }

    /// A capsule around links in the mesh's frame.
    pub(crate) fn bound(&self, bound: &BoundingCapsule) -> PlacedLink {
        let ([start, end], radius) = self.capsule(bound);
        PlacedLink::between(start, end, radius, [false; 2])
    }

    /// The ends of its axis, and a radius that holds the links as they are placed one by one.
    #[inline(always)]
    fn capsule(&self, bound: &BoundingCapsule) -> ([Vector; 2], Real) {
        ([self.pose * bound.start, self.pose * bound.end], bound.radius * self.stretch + self.slack)
    }

    /// Base and tip in the mesh's frame.
    pub(crate) fn ends(&self) -> [Vector; 2] {
        self.ends
    }

    /// The ends of a link's axis, or of the axis of a capsule around links, in the mesh's frame; the radius; which caps
    /// are flat.
    #[inline(always)] // what it hands over is used at once
    pub(crate) fn outline(&self, node: &LinkNode) -> ([Vector; 2], Real, [bool; 2]) {
        match node {
            LinkNode::Inner { bound, .. } => {
                let (ends, radius) = self.capsule(bound);
                (ends, radius, [false; 2])
            }
            LinkNode::Leaf(link) => {
                let link = self.robot.links()[*link].transformed(&self.pose);
                ([link.start(), link.end()], link.radius(), link.flat())
            }
        }
    }

    /// A point of the robot in the mesh's frame.
    pub(crate) fn placed(&self, point: Vector) -> Vector {
        self.pose * point
    }

    pub(crate) fn in_robot_frame(&self, point: Vector) -> Vector {
        self.pose.inverse_transform_point(point)
    }
}

/// A link in the mesh's frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlacedLink {
    start: Vector,
    end: Vector,
    /// From start to end.
    along: Vector,
    /// The unit direction of the axis, or zero without one.
    axis: Vec3<Real>,
    radius: Real,
    flat: [bool; 2],
    /// The largest coordinate from the start, or the radius.
    extent: Real,
}

/// The triangle nearest to a link, in the mesh's frame and unit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Nearest {
    pub triangle: u32,
    pub distance: Real,
    pub on_robot: Vector,
    pub on_mesh: Vector,
}

impl PlacedLink {
    /// The link at `pose`.
    pub(crate) fn new(link: &ModifiedCylinder, pose: &Pose) -> Self {
        Self::of(&link.transformed(pose))
    }

    /// A link that is in the mesh's frame.
    pub(crate) fn of(link: &ModifiedCylinder) -> Self {
        Self::between(link.start(), link.end(), link.radius(), link.flat())
    }

    pub(crate) fn between(start: Vector, end: Vector, radius: Real, flat: [bool; 2]) -> Self {
        let along = end - start;
        let extent = along.abs().max_element().max(radius);
        Self { start, end, along, axis: Vec3::from(along).normalised(), radius, flat, extent }
    }

    pub(crate) fn is_finite(&self) -> bool {
        self.start.is_finite() && self.end.is_finite() && self.radius.is_finite()
    }

    /// The share of the axis at which it is nearest to a point.
    pub(crate) fn share_of(&self, point: Vector) -> Real {
        let share = (point - self.start).dot(self.along) / self.along.length_squared();
        // 0 / 0 without a length: the comparison turns it into 0.
        if share > 0.0 { share.min(1.0) } else { 0.0 }
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

    /// The nearest points of the link and a triangle.
    pub(crate) fn measure(&self, triangle: u32, corners: [Vector; 3]) -> Nearest {
        let pair = self.pair(corners);
        let face = Face::new(pair.triangle);
        Pair::report(
            pair.unit,
            self.start,
            triangle,
            Axial::new(&pair.link, &face).with_caps(&pair.link, &face),
        )
    }

    /// A lower bound on the distance between link and triangle.
    #[cfg(feature = "gpu")]
    pub(crate) fn at_least(&self, corners: [Vector; 3]) -> Real {
        let pair = self.pair(corners);
        pair.at_least() * pair.unit
    }

    /// The same if they are at most `bound` apart. Cheaper bounds spare what they can.
    fn measure_within(&self, bound: Real, triangle: u32, corners: [Vector; 3]) -> Option<Nearest> {
        let pair = self.pair(corners);
        // Bounds are brought into the mesh's unit, and not the other way: whatever is rounded there, the distance is too.
        if pair.at_least() * pair.unit > bound {
            return None;
        }
        let face = Face::new(pair.triangle);
        let axial = Axial::new(&pair.link, &face);
        let closest = if !axial.beyond_flat_cap() {
            axial.without_caps(&pair.link)
        } else if axial.cap_bounds(&pair.link, &face).0 * pair.unit > bound {
            return None;
        } else {
            axial.with_caps(&pair.link, &face)
        };
        let nearest = Pair::report(pair.unit, self.start, triangle, closest);
        (nearest.distance <= bound).then_some(nearest)
    }

    /// Whether the link is at most `bound` from the segment between two points.
    pub(crate) fn comes_within(&self, bound: Real, from: Vector, to: Vector) -> bool {
        // The capsule around the link is quick to measure, and no farther.
        let pair = self.pair([from, to, to]);
        let [from, to, _] = pair.triangle;
        let axis = segment_segment([Vec3::zero(0.0), pair.link.end], [from, to]).distance;
        if (axis - pair.link.radius - SLACK) * pair.unit > bound {
            return false;
        }
        let edge = Face::new(pair.triangle);
        Axial::new(&pair.link, &edge).with_caps(&pair.link, &edge).distance * pair.unit <= bound
    }

    /// The largest coordinate of link and triangle from the link's start, or the radius.
    pub(crate) fn extent_with(&self, corners: [Vector; 3]) -> Real {
        let [a, b, c] = corners.map(|corner| (corner - self.start).abs());
        a.max(b).max(c).max_element().max(self.extent)
    }

    pub(crate) fn pair(&self, corners: [Vector; 3]) -> Pair {
        let offsets = corners.map(|corner| corner - self.start);
        let extent = self.extent_with(corners);
        let scale = extent.power_of_two_to_unity();
        let end = Vec3::from(self.along * scale);
        // A length whose square vanishes beside the triangle tells no direction.
        let axis = if gives_direction(end.norm_squared()) { self.axis } else { Vec3::zero(0.0) };
        Pair {
            triangle: offsets.map(|offset| Vec3::from(offset * scale)),
            link: Link { end, axis, radius: self.radius * scale, flat: self.flat },
            unit: 1.0 / scale,
        }
    }

    /// A lower bound on the distance between the link and anything in the box.
    ///
    /// With c the box's centre and v the way to it from the nearest axis point, the whole axis lies behind a plane
    /// with normal v before its ends, and the box beyond the one through its corner on that side. But for rounding
    /// the bound is |v| - <|v|, h> / |v| with h the half extents: off by about h^2 / |v|, next to nothing for a small
    /// box. It serves better than the distance between the boxes of link and node, which a slanted link fills
    /// badly.
    pub(crate) fn distance_to_box(&self, mins: Vector, maxs: Vector) -> Real {
        let (low, high) = (mins - self.start, maxs - self.start);
        let scale = low.abs().max(high.abs()).max_element().max(self.extent).power_of_two_to_unity();
        let half = (high - low) * (0.5 * scale);
        let centre = Vec3::from(low * scale + half);
        let end = Vec3::from(self.along * scale);
        let link = Link { end, axis: self.axis, radius: self.radius * scale, flat: self.flat };
        let normal = offset_from_axis(&link, centre);
        let corner = half.dot(Vector::from(normal).abs());
        let beyond = normal.dot(centre) - link.reach_along(normal) - corner;
        ((beyond.over(normal.norm()) - link.radius - SLACK) / scale).max(0.0)
    }
}

/// Link and triangle in the coordinates of [`PlacedLink::pair`], with twice the digits: nothing is rounded but the
/// link's direction.
pub(crate) fn place_exactly(
    link: &PlacedLink,
    corners: [Vector; 3],
) -> ([Vec3<DoubleDouble>; 3], Link<DoubleDouble>) {
    let pair = link.pair(corners);
    let scale = 1.0 / pair.unit;
    let offset = |point: Vector| {
        let coordinate = |x: Real, from: Real| DoubleDouble::from(x * scale) - (from * scale).into();
        let (to, from) = (point, link.start);
        Vec3::new(coordinate(to.x, from.x), coordinate(to.y, from.y), coordinate(to.z, from.z))
    };
    let has_axis = pair.link.axis != Vec3::zero(0.0);
    let flat = link.flat.map(|flat| flat && has_axis);
    let placed = Link::new(offset(link.end), pair.link.radius.into(), flat);
    (corners.map(offset), placed)
}

/// A link and a triangle in coordinates of their own.
pub(crate) struct Pair {
    pub triangle: [Vec3<Real>; 3],
    pub link: Link<Real>,
    /// What 1 is in the mesh's unit.
    pub unit: Real,
}

impl Pair {
    /// A lower bound on the distance, by the plane of [`PlacedLink::distance_to_box`].
    fn at_least(&self) -> Real {
        let [a, b, c] = self.triangle;
        let centre = (a + b + c) * (1.0 / 3.0);
        let normal = offset_from_axis(&self.link, centre);
        let beyond = normal.dot(a).min(normal.dot(b)).min(normal.dot(c)) - self.link.reach_along(normal);
        beyond.over(normal.norm()) - self.link.radius - SLACK
    }

    /// An answer in the mesh's frame, in which the pair's origin is `start` and 1 is `unit`.
    pub(crate) fn report(unit: Real, start: Vector, triangle: u32, closest: Closest<Real>) -> Nearest {
        let place = |point: Vec3<Real>| start + Vector::from(point) * unit;
        let (distance, on_mesh) = (closest.distance * unit, place(closest.point1));
        // One common point where they touch: rounding may have put the two apart.
        let on_robot = if distance > 0.0 { place(closest.point2) } else { on_mesh };
        Nearest { triangle, distance, on_robot, on_mesh }
    }
}

/// From the axis point nearest to `point` to that point.
fn offset_from_axis(link: &Link<Real>, point: Vec3<Real>) -> Vec3<Real> {
    let t = point.dot(link.axis).max(0.0).min(link.end.dot(link.axis));
    point.along(link.axis, -t)
}

/// The nearest triangle so far of those at most so far away; of two as near the one with the lower number.
#[derive(Clone, Copy)]
pub(crate) struct Best {
    bound: Real,
    nearest: Option<Nearest>,
    /// Of the triangles that touch, only those with a lower number than this are wanted.
    below: u32,
}

impl Best {
    /// Nothing yet.
    pub(crate) fn within(bound: Real) -> Self {
        Self { bound, nearest: None, below: u32::MAX }
    }

    /// The same, where of the triangles that touch only those with a lower number than `below` are wanted.
    pub(crate) fn touching_below(self, below: u32) -> Self {
        Self { below, ..self }
    }

    /// What was found so far, of which something at most `bound` away would be an improvement.
    pub(crate) fn resume(bound: Real, nearest: Option<Nearest>) -> Self {
        Self { bound, nearest, below: u32::MAX }
    }

    /// What a triangle must not be farther than.
    pub(crate) fn bound(&self) -> Real {
        self.bound
    }

    pub(crate) fn nearest(&self) -> Option<Nearest> {
        self.nearest
    }

    /// Only triangles with a lower number than this can still be better: nothing is nearer than what touches.
    #[inline(always)]
    pub(crate) fn wanted_below(&self) -> u32 {
        if self.bound <= 0.0 { self.below } else { u32::MAX }
    }

    /// Measures a triangle. True if it is the best so far.
    #[inline(never)] // the same code whatever the instruction set
    pub(crate) fn measure(&mut self, link: &PlacedLink, triangle: u32, corners: [Vector; 3]) -> bool {
        link.measure_within(self.bound, triangle, corners).is_some_and(|nearest| self.take(nearest))
    }

    /// Whether a triangle so far away would be the best so far.
    #[inline(always)]
    pub(crate) fn is_worse_than(&self, distance: Real, triangle: u32) -> bool {
        distance <= self.bound
            && self.nearest.is_none_or(|mine| {
                distance < mine.distance || (distance <= mine.distance && triangle < mine.triangle)
            })
            && (distance > 0.0 || triangle < self.below)
    }

    /// Takes over a triangle if it is the best so far.
    pub(crate) fn take(&mut self, other: Nearest) -> bool {
        let is_better = self.is_worse_than(other.distance, other.triangle);
        if is_better {
            let below = if other.distance > 0.0 { self.below } else { other.triangle };
            *self = Self { bound: other.distance, nearest: Some(other), below };
        }
        is_better
    }
}

impl Nearest {
    /// The answer about a link.
    pub(crate) fn report(&self, link: usize) -> LinkProximity {
        let Self { triangle, distance, on_robot, on_mesh } = *self;
        LinkProximity { link: link as u32, triangle, distance, on_robot, on_mesh }
    }
}
