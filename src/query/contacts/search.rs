//! The contacts of a robot by search: the link tree is pruned by capsules, then each link is
//! searched.

use super::candidate_gather::gather;
use super::local_minima::{ContactCollector, LocalMinima};
use super::opposite_corners::OppositeCorners;
use super::prominence::ContactQuery;
use super::triangle_candidates::TriangleCandidates;
use super::wall::Wall;
use crate::answer::Contact;
use crate::pair::{PlacedLink, PlacedRobot};
use crate::robot::LinkNode;
use crate::search::hierarchy::{MeshSearch, Searched};
use crate::threads::Lazy;
use parry3d_f64::math::Real;

/// A search that culls triangles on a slope towards a neighbour.
pub(crate) struct ContactSearch<'a> {
    pub search: MeshSearch<'a>,
    /// Built on first use.
    pub across: &'a Lazy<OppositeCorners<f32>>,
}

impl ContactSearch<'_> {
    /// Writes the contacts of the robot to `out`, link by link.
    pub(crate) fn within(
        &mut self,
        robot: PlacedRobot,
        query: ContactQuery,
        minima: &mut LocalMinima,
        out: &mut Vec<Contact>,
    ) {
        let (level, hierarchy) = (self.search.level, self.search.hierarchy);
        let wall = Wall { mesh: &hierarchy.mesh, tree: Some(hierarchy.single()) };
        let mut contacts = ContactCollector::new(level, wall, robot, query, minima, out);
        let (tree, mut place) = (robot.link_tree(), 0);
        while let Some(node) = tree.get(place) {
            match node {
                LinkNode::Inner { bound, below } => {
                    if !self.search.may_meet(&robot.bound(bound), query.margin) {
                        place += below;
                    }
                }
                LinkNode::Leaf(link) => {
                    contacts.add(*link, |link, near| self.near(link, query.margin, near));
                }
            }
            place += 1;
        }
        self.search.scratch.work.measured += contacts.finish();
    }

    /// Adds to `found` the triangles that may be at most `bound` from a link.
    fn near(&mut self, link: &PlacedLink, bound: Real, found: &mut TriangleCandidates) {
        let hierarchy = self.search.hierarchy;
        match hierarchy.searched(self.search.level, link) {
            Searched::Single(searched) => {
                let across = self.across.get_or_build(|| OppositeCorners::new(hierarchy.single()));
                gather(self.search.single(), &searched, bound, Some(across), found);
            }
            // Links that need double precision are rare, so they have no table of opposite corners.
            Searched::Double(searched) => {
                gather(self.search.double(), &searched, bound, None, found)
            }
            Searched::OutOfReach => found.add_unclassified(0..hierarchy.mesh.len() as u32),
        }
    }
}
