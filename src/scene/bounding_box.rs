//! The bounding box of triangles, and lower bounds on a robot's distance from it.

use crate::distance::Scalar;
use crate::pair::{PlacedLink, PlacedRobot};
use crate::robot::{LinkNode, length};
use parry3d_f64::math::{Pose, Real, Vector};

/// The corners of a box. For an empty box `low` is above `high`.
#[derive(Clone, Copy, Debug)]
pub(super) struct BoundingBox {
    low: Vector,
    high: Vector,
}

impl Default for BoundingBox {
    fn default() -> Self {
        Self { low: Vector::splat(Real::INFINITY), high: Vector::splat(Real::NEG_INFINITY) }
    }
}

impl BoundingBox {
    pub fn points(points: impl Iterator<Item = Vector>) -> Self {
        points.fold(Self::default(), |Self { low, high }, point| Self {
            low: low.min(point),
            high: high.max(point),
        })
    }

    /// The bounding box of this box after a pose.
    pub fn moved(&self, pose: &Pose) -> Self {
        let Self { low, high } = *self;
        let corners = (0..8).map(|corner| {
            let from = |axis: usize| if corner >> axis & 1 == 0 { low[axis] } else { high[axis] };
            pose * Vector::new(from(0), from(1), from(2))
        });
        Self::points(corners)
    }

    pub fn and(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// This box with a rim of a width.
    pub fn grown(self, width: Real) -> Self {
        Self { low: self.low - Vector::splat(width), high: self.high + Vector::splat(width) }
    }

    /// The distance from another box, without the rounding of both.
    pub fn gap(&self, other: &Self) -> Real {
        length((self.low - other.high).max(other.low - self.high).max(Vector::ZERO))
    }

    /// The largest magnitude of a coordinate.
    pub fn size(&self) -> Real {
        self.low.abs().max(self.high.abs()).max_element()
    }

    /// An upper bound on the distance of its points from the origin.
    pub fn farthest(&self) -> Real {
        length(self.low.abs().max(self.high.abs())) * (1.0 + 8.0 * Real::UNIT_ROUNDOFF)
    }

    /// A lower bound on the distance of a robot, by the bounding box of the capsule that contains
    /// the robot.
    ///
    /// **Rounding.** Let M be the largest magnitude of the capsule's ends, its radius and the box's
    /// corners.
    ///
    /// 1. Each coordinate of the gap between the boxes is a difference of sums and errs by at most
    ///    6 u M.
    /// 2. So the length of the gap errs by less than 11 u M, and by less than 14 u M for its own
    ///    squares, sums and root.
    /// 3. The final subtraction errs by less than 6 u M.
    /// 4. A measured distance may fall short by 16 u of an extent of 2 M.
    ///
    /// The sum is less than the 64 u M that are subtracted.
    pub fn at_least(&self, robot: &PlacedRobot) -> Real {
        let ([start, end], radius, _) = robot.outline(&robot.link_tree()[0]);
        let Self { low, high } = *self;
        let way =
            (start.min(end) - radius - high).max(low - (start.max(end) + radius)).max(Vector::ZERO);
        let largest =
            start.abs().max(end.abs()).max(low.abs()).max(high.abs()).max_element().max(radius);
        length(way) - 64.0 * Real::UNIT_ROUNDOFF * largest
    }

    /// The distance of a point, without its rounding.
    pub fn distance_to_point(&self, point: Vector) -> Real {
        length((self.low - point).max(point - self.high).max(Vector::ZERO))
    }

    /// A lower bound on the distance of a link.
    pub fn distance_to(&self, link: &PlacedLink) -> Real {
        link.distance_to_box(self.low, self.high)
    }

    /// Returns whether some link of a robot may be at most `bound` away, by the capsules around its
    /// links.
    pub fn may_be_within(&self, robot: &PlacedRobot, bound: Real) -> bool {
        let (nodes, mut place) = (robot.link_tree(), 0);
        while let Some(node) = nodes.get(place) {
            let ([start, end], radius, flat) = robot.outline(node);
            let link = PlacedLink::between(start, end, radius, flat);
            let is_far = self.distance_to(&link) > bound;
            place += match node {
                LinkNode::Inner { below, .. } if is_far => 1 + below,
                LinkNode::Leaf(_) if !is_far => return true,
                _ => 1,
            };
        }
        false
    }
}
