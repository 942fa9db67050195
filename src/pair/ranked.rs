//! The triangles near a robot's links in the order in which pieces of the wall appear: measured in double precision, a
//! pack at a time.

use super::coordinates::Pair;
use super::nearest::Nearest;
use super::pair_lanes::{PairLanes, PairRows, Rows, TOGETHER, put_pair, store};
use super::placed_link::PlacedLink;
use crate::distance::lanes::Pack;
use crate::distance::{Scalar, Unfused, dispatch};
use crate::mesh::Mesh;
use fearless_simd::Level;
use parry3d_f64::math::{Real, Vector};

/// A triangle near a link.
#[derive(Clone, Copy)]
pub(crate) struct Ranked {
    /// The distance, or where it is 0 the axis distance less the radius.
    pub rank: Real,
    pub nearest: Nearest,
    /// What rounding can do to the distance.
    pub rounding: Real,
}

/// The distance, the closest points of triangle and link, the axis distance less the radius, and the extent.
type RankRows = Rows<9>;

/// Measures triangles, each with its link.
pub(crate) fn rank_each<'a>(
    level: Level,
    mesh: &Mesh,
    mut pairs: impl Iterator<Item = (&'a PlacedLink, u32)>,
    mut take: impl FnMut(Ranked),
) {
    let (mut rows, mut triangles) = ([[0.0; TOGETHER]; 18], [0; TOGETHER]);
    loop {
        let mut count = 0;
        for (link, triangle) in pairs.by_ref().take(TOGETHER) {
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
    let point = |row: usize| Vector::new(found[row][lane], found[row + 1][lane], found[row + 2][lane]);
    let (distance, on_mesh) = (found[0][lane], point(1));
    let touches = distance <= 0.0;
    // One common point where they touch: rounding may have put the two apart.
    let on_robot = if touches { on_mesh } else { point(4) };
    Ranked {
        rank: if touches { found[7][lane].min(0.0) } else { distance },
        nearest: Nearest { triangle, distance, on_robot, on_mesh },
        rounding: rounding(found[8][lane]),
    }
}

/// What rounding can do to the distance between a link and what is no farther out than `extent`, from the link's start.
pub(crate) fn rounding(extent: Real) -> Real {
    32.0 * f64::UNIT_ROUNDOFF * extent
}

#[inline(never)] // compiled for each instruction set, not for each use as well
fn ranks_at(level: Level, pairs: &PairRows, count: usize) -> RankRows {
    let mut ranks = [[0.0; TOGETHER]; 9];
    dispatch!(level, simd => fill::<Unfused<_>>(simd, pairs, count, &mut ranks));
    ranks
}

#[inline(always)]
fn fill<L: Pack<Element = f64>>(token: L::Token, pairs: &PairRows, count: usize, ranks: &mut RankRows) {
    for lane in (0..count).step_by(L::LANES) {
        let pair = PairLanes::<L>::new(token, pairs, lane);
        let PairLanes { pair: Pair { link, unit, extent, .. }, axial, closest, .. } = &pair;
        (closest.distance * *unit).store(&mut ranks[0][lane..]);
        store(ranks, 1, lane, pair.placed(closest.point1));
        store(ranks, 4, lane, pair.placed(closest.point2));
        ((axial.axis_squared.sqrt() - link.radius) * *unit).store(&mut ranks[7][lane..]);
        extent.store(&mut ranks[8][lane..]);
    }
}
