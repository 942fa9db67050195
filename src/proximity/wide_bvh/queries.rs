//! The queries of a robot: all its links, the closest of them, or only whether they keep away.

use super::hierarchy::MeshSearch;
use crate::proximity::local_minima::{LocalMinima, RobotContacts};
use crate::proximity::placed::{Best, Nearest, PlacedRobot};
use crate::proximity::{Contact, LinkProximity};
use crate::robot::{LinkNode, distance_to_segment};
use parry3d_f64::math::Real;

/// A robot on its way through a mesh.
pub(super) struct RobotSearch<'a> {
    pub search: MeshSearch<'a>,
    pub robot: PlacedRobot<'a>,
}

/// A link of the robot and its nearest triangle.
pub(super) type OfLink = (usize, Nearest);

impl RobotSearch<'_> {
    /// The closest triangle of every link. `last` are the triangles to start with, link by link.
    pub(super) fn per_link(&mut self, last: &[u32], out: &mut Vec<LinkProximity>) {
        for number in 0..self.robot.links().len() {
            let link = self.robot.link(number);
            let before = out.last().map(|answer: &LinkProximity| answer.triangle);
            let start = [last.get(number).copied(), before];
            let nearest = self.search.nearest(&link, Best::within(Real::INFINITY), start).nearest();
            out.push(nearest.unwrap_or_else(|| self.search.any(&link)).report(number));
        }
    }

    /// The closest link and triangle. `last` are those to start with.
    pub(super) fn minimum(&mut self, last: Option<(usize, u32)>) -> OfLink {
        self.minimum_within(last, Real::INFINITY).unwrap_or_else(|| (0, self.search.any(&self.robot.link(0))))
    }

    /// The closest link and triangle, if they are at most `bound` apart. `last` are those to start with.
    pub(super) fn minimum_within(&mut self, last: Option<(usize, u32)>, bound: Real) -> Option<OfLink> {
        let (first, triangle) = match last {
            Some((link, triangle)) if link < self.robot.links().len() => (link, triangle),
            _ => self.likely_minimum(),
        };
        let link = self.robot.link(first);
        let nearest = self.search.nearest(&link, Best::within(bound), [Some(triangle), None]).nearest();
        let mut best = nearest.map(|nearest| (first, nearest));
        let tree = self.robot.link_tree();
        let mut place = 0;
        while let Some(node) = tree.get(place) {
            let bound = best.map_or(bound, |best| best.1.distance);
            // Of the links that touch, the one with the lowest triangle counts, then the lowest link.
            let below = match best {
                Some((_, nearest)) if nearest.distance <= 0.0 => nearest.triangle.saturating_add(1),
                _ => u32::MAX,
            };
            match node {
                LinkNode::Inner { bound: capsule, below: links_below } => {
                    if !self.search.may_meet_below(&self.robot.bound(capsule), bound, below) {
                        place += links_below;
                    }
                }
                LinkNode::Leaf(link) if *link != first => {
                    let placed = self.robot.link(*link);
                    let wanted = Best::within(bound).touching_below(below);
                    if let Some(nearest) = self.search.nearest(&placed, wanted, [None, None]).nearest() {
                        let found = (*link, nearest);
                        best = Some(best.map_or(found, |best| nearer(found, best)));
                    }
                }
                LinkNode::Leaf(_) => {}
            }
            place += 1;
        }
        best
    }

    /// The contacts of every link.
    pub(super) fn within(&mut self, margin: Real, minima: &mut LocalMinima, out: &mut Vec<Contact>) {
        let Self { search, robot } = self;
        let mut contacts =
            RobotContacts::new(search.level, &search.hierarchy.mesh, *robot, margin, minima, out);
        let (tree, mut place) = (robot.link_tree(), 0);
        while let Some(node) = tree.get(place) {
            match node {
                LinkNode::Inner { bound, below } => {
                    if !search.may_meet(&robot.bound(bound), margin) {
                        place += below;
                    }
                }
                LinkNode::Leaf(link) => {
                    let count = contacts.add(*link, |link, near| search.within(link, margin, near));
                    search.scratch.work.measured += count;
                }
            }
            place += 1;
        }
    }

    /// Whether every link keeps more than `margin` away from the mesh.
    pub(super) fn clears(&mut self, margin: Real) -> bool {
        self.search.keeps_away(self.robot, margin)
    }

    /// About the triangle nearest to the capsule around the robot, and the link nearest to that triangle.
    fn likely_minimum(&mut self) -> (usize, u32) {
        let Some(LinkNode::Inner { bound, .. }) = self.robot.link_tree().first() else { return (0, 0) };
        let triangle = self.search.about_nearest(&self.robot.bound(bound)).unwrap_or(0);
        let [a, b, c] = self.search.hierarchy.mesh.corners(triangle);
        let centre = self.robot.in_robot_frame(a / 3.0 + b / 3.0 + c / 3.0);
        let distances = self
            .robot
            .links()
            .iter()
            .map(|link| distance_to_segment(centre, link.start(), link.end()) - link.radius());
        let nearest = distances.enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
        (nearest.map_or(0, |(link, _)| link), triangle)
    }
}

/// The nearer of two, or of links as near the one with the lower triangle, then the lower link.
fn nearer(one: OfLink, other: OfLink) -> OfLink {
    let key = |of: &OfLink| (of.1.triangle, of.0);
    let is_nearer =
        one.1.distance < other.1.distance || (one.1.distance <= other.1.distance && key(&one) < key(&other));
    if is_nearer { one } else { other }
}
