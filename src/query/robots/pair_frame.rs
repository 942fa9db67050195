//! The coordinates of a search over two robots, and capsules around runs of links.
//!
//! The origin is the first robot's base. The scale is the power of two that brings the largest
//! extent of both robots near 1, so that nothing overflows.

use crate::distance::{Scalar, Vec3, segment_parameters};
use crate::pair::PlacedRobot;
use parry3d_f64::math::{Real, Vector};

/// A bound on the rounding error of the distance between two capsules, for coordinates below 2.
///
/// Each coordinate of an end errs by u, by u more if it was moved, and the difference of two by 4 u
/// more. The feet on the axes and the distance between them err by less than 16 u. The radii are
/// exact up to u. A distance at a flat cap may be measured too small by 16 u of an extent below 4:
/// another 64 u.
pub(super) const SLACK: Real = 128.0 * f64::UNIT_ROUNDOFF;

/// A capsule around a run of links.
#[derive(Clone, Copy, Debug)]
pub(super) struct NodeCapsule {
    start: Vec3<Real>,
    along: Vec3<Real>,
    radius: Real,
}

impl NodeCapsule {
    /// Returns a lower bound on the distance between the contents of two capsules.
    pub fn at_least(&self, other: &Self) -> Real {
        let axes = segment_parameters(self.start - other.start, self.along, other.along);
        axes.gap.norm() - self.radius - other.radius - SLACK
    }
}

/// The frame of a search over two robots.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PairFrame {
    origin: Vector,
    scale: Real,
}

impl PairFrame {
    /// Returns the frame for two robots.
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

    /// Converts a length to this frame.
    pub fn length(&self, outside: Real) -> Real {
        outside * self.scale
    }

    /// Converts a length from this frame. The scale is a power of two, so this is exact.
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
