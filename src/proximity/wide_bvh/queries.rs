//! The queries of a robot that ask every link, or only whether all keep away.

use super::hierarchy::MeshSearch;
use crate::proximity::local_minima::{LocalMinima, RobotContacts, Wall};
use crate::proximity::placed::{Best, PlacedRobot};
use crate::proximity::{Contact, LinkProximity};
use crate::robot::LinkNode;
use parry3d_f64::math::Real;

/// A robot on its way through a mesh.
pub(super) struct RobotSearch<'a> {
    pub search: MeshSearch<'a>,
    pub robot: PlacedRobot<'a>,
}

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

    /// The contacts of every link.
    pub(super) fn within(&mut self, margin: Real, minima: &mut LocalMinima, out: &mut Vec<Contact>) {
        let Self { search, robot } = self;
        let (level, hierarchy, robot) = (search.level, search.hierarchy, *robot);
        let wall = Wall { mesh: &hierarchy.mesh, place_of: hierarchy.place_of() };
        let mut contacts = RobotContacts::new(level, wall, robot, margin, minima, out);
        let (tree, mut place) = (robot.link_tree(), 0);
        while let Some(node) = tree.get(place) {
            match node {
                LinkNode::Inner { bound, below } => {
                    if !search.may_meet(&robot.bound(bound), margin) {
                        place += below;
                    }
                }
                LinkNode::Leaf(link) => {
                    contacts.add(*link, |link, near| search.within(link, margin, near));
                }
            }
            place += 1;
        }
        search.scratch.work.measured += contacts.finish();
    }

    /// Whether every link keeps more than `margin` away from the mesh.
    pub(super) fn clears(&mut self, margin: Real) -> bool {
        self.search.keeps_away(self.robot, margin)
    }
}
