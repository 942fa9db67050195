//! Several triangles against one link in double precision, a pack at a time: the bits are those of
//! [`PlacedLink::measure`], on every instruction set.

use super::mesh::Mesh;
use super::placed::{Best, Nearest, Pair, PlacedLink};
use crate::distance::lanes::Pack;
use crate::distance::{Axial, Closest, Face, Link, Unfused, Vec3, dispatch};
use fearless_simd::Level;
use parry3d_f64::math::Real;

/// How many triangles are measured together: the widest pack of `f64`.
pub(super) const TOGETHER: usize = 8;

/// Fewer are measured one by one: a pack takes about as long as two of them.
const WORTH_A_PACK: usize = 3;

/// Numbers of up to [`TOGETHER`] pairs, each in a row of its own: the corners of the triangle, then the end, the axis and
/// the radius of the link.
type Pairs = [[f64; TOGETHER]; 16];
/// Numbers of their answers: the distance, and the points of triangle and link.
type Answers = [[f64; TOGETHER]; 7];

impl Best {
    /// Measures up to [`TOGETHER`] triangles. True if one of them is the best so far.
    #[inline(never)] // the same code wherever it is called from
    pub(super) fn measure_together(
        &mut self,
        level: Level,
        link: &PlacedLink,
        mesh: &Mesh,
        triangles: &[u32],
    ) -> bool {
        if triangles.len() < WORTH_A_PACK {
            let measure = |is_best, &triangle| self.measure(link, triangle, mesh.corners(triangle)) | is_best;
            return triangles.iter().fold(false, measure);
        }
        let mut is_best = false;
        measure_pack(level, link, mesh, triangles, self.bound(), |nearest| is_best |= self.take(nearest));
        is_best
    }
}

/// Measures up to [`TOGETHER`] triangles in packs. `take` gets those that are at most `bound` away.
#[inline(always)]
fn measure_pack(
    level: Level,
    link: &PlacedLink,
    mesh: &Mesh,
    triangles: &[u32],
    bound: Real,
    mut take: impl FnMut(Nearest),
) {
    let (mut pairs, mut answers) = ([[0.0; TOGETHER]; 16], [[0.0; TOGETHER]; 7]);
    let mut units = [0.0; TOGETHER];
    for (lane, &triangle) in triangles.iter().enumerate().take(TOGETHER) {
        let pair = link.pair(mesh.corners(triangle));
        let [a, b, c] = pair.triangle;
        put(&mut pairs, 0, lane, a);
        put(&mut pairs, 3, lane, b);
        put(&mut pairs, 6, lane, c);
        put(&mut pairs, 9, lane, pair.link.end);
        put(&mut pairs, 12, lane, pair.link.axis);
        pairs[15][lane] = pair.link.radius;
        units[lane] = pair.unit;
    }
    let (flat, count) = (link.flat(), triangles.len());
    closest_at(level, &pairs, flat, count, &mut answers);
    for (lane, &triangle) in triangles.iter().enumerate().take(TOGETHER) {
        let distance = answers[0][lane];
        if distance * units[lane] <= bound {
            let point =
                |row: usize| Vec3::new(answers[row][lane], answers[row + 1][lane], answers[row + 2][lane]);
            let closest = Closest { distance, point1: point(1), point2: point(4) };
            take(Pair::report(units[lane], link.start(), triangle, closest));
        }
    }
}

/// Writes three coordinates to the rows `row` to `row + 2`.
fn put(pairs: &mut Pairs, row: usize, lane: usize, point: Vec3<f64>) {
    pairs[row][lane] = point.x;
    pairs[row + 1][lane] = point.y;
    pairs[row + 2][lane] = point.z;
}

#[inline(never)] // compiled for each instruction set, not for each use as well
fn closest_at(level: Level, pairs: &Pairs, flat: [bool; 2], count: usize, answers: &mut Answers) {
    dispatch!(level, simd => closest::<Unfused<_>>(simd, pairs, flat, count, answers));
}

#[inline(always)]
fn closest<L: Pack<Element = f64>>(
    token: L::Token,
    pairs: &Pairs,
    flat: [bool; 2],
    count: usize,
    answers: &mut Answers,
) {
    let zero = L::splat(token, 0.0);
    let (yes, no) = (zero.le(zero), zero.lt(zero));
    for lane in (0..count).step_by(L::LANES) {
        let face = Face::new([
            point::<L>(token, pairs, 0, lane),
            point::<L>(token, pairs, 3, lane),
            point::<L>(token, pairs, 6, lane),
        ]);
        let link = Link {
            end: point::<L>(token, pairs, 9, lane),
            axis: point::<L>(token, pairs, 12, lane),
            radius: L::load(token, &pairs[15][lane..]),
            flat: [if flat[0] { yes } else { no }, if flat[1] { yes } else { no }],
        };
        let axial = Axial::new(&link, &face);
        // Where no lane is beyond a flat cap the discs decide nothing.
        let closest = if L::bits(axial.beyond_flat_cap()) == 0 {
            axial.without_caps(&link)
        } else {
            axial.with_caps(&link, &face)
        };
        let Closest { distance, point1, point2 } = closest;
        distance.store(&mut answers[0][lane..]);
        point1.x.store(&mut answers[1][lane..]);
        point1.y.store(&mut answers[2][lane..]);
        point1.z.store(&mut answers[3][lane..]);
        point2.x.store(&mut answers[4][lane..]);
        point2.y.store(&mut answers[5][lane..]);
        point2.z.store(&mut answers[6][lane..]);
    }
}

/// Three coordinates from the rows `row` to `row + 2`.
#[inline(always)]
fn point<L: Pack<Element = f64>>(token: L::Token, pairs: &Pairs, row: usize, lane: usize) -> Vec3<L> {
    let [x, y, z] = [&pairs[row], &pairs[row + 1], &pairs[row + 2]];
    Vec3::new(L::load(token, &x[lane..]), L::load(token, &y[lane..]), L::load(token, &z[lane..]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::distance::lanes::tests::levels;
    use crate::{Cap, ModifiedCylinder};
    use parry3d_f64::math::{Pose, Vector};

    /// Numbers in [-1, 1), many of them on a coarse lattice, where ties and parallels are common.
    fn numbers(seed: u64) -> impl FnMut(u32) -> f64 {
        let mut state = seed;
        move |lattice| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let number = (state >> 11) as f64 * 2.0_f64.powi(-52) - 1.0;
            if lattice == 0 { (number * 4.0).round() / 4.0 } else { number }
        }
    }

    /// Each triangle measured with any others, on each instruction set, has the bits it has alone.
    #[test]
    fn together_is_alone_bit_for_bit() {
        let mut next = numbers(3);
        let bits = |best: &Best| {
            let nearest = best.nearest().expect("no bound");
            let points = [nearest.on_robot, nearest.on_mesh].map(|point| point.to_array().map(f64::to_bits));
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
            let Ok(link) = ModifiedCylinder::new(start, start + way, radius, caps) else { continue };
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
                    // Of several of itself and one beyond any bound, in a lane that moves.
                    let others = [triangle; TOGETHER];
                    let count = 1 + (round as usize + triangle as usize) % TOGETHER;
                    together.measure_together(level, &link, &mesh, &others[..count]);
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
                together.measure_together(level, &link, &mesh, &[7, 3, 0, 1, 6, 2, 5, 4]);
                assert_eq!(bits(&together), bits(&alone), "{level:?}, round {round}");
            }
        }
        assert!(touching > 1000 && discs > 5000 && compared > 20_000, "{touching} {discs} {compared}");
    }
}
