//! Gathers every triangle within a margin of a link, with bounds and features.
//!
//! Triangles of a leaf that are excluded by a plane or culled on a slope are left out. The others
//! are collected until they fill a block, and are then tested together.

use super::feature_cull::CERTAIN;
use super::opposite_corners::OppositeCorners;
use super::triangle_candidates::{TriangleCandidate, TriangleCandidates};
use crate::distance::dispatch;
use crate::distance::lanes::{Lane, Pack};
use crate::mesh::{BLOCK, Mesh, first_of_face, load_vertices};
use crate::pair::{LinkLanes, SearchLink};
use crate::search::hierarchy::{LeafVisitor, Traversal, WideBvh};
use fearless_simd::Level;
use parry3d_f64::math::Real;

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
    dispatch!(traversal.level, simd => {
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
        let (mut in_question, mut slopes) = (0, 0);
        let (limit_of_all, error) =
            (L::splat(token, self.limit), L::splat(token, self.searched.error));
        for lane in (0..BLOCK).step_by(L::LANES) {
            let vertices = load_vertices::<L>(token, &leaf.rows, lane);
            let near = lanes.not_behind_plane(vertices, limit_of_all);
            in_question |= near << lane;
            if near != 0
                && let Some(across) = across
            {
                let across = load_vertices::<L>(token, &across.rows, lane);
                slopes |= (near & lanes.descends(vertices, across, error)) << lane;
            }
        }
        self.found.add_culled(number, slopes);
        in_question &= !slopes;
        while in_question != 0 {
            let lane = in_question.trailing_zeros() as usize;
            in_question &= in_question - 1;
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
        dispatch!(self.level, simd => self.take::<E::Pack<_>>(simd));
        self.waiting = 0;
    }

    #[inline(always)]
    fn take<L: Pack<Element = E>>(&mut self, token: L::Token) {
        let lanes = LinkLanes::<L>::new(token, self.searched);
        let (limit, error) = (L::splat(token, self.limit), L::splat(token, self.searched.error));
        let certain = CERTAIN * self.searched.error.into();
        let (mut lower, mut upper) = ([E::default(); BLOCK], [E::default(); BLOCK]);
        for first in (0..self.waiting).step_by(L::LANES) {
            self.computed += L::LANES as u64;
            let vertices = load_vertices::<L>(token, &self.rows, first);
            let (bounds, feet) = lanes.nearer_and_features(vertices, limit, error);
            bounds.lower.store(&mut lower);
            bounds.upper.store(&mut upper);
            // The lanes behind the pending triangles hold stale values.
            let mut near = bounds.nearer & ((1 << (self.waiting - first).min(L::LANES)) - 1);
            while near != 0 {
                let lane = near.trailing_zeros() as usize;
                near &= near - 1;
                let (lower, upper): (f64, f64) = (lower[lane].into(), upper[lane].into());
                let is_apart = self.searched.radius.into() + certain < lower;
                let place = first + lane;
                self.found.in_question.push(TriangleCandidate {
                    triangle: self.triangles[place],
                    lower: lower - certain,
                    upper,
                    away: if is_apart {
                        three_bits(feet.away, lane, self.firsts[place])
                    } else {
                        0
                    },
                    beyond: three_bits(feet.beyond, lane, self.firsts[place]),
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
