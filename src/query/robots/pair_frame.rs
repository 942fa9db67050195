//! The capsules around many links, in the coordinates of a search.
//!
//! A search over two robots takes place in coordinates from the first robot's base, multiplied by
//! the power of two that brings the largest of both robots near one, so that nothing overflows.

use crate::distance::{Scalar, Vec3, segment_parameters};
use crate::pair::PlacedRobot;
use parry3d_f64::math::{Real, Vector};

/// What rounding can add to the distance between two capsules, where all coordinates are below 2.
///
/// Each coordinate of an end errs by u of it, by as much again where it was moved, and the
/// difference of two by 4 u more; the foot on either axis and the length of the way between them by
/// less than 16 u. Both radii are exact but for u. A distance at a flat cap may be measured too
/// short by 16 u of an extent below 4: another 64 u.
pub(super) const SLACK: Real = 128.0 * f64::UNIT_ROUNDOFF;

/// A capsule around links.
#[derive(Clone, Copy, Debug)]
pub(super) struct NodeCapsule {
    start: Vec3<Real>,
    along: Vec3<Real>,
    radius: Real,
}

impl NodeCapsule {
    /// A lower bound on the distance between what two capsules hold.
    pub fn at_least(&self, other: &Self) -> Real {
        let axes = segment_parameters(self.start - other.start, self.along, other.along);
        axes.gap.norm() - self.radius - other.radius - SLACK
    }
}

impl NodeCapsule {
    /// How long it is.
    pub fn size(&self) -> Real {
        self.along.norm() + 2.0 * self.radius
    }

    /// The unit vector along the way from its axis to another's, unless they meet.
    pub fn way_to(&self, other: &Self) -> Option<Vector> {
        let axes = segment_parameters(self.start - other.start, self.along, other.along);
        let way = -Vector::from(axes.gap.normalised());
        (way != Vector::ZERO).then_some(way)
    }
}

/// Where a search over robots takes place.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PairFrame {
    origin: Vector,
    scale: Real,
}

impl PairFrame {
    /// The frame of a search over these robots.
    pub fn around(robots: [&PlacedRobot; 2]) -> Self {
        let origin = robots[0].ends()[0];
        let reach = |robot: &PlacedRobot| {
            let (ends, radius, _) = robot.outline(&robot.link_tree()[0]);
            ends.into_iter()
                .fold(0.0, |most: Real, end| most.max((end - origin).abs().max_element()))
                + radius
        };
        let scale = reach(robots[0]).max(reach(robots[1])).power_of_two_to_unity();
        Self { origin, scale }
    }

    /// A length in this frame.
    pub fn length(&self, outside: Real) -> Real {
        outside * self.scale
    }

    /// The length outside of one in this frame: the scale is a power of two, so that nothing is
    /// lost.
    pub fn outside(&self, length: Real) -> Real {
        length * (1.0 / self.scale)
    }

    pub fn point(&self, outside: Vector) -> Vector {
        (outside - self.origin) * self.scale
    }

    pub fn outline(&self, robot: &PlacedRobot, node: usize) -> NodeCapsule {
        let (ends, radius, _) = robot.outline(&robot.link_tree()[node]);
        let [start, end] = ends.map(|end| Vec3::from(self.point(end)));
        NodeCapsule { start, along: end - start, radius: self.length(radius) }
    }
}
