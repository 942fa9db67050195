//! The triangles near a robot, for a query for contacts: the link tree is pruned by capsules, then
//! each link is searched for all triangles within the margin.
//!
//! Triangles of a leaf that are excluded by a plane or culled on a slope are left out. The others
//! are collected with bounds and features until they fill a block, and are then tested together.

use super::contact_collector::{ContactCollector, ContactMemory};
use super::feature_cull::CERTAIN_GAP;
use super::prominence::ContactQuery;
use super::triangle_candidates::{TriangleCandidate, TriangleCandidates, Wall};
use crate::answer::Contact;
use crate::distance::dispatch;
use crate::distance::lanes::{Lane, Pack};
use crate::mesh::{BLOCK, Mesh, first_of_face, load_vertices, place_points, rotated};
use crate::pair::{LinkLanes, PlacedLink, PlacedRobot, SearchLink};
use crate::robot::LinkNode;
use crate::search::hierarchy::{LeafVisitor, MeshSearch, Searched, Traversal, WideBvh};
use crate::threads::Lazy;
use fearless_simd::Level;
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
        memory: &mut ContactMemory,
        out: &mut Vec<Contact>,
    ) {
        let (level, hierarchy) = (self.search.level, self.search.hierarchy);
        let wall = Wall { mesh: &hierarchy.mesh, tree: Some(hierarchy.single()) };
        let mut contacts = ContactCollector::new(level, wall, robot, query, memory, out);
        let (tree, mut index) = (robot.link_tree(), 0);
        while let Some(node) = tree.get(index) {
            match node {
                LinkNode::Inner { bound, below } => {
                    if !self.search.may_meet(&robot.bound(bound), query.margin) {
                        index += below;
                    }
                }
                LinkNode::Leaf(link) => {
                    contacts
                        .add(*link, |link, found| self.find_candidates(link, query.margin, found));
                }
            }
            index += 1;
        }
        self.search.scratch.work.measured += contacts.finish();
    }

    /// Adds to `found` the triangles that may be at most `bound` from a link.
    fn find_candidates(&mut self, link: &PlacedLink, bound: Real, found: &mut TriangleCandidates) {
        let hierarchy = self.search.hierarchy;
        match hierarchy.in_resolving_precision(self.search.level, link) {
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

/// Adds to `found` every triangle that may be at most `bound` from the link. `across` are the
/// opposite corners, with which triangles on a slope are culled; single precision only.
pub(super) fn gather<E: Lane>(
    mut traversal: Traversal<E>,
    searched: &SearchLink<E>,
    bound: Real,
    across: Option<&OppositeCorners<E>>,
    found: &mut TriangleCandidates,
) {
    let limit = searched.axis_limit(bound);
    let mut gathering = CandidateGather::new(traversal.level, searched, limit, across, found);
    dispatch!(E::WIDEST_SEARCH, traversal.level, simd => {
        traversal.visit_leaves::<E::Pack<_>>(simd, searched, limit, &mut gathering)
    });
    traversal.work.axis_distances += gathering.finish();
}

/// The triangles gathered so far.
struct CandidateGather<'a, E> {
    level: Level,
    searched: &'a SearchLink<E>,
    /// A gathered triangle has an axis distance below this.
    limit: E,
    /// The opposite corners, with which triangles on a slope are culled.
    across: Option<&'a OppositeCorners<E>>,
    found: &'a mut TriangleCandidates,
    /// The pending triangles, in rows like the rows of a leaf.
    rows: [E; 9 * BLOCK],
    triangles: [u32; BLOCK],
    /// The corner that each pending triangle has first.
    firsts: [usize; BLOCK],
    waiting: usize,
    /// The number of axis distances computed.
    computed: u64,
}

impl<E: Lane> LeafVisitor<E> for CandidateGather<'_, E> {
    /// Adds the triangles of a leaf that may be within the limit.
    #[inline(always)]
    fn visit<L: Pack<Element = E>>(
        &mut self,
        token: L::Token,
        lanes: &LinkLanes<L>,
        tree: &WideBvh<E>,
        mesh: &Mesh,
        number: u32,
    ) {
        let leaf = &tree.leaves[number as usize];
        let across = self.across.map(|across| across.of(number, tree, mesh));
        let (mut remaining, mut culled) = (0, 0);
        let (limit_of_all, error) =
            (L::splat(token, self.limit), L::splat(token, self.searched.error));
        for lane in (0..BLOCK).step_by(L::LANES) {
            let vertices = load_vertices::<L>(token, &leaf.rows, lane);
            let within = lanes.not_excluded_by_plane(vertices, limit_of_all);
            remaining |= within << lane;
            if within != 0
                && let Some(across) = across
            {
                let across = load_vertices::<L>(token, &across.rows, lane);
                culled |= (within & lanes.culled_by_descent(vertices, across, error)) << lane;
            }
        }
        self.found.add_culled(number, culled);
        remaining &= !culled;
        while remaining != 0 {
            let lane = remaining.trailing_zeros() as usize;
            remaining &= remaining - 1;
            // A leaf that is not full repeats its last triangle.
            if lane > 0 && leaf.triangles[lane - 1] == leaf.triangles[lane] {
                continue;
            }
            for (row, from) in self.rows.chunks_exact_mut(BLOCK).zip(leaf.rows.chunks_exact(BLOCK))
            {
                row[self.waiting] = from[lane];
            }
            self.triangles[self.waiting] = leaf.triangles[lane];
            self.firsts[self.waiting] = match across {
                Some(across) => across.first(lane),
                None => first_of_face::<E>(&tree.frame, mesh, leaf.triangles[lane]),
            };
            self.waiting += 1;
            if self.waiting == BLOCK {
                self.measure_pending();
            }
        }
    }
}

impl<'a, E: Lane> CandidateGather<'a, E> {
    fn new(
        level: Level,
        searched: &'a SearchLink<E>,
        limit: E,
        across: Option<&'a OppositeCorners<E>>,
        found: &'a mut TriangleCandidates,
    ) -> Self {
        let (rows, triangles, firsts) = ([E::default(); 9 * BLOCK], [0; BLOCK], [0; BLOCK]);
        Self {
            level,
            searched,
            limit,
            across,
            found,
            rows,
            triangles,
            firsts,
            waiting: 0,
            computed: 0,
        }
    }

    /// Tests the remaining triangles. Returns the number of axis distances computed.
    fn finish(mut self) -> u64 {
        if self.waiting > 0 {
            self.measure_pending();
        }
        self.computed
    }

    /// Tests the pending triangles and adds each that may be within the limit.
    #[inline(never)] // compiled once for all searches
    fn measure_pending(&mut self) {
        dispatch!(E::WIDEST_SEARCH, self.level, simd => self.test_pending::<E::Pack<_>>(simd));
        self.waiting = 0;
    }

    #[inline(always)]
    fn test_pending<L: Pack<Element = E>>(&mut self, token: L::Token) {
        let lanes = LinkLanes::<L>::new(token, self.searched);
        let (limit, error) = (L::splat(token, self.limit), L::splat(token, self.searched.error));
        let certain = CERTAIN_GAP * self.searched.error.into();
        let (mut lower, mut upper) = ([E::default(); BLOCK], [E::default(); BLOCK]);
        for first in (0..self.waiting).step_by(L::LANES) {
            self.computed += L::LANES as u64;
            let vertices = load_vertices::<L>(token, &self.rows, first);
            let (bounds, features) = lanes.nearer_and_features(vertices, limit, error);
            bounds.lower.store(&mut lower);
            bounds.upper.store(&mut upper);
            // The lanes behind the pending triangles hold stale values.
            let mut within = bounds.nearer & ((1 << (self.waiting - first).min(L::LANES)) - 1);
            while within != 0 {
                let lane = within.trailing_zeros() as usize;
                within &= within - 1;
                let (lower, upper): (f64, f64) = (lower[lane].into(), upper[lane].into());
                let is_apart = self.searched.radius.into() + certain < lower;
                let pending = first + lane;
                self.found.triangles.push(TriangleCandidate {
                    triangle: self.triangles[pending],
                    lower: lower - certain,
                    upper,
                    away: if is_apart {
                        three_bits(features.away, lane, self.firsts[pending])
                    } else {
                        0
                    },
                    beyond: three_bits(features.beyond, lane, self.firsts[pending]),
                });
            }
        }
    }
}

/// Returns a lane's bits for the corners or edges of a triangle, in the triangle's own order. The
/// lane has them from the corner `first` on.
#[inline(always)]
fn three_bits(lanes: [u64; 3], lane: usize, first: usize) -> u8 {
    let [a, b, c] = lanes.map(|lanes| (lanes >> lane & 1) as u8);
    let bits = a | b << 1 | c << 2;
    (bits << first | bits >> (3 - first)) & 7
}

/// The opposite corners beyond the edges of a leaf's triangles.
#[derive(Clone)]
pub(crate) struct LeafCorners<E> {
    /// Rows in the layout of the triangles' own corners; NaN if an edge has no second triangle.
    pub rows: [E; 9 * BLOCK],
    /// The corner that each triangle has first in its leaf, two bits per triangle.
    firsts: u32,
}

/// The opposite corners of all triangles. Each leaf is filled on first use.
#[derive(Clone)]
pub(crate) struct OppositeCorners<E>(Vec<Lazy<LeafCorners<E>>>);

impl<E: Lane> OppositeCorners<E> {
    pub(crate) fn new(tree: &WideBvh<E>) -> Self {
        Self(tree.leaves.iter().map(|_| Lazy::new()).collect())
    }

    /// Empties all leaves, after the vertices moved.
    pub(crate) fn forget(&mut self) {
        self.0.iter_mut().for_each(|leaf| *leaf = Lazy::new());
    }

    /// Fills all leaves.
    pub(crate) fn prepare(&self, tree: &WideBvh<E>, mesh: &Mesh) {
        for leaf in 0..self.0.len() as u32 {
            self.of(leaf, tree, mesh);
        }
    }

    /// Returns the opposite corners of a leaf, in the frame of the search.
    pub(crate) fn of(&self, leaf: u32, tree: &WideBvh<E>, mesh: &Mesh) -> &LeafCorners<E> {
        self.0[leaf as usize].get_or_build(|| {
            let mut corners = LeafCorners { rows: [E::round(f64::NAN); 9 * BLOCK], firsts: 0 };
            for (lane, &triangle) in tree.leaves[leaf as usize].triangles.iter().enumerate() {
                let first = first_of_face::<E>(&tree.frame, mesh, triangle);
                let across = rotated(mesh.corners_across(triangle), first);
                place_points(&tree.frame, across, &mut corners.rows, lane);
                corners.firsts |= (first as u32) << (2 * lane);
            }
            corners
        })
    }
}

impl<E> LeafCorners<E> {
    /// Returns the corner that the triangle in a lane has first.
    #[inline(always)]
    pub(crate) fn first(&self, lane: usize) -> usize {
        (self.firsts >> (2 * lane) & 3) as usize
    }
}
