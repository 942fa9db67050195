//! Which triangles certainly lie on a slope towards a neighbour, a pack at a time: a test that costs a fraction of the
//! distance between link and triangle, and spares it.
//!
//! # Two conditions
//! Let d be the distance from the link, B its axis where both caps are round and the link itself where one is flat, and
//! W(z) the way to a point z from the nearest point of B. Then |W(z)| is d(z) and the radius, or d(z); call it D(z). It is
//! convex, and W(z) points the way in which it grows. The projection onto a convex set is firmly nonexpansive, and so is
//! what it leaves: with delta = W(z) - W(m) and s = z - m,
//!
//! ```text
//! <delta, s> >= |delta|^2,   so   |delta - s / 2| <= |s| / 2.                                              (1)
//! ```
//!
//! Let f be the edge AB of a triangle T with the third corner C, and M its middle. Let F be a point of f, h = C - F.
//!
//! 1. *T's nearest point is on f.* Along f, z = M + s with |s| <= |AB| / 2, and by (1)
//!
//!    ```text
//!    <W(z), h> >= <W(M), h> + (<s, h> - |s| |h|) / 2 >= <W(M), h> - (|AB| |h| + |<AB, h>|) / 4.
//!    ```
//!
//!    Where the right side is positive, let z be f's nearest point. Any point of T is z' + g h, with z' on f and g >= 0;
//!    <W(z), z' - z> >= 0, z being the nearest of f, and <W(z), h> > 0: so none of T is nearer than z. F is the foot of C
//!    on f, which makes <AB, h> zero but for rounding; it must lie on f.
//! 2. *A neighbour is nearer.* D being convex, it lies above its tangents: it is at least D(M) - |<W(M), AB>| / (2 D(M)) on
//!    all of f, and with E the end of f that <W(M), AB> leads down to and O the other end, at least
//!    D(E) - max(0, -<W(E), O - E>) / D(E). T keeps the greater of the two. Another triangle that has f reaches to its own
//!    third corner C' and holds the way from E to it. It is nearer if D is less at C', or at the point P a quarter of the way:
//!    near a link that is closer than the triangles are long D may rise again on the way to C'.
//!
//! So T's nearest point is on f, and a triangle that has f too is nearer: T is left out as `local_minima` says. Of T's
//! edges the one opposite to the corner that is farthest from the axis is tried.
//!
//! # Rounding
//! Let e be the link's `error`, 64 u reach; it is that of single precision. A corner errs by e / 16. The computed W(M) is
//! within 2 e of a true way from the link to M, and its length exceeds D(M) by less than 4 e: so, as `feet` derives,
//! it is within t = 4 e + sqrt(9 e (|W(M)| + 4 e)) of the true one. With the computed corners h errs by e / 4, |AB| by e / 8,
//! and |<AB, h>| is below e (|AB| + |h|), F being computed. So condition 1 holds if
//!
//! ```text
//! <W(M), h> > |h| (|AB| / 4 + t) + e (|W(M)| + |AB| + |h|),
//! ```
//!
//! where the true products differ by t |h| + (|W(M)| + t) e / 4 + 3 e (|AB| + |h|) / 8 at most, and t < 11 e + |W(M)| / 2; 2 x
//! is never more than 1 + x^2. In condition 2 each slope errs by t |AB| / |W|, with the t and the W of its point, and each
//! length by 2 e: with 8 e in all, 4 e are left by which the neighbour is nearer, far above what a measurement in double
//! precision errs by. T must keep as much, lest it touch. Any end may be taken for E. P errs by less than e / 8, its
//! corners' errors and its own roundings together, and so its length by less than 2 e too.

use super::link_lanes::LinkLanes;
use crate::distance::lanes::Pack;
use crate::distance::{Mask, Vec3};

impl<L: Pack> LinkLanes<L> {
    /// Which triangles certainly lie on a slope towards a nearer one, one bit per lane. `across` are the corners beyond
    /// the edges from the first corner to the second, from the second to the third and from the third to the first;
    /// no numbers where there are none. `error` is the link's.
    #[inline(always)]
    pub(super) fn on_slope(&self, [a, b, c]: [Vec3<L>; 3], across: [Vec3<L>; 3], error: L) -> u64 {
        let (zero, one) = (error.zero(), error.one());
        let centre = (a + b + c) * error.lit(1.0 / 3.0);
        let up = self.offset_from_axis(centre);
        let [height_a, height_b, height_c] = [up.dot(a), up.dot(b), up.dot(c)];
        let a_is_top = height_b.le(height_a) & height_c.le(height_a);
        let b_is_top = height_c.le(height_b);
        let top = choose([a_is_top, b_is_top], a, b, c);
        let (from, to) = (choose([a_is_top, b_is_top], b, c, a), choose([a_is_top, b_is_top], c, a, b));
        let beyond = choose([a_is_top, b_is_top], across[1], across[2], across[0]);

        let edge = to - from;
        let squared = edge.norm_squared();
        let share = (top - from).dot(edge).over(squared);
        let rise = (top - from).along(edge, -share);
        let (way, radius) = self.way_to((from + to) * error.lit(0.5));
        let (apart, length) = (way.norm(), squared.sqrt());
        let turn = turn_at(apart, error);
        let rise_squared = rise.norm_squared();
        let sizes = apart + one + (squared + rise_squared) * error.lit(0.5);
        let steep = way.dot(rise) - error * sizes;
        let least = length * error.lit(0.25) + turn;
        let is_at_edge = zero.le(share)
            & share.le(one)
            & zero.lt(steep)
            & (rise_squared * least * least).lt(steep * steep);

        let eight = error * error.lit(8.0);
        let along = way.dot(edge);
        let kept = apart - (along.abs() * error.lit(0.5) + turn * length).over(apart) - eight;
        let is_lower = radius.lt(kept) & self.way_to(beyond).0.norm().lt(kept);
        if L::bits(is_at_edge & !is_lower) == 0 {
            return L::bits(is_at_edge & is_lower);
        }
        let falls = along.lt(zero);
        let (low, to_high) = (Vec3::select(falls, to, from), Vec3::select(falls, -edge, edge));
        let way = self.way_to(low).0;
        let apart = way.norm();
        let fall = (turn_at(apart, error) * length - way.dot(to_high)).max(zero).over(apart);
        let kept = kept.max(apart - fall - eight);
        let on_the_way = low.along(beyond - low, error.lit(0.25));
        let nearest = self.way_to(beyond).0.norm().min(self.way_to(on_the_way).0.norm());
        L::bits(is_at_edge & radius.lt(kept) & nearest.lt(kept))
    }

    /// The way to a point from the nearest point of the axis, if both caps are round, else of the link; and the length of
    /// the ways to points that touch.
    #[inline(always)]
    fn way_to(&self, point: Vec3<L>) -> (Vec3<L>, L) {
        let (zero, radius) = (self.length.zero(), self.link.radius);
        if !self.has_flat_cap() {
            return (self.offset_from_axis(point), radius);
        }
        let relative = point - self.start;
        let height = relative.dot(self.link.axis);
        let from_axis = relative.along(self.link.axis, -height.max(zero).min(self.length));
        let [start, end] = self.link.flat;
        let is_beyond_disc = (start & height.lt(zero)) | (end & self.length.lt(height));
        let arm = Vec3::select(is_beyond_disc, relative.along(self.link.axis, -height), from_axis);
        // What is over a disc or in the link has no way to go across.
        let reach = arm.norm();
        let share = radius.lt(reach).select(radius.over(reach), zero.one());
        (from_axis.along(arm, -share), zero)
    }
}

/// By how much the way to a point errs that is so long, beside the error of the point.
#[inline(always)]
fn turn_at<L: Pack>(apart: L, error: L) -> L {
    let four = error * error.lit(4.0);
    four + ((apart + four) * error * error.lit(9.0)).sqrt()
}

/// The first where the first mask is true, the second where only the second one is, else the third. (A function, because
/// a closure may escape inlining.)
#[inline(always)]
fn choose<L: Pack>([first, second]: [L::Mask; 2], a: Vec3<L>, b: Vec3<L>, c: Vec3<L>) -> Vec3<L> {
    Vec3::select(first, a, Vec3::select(second, b, c))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::distance::lanes::{Lane, tests::levels};
    use crate::distance::{Scalar, dispatch};
    use crate::proximity::mesh::Mesh;
    use crate::proximity::placed::PlacedLink;
    use crate::proximity::search_frame::{SearchFrame, SearchLink};
    use crate::proximity::shared_parts::ends_of;
    use crate::proximity::triangle_block::{BLOCK, load_vertices, place_points, place_triangle};
    use crate::{Cap, ModifiedCylinder};
    use continuum_testing::Random;
    use fearless_simd::Level;
    use parry3d_f64::math::{Pose, Vector};

    /// Which of a block's triangles are on a slope.
    fn slopes_of(level: Level, searched: &SearchLink<f32>, rows: &[f32], across: &[f32]) -> u64 {
        dispatch!(level, simd => slopes::<<f32 as Lane>::Pack<_>>(simd, searched, rows, across))
    }

    #[inline(always)]
    fn slopes<L: Pack<Element = f32>>(
        token: L::Token,
        searched: &SearchLink<f32>,
        rows: &[f32],
        across: &[f32],
    ) -> u64 {
        let lanes = LinkLanes::<L>::new(token, searched);
        let (mut slopes, error) = (0, L::splat(token, searched.error));
        for lane in (0..BLOCK).step_by(L::LANES) {
            let corners = load_vertices(token, rows, lane);
            slopes |= lanes.on_slope(corners, load_vertices(token, across, lane), error) << lane;
        }
        slopes
    }

    /// A wall of 2 x 4 squares, cut in two, over a plane that tilts: level or steep, even or rough, with slivers or not.
    fn wall(random: &mut Random) -> Mesh {
        let size = [0.02, 0.3, 1.0][random.below(3) as usize];
        let tilt = 10.0_f64.powi(-(random.below(7) as i32));
        let (rough, thin) =
            (tilt * [0.0, 0.1, 1.0][random.below(3) as usize], [1.0, 1e-4][random.below(2) as usize]);
        let (slope_x, slope_y) = (random.between(-tilt, tilt), random.between(-tilt, tilt));
        let corner = |k: u32| {
            let (x, y) = (f64::from(k % 5) - 2.0, (f64::from(k / 5) - 1.0) * thin);
            let (x, y) = (x + random.between(-0.3, 0.3), y + thin * random.between(-0.3, 0.3));
            Vector::new(x, y, slope_x * x + slope_y * y + random.between(-rough, rough)) * size
        };
        let corners = (0..15).map(corner).collect();
        let squares = (0..9).filter(|k| k % 5 < 4);
        Mesh::of(corners, squares.flat_map(|k| [[k, k + 1, k + 6], [k, k + 6, k + 5]]).collect())
    }

    /// An axis that crosses an edge at a small angle, over the triangle at one end and beside it at the other.
    fn over_an_edge(random: &mut Random, mesh: &Mesh) -> (Vector, Vector) {
        let corners = mesh.corners(random.below(BLOCK as u32));
        let first = random.below(3) as usize;
        let [from, to, beyond] = [0, 1, 2].map(|k| corners[(first + k) % 3]);
        let (along, inwards) = (to - from, beyond - (from + to) * 0.5);
        let up = along.cross(inwards).normalize_or_zero() * along.length();
        let [low, high] = [random.between(0.0, 0.5), random.between(0.0, 0.5)];
        let inside = from + along * random.between(-0.3, 0.3) + inwards * random.between(0.0, 0.5) + up * low;
        (inside, to + along * random.between(-0.3, 0.3) - inwards * random.between(0.0, 0.5) + up * high)
    }

    /// Not only is the nearest point on an edge: another triangle that has it is nearer, by more than measurements err.
    #[test]
    fn a_triangle_on_a_slope_has_a_nearer_neighbour() {
        let (mut found, mut others, mut flat) = (0, 0, 0);
        for seed in 0..6000 {
            let mut random = Random::new(seed);
            let mesh = wall(&mut random);
            let caps = [Cap::Flat, Cap::Round];
            let caps = [caps[random.below(2) as usize], caps[random.below(2) as usize]];
            let size = [0.02, 0.3, 1.0][random.below(3) as usize];
            let start = Vector::new(0.0, 0.0, random.between(0.0, 1.0) * size) + random.point() * size;
            // A short link near a large triangle is where the way to it turns most.
            let long = [1.0, 0.1, 0.01][random.below(3) as usize];
            let way = [random.point(), Vector::X, Vector::Z][random.below(3) as usize] * size * long;
            let radius = random.between(0.0, 0.3) * size * long;
            let (start, end) =
                if seed % 3 == 0 { over_an_edge(&mut random, &mesh) } else { (start, start + way) };
            let Ok(link) = ModifiedCylinder::new(start, end, radius, caps) else { continue };
            let link = PlacedLink::new(&link, &Pose::IDENTITY);
            let frame = SearchFrame::new(&mesh);
            let Some(searched) = SearchLink::<f32>::new(&link, &frame) else { continue };
            let (mut rows, mut across) = ([0.0; 9 * BLOCK], [0.0; 9 * BLOCK]);
            for triangle in 0..BLOCK as u32 {
                place_triangle(&frame, &mesh, triangle, &mut rows, triangle as usize);
                place_points(&frame, mesh.corners_across(triangle), &mut across, triangle as usize);
            }
            for level in levels() {
                let slopes = slopes_of(level, &searched, &rows, &across);
                for triangle in 0..BLOCK as u32 {
                    if slopes >> triangle & 1 == 0 {
                        others += 1;
                        continue;
                    }
                    let corners = mesh.corners(triangle);
                    let rounding = 32.0 * f64::UNIT_ROUNDOFF * link.extent_with(corners);
                    let distance = link.measure(0, corners).distance;
                    let is_on_slope = (3..6).any(|edge| {
                        let [from, to] = ends_of(corners, edge);
                        let is_lower = |other: u32| {
                            link.measure(0, mesh.corners(other)).distance + 4.0 * rounding < distance
                        };
                        link.measure(0, [from, to, to]).distance <= distance + rounding
                            && mesh.parts().others(triangle, edge).any(is_lower)
                    });
                    assert!(is_on_slope, "{seed}, {level:?}: {triangle} at {distance}");
                    found += 1;
                    flat += usize::from(link.flat() != [false; 2]);
                }
            }
        }
        assert!(found > 10_000 && others > 20_000 && flat > 5000, "{found} {others} {flat}");
    }
}
