//! The measurement of candidate triangles in double precision, one pack at a time, with the bits of
//! [`PlacedLink::measure`] on every instruction set.
//!
//! - [`Best::measure_batch`]: several triangles against one link. Keeps the closest.
//! - [`measure_each`]: triangles near a robot's links, each with the bound at which it becomes part
//!   of the wall within the bound.

use super::coordinates::{Nearest, Pair, Placed};
use super::pair_lanes;
use super::pair_lanes::{BATCH, PairLanes, PairRows, Rows, put_corners, put_pair, store};
use super::placed_link::PlacedLink;
use crate::distance::lanes::{Pack, set_bits};
use crate::distance::{Scalar, Unfused, dispatch};
use crate::mesh::Mesh;
use fearless_simd::Level;
use parry3d_f64::math::{Real, Vector};

/// Below this count triangles are measured one by one. From 2 on a half-filled pack is faster.
const MIN_FOR_PACK: usize = 2;

/// The vertices of up to [`BATCH`] triangles in the mesh's frame, each coordinate in its own row.
type CornerRows = Rows<9>;

impl Best {
    /// Measures up to [`BATCH`] triangles. Returns whether one of them becomes the best.
    #[inline(never)] // the same code wherever it is called from
    pub(crate) fn measure_batch(
        &mut self,
        level: Level,
        link: &PlacedLink,
        mesh: &Mesh,
        triangles: &[u32],
    ) -> bool {
        if triangles.len() < MIN_FOR_PACK {
            let measure =
                |is_best, &triangle| self.measure(link, triangle, mesh.corners(triangle)) | is_best;
            return triangles.iter().fold(false, measure);
        }
        let mut is_best = false;
        let mut answers = NearestRows::new();
        let near = measure_pack(level, link, mesh, triangles, self.bound(), &mut answers);
        for lane in set_bits(near) {
            // Most triangles within the bound tie with it, and most ties do not improve the
            // best: test before building the result.
            if self.is_improved_by(answers.distance(lane), triangles[lane]) {
                is_best |= self.take(answers.nearest(lane, triangles[lane]));
            }
        }
        is_best
    }
}

/// Measures up to [`BATCH`] triangles against a link. Returns those at most `bound` away, one bit
/// for each.
#[inline(always)]
fn measure_pack(
    level: Level,
    link: &PlacedLink,
    mesh: &Mesh,
    triangles: &[u32],
    bound: Real,
    answers: &mut NearestRows,
) -> u64 {
    let mut corners = [[0.0; BATCH]; 9];
    for (lane, &triangle) in triangles.iter().enumerate().take(BATCH) {
        put_corners(&mut corners, lane, mesh.corners(triangle));
    }
    closest_at(narrowed(level, triangles.len()), link, &corners, triangles.len(), bound, answers)
}

/// Returns the instruction set whose packs `count` pairs fill best: half a pack takes nearly half
/// the time.
fn narrowed(
    level: Level,
    #[cfg_attr(not(any(target_arch = "x86", target_arch = "x86_64")), expect(unused))] count: usize,
) -> Level {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    if 2 * count <= BATCH
        && let Some(avx2) = level.as_avx2()
    {
        return Level::Avx2(avx2);
    }
    level
}

#[inline(never)] // compiled for each instruction set, not for each use as well
fn closest_at(
    level: Level,
    link: &PlacedLink,
    corners: &CornerRows,
    count: usize,
    bound: Real,
    answers: &mut NearestRows,
) -> u64 {
    dispatch!(level, simd => closest::<Unfused<_>>(simd, link, corners, count, bound, answers))
}

/// [`PlacedLink::measure`] in lanes, step by step.
#[inline(always)]
fn closest<L: Pack<Element = f64>>(
    token: L::Token,
    link: &PlacedLink,
    corners: &CornerRows,
    count: usize,
    bound: Real,
    answers: &mut NearestRows,
) -> u64 {
    let (bound, link) = (L::splat(token, bound), Placed::<L>::splat(token, link));
    let mut near = 0;
    for lane in (0..count).step_by(L::LANES) {
        let corners = pair_lanes::corners::<L, 9>(token, corners, lane);
        let distance = answers.take(lane, &PairLanes::between(&link, corners));
        near |= L::bits(distance.le(bound)) << lane;
    }
    near & ((1 << count) - 1)
}

/// The closest triangle so far among those within a bound. Ties go to the lower triangle number.
#[derive(Clone, Copy)]
pub(crate) struct Best {
    bound: Real,
    nearest: Option<Nearest>,
    /// Among triangles at distance 0, only those with a lower number are candidates.
    below: u32,
}

impl Best {
    /// Returns an empty best with this bound.
    pub(crate) fn within(bound: Real) -> Self {
        Self { bound, nearest: None, below: u32::MAX }
    }

    /// Restricts triangles at distance 0 to those with a lower number than `below`.
    pub(crate) fn touching_below(self, below: u32) -> Self {
        Self { below, ..self }
    }

    /// Returns an earlier best, to be improved by triangles at most `bound` away.
    #[cfg(feature = "exhaustive")]
    pub(crate) fn resume(bound: Real, nearest: Option<Nearest>) -> Self {
        Self { bound, nearest, below: u32::MAX }
    }

    /// The upper bound: only triangles at most this far away are candidates.
    pub(crate) fn bound(&self) -> Real {
        self.bound
    }

    pub(crate) fn nearest(&self) -> Option<Nearest> {
        self.nearest
    }

    /// Returns a limit on the number of a triangle that can still improve the best: at distance 0
    /// only a lower number can.
    #[inline(always)]
    pub(crate) fn triangle_limit(&self) -> u32 {
        if self.bound <= 0.0 { self.below } else { u32::MAX }
    }

    /// Measures a triangle. Returns whether it is the best so far.
    #[inline(never)] // the same code whatever the instruction set
    pub(crate) fn measure(
        &mut self,
        link: &PlacedLink,
        triangle: u32,
        corners: [Vector; 3],
    ) -> bool {
        link.measure_within(self.bound, triangle, corners).is_some_and(|nearest| self.take(nearest))
    }

    /// Returns whether a triangle at this distance improves the best.
    #[inline(always)]
    fn is_improved_by(&self, distance: Real, triangle: u32) -> bool {
        distance <= self.bound
            && self.nearest.is_none_or(|mine| {
                distance < mine.distance || (distance <= mine.distance && triangle < mine.triangle)
            })
            && (distance > 0.0 || triangle < self.below)
    }

    /// Keeps a triangle if it improves the best. Returns whether it does.
    pub(crate) fn take(&mut self, other: Nearest) -> bool {
        let is_better = self.is_improved_by(other.distance, other.triangle);
        if is_better {
            let below = if other.distance > 0.0 { self.below } else { other.triangle };
            *self = Self { bound: other.distance, nearest: Some(other), below };
        }
        is_better
    }
}

/// The distances of several pairs and their closest points, on the triangle and on the link, in the
/// mesh's frame.
pub(super) struct NearestRows(Rows<7>);

impl NearestRows {
    pub(super) fn new() -> Self {
        Self([[0.0; BATCH]; 7])
    }

    /// Stores the results of a pack from `lane` on. Returns the distances.
    #[inline(always)]
    pub(super) fn take<L: Pack<Element = f64>>(&mut self, lane: usize, pack: &PairLanes<L>) -> L {
        let distance = pack.closest.distance * pack.pair.unit;
        distance.store(&mut self.0[0][lane..]);
        store(&mut self.0, 1, lane, pack.placed(pack.closest.point1));
        store(&mut self.0, 4, lane, pack.placed(pack.closest.point2));
        distance
    }

    pub(super) fn distance(&self, lane: usize) -> Real {
        self.0[0][lane]
    }

    /// Returns the result of the pair in a lane, whose triangle is `triangle`.
    pub(super) fn nearest(&self, lane: usize, triangle: u32) -> Nearest {
        let point = |row: usize| {
            Vector::new(self.0[row][lane], self.0[row + 1][lane], self.0[row + 2][lane])
        };
        Nearest::new(triangle, self.0[0][lane], point(1), || point(4))
    }
}

/// A triangle that was measured near a link.
#[derive(Clone, Copy)]
pub(crate) struct Measurement {
    /// The distance; if that is 0, the axis distance minus the radius, at most 0. In this order
    /// triangles appear when the bound grows.
    pub appears_at: Real,
    pub nearest: Nearest,
    /// The rounding error of the distance.
    pub rounding: Real,
}

/// The results of several pairs.
struct MeasurementRows {
    nearest: NearestRows,
    /// The axis distances minus the radii.
    to_axis: [Real; BATCH],
    extent: [Real; BATCH],
}

/// Measures triangles, each with its link, and passes each result to `take` in order.
pub(crate) fn measure_each<'a>(
    level: Level,
    mesh: &Mesh,
    mut pairs: impl Iterator<Item = (&'a PlacedLink, u32)>,
    mut take: impl FnMut(Measurement),
) {
    let (mut rows, mut triangles) = ([[0.0; BATCH]; 18], [0; BATCH]);
    loop {
        let mut count = 0;
        for (link, triangle) in pairs.by_ref().take(BATCH) {
            let ends = [link.start(), link.end()];
            put_pair(&mut rows, count, mesh.corners(triangle), ends, link.radius(), link.flat());
            triangles[count] = triangle;
            count += 1;
        }
        if count == 0 {
            return;
        }
        let found = measurements_at(level, &rows, count);
        for (lane, &triangle) in triangles.iter().enumerate().take(count) {
            take(measurement(&found, lane, triangle));
        }
    }
}

fn measurement(found: &MeasurementRows, lane: usize, triangle: u32) -> Measurement {
    let nearest = found.nearest.nearest(lane, triangle);
    let appears_at =
        if nearest.distance <= 0.0 { found.to_axis[lane].min(0.0) } else { nearest.distance };
    Measurement { appears_at, nearest, rounding: rounding(found.extent[lane]) }
}

/// Returns the rounding error of the distance between a link and a shape whose coordinates relative
/// to the link's start are at most `extent`.
pub(crate) fn rounding(extent: Real) -> Real {
    32.0 * f64::UNIT_ROUNDOFF * extent
}

#[inline(never)] // compiled for each instruction set, not for each use as well
fn measurements_at(level: Level, pairs: &PairRows, count: usize) -> MeasurementRows {
    let [to_axis, extent] = [[0.0; BATCH]; 2];
    let mut measured = MeasurementRows { nearest: NearestRows::new(), to_axis, extent };
    dispatch!(level, simd => fill::<Unfused<_>>(simd, pairs, count, &mut measured));
    measured
}

#[inline(always)]
fn fill<L: Pack<Element = f64>>(
    token: L::Token,
    pairs: &PairRows,
    count: usize,
    measured: &mut MeasurementRows,
) {
    for lane in (0..count).step_by(L::LANES) {
        let pair = PairLanes::<L>::new(token, pairs, lane);
        measured.nearest.take(lane, &pair);
        let PairLanes { pair: Pair { link, unit, extent, .. }, axial, .. } = pair;
        ((axial.axis_squared.sqrt() - link.radius) * unit).store(&mut measured.to_axis[lane..]);
        extent.store(&mut measured.extent[lane..]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::distance::lanes::tests::levels;
    use crate::robot::{Cap, ModifiedCylinder};
    use parry3d_f64::math::{Pose, Vector};

    /// Returns numbers in [-1, 1), many of them on a coarse lattice, where ties and parallels are
    /// common.
    fn numbers(seed: u64) -> impl FnMut(u32) -> f64 {
        let mut state = seed;
        move |lattice| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            let number = (state >> 11) as f64 * 2.0_f64.powi(-52) - 1.0;
            if lattice == 0 { (number * 4.0).round() / 4.0 } else { number }
        }
    }

    /// A triangle measured in a batch has the bits of the triangle measured alone, on each
    /// instruction set.
    #[test]
    fn together_is_alone_bit_for_bit() {
        let mut next = numbers(3);
        let bits = |best: &Best| {
            let nearest = best.nearest().expect("no bound");
            let points =
                [nearest.on_robot, nearest.on_mesh].map(|point| point.to_array().map(f64::to_bits));
            (nearest.triangle, nearest.distance.to_bits(), points)
        };
        let (mut touching, mut discs, mut compared) = (0, 0, 0);
        for round in 0..3000_u32 {
            let mut point = |size: f64| Vector::from([0; 3].map(|_| next(round % 5) * size));
            let size = 2.0_f64.powi(round as i32 % 41 - 20);
            let (start, way) = (point(1.0), point(size));
            let radius = size * [0.0, 0.01, 0.3, 3.0][round as usize % 4];
            let caps = [Cap::Flat, Cap::Round];
            let caps = [caps[round as usize / 2 % 2], caps[round as usize / 3 % 2]];
            let Ok(link) = ModifiedCylinder::new(start, start + way, radius, caps) else {
                continue;
            };
            let link = PlacedLink::new(&link, &Pose::IDENTITY);
            let corners: Vec<_> = (0..24).map(|_| start + way * 0.5 + point(3.0 * size)).collect();
            let triangles = (0..8).map(|k| [3 * k, 3 * k + 1, 3 * k + (round + k) % 3]).collect();
            let mesh = Mesh::of(corners, triangles);
            for triangle in 0..8 {
                let mut alone = Best::within(f64::INFINITY);
                alone.take(link.measure(triangle, mesh.corners(triangle)));
                touching += usize::from(alone.bound() <= 0.0);
                discs += usize::from(link.flat() != [false; 2]);
                for level in levels() {
                    let mut together = Best::within(f64::INFINITY);
                    // A batch of copies of the triangle; its length varies, so the last lane does
                    // too.
                    let others = [triangle; BATCH];
                    let count = 1 + (round as usize + triangle as usize) % BATCH;
                    together.measure_batch(level, &link, &mesh, &others[..count]);
                    assert_eq!(bits(&together), bits(&alone), "{level:?}, round {round}");
                    compared += 1;
                }
            }
            let mut alone = Best::within(f64::INFINITY);
            (0..8).for_each(|triangle| {
                alone.take(link.measure(triangle, mesh.corners(triangle)));
            });
            for level in levels() {
                let mut together = Best::within(f64::INFINITY);
                together.measure_batch(level, &link, &mesh, &[7, 3, 0, 1, 6, 2, 5, 4]);
                assert_eq!(bits(&together), bits(&alone), "{level:?}, round {round}");
            }
        }
        assert!(
            touching > 1000 && discs > 5000 && compared > 20_000,
            "{touching} {discs} {compared}"
        );
    }
}
