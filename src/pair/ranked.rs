//! Ranks the triangles near a robot's links, in double precision, one pack at a time.
//!
//! The rank is the order in which pieces of the wall appear when the bound grows.

use super::coordinates::Pair;
use super::nearest::Nearest;
use super::nearest_rows::NearestRows;
use super::pair_lanes::{BATCH, PairLanes, PairRows, put_pair};
use super::placed_link::PlacedLink;
use crate::distance::lanes::Pack;
use crate::distance::{Scalar, Unfused, dispatch};
use crate::mesh::Mesh;
use fearless_simd::Level;
use parry3d_f64::math::Real;

/// A triangle near a link, with its rank.
#[derive(Clone, Copy)]
pub(crate) struct Ranked {
    /// The distance; if that is 0, the axis distance minus the radius, at most 0.
    pub rank: Real,
    pub nearest: Nearest,
    /// The rounding error of the distance.
    pub rounding: Real,
}

/// The results of several pairs.
struct RankRows {
    nearest: NearestRows,
    /// The axis distances minus the radii.
    to_axis: [Real; BATCH],
    extent: [Real; BATCH],
}

/// Measures triangles, each with its link, and passes each result to `take` in order.
pub(crate) fn rank_each<'a>(
    level: Level,
    mesh: &Mesh,
    mut pairs: impl Iterator<Item = (&'a PlacedLink, u32)>,
    mut take: impl FnMut(Ranked),
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
        let found = ranks_at(level, &rows, count);
        for (lane, &triangle) in triangles.iter().enumerate().take(count) {
            take(ranked(&found, lane, triangle));
        }
    }
}

fn ranked(found: &RankRows, lane: usize, triangle: u32) -> Ranked {
    let nearest = found.nearest.nearest(lane, triangle);
    let rank =
        if nearest.distance <= 0.0 { found.to_axis[lane].min(0.0) } else { nearest.distance };
    Ranked { rank, nearest, rounding: rounding(found.extent[lane]) }
}

/// Returns the rounding error of the distance between a link and a shape whose coordinates relative
/// to the link's start are at most `extent`.
pub(crate) fn rounding(extent: Real) -> Real {
    32.0 * f64::UNIT_ROUNDOFF * extent
}

#[inline(never)] // compiled for each instruction set, not for each use as well
fn ranks_at(level: Level, pairs: &PairRows, count: usize) -> RankRows {
    let [to_axis, extent] = [[0.0; BATCH]; 2];
    let mut ranks = RankRows { nearest: NearestRows::new(), to_axis, extent };
    dispatch!(level, simd => fill::<Unfused<_>>(simd, pairs, count, &mut ranks));
    ranks
}

#[inline(always)]
fn fill<L: Pack<Element = f64>>(
    token: L::Token,
    pairs: &PairRows,
    count: usize,
    ranks: &mut RankRows,
) {
    for lane in (0..count).step_by(L::LANES) {
        let pair = PairLanes::<L>::new(token, pairs, lane);
        ranks.nearest.take(lane, &pair);
        let PairLanes { pair: Pair { link, unit, extent, .. }, axial, .. } = pair;
        ((axial.axis_squared.sqrt() - link.radius) * unit).store(&mut ranks.to_axis[lane..]);
        extent.store(&mut ranks.extent[lane..]);
    }
}
