//! The queries of a robot: all its links, the closest of them, or only whether they keep away.

use super::build::WideBvh;
use super::traverse::{Stack, Traversal};
use crate::proximity::mesh::Mesh;
use crate::proximity::placed::{Best, Nearest, PlacedLink, PlacedRobot};
use crate::proximity::search_frame::SearchLink;
use crate::proximity::{LinkProximity, Work};
use crate::robot::{LinkNode, distance_to_segment};
use fearless_simd::Level;
use parry3d_f64::math::Real;
use std::sync::OnceLock;

/// A mesh and its hierarchies.
#[derive(Clone)]
pub(super) struct Hierarchy {
    pub mesh: Mesh,
    single: WideBvh<f32>,
    /// For links that single precision does not resolve, built when the first of them comes.
    double: OnceLock<WideBvh<f64>>,
}

impl Hierarchy {
    pub(super) fn new(level: Level, mesh: Mesh) -> Self {
        Self { single: WideBvh::new(level, &mesh), double: OnceLock::new(), mesh }
    }

    fn double(&self, level: Level) -> &WideBvh<f64> {
        self.double.get_or_init(|| WideBvh::new(level, &self.mesh))
    }

    /// The link in the precision that resolves it.
    fn searched(&self, level: Level, link: &PlacedLink) -> Searched {
        let single = SearchLink::new(link, &self.single.frame);
        if let Some(single) = single.filter(|single| self.single.frame.resolves(single)) {
            return Searched::Single(single);
        }
        match SearchLink::new(link, &self.double(level).frame) {
            Some(double) => Searched::Double(double),
            None => Searched::OutOfReach,
        }
    }

    /// Takes over that the vertices of the mesh have moved.
    pub(super) fn refit(&mut self, level: Level) {
        self.single.refit(level, &self.mesh);
        if let Some(double) = self.double.get_mut() {
            double.refit(level, &self.mesh);
        }
    }
}

/// A link in the frame of a search.
enum Searched {
    Single(SearchLink<f32>),
    Double(SearchLink<f64>),
    /// Farther out than double precision reaches beside a mesh so small.
    OutOfReach,
}

/// Memory of a query, used again by the next.
#[derive(Clone, Default)]
pub(super) struct Scratch {
    single: Stack<f32>,
    double: Stack<f64>,
    pub work: Work,
}

/// A robot on its way through a mesh.
pub(super) struct RobotSearch<'a> {
    pub level: Level,
    pub hierarchy: &'a Hierarchy,
    pub scratch: &'a mut Scratch,
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
            let nearest = self.nearest(&link, Best::within(Real::INFINITY), start).nearest();
            out.push(nearest.unwrap_or_else(|| self.any(&link)).report(number));
        }
    }

    /// The closest link and triangle. `last` are those to start with.
    pub(super) fn minimum(&mut self, last: Option<(usize, u32)>) -> OfLink {
        let (first, triangle) = match last {
            Some((link, triangle)) if link < self.robot.links().len() => (link, triangle),
            _ => self.likely_minimum(),
        };
        let link = self.robot.link(first);
        let nearest = self.nearest(&link, Best::within(Real::INFINITY), [Some(triangle), None]).nearest();
        let mut best = (first, nearest.unwrap_or_else(|| self.any(&link)));
        let tree = self.robot.link_tree();
        let mut place = 0;
        while let Some(node) = tree.get(place) {
            let bound = best.1.distance;
            if bound <= 0.0 {
                break;
            }
            match node {
                LinkNode::Inner { bound: capsule, below } => {
                    if !self.may_meet(&self.robot.bound(capsule), bound) {
                        place += below;
                    }
                }
                LinkNode::Leaf(link) if *link != first => {
                    let placed = self.robot.link(*link);
                    if let Some(nearest) = self.nearest(&placed, Best::within(bound), [None, None]).nearest()
                    {
                        best = nearer((*link, nearest), best);
                    }
                }
                LinkNode::Leaf(_) => {}
            }
            place += 1;
        }
        best
    }

    /// Whether every link keeps more than `margin` away from the mesh.
    pub(super) fn clears(&mut self, margin: Real) -> bool {
        let tree = self.robot.link_tree();
        let mut place = 0;
        while let Some(node) = tree.get(place) {
            match node {
                LinkNode::Inner { bound, below } => {
                    if !self.may_meet(&self.robot.bound(bound), margin) {
                        place += below;
                    }
                }
                LinkNode::Leaf(link) => {
                    let link = self.robot.link(*link);
                    if self.nearest(&link, Best::within(margin), [None, None]).nearest().is_some() {
                        return false;
                    }
                }
            }
            place += 1;
        }
        true
    }

    /// The triangle nearest to the capsule around the robot, and the link nearest to that triangle.
    fn likely_minimum(&mut self) -> (usize, u32) {
        let Some(LinkNode::Inner { bound, .. }) = self.robot.link_tree().first() else { return (0, 0) };
        let capsule = self.robot.bound(bound);
        let found = self.nearest(&capsule, Best::within(Real::INFINITY), [None, None]).nearest();
        let triangle = found.map_or(0, |found| found.triangle);
        let [a, b, c] = self.hierarchy.mesh.corners(triangle);
        let centre = self.robot.in_robot_frame(a / 3.0 + b / 3.0 + c / 3.0);
        let distances = self
            .robot
            .links()
            .iter()
            .map(|link| distance_to_segment(centre, link.start(), link.end()) - link.radius());
        let nearest = distances.enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
        (nearest.map_or(0, |(link, _)| link), triangle)
    }

    /// The triangle nearest to a link that improves on `best`. The triangles to `start` with come first.
    fn nearest(&mut self, link: &PlacedLink, mut best: Best, start: [Option<u32>; 2]) -> Best {
        match self.hierarchy.searched(self.level, link) {
            Searched::Single(searched) => self.single().nearest(link, &searched, best, start),
            Searched::Double(searched) => self.double().nearest(link, &searched, best, start),
            Searched::OutOfReach => {
                let mesh = &self.hierarchy.mesh;
                for triangle in 0..mesh.len() as u32 {
                    best.measure(link, triangle, mesh.corners(triangle));
                }
                self.scratch.work.measured += mesh.len() as u64;
                best
            }
        }
    }

    /// Whether any triangle may be at most `bound` from a capsule around links; false only if none is.
    fn may_meet(&mut self, capsule: &PlacedLink, bound: Real) -> bool {
        match self.hierarchy.searched(self.level, capsule) {
            Searched::Single(searched) => self.single().may_meet(&searched, bound),
            Searched::Double(searched) => self.double().may_meet(&searched, bound),
            Searched::OutOfReach => true,
        }
    }

    /// Some triangle, for a link whose nearest no search tells.
    fn any(&self, link: &PlacedLink) -> Nearest {
        link.measure(0, self.hierarchy.mesh.corners(0))
    }

    fn single(&mut self) -> Traversal<'_, f32> {
        let Hierarchy { mesh, single, .. } = self.hierarchy;
        let Scratch { single: stack, work, .. } = &mut *self.scratch;
        Traversal { level: self.level, mesh, tree: single, stack, work }
    }

    fn double(&mut self) -> Traversal<'_, f64> {
        let tree = self.hierarchy.double(self.level);
        let Scratch { double: stack, work, .. } = &mut *self.scratch;
        Traversal { level: self.level, mesh: &self.hierarchy.mesh, tree, stack, work }
    }
}

/// The nearer of two, or of links as near the one with the lower triangle, then the lower link.
fn nearer(one: OfLink, other: OfLink) -> OfLink {
    let key = |of: &OfLink| (of.1.triangle, of.0);
    let is_nearer =
        one.1.distance < other.1.distance || (one.1.distance <= other.1.distance && key(&one) < key(&other));
    if is_nearer { one } else { other }
}
