//! The queries of a robot that ask every link, or only whether all keep away.

use super::few_each::FewEach;
use crate::answer::{Contact, LinkProximity};
use crate::pair::PlacedRobot;
use crate::query::contacts::{LocalMinima, RobotContacts, Wall};
use crate::robot::LinkNode;
use crate::search::hierarchy::{KeepsAway, MeshSearch};
use parry3d_f64::math::Real;

/// A robot on its way through a mesh.
pub(crate) struct RobotSearch<'a> {
    pub search: MeshSearch<'a>,
    pub robot: PlacedRobot<'a>,
}

impl RobotSearch<'_> {
    /// The closest triangle of every link. `last` are the triangles to start with, link by link.
    pub(crate) fn per_link(&mut self, last: &[u32], few: &mut FewEach, out: &mut Vec<LinkProximity>) {
        few.clear();
        let mut before = None;
        for number in 0..self.robot.links().len() {
            let link = self.robot.link(number);
            let start = [last.get(number).copied(), before];
            let answer = few.add(number, &link, |few| self.search.nearest_or_few(&link, start, few));
            before = Some(match answer {
                Ok(best) => {
                    let nearest = best.nearest().unwrap_or_else(|| self.search.any(&link));
                    out.push(nearest.report(number));
                    nearest.triangle
                }
                Err(likely) => {
                    out.push(LinkProximity::unanswered());
                    likely
                }
            });
        }
        let MeshSearch { level, hierarchy, scratch } = &mut self.search;
        scratch.work.measured += few.answer(*level, &hierarchy.mesh, out);
    }

    /// The contacts of every link.
    pub(crate) fn within(&mut self, margin: Real, minima: &mut LocalMinima, out: &mut Vec<Contact>) {
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

    /// What keeps more than `margin` away from the mesh. None where some link does not.
    pub(crate) fn clears(&mut self, margin: Real) -> Option<KeepsAway> {
        self.search.keeps_away(self.robot, margin)
    }
}
