//! The triangles that may be within a margin of a link, with the bounds of the search, before they
//! are measured.

use crate::mesh::{BLOCK, Mesh, PART_WITHOUT, PARTS};
use crate::search::hierarchy::WideBvh;
use parry3d_f64::math::Real;

/// The triangles that may be within a margin of the links of a robot, link by link.
#[derive(Clone, Default)]
pub(crate) struct TriangleCandidates {
    /// The triangles that may hold a local minimum.
    pub triangles: Vec<TriangleCandidate>,
    /// The triangles that certainly lie on a slope, leaf by leaf.
    culled: Vec<CulledLeaf>,
}

/// The end of the triangles of one link.
#[derive(Clone, Copy, Default)]
pub(crate) struct CandidateEnd {
    pub triangles: usize,
    culled: usize,
}

/// The triangles that may be within a margin of one link.
#[derive(Clone, Copy)]
pub(crate) struct LinkCandidates<'a> {
    pub triangles: &'a [TriangleCandidate],
    culled: &'a [CulledLeaf],
}

/// A triangle that may be within a margin of a link.
#[derive(Clone, Copy)]
pub(crate) struct TriangleCandidate {
    pub triangle: u32,
    /// A lower bound. A triangle whose `upper` is below it is certainly nearer, by more than the
    /// rounding of both distances.
    pub lower: Real,
    pub upper: Real,
    /// One bit for each corner that certainly has no share in the nearest point.
    pub away: u8,
    /// One bit for each edge that is certainly farther than the nearest point, by more than the
    /// rounding of both distances. The lowest bit is the edge from the first corner to the second.
    pub beyond: u8,
}

/// The triangles of a leaf that lie on a slope.
#[derive(Clone, Copy)]
struct CulledLeaf {
    leaf: u32,
    /// One bit per triangle.
    lanes: u64,
}

/// The index of each candidate of one link. Indices of other links stay in it. They are harmless,
/// because the triangle at the index is compared.
#[derive(Clone, Default)]
pub(crate) struct CandidateIndex {
    /// For each triangle of the mesh its index among the candidates.
    of_triangle: Vec<u32>,
    /// For each leaf of the search its index among the culled leaves.
    of_leaf: Vec<u32>,
}

impl TriangleCandidates {
    pub(crate) fn clear(&mut self) {
        self.triangles.clear();
        self.culled.clear();
    }

    /// Adds triangles without bounds.
    pub(crate) fn add_unclassified(&mut self, triangles: impl Iterator<Item = u32>) {
        self.triangles.extend(triangles.map(TriangleCandidate::unclassified));
    }

    /// Adds the triangles of a leaf that certainly lie on a slope, one bit per triangle.
    pub(crate) fn add_culled(&mut self, leaf: u32, lanes: u64) {
        if lanes != 0 {
            self.culled.push(CulledLeaf { leaf, lanes });
        }
    }

    /// Returns the current end, where the triangles of the next link begin.
    pub(crate) fn end(&self) -> CandidateEnd {
        CandidateEnd { triangles: self.triangles.len(), culled: self.culled.len() }
    }

    /// Returns the triangles of one link.
    pub(crate) fn between(&self, [from, to]: [CandidateEnd; 2]) -> LinkCandidates<'_> {
        LinkCandidates {
            triangles: &self.triangles[from.triangles..to.triangles],
            culled: &self.culled[from.culled..to.culled],
        }
    }
}

/// The candidates near one link, and where each triangle of the wall is among them.
#[derive(Clone, Copy)]
pub(crate) struct NearLink<'a> {
    pub wall: Wall<'a>,
    pub candidates: LinkCandidates<'a>,
    pub index: &'a CandidateIndex,
}

impl NearLink<'_> {
    /// Returns the index of a triangle among the candidates, if it is one.
    #[inline(always)]
    pub(crate) fn index_of(&self, triangle: u32) -> Option<usize> {
        let index = self.index.of_triangle[triangle as usize] as usize;
        let known = self.candidates.triangles.get(index);
        known.filter(|known| known.triangle == triangle).map(|_| index)
    }

    /// Returns true if the search has culled a triangle, because it certainly lies on a slope.
    #[inline(always)]
    pub(crate) fn is_culled(&self, triangle: u32) -> bool {
        let Some(&position) = self.wall.place_of().get(triangle as usize) else { return false };
        let (leaf, lane) = (position / BLOCK as u32, position as usize % BLOCK);
        let index = self.index.of_leaf.get(leaf as usize);
        let culled = index.and_then(|&index| self.candidates.culled.get(index as usize));
        culled.is_some_and(|culled| culled.leaf == leaf && culled.lanes >> lane & 1 == 1)
    }
}

impl CandidateIndex {
    /// Indexes the triangles of a link, in a mesh of `triangles` triangles.
    pub(crate) fn number(&mut self, candidates: LinkCandidates, triangles: usize) {
        self.of_triangle.resize(triangles, 0);
        for (index, known) in (0..).zip(candidates.triangles) {
            self.of_triangle[known.triangle as usize] = index;
        }
        for (index, culled) in (0..).zip(candidates.culled) {
            let leaf = culled.leaf as usize;
            if leaf >= self.of_leaf.len() {
                // Every leaf has a triangle.
                self.of_leaf.resize(triangles, 0);
            }
            self.of_leaf[leaf] = index;
        }
    }
}

impl TriangleCandidate {
    /// A triangle without bounds.
    fn unclassified(triangle: u32) -> Self {
        let everywhere = Real::INFINITY;
        Self { triangle, lower: -everywhere, upper: everywhere, away: 0, beyond: 0 }
    }

    /// Returns the corner or edge on which the nearest point certainly lies, if one is known.
    pub(crate) fn nearest_feature(&self) -> Option<usize> {
        PART_WITHOUT[self.away as usize].map(usize::from)
    }

    /// Returns the corners and edges that may hold the nearest point, one bit for each: all that are
    /// not certainly farther. A corner is farther if one of its edges is.
    pub(crate) fn near_parts(&self) -> u64 {
        let edges = u64::from(self.beyond);
        let corners = (edges | edges << 1 | edges >> 2) & 0b111;
        ALL_PARTS & !(corners | edges << 3)
    }
}

/// All corners and edges of a triangle, one bit for each.
pub(crate) const ALL_PARTS: u64 = (1 << PARTS) - 1;

/// The mesh, and its hierarchy if the search culls triangles on slopes.
#[derive(Clone, Copy)]
pub(crate) struct Wall<'a> {
    pub mesh: &'a Mesh,
    /// The hierarchy of a search that culls triangles on slopes.
    pub tree: Option<&'a WideBvh<f32>>,
}

impl<'a> Wall<'a> {
    /// A wall without such a search.
    #[cfg(feature = "exhaustive")]
    pub(crate) fn of(mesh: &'a Mesh) -> Self {
        Self { mesh, tree: None }
    }

    /// Returns the position of each triangle among the lanes of all leaves of the search; empty
    /// without such a search.
    #[inline(always)]
    pub(super) fn place_of(&self) -> &'a [u32] {
        self.tree.map_or(&[], |tree| &tree.place_of)
    }
}
