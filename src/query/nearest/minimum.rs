//! The closest link of a chain and its nearest triangle: branch and bound over the link tree.
//!
//! # Definitions
//! - `upper`: the caller's bound or the best distance so far, whichever is smaller.
//! - `lower[k]`: a lower bound on the distance of link k ([`LinkLowerBounds`]).
//! - `look_ahead`: extra search radius that yields `lower[k]` for later queries. None if it does
//!   not pay; then no new bounds are recorded.
//! - Link k is *open* if `lower[k] <= upper` or if `lower[k]` is unknown.
//!
//! # Algorithm
//! 1. **Reuse.** Subtract the displacement of link k from `lower[k]`. Stop if no link is open.
//! 2. **Seed.** Search the closest link of the last query, or a guess, if it is open. Its distance
//!    lowers `upper`.
//! 3. **Prune.** Walk the link tree in preorder. Skip a subtree if none of its links is open. If
//!    more than half of them are, also skip it if its capsule is farther than `upper + look_ahead`
//!    from the mesh.
//! 4. **Search** the mesh from each link that is left and open. Update `upper` and `lower[k]`.
//!
//! # Correctness
//! **Claim.** The answer is the least (distance, triangle, link) among the links at most the
//! caller's bound from the mesh. The warm start and the seed never change it.
//!
//! **Proof.** `upper` never grows. Steps 1 and 3 skip a link only if its distance exceeds `upper`.
//! One other case skips a link: at `upper = 0`, every triangle that it may touch has a higher
//! number than the best one. Such a link loses the tie. So steps 2 and 4 search every link at the
//! final distance, ties included; [`closer`] orders ties.
//!
//! **Recorded bounds.** A radius is recorded as `lower[k]` only where the search of link k, or the
//! test of a capsule around it, reached that radius.
//!
//! **Rounding.** `lower[k]` is rounded down and the capsule test is conservative: both can only
//! search a link too many.

use super::link_lower_bounds::LinkLowerBounds;
use crate::answer::Work;
use crate::mesh::BLOCK;
use crate::pair::{Best, Nearest, PlacedRobot};
use crate::robot::{BoundingCapsule, LinkNode, distance_to_segment};
use crate::search::hierarchy::MeshSearch;
use parry3d_f64::math::Real;
use std::ops::Range;

/// A link of the robot and its nearest triangle.
pub(crate) type LinkHit = (usize, Nearest);

/// State that warm-starts the next query.
#[derive(Clone, Default)]
pub(crate) struct WarmStart {
    /// The closest link and its triangle at the last query.
    last: Option<(usize, u32)>,
    /// Lower bounds on the distances of the links.
    lower_bounds: LinkLowerBounds,
}

impl WarmStart {
    pub(crate) fn forget(&mut self) {
        self.last = None;
        self.forget_distances();
    }

    /// Forgets the lower bounds, which hold only while the mesh is at rest.
    pub(crate) fn forget_distances(&mut self) {
        self.lower_bounds.forget();
    }
}

/// Returns the closest link and its nearest triangle, if they are at most `bound` apart.
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

/// A branch-and-bound search for the closest link (see the module).
struct BranchAndBound<'a> {
    search: MeshSearch<'a>,
    robot: PlacedRobot<'a>,
    lower_bounds: &'a mut LinkLowerBounds,
    upper: Real,
    best: Option<LinkHit>,
    /// Extra search radius. None: search only to `upper`.
    look_ahead: Option<Real>,
}

impl<'a> BranchAndBound<'a> {
    fn within(
        bound: Real,
        search: MeshSearch<'a>,
        robot: PlacedRobot<'a>,
        lower_bounds: &'a mut LinkLowerBounds,
    ) -> Self {
        Self { search, robot, lower_bounds, upper: bound, best: None, look_ahead: None }
    }

    /// Runs the search from the closest link and triangle of the last query, and records its cost.
    fn nearest(mut self, last: Option<(usize, u32)>) -> Option<LinkHit> {
        let before = self.visited();
        self.run(last);
        self.lower_bounds.record_cost(self.visited() - before, self.robot.links().len());
        self.best
    }

    /// Returns the nodes and leaves visited since the engine was built.
    fn visited(&self) -> u64 {
        let Work { nodes, visited, .. } = self.search.scratch.work;
        nodes + visited / BLOCK as u64
    }

    /// Steps 1 to 4.
    fn run(&mut self, last: Option<(usize, u32)>) {
        let (robot, mesh_reach) = (self.robot, self.search.hierarchy.mesh_reach);
        let count = robot.links().len();
        self.lower_bounds.refresh(robot);
        if self.lower_bounds.count_open(0..count, self.upper) == 0 {
            return;
        }
        let (first, triangle) = match last {
            Some((link, triangle)) if link < count => (link, triangle),
            _ => self.seed(),
        };
        if self.lower_bounds.count_open(first..first + 1, self.upper) > 0 {
            let wanted = Best::within(self.upper);
            let nearest =
                self.search.nearest(&robot.link(first), wanted, [Some(triangle), None]).nearest();
            self.offer(first, nearest);
        }
        self.lower_bounds.drop_if_useless(count, self.upper);
        // A look-ahead as long as the robot's axis and last diameter, or as wide as the mesh, would
        // prune little: the robot jumped.
        let (tip, length_before_tip) = (&robot.links()[count - 1], robot.length_before(count - 1));
        let size = length_before_tip + tip.length() + 2.0 * tip.radius();
        let most = size.min(mesh_reach);
        self.look_ahead = self.lower_bounds.choose_look_ahead(robot, self.upper, most, mesh_reach);
        if self.look_ahead.is_some()
            && let Some((_, nearest)) = self.best
        {
            self.lower_bounds.set(robot, first..first + 1, nearest.distance, None, mesh_reach);
        }
        let tree = robot.link_tree();
        // The index in the tree, and the number of the first link below it.
        let (mut index, mut link) = (0, 0);
        while let Some(node) = tree.get(index) {
            let links = link..link + node.links();
            match node {
                LinkNode::Inner { bound: capsule, below } => {
                    if self.can_prune(capsule, links.clone()) {
                        index += below;
                        link = links.end;
                    }
                }
                LinkNode::Leaf(_) => {
                    if link != first && self.lower_bounds.count_open(links, self.upper) > 0 {
                        self.search_link(link);
                    }
                    link += 1;
                }
            }
            index += 1;
        }
    }

    /// Step 3: returns true if no link of a subtree can improve on the best. False proves nothing.
    /// Records the search radius for links that the capsule proves farther away.
    fn can_prune(&mut self, capsule: &BoundingCapsule, links: Range<usize>) -> bool {
        let open = self.lower_bounds.count_open(links.clone(), self.upper);
        // The capsule of many links is a weak bound on a few of them.
        if 2 * open <= links.len() {
            return open == 0;
        }
        let capsule = self.robot.bound(capsule);
        let Some(radius) = self.search_radius() else {
            return !self.search.may_meet_lower(&capsule, self.upper, self.triangle_limit());
        };
        let is_beyond = !self.search.may_meet(&capsule, radius);
        if is_beyond {
            self.lower_bounds.set(
                self.robot,
                links,
                radius,
                None,
                self.search.hierarchy.mesh_reach,
            );
        }
        is_beyond
    }

    /// Step 4: searches the triangle nearest to a link.
    fn search_link(&mut self, number: usize) {
        let link = self.robot.link(number);
        let wanted = Best::within(self.upper).touching_below(self.triangle_limit());
        let found = if let Some(radius) = self.search_radius() {
            let (best, lower, triangle) = self.search.nearest_with_lower_bound(
                &link,
                wanted,
                radius,
                [self.lower_bounds.recorded_triangle(number), None],
            );
            self.lower_bounds.set(
                self.robot,
                number..number + 1,
                lower,
                triangle,
                self.search.hierarchy.mesh_reach,
            );
            best
        } else {
            self.search.nearest(&link, wanted, [None; 2])
        };
        self.offer(number, found.nearest());
    }

    /// Returns `upper + look_ahead`. None without a look-ahead, and at `upper = 0`: then only links
    /// that touch can still win a tie.
    fn search_radius(&self) -> Option<Real> {
        self.look_ahead.filter(|_| self.upper > 0.0).map(|look_ahead| self.upper + look_ahead)
    }

    /// Returns the lowest triangle number that cannot win: at `upper = 0` the one after the best
    /// triangle. The best triangle itself can still win for a lower link.
    fn triangle_limit(&self) -> u32 {
        match self.best {
            Some((_, nearest)) if nearest.distance <= 0.0 => nearest.triangle.saturating_add(1),
            _ => u32::MAX,
        }
    }

    /// Keeps the closer of the best and this one, and lowers `upper`.
    fn offer(&mut self, link: usize, nearest: Option<Nearest>) {
        let Some(nearest) = nearest else { return };
        let found = (link, nearest);
        let best = self.best.map_or(found, |best| closer(found, best));
        self.best = Some(best);
        self.upper = best.1.distance;
    }

    /// The guess of step 2: a triangle about nearest to the robot's capsule, and the link closest
    /// to the centroid of that triangle.
    fn seed(&mut self) -> (usize, u32) {
        let Some(LinkNode::Inner { bound: capsule, .. }) = self.robot.link_tree().first() else {
            return (0, 0);
        };
        let triangle = self.search.search_guess(&self.robot.bound(capsule)).unwrap_or(0);
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

/// Returns the closer of two. Ties go to the lower triangle, then to the lower link.
fn closer(one: LinkHit, other: LinkHit) -> LinkHit {
    let key = |of: &LinkHit| (of.1.triangle, of.0);
    let is_nearer = one.1.distance < other.1.distance
        || (one.1.distance <= other.1.distance && key(&one) < key(&other));
    if is_nearer { one } else { other }
}
