//! The closest link and triangle.
//!
//! The link that was closest last time comes first and gives a bound. The tree over the links then
//! leaves out what is farther: runs of links whose distances are known to be larger still, and
//! those around which a capsule is. What is searched is searched a little farther than the bound,
//! so that the next queries know those distances.

use crate::answer::Work;
use crate::mesh::BLOCK;
use crate::pair::{Best, Nearest, PlacedRobot};
use crate::query::nearest::memory::LinkLowerBounds;
use crate::robot::{BoundingCapsule, LinkNode, distance_to_segment};
use crate::search::hierarchy::MeshSearch;
use parry3d_f64::math::Real;
use std::ops::Range;

/// A link of the robot and its nearest triangle.
pub(crate) type LinkHit = (usize, Nearest);

/// What a query for the minimum leaves for the next.
#[derive(Clone, Default)]
pub(crate) struct WarmStart {
    /// The closest link and its triangle at the last query.
    last: Option<(usize, u32)>,
    /// What the links kept.
    lower_bounds: LinkLowerBounds,
}

impl WarmStart {
    pub(crate) fn forget(&mut self) {
        self.last = None;
        self.forget_distances();
    }

    /// Forgets what only holds as long as the mesh is still.
    pub(crate) fn forget_distances(&mut self) {
        self.lower_bounds.forget();
    }
}

/// The closest link of a robot and its nearest triangle, if they are at most `bound` apart.
pub(crate) fn minimum_within(
    search: MeshSearch,
    robot: PlacedRobot,
    memory: &mut WarmStart,
    bound: Real,
) -> Option<LinkHit> {
    let WarmStart { last, lower_bounds } = memory;
    let found = BranchAndBound::within(bound, search, robot, lower_bounds).nearest(*last);
    if let Some((link, nearest)) = found {
        *last = Some((link, nearest.triangle));
    }
    found
}

/// A search for the closest link that is at most so far away.
struct BranchAndBound<'a> {
    search: MeshSearch<'a>,
    robot: PlacedRobot<'a>,
    lower_bounds: &'a mut LinkLowerBounds,
    bound: Real,
    best: Option<LinkHit>,
    /// By how much searches are wider than the bound, so that the next query knows more.
    look_ahead: Option<Real>,
}

impl<'a> BranchAndBound<'a> {
    fn within(
        bound: Real,
        search: MeshSearch<'a>,
        robot: PlacedRobot<'a>,
        lower_bounds: &'a mut LinkLowerBounds,
    ) -> Self {
        Self { search, robot, lower_bounds, bound, best: None, look_ahead: None }
    }

    /// The closest link and triangle, if there are any. `last` are those to start with.
    fn nearest(mut self, last: Option<(usize, u32)>) -> Option<LinkHit> {
        let before = self.visited();
        self.run(last);
        self.lower_bounds.record_cost(self.visited() - before, self.robot.links().len());
        self.best
    }

    /// How many nodes and leaves were visited since the engine was built.
    fn visited(&self) -> u64 {
        let Work { nodes, visited, .. } = self.search.scratch.work;
        nodes + visited / BLOCK as u64
    }

    fn run(&mut self, last: Option<(usize, u32)>) {
        let (robot, reach) = (self.robot, self.search.hierarchy.reach);
        let count = robot.links().len();
        self.lower_bounds.refresh(robot);
        if self.lower_bounds.count_open(0..count, self.bound) == 0 {
            return;
        }
        let (first, triangle) = match last {
            Some((link, triangle)) if link < count => (link, triangle),
            _ => self.seed(),
        };
        if self.lower_bounds.count_open(first..first + 1, self.bound) > 0 {
            let wanted = Best::within(self.bound);
            let nearest =
                self.search.nearest(&robot.link(first), wanted, [Some(triangle), None]).nearest();
            self.offer(first, nearest);
        }
        self.lower_bounds.drop_if_useless(count, self.bound);
        // A robot that jumps would make it so wide that nothing of the mesh is left out, or no link
        // of the robot.
        let (last, before) = (&robot.links()[count - 1], robot.length_before(count - 1));
        let size = before + last.length() + 2.0 * last.radius();
        self.look_ahead = self.lower_bounds.look_ahead(robot, self.bound, size.min(reach), reach);
        if self.look_ahead.is_some()
            && let Some((_, nearest)) = self.best
        {
            self.lower_bounds.set(robot, first..first + 1, nearest.distance, None, reach);
        }
        let tree = robot.link_tree();
        let (mut place, mut link) = (0, 0);
        while let Some(node) = tree.get(place) {
            let links = link..link + node.links();
            match node {
                LinkNode::Inner { bound, below } => {
                    if self.can_prune(bound, links.clone()) {
                        place += below;
                        link = links.end;
                    }
                }
                LinkNode::Leaf(_) => {
                    if link != first && self.lower_bounds.count_open(links, self.bound) > 0 {
                        self.search_link(link);
                    }
                    link += 1;
                }
            }
            place += 1;
        }
    }

    /// Whether no link of a run improves on the best; false where that is not clear from its
    /// capsule.
    fn can_prune(&mut self, capsule: &BoundingCapsule, links: Range<usize>) -> bool {
        let in_question = self.lower_bounds.count_open(links.clone(), self.bound);
        // The capsule of many links says little about a few of them.
        if 2 * in_question <= links.len() {
            return in_question == 0;
        }
        let capsule = self.robot.bound(capsule);
        let Some(far) = self.search_radius() else {
            return !self.search.may_meet_below(&capsule, self.bound, self.triangle_limit());
        };
        let keep_away = !self.search.may_meet(&capsule, far);
        if keep_away {
            self.lower_bounds.set(self.robot, links, far, None, self.search.hierarchy.reach);
        }
        keep_away
    }

    /// Searches for the triangle nearest to a link.
    fn search_link(&mut self, number: usize) {
        let link = self.robot.link(number);
        let wanted = Best::within(self.bound).touching_below(self.triangle_limit());
        let found = if let Some(far) = self.search_radius() {
            let (best, apart, about) = self.search.nearest_with_lower_bound(
                &link,
                wanted,
                far,
                [self.lower_bounds.approximate_nearest(number), None],
            );
            self.lower_bounds.set(
                self.robot,
                number..number + 1,
                apart,
                about,
                self.search.hierarchy.reach,
            );
            best
        } else {
            self.search.nearest(&link, wanted, [None; 2])
        };
        self.offer(number, found.nearest());
    }

    /// How far a search is to look so that the next queries know more. None where that is as far as
    /// the bound: of the links that touch only some triangles are asked.
    fn search_radius(&self) -> Option<Real> {
        self.look_ahead.filter(|_| self.bound > 0.0).map(|look_ahead| self.bound + look_ahead)
    }

    /// Of the links that touch, the one with the lowest triangle counts, then the lowest link.
    fn triangle_limit(&self) -> u32 {
        match self.best {
            Some((_, nearest)) if nearest.distance <= 0.0 => nearest.triangle.saturating_add(1),
            _ => u32::MAX,
        }
    }

    /// Keeps the triangle nearest to a link, if it is near enough.
    fn offer(&mut self, link: usize, nearest: Option<Nearest>) {
        let Some(nearest) = nearest else { return };
        let found = (link, nearest);
        let best = self.best.map_or(found, |best| closer(found, best));
        self.best = Some(best);
        self.bound = best.1.distance;
    }

    /// About the triangle nearest to the capsule around the robot, and the link nearest to that
    /// triangle.
    fn seed(&mut self) -> (usize, u32) {
        let Some(LinkNode::Inner { bound, .. }) = self.robot.link_tree().first() else {
            return (0, 0);
        };
        let triangle = self.search.approximate_nearest(&self.robot.bound(bound)).unwrap_or(0);
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
fn closer(one: LinkHit, other: LinkHit) -> LinkHit {
    let key = |of: &LinkHit| (of.1.triangle, of.0);
    let is_nearer = one.1.distance < other.1.distance
        || (one.1.distance <= other.1.distance && key(&one) < key(&other));
    if is_nearer { one } else { other }
}
