//! Where a link is, and how far from there any of its points can be when it has moved.

use crate::proximity::placed::PlacedRobot;
use crate::robot::{LinkNode, length};
use parry3d_f64::math::{Real, Vector};

/// What rounding can do to two distances and to what is between them, for coordinates of size one: 16 u of the extent, which
/// is at most two, for each distance, and 8 u for the ends of each link and their differences.
pub(super) const ROUNDING: Real = 128.0 * f64::EPSILON;

/// A link in the mesh's frame.
#[derive(Clone, Copy)]
pub(super) struct Outline {
    ends: [Vector; 2],
    radius: Real,
    flat: [bool; 2],
}

impl Outline {
    pub(super) fn of(robot: PlacedRobot, link: usize) -> Self {
        let (ends, radius, flat) = robot.outline(&LinkNode::Leaf(link));
        Self { ends, radius, flat }
    }

    /// The robot as one link from its base to its tip, with the radius and the caps of its last one.
    pub(super) fn of_whole(robot: PlacedRobot) -> Self {
        let tip = &robot.links()[robot.links().len() - 1];
        Self { ends: robot.ends(), radius: tip.radius(), flat: tip.flat() }
    }

    /// All links from the tip to the base, each end placed once where two share it.
    pub(super) fn of_all(robot: PlacedRobot) -> impl Iterator<Item = Self> {
        let mut shared: Option<(Vector, Vector)> = None;
        robot.links().iter().rev().map(move |link| {
            let end = match shared {
                Some((point, placed)) if point == link.end() => placed,
                _ => robot.placed(link.end()),
            };
            let start = robot.placed(link.start());
            shared = Some((link.start(), start));
            Self { ends: [start, end], radius: link.radius(), flat: link.flat() }
        })
    }

    /// The largest coordinate.
    pub(super) fn extent(&self) -> Real {
        self.ends[0].abs().max(self.ends[1].abs()).max_element() + self.radius
    }

    /// How far a point of the link can be from all points of the link `then`. Not a number where that can't be told.
    ///
    /// No point of an axis moves farther than the farther of its ends; the ball around it moves along; and where a flat cap
    /// makes it a disc, that turns with the axis, by at most r |a' - a| at its rim, which is at most
    /// 2 r |d' - d| / (|d'| + |d|) for the ways d and d' from start to end (Dunkl and Williams, 1964). A radius that has
    /// grown adds its growth.
    pub(super) fn moved_from(&self, then: &Self) -> Real {
        if self.flat != then.flat {
            return Real::NAN;
        }
        let [start, end] = [self.ends[0] - then.ends[0], self.ends[1] - then.ends[1]];
        let grown = (self.radius - then.radius).max(0.0);
        let turned = if self.flat == [false; 2] {
            0.0
        } else {
            let [long, longer] = [then, self].map(|link| length(link.ends[1] - link.ends[0]));
            // The quotient first: a product of two lengths may vanish.
            2.0 * self.radius * (length(end - start) / (long + longer))
        };
        length(start).max(length(end)) + turned + grown
    }
}
