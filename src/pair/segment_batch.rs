//! Points and segments of the mesh against one link, one pack at a time, with the same bits on
//! every instruction set.

use super::coordinates::Placed;
use super::measure_batch::rounding;
use super::pair_lanes::{BATCH, PairLanes, Rows, corners, put_corners, store};
use super::placed_link::PlacedLink;
use crate::distance::lanes::Pack;
use crate::distance::{Unfused, dispatch};
use fearless_simd::Level;
use parry3d_f64::math::{Real, Vector};

/// The distance of a point or a segment from a link, and its rounding error.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PartDistance {
    pub distance: Real,
    pub rounding: Real,
    /// The vector to a point from the link's closest point; zero for a segment.
    pub way: Vector,
}

/// Measures points, and passes the distance of each to `take`, in order.
pub(crate) fn measure_points(
    level: Level,
    link: &PlacedLink,
    points: impl Iterator<Item = Vector>,
    take: impl FnMut(PartDistance),
) {
    measure(level, link, points.map(|point| [point; 2]), true, take);
}

/// Measures segments, each given by its two ends, and passes the distance of each to `take`, in
/// order.
pub(crate) fn measure_segments(
    level: Level,
    link: &PlacedLink,
    segments: impl Iterator<Item = [Vector; 2]>,
    take: impl FnMut(PartDistance),
) {
    measure(level, link, segments, false, take);
}

fn measure(
    level: Level,
    link: &PlacedLink,
    mut segments: impl Iterator<Item = [Vector; 2]>,
    are_points: bool,
    mut take: impl FnMut(PartDistance),
) {
    let (mut rows, mut found) = ([[0.0; BATCH]; 9], [[0.0; BATCH]; 5]);
    loop {
        let mut count = 0;
        for [from, to] in segments.by_ref().take(BATCH) {
            put_corners(&mut rows, count, [from, to, to]);
            count += 1;
        }
        if count == 0 {
            return;
        }
        measure_pack(level, link, &rows, count, are_points, &mut found);
        for lane in 0..count {
            let [distance, extent, x, y, z] = found.map(|row| row[lane]);
            take(PartDistance { distance, rounding: rounding(extent), way: Vector::new(x, y, z) });
        }
    }
}

#[inline(never)] // compiled for each instruction set, not for each use as well
fn measure_pack(
    level: Level,
    link: &PlacedLink,
    segments: &Rows<9>,
    count: usize,
    are_points: bool,
    found: &mut Rows<5>,
) {
    dispatch!(level, simd => fill::<Unfused<_>>(simd, link, segments, count, are_points, found));
}

#[inline(always)]
fn fill<L: Pack<Element = f64>>(
    token: L::Token,
    link: &PlacedLink,
    segments: &Rows<9>,
    count: usize,
    are_points: bool,
    found: &mut Rows<5>,
) {
    let link = Placed::<L>::splat(token, link);
    for lane in (0..count).step_by(L::LANES) {
        let corners = corners::<L, 9>(token, segments, lane);
        let (distance, pair) = if are_points {
            let pair = link.with(corners);
            let (distance, on_link) = pair.link.closest_to(pair.triangle[0]);
            store(found, 2, lane, (pair.triangle[0] - on_link) * pair.unit);
            (distance, pair)
        } else {
            let PairLanes { pair, closest, .. } = PairLanes::between(&link, corners);
            (closest.distance, pair)
        };
        (distance * pair.unit).store(&mut found[0][lane..]);
        pair.extent.store(&mut found[1][lane..]);
    }
}
