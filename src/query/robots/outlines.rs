//! The capsules around a robot's links, placed in the coordinates of a search.
//!
//! A search over two robots takes place in coordinates from the first robot's base, multiplied by the power of two that
//! brings the largest of both robots near one, so that nothing overflows. A difference of two capsules' coordinates errs by
//! a few u of that, and so does the distance between their axes: [`SLACK`] is more than it can be.

use super::outline_rows::OutlineRows;
use crate::distance::{Scalar, Vec3, segment_parameters};
use crate::pair::PlacedRobot;
use crate::robot::LinkNode;
use parry3d_f64::math::{Real, Vector};

/// What rounding can add to the distance between two capsules, where all coordinates are below 2.
///
/// Each coordinate of an end errs by u of it, by as much again where it was moved, and the difference of two by 4 u more;
/// the foot on either axis and the length of the way between them by less than 16 u. Both radii are exact but for u.
const SLACK: Real = 64.0 * f64::UNIT_ROUNDOFF;

/// A capsule around links, or the one around a single link; or a pack of them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Outline<T = Real> {
    pub start: Vec3<T>,
    pub along: Vec3<T>,
    pub radius: T,
}

impl<T: Scalar> Outline<T> {
    /// A lower bound on the distance between what two capsules hold.
    #[inline(always)]
    pub fn at_least(&self, other: &Self) -> T {
        let axes = segment_parameters(self.start - other.start, self.along, other.along);
        axes.gap.norm() - self.radius - other.radius - self.radius.lit(SLACK)
    }
}

/// Where a search over robots takes place.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct SearchFrame {
    origin: Vector,
    scale: Real,
}

impl SearchFrame {
    /// The frame of a search over these robots.
    pub fn around(robots: [&PlacedRobot; 2]) -> Self {
        let origin = robots[0].ends()[0];
        let reach = |robot: &PlacedRobot| {
            let (ends, radius, _) = robot.outline(&robot.link_tree()[0]);
            ends.into_iter().fold(0.0, |most: Real, end| most.max((end - origin).abs().max_element()))
                + radius
        };
        let scale = reach(robots[0]).max(reach(robots[1])).power_of_two_to_unity();
        Self { origin, scale }
    }

    /// What 1 of the search is outside: a power of two, as the scale is.
    pub fn unit(&self) -> Real {
        1.0 / self.scale
    }

    pub fn outline(&self, robot: &PlacedRobot, node: usize) -> Outline {
        let ([start, end], radius, _) = robot.outline(&robot.link_tree()[node]);
        let [start, end] = [start, end].map(|end| Vec3::from((end - self.origin) * self.scale));
        Outline { start, along: end - start, radius: radius * self.scale }
    }
}

/// The outlines of one robot, each placed when it is first asked for.
#[derive(Clone, Debug, Default)]
pub(super) struct Outlines {
    placed: Vec<Option<Outline>>,
    /// Those of single links that are placed.
    links: OutlineRows,
}

impl Outlines {
    /// Forgets the last robot's.
    pub fn start(&mut self, robot: &PlacedRobot) {
        self.placed.clear();
        self.placed.resize(robot.link_tree().len(), None);
        self.links.start(robot.links().len());
    }

    pub fn get(&mut self, frame: &SearchFrame, robot: &PlacedRobot, node: usize) -> Outline {
        let links = &mut self.links;
        *self.placed[node].get_or_insert_with(|| {
            let outline = frame.outline(robot, node);
            if let LinkNode::Leaf(link) = robot.link_tree()[node] {
                links.put(link, &outline);
            }
            outline
        })
    }

    /// Those of the links below a node, in rows.
    pub fn of_links(&mut self, frame: &SearchFrame, robot: &PlacedRobot, node: usize) -> &OutlineRows {
        let below = 2 * robot.link_tree()[node].links() - 1;
        for node in node..node + below {
            if matches!(robot.link_tree()[node], LinkNode::Leaf(_)) {
                self.get(frame, robot, node);
            }
        }
        &self.links
    }
}
