//! Several pairs of links in double precision, one pack at a time, with the bits of
//! [`PlacedLink::measure_link`](super::PlacedLink::measure_link) on every instruction set.

use super::links_of_robots::capsules_apart;
use super::pair_lanes::{BATCH, Rows, link, put_link, store};
use super::placed_link::PlacedLink;
use super::two_links::NearestOfLinks;
use crate::distance::lanes::{Pack, set_bits};
use crate::distance::{Unfused, dispatch};
use fearless_simd::Level;
use parry3d_f64::math::{Real, Vector};

/// A link in the common frame of both robots: the ends of its axis, its radius, and which caps are
/// flat.
pub(crate) type PlacedEnds = ([Vector; 2], Real, [bool; 2]);

/// Pairs of links in one frame, and their closest points.
///
/// All pairs are stored before the first is measured. A pack is written number by number and read
/// as a whole, and a processor stalls if it reads numbers together that it has just written one by
/// one.
#[derive(Clone, Debug, Default)]
pub(crate) struct LinkPairBatch {
    packs: Vec<PackOfPairs>,
    count: usize,
}

/// Up to [`BATCH`] pairs.
#[derive(Clone, Copy, Debug)]
struct PackOfPairs {
    /// The first and the second link of each pair.
    pairs: Rows<18>,
    /// The distances, and the points on the first and the second link.
    found: Rows<7>,
    /// Which pairs are within the bound, one bit for each.
    near: u64,
}

impl PackOfPairs {
    const EMPTY: Self = Self { pairs: [[0.0; BATCH]; 18], found: [[0.0; BATCH]; 7], near: 0 };
}

impl LinkPairBatch {
    pub(crate) fn clear(&mut self) {
        self.count = 0;
    }

    #[inline(always)]
    pub(crate) fn push(&mut self, first: &PlacedEnds, second: &PlacedEnds) {
        let (pack, lane) = (self.count / BATCH, self.count % BATCH);
        if pack == self.packs.len() {
            self.packs.push(PackOfPairs::EMPTY);
        }
        put_link(&mut self.packs[pack].pairs, 0, lane, first.0, first.1, first.2);
        put_link(&mut self.packs[pack].pairs, 9, lane, second.0, second.1, second.2);
        self.count += 1;
    }

    /// Measures all pairs. Pairs farther apart than `bound` have no result.
    #[inline(never)] // compiled for each instruction set, not for each use as well
    pub(crate) fn measure(&mut self, level: Level, bound: Real) {
        if self.count == 1 {
            // A pack takes the same time for one pair as for all, and longer than a single pair.
            self.packs[0].measure_first(bound);
            return;
        }
        dispatch!(level, simd => self.measure_packs::<Unfused<_>>(simd, bound));
    }

    #[inline(always)]
    fn measure_packs<L: Pack<Element = f64>>(&mut self, token: L::Token, bound: Real) {
        let bound = L::splat(token, bound);
        let mut left = self.count;
        for pack in self.packs.iter_mut().take(self.count.div_ceil(BATCH)) {
            pack.near = 0;
            for lane in (0..left.min(BATCH)).step_by(L::LANES) {
                // Unused lanes hold earlier pairs; they take no extra time, and the mask drops
                // them.
                let are_there = u64::MAX >> (64 - (left - lane).min(L::LANES));
                pack.near |= pack.measure(token, lane, are_there, bound) << lane;
            }
            left = left.saturating_sub(BATCH);
        }
    }

    /// Returns the pairs within the bound, in order, and their distances.
    pub(crate) fn near(&self) -> impl Iterator<Item = (usize, Real)> {
        let packs = self.packs[..self.count.div_ceil(BATCH)].iter().enumerate();
        packs.flat_map(|(number, pack)| {
            set_bits(pack.near).map(move |lane| (number * BATCH + lane, pack.found[0][lane]))
        })
    }

    /// Returns the closest points of a pair; if its links meet, one common point.
    pub(crate) fn nearest(&self, pair: usize) -> NearestOfLinks {
        let (found, lane) = (&self.packs[pair / BATCH].found, pair % BATCH);
        let distance = found[0][lane];
        let on_first = Vector::new(found[1][lane], found[2][lane], found[3][lane]);
        let on_second = Vector::new(found[4][lane], found[5][lane], found[6][lane]);
        NearestOfLinks {
            distance,
            on_first,
            on_second: if distance > 0.0 { on_second } else { on_first },
        }
    }
}

impl PackOfPairs {
    /// Measures the first pair alone.
    fn measure_first(&mut self, bound: Real) {
        let [first, second] = [0, 9].map(|row| {
            let number = |place: usize| self.pairs[row + place][0];
            let [start, end] =
                [0, 3].map(|end| Vector::new(number(end), number(end + 1), number(end + 2)));
            PlacedLink::between(start, end, number(6), [number(7) > 0.0, number(8) > 0.0])
        });
        self.near = 0;
        if let Some(NearestOfLinks { distance, on_first, on_second }) =
            first.measure_link_within(bound, &second)
        {
            let numbers = [
                distance,
                on_first.x,
                on_first.y,
                on_first.z,
                on_second.x,
                on_second.y,
                on_second.z,
            ];
            for (row, number) in self.found.iter_mut().zip(numbers) {
                row[0] = number;
            }
            self.near = 1;
        }
    }

    /// Measures the pairs from `lane` on. Returns which of the pairs in `are_there` are within the
    /// bound.
    #[inline(always)]
    fn measure<L: Pack<Element = f64>>(
        &mut self,
        token: L::Token,
        lane: usize,
        are_there: u64,
        bound: L,
    ) -> u64 {
        let mut first = link::<L>(token, &self.pairs, 0, lane);
        let mut second = link::<L>(token, &self.pairs, 9, lane);
        // Round caps do not need the directions of the axes.
        if L::bits(first.flat[0] | first.flat[1] | second.flat[0] | second.flat[1]) != 0 {
            (first, second) = (first.with_axis(), second.with_axis());
        }
        let (pair, unit) = first.with_link(&second);
        let axes = pair.axes();
        let near = !bound.lt(capsules_apart(&pair, axes.gap.norm()) * unit);
        if L::bits(near) & are_there == 0 {
            return 0;
        }
        let closest = pair.closest(
            &axes,
            #[inline(always)]
            |mask| L::bits(mask & near) & are_there != 0,
        );
        let distance = closest.distance * unit;
        distance.store(&mut self.found[0][lane..]);
        store(&mut self.found, 1, lane, first.start + closest.point1 * unit);
        store(&mut self.found, 4, lane, first.start + closest.point2 * unit);
        L::bits(near & distance.le(bound)) & are_there
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::distance::lanes::tests::levels;
    use continuum_testing::Random;

    fn bits(nearest: &NearestOfLinks) -> [u64; 7] {
        let [a, b] = [nearest.on_first, nearest.on_second];
        [nearest.distance, a.x, a.y, a.z, b.x, b.y, b.z].map(f64::to_bits)
    }

    /// Returns a random link, every second time on a coarse lattice, where ties, parallels and
    /// touching links are common; sometimes a ball.
    fn link(random: &mut Random, size: f64) -> PlacedEnds {
        let step = if random.below(2) == 0 { 0.5 } else { 0.0 };
        let mut point = |most: f64| {
            let point = random.point() * most;
            (if step > 0.0 { (point / step).round() * step } else { point }) * size
        };
        let (start, way) = (point(2.0), point(1.0));
        let radius = size * [0.0, 0.01, 0.3, 2.0][random.below(4) as usize];
        let flat = [random.below(3) == 0, random.below(3) == 0];
        ([start, start + way], radius, if way == Vector::ZERO { [false; 2] } else { flat })
    }

    #[test]
    fn together_is_alone_bit_for_bit() {
        let mut random = Random::new(5);
        let (mut touching, mut flat, mut beyond) = (0, 0, 0);
        for round in 0..4000 {
            // Every seventh round uses numbers near the smallest.
            let size = 2.0_f64.powi(if round % 7 == 0 { -1060 } else { round % 61 - 30 });
            let pairs: Vec<_> = (0..1 + random.below(20))
                .map(|_| [link(&mut random, size), link(&mut random, size)])
                .collect();
            let alone = |[first, second]: &[PlacedEnds; 2]| {
                let [first, second] = [first, second].map(|(ends, radius, flat)| {
                    PlacedLink::between(ends[0], ends[1], *radius, *flat)
                });
                first.measure_link(&second)
            };
            let alone: Vec<_> = pairs.iter().map(alone).collect();
            // Every second round the bound is the distance of a pair, which is within it.
            let bound = if round % 2 == 0 { f64::INFINITY } else { alone[0].distance };
            for level in levels() {
                let mut together = LinkPairBatch::default();
                // Results of earlier pairs must not count.
                pairs.iter().rev().for_each(|[first, second]| together.push(first, second));
                together.measure(level, f64::INFINITY);
                together.clear();
                pairs.iter().for_each(|[first, second]| together.push(first, second));
                together.measure(level, bound);
                let found: Vec<_> = together.near().collect();
                let expected = alone.iter().map(|nearest| nearest.distance).enumerate();
                let expected: Vec<_> =
                    expected.filter(|(_, distance)| *distance <= bound).collect();
                assert_eq!(found, expected, "{level:?}, round {round}");
                for (pair, _) in found {
                    assert_eq!(
                        bits(&together.nearest(pair)),
                        bits(&alone[pair]),
                        "{level:?}, round {round}"
                    );
                }
                beyond += pairs.len() - expected.len();
            }
            touching += alone.iter().filter(|nearest| nearest.distance == 0.0).count();
            flat +=
                pairs.iter().filter(|pair| pair.iter().any(|link| link.2 != [false; 2])).count();
        }
        assert!(touching > 5000 && flat > 10_000 && beyond > 10_000, "{touching} {flat} {beyond}");
    }
}
