//! What a search knows of the triangles that may be within a margin of a link, before they are
//! measured.

use crate::mesh::{BLOCK, PART_WITHOUT};
use parry3d_f64::math::Real;

/// The triangles that may be within a margin of the links of a robot, link by link.
#[derive(Clone, Default)]
pub(crate) struct TriangleCandidates {
    /// Those that may hold a local minimum.
    pub in_question: Vec<TriangleCandidate>,
    /// Those that certainly lie on a slope.
    slopes: Vec<CulledLeaf>,
}

/// Where the triangles of one link end.
#[derive(Clone, Copy, Default)]
pub(crate) struct CandidateEnd {
    pub in_question: usize,
    slopes: usize,
}

/// The triangles that may be within a margin of one link.
#[derive(Clone, Copy)]
pub(crate) struct LinkCandidates<'a> {
    pub in_question: &'a [TriangleCandidate],
    slopes: &'a [CulledLeaf],
}

/// A triangle that may be within a margin of a link.
#[derive(Clone, Copy)]
pub(crate) struct TriangleCandidate {
    pub triangle: u32,
    /// Another triangle whose `upper` is below this is certainly nearer, by more than the rounding
    /// of both distances.
    pub lower: Real,
    pub upper: Real,
    /// One bit for each corner that certainly has no share in the nearest point.
    pub away: u8,
    /// One bit for each edge, from the one between the first corners on, that is certainly farther
    /// than the nearest point, by more than the rounding of both distances.
    pub beyond: u8,
}

/// Those of a leaf that lie on a slope.
#[derive(Clone, Copy)]
struct CulledLeaf {
    leaf: u32,
    /// One bit for each that does.
    lanes: u64,
}

/// Where the triangles of one link stand. What is written there of other links does no harm: it is
/// compared with what stands at the place.
#[derive(Clone, Default)]
pub(crate) struct CandidateIndex {
    /// For each triangle of the mesh where it stands among those in question.
    of_triangle: Vec<u32>,
    /// For each leaf of the search where it stands among the slopes.
    of_leaf: Vec<u32>,
}

impl TriangleCandidates {
    pub(crate) fn clear(&mut self) {
        self.in_question.clear();
        self.slopes.clear();
    }

    /// Adds triangles of which nothing is known.
    pub(crate) fn add_unclassified(&mut self, triangles: impl Iterator<Item = u32>) {
        self.in_question.extend(triangles.map(TriangleCandidate::unclassified));
    }

    /// Adds those of a leaf that certainly lie on a slope, one bit for each.
    pub(crate) fn add_culled(&mut self, leaf: u32, lanes: u64) {
        if lanes != 0 {
            self.slopes.push(CulledLeaf { leaf, lanes });
        }
    }

    /// Where those of the next link will stand.
    pub(crate) fn end(&self) -> CandidateEnd {
        CandidateEnd { in_question: self.in_question.len(), slopes: self.slopes.len() }
    }

    /// Those of one link.
    pub(crate) fn between(&self, [from, to]: [CandidateEnd; 2]) -> LinkCandidates<'_> {
        LinkCandidates {
            in_question: &self.in_question[from.in_question..to.in_question],
            slopes: &self.slopes[from.slopes..to.slopes],
        }
    }
}

impl LinkCandidates<'_> {
    /// Where a triangle stands among those in question, if it does.
    #[inline(always)]
    pub(crate) fn index(&self, index: &CandidateIndex, triangle: u32) -> Option<usize> {
        let index = index.of_triangle[triangle as usize] as usize;
        self.in_question.get(index).filter(|known| known.triangle == triangle).map(|_| index)
    }

    /// Whether a triangle certainly lies on a slope. `place_of` says where each triangle of the
    /// mesh stands in the leaves of the search; where there are none, nothing does.
    #[inline(always)]
    pub(crate) fn is_culled(
        &self,
        index: &CandidateIndex,
        place_of: &[u32],
        triangle: u32,
    ) -> bool {
        let Some(&place) = place_of.get(triangle as usize) else { return false };
        let (leaf, lane) = (place / BLOCK as u32, place as usize % BLOCK);
        let at = index.of_leaf.get(leaf as usize);
        let slopes = at.and_then(|&at| self.slopes.get(at as usize));
        slopes.is_some_and(|slopes| slopes.leaf == leaf && slopes.lanes >> lane & 1 == 1)
    }
}

impl CandidateIndex {
    /// Writes down where the triangles of a link stand, in a mesh of so many.
    pub(crate) fn number(&mut self, near: LinkCandidates, triangles: usize) {
        self.of_triangle.resize(triangles, 0);
        for (index, known) in (0..).zip(near.in_question) {
            self.of_triangle[known.triangle as usize] = index;
        }
        for (index, slopes) in (0..).zip(near.slopes) {
            let leaf = slopes.leaf as usize;
            if leaf >= self.of_leaf.len() {
                // No leaf has no triangle.
                self.of_leaf.resize(triangles, 0);
            }
            self.of_leaf[leaf] = index;
        }
    }
}

impl TriangleCandidate {
    /// A triangle of which nothing is known.
    fn unclassified(triangle: u32) -> Self {
        let everywhere = Real::INFINITY;
        Self { triangle, lower: -everywhere, upper: everywhere, away: 0, beyond: 0 }
    }

    /// The corner or edge on which the nearest point certainly lies, if there is one.
    pub(crate) fn nearest_feature(&self) -> Option<usize> {
        PART_WITHOUT[self.away as usize].map(usize::from)
    }

    /// Whether a corner or an edge is certainly farther than the nearest point. A corner is where
    /// one of its edges is.
    pub(crate) fn is_beyond(&self, part: usize) -> bool {
        let edge = |number: usize| self.beyond >> (number % 3) & 1 == 1;
        if part < 3 { edge(part) || edge(part + 2) } else { edge(part) }
    }
}
