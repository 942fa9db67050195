//! Links of which each has few triangles in question: these are measured together, several links in a pack.

use crate::proximity::LinkProximity;
use crate::proximity::mesh::Mesh;
use crate::proximity::placed::{Best, PlacedLink};
use crate::proximity::ranked::rank_each;
use fearless_simd::Level;
use parry3d_f64::math::Real;

/// Memory that is used again.
#[derive(Clone, Default)]
pub(super) struct FewEach {
    /// The links, with their numbers.
    links: Vec<(usize, PlacedLink)>,
    /// What was measured for each of them.
    nearest: Vec<Best>,
    /// The triangles in question, link by link.
    triangles: Vec<u32>,
    /// For each of them where its link stands.
    owners: Vec<usize>,
}

impl FewEach {
    pub(super) fn clear(&mut self) {
        self.links.clear();
        self.nearest.clear();
        self.triangles.clear();
        self.owners.clear();
    }

    /// What `search` finds for a link. Where it adds triangles in question instead, the first of these; they are measured
    /// later.
    pub(super) fn add(
        &mut self,
        number: usize,
        link: &PlacedLink,
        search: impl FnOnce(&mut Vec<u32>) -> Option<Best>,
    ) -> Result<Best, u32> {
        let first = self.triangles.len();
        search(&mut self.triangles).ok_or_else(|| {
            self.owners.resize(self.triangles.len(), self.links.len());
            self.links.push((number, *link));
            self.nearest.push(Best::within(Real::INFINITY));
            self.triangles[first]
        })
    }

    /// Measures all that are in question and writes the answers of their links. Returns how many were measured.
    pub(super) fn answer(&mut self, level: Level, mesh: &Mesh, out: &mut [LinkProximity]) -> u64 {
        let Self { links, nearest, triangles, owners } = self;
        let pairs = owners.iter().zip(&*triangles).map(|(&owner, &triangle)| (&links[owner].1, triangle));
        let mut place = 0;
        rank_each(level, mesh, pairs, |ranked| {
            nearest[owners[place]].take(ranked.nearest);
            place += 1;
        });
        for ((number, _), best) in links.iter().zip(nearest) {
            if let Some(nearest) = best.nearest() {
                out[*number] = nearest.report(*number);
            }
        }
        place as u64
    }
}
