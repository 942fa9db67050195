//! The nearest triangle of every link.
//!
//! Each search starts at two triangles: the link's own answer of the last query, and the answer of
//! the link before it. Links with few candidates are measured together at the end, several links in
//! a pack ([`CandidateBatch`]). A link with many candidates fills packs of its own and is answered
//! at once.

use crate::answer::LinkProximity;
use crate::mesh::Mesh;
use crate::pair::{Best, PlacedLink, PlacedRobot, measure_each};
use crate::search::hierarchy::MeshSearch;
use fearless_simd::Level;
use parry3d_f64::math::Real;

/// State that warm-starts the next query.
#[derive(Clone, Default)]
pub(crate) struct PerLinkMemory {
    /// The nearest triangle of each link at the last query.
    last: Vec<u32>,
    batch: CandidateBatch,
}

impl PerLinkMemory {
    pub(crate) fn forget(&mut self) {
        self.last.clear();
    }
}

/// Writes the nearest triangle of every link of a robot to `out`, in the order of the links.
pub(crate) fn per_link(
    mut search: MeshSearch,
    robot: PlacedRobot,
    memory: &mut PerLinkMemory,
    out: &mut Vec<LinkProximity>,
) {
    let PerLinkMemory { last, batch } = memory;
    out.clear();
    batch.clear();
    let mut before = None;
    for number in 0..robot.links().len() {
        let link = robot.link(number);
        let start = [last.get(number).copied(), before];
        let answer =
            batch.add(number, &link, |found| search.nearest_or_candidates(&link, start, found));
        before = Some(match answer {
            Ok(best) => {
                let nearest = best.nearest().unwrap_or_else(|| search.any(&link));
                out.push(link.answer(number, &nearest));
                nearest.triangle
            }
            Err(first_candidate) => {
                out.push(LinkProximity::placeholder());
                first_candidate
            }
        });
    }
    let MeshSearch { level, hierarchy, scratch, .. } = search;
    scratch.work.measured += batch.answer(level, &hierarchy.mesh, out);
    last.clear();
    last.extend(out.iter().map(|answer| answer.witness.triangle));
}

/// The links, their candidates and results; reused by later queries.
#[derive(Clone, Default)]
struct CandidateBatch {
    /// The links, with their numbers.
    links: Vec<(usize, PlacedLink)>,
    /// The best result of each link.
    nearest: Vec<Best>,
    /// The candidate triangles, link by link.
    triangles: Vec<u32>,
    /// For each candidate the index of its link in `links`.
    owners: Vec<usize>,
}

impl CandidateBatch {
    pub(crate) fn clear(&mut self) {
        self.links.clear();
        self.nearest.clear();
        self.triangles.clear();
        self.owners.clear();
    }

    /// Runs `search` for a link. Returns its answer, or the first of the candidates that it adds;
    /// the link is then answered by `answer`.
    pub(crate) fn add(
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

    /// Measures all candidates and writes the answers of their links to `out`. Returns the number
    /// of candidates measured.
    pub(crate) fn answer(&mut self, level: Level, mesh: &Mesh, out: &mut [LinkProximity]) -> u64 {
        let Self { links, nearest, triangles, owners } = self;
        let pairs =
            owners.iter().zip(&*triangles).map(|(&owner, &triangle)| (&links[owner].1, triangle));
        let mut owners = owners.iter();
        let mut count = 0;
        measure_each(level, mesh, pairs, |measured| {
            if let Some(&owner) = owners.next() {
                nearest[owner].take(measured.nearest);
            }
            count += 1;
        });
        for ((number, link), best) in links.iter().zip(nearest) {
            if let Some(nearest) = best.nearest() {
                out[*number] = link.answer(*number, &nearest);
            }
        }
        count
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::distance::lanes::tests::levels;
    use crate::robot::{Cap, ModifiedCylinder};
    use continuum_testing::Random;
    use parry3d_f64::math::Pose;

    /// A shared pack gives each link the same bits as its triangles measured alone, on each
    /// instruction set.
    #[test]
    fn links_that_share_a_pack_are_answered_as_if_alone() {
        let bits = |answer: &LinkProximity| {
            let points = [answer.witness.on_robot, answer.witness.on_mesh]
                .map(|point| point.to_array().map(f64::to_bits));
            (answer.link, answer.witness.triangle, answer.distance.to_bits(), points)
        };
        let (mut touching, mut ties, mut found_at_once, mut compared) = (0, 0, 0, 0);
        for seed in 0..400 {
            let random = &mut Random::new(seed);
            let corners: Vec<_> = (0..60).map(|_| (random.point() * 4.0).round() / 4.0).collect();
            // Each triangle is in the mesh twice.
            let triangles = (0..40).map(|k| [k % 20 * 3, k % 20 * 3 + 1, k % 20 * 3 + 2]).collect();
            let mesh = Mesh::of(corners, triangles);
            let mut links = Vec::new();
            while links.len() < 20 {
                let size = 2.0_f64.powi(random.below(21) as i32 - 18);
                let (start, radius) = (random.point(), size * random.between(0.0, 2.0));
                let caps = [0; 2].map(|_| [Cap::Flat, Cap::Round][random.below(2) as usize]);
                let link =
                    ModifiedCylinder::new(start, start + random.point() * size, radius, caps)
                        .unwrap();
                let few: Vec<_> = (0..1 + random.below(5)).map(|_| random.below(40)).collect();
                links.push((PlacedLink::new(&link, &Pose::IDENTITY), few, random.below(5) == 0));
            }
            let alone = |(link, few, _): &(PlacedLink, Vec<u32>, bool)| {
                let mut best = Best::within(Real::INFINITY);
                few.iter().for_each(|&triangle| {
                    best.take(link.measure(triangle, mesh.corners(triangle)));
                });
                best
            };
            let expected: Vec<_> = links.iter().map(alone).collect();
            for level in levels() {
                let (mut few_each, mut out) = (CandidateBatch::default(), Vec::new());
                for (number, (link, few, is_found_at_once)) in links.iter().enumerate() {
                    let answer = few_each.add(number, link, |triangles| {
                        if *is_found_at_once {
                            return Some(expected[number]);
                        }
                        triangles.extend(few);
                        None
                    });
                    out.push(match answer {
                        Ok(best) => link.answer(number, &best.nearest().unwrap()),
                        Err(first) => {
                            assert_eq!(first, few[0]);
                            LinkProximity::placeholder()
                        }
                    });
                    found_at_once += u32::from(answer.is_ok());
                }
                let measured = few_each.answer(level, &mesh, &mut out);
                let in_question = links.iter().filter(|link| !link.2).map(|link| link.1.len());
                assert_eq!(measured, in_question.sum::<usize>() as u64);
                for (number, (answer, best)) in out.iter().zip(&expected).enumerate() {
                    let expected = links[number].0.answer(number, &best.nearest().unwrap());
                    assert_eq!(bits(answer), bits(&expected), "{level:?}, seed {seed}");
                    touching += u32::from(answer.distance <= 0.0);
                    let as_near = |triangle: &&u32| **triangle == answer.witness.triangle + 20;
                    ties += links[number].1.iter().filter(as_near).count();
                    compared += 1;
                }
            }
        }
        assert!(
            touching > 1000 && ties > 500 && found_at_once > 1000 && compared > 8000,
            "{touching} {ties}"
        );
    }
}
