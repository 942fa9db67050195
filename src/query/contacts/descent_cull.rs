//! Which triangles certainly lie on a slope towards a nearer neighbour, a pack at a time.
//!
//! The test costs a fraction of the distance between link and triangle, and makes that distance
//! unnecessary.
//!
//! # Definitions
//! - d(z): the distance of a point z from the link.
//! - B: the link's axis if both caps are round, otherwise the link.
//! - W(z): the vector to z from the nearest point of B. `D(z) = |W(z)|` is d(z) plus the radius, or
//!   d(z). D is convex, and grows in the direction of W(z).
//! - T: a triangle; f = AB: one of its edges; C: its third corner; `h = C - F` for a point F of f.
//! - m: the point of f that is nearest to B; z: any point of f.
//!
//! **Lemma.** The projection onto a convex set is firmly nonexpansive, and so is W. With
//! `delta = W(z) - W(m)` and `s = z - m`,
//!
//! ```text
//! <delta, s> >= |delta|^2,   so   |delta - s / 2| <= |s| / 2.                         (1)
//! ```
//!
//! As m is nearest, `<W(m), m - z> <= 0`. So (1) gives, with `delta = W(m) - W(z)` and `s = m - z`,
//!
//! ```text
//! |delta|^2 <= <W(m), s> - <W(z), s> <= -<W(z), s> <= gap,
//! gap = max(-<W(z), A - z>, -<W(z), B - z>).                                          (2)
//! ```
//!
//! # Conditions
//! 1. *The nearest point of T is on f.* This holds if
//!
//!    ```text
//!    <W(m), h> >= <W(z), h> - sqrt(gap) |h| > 0.
//!    ```
//!
//!    **Proof.** Any point of T is `m' + g h` with m' on f and `g >= 0`, and `<W(m), m' - m> >= 0`.
//!    So no point of T is nearer than m. F is the point of f that is nearest to C, which makes h
//!    short.
//! 2. *A neighbour is nearer.* This holds if D at some point P of the neighbour is less than
//!    `D(z) - gap / D(z)`.
//!
//!    **Proof.** D is convex, so it lies above its tangents: on all of f it is at least
//!    `D(z) - gap / D(z)`. Another triangle at f, with the third corner C', contains the segment
//!    from z to C'. P is a point of that segment.
//!
//! If both hold, the nearest point of T is on f, and another triangle at f is nearer. So T is
//! culled (`local_minima`).
//!
//! The edge tried is the one opposite to the corner of T that is farthest from the axis. Any z and
//! P are valid. They minimise D on the edge and on the segment to C', if the nearest point of the
//! axis stays of one kind all along: an inner point, or the same end. The kind is taken at the
//! middle of the edge, and at z.
//!
//! # Rounding
//! Let e be the link's `error`, `64 u reach`; it is the error of single precision.
//!
//! - In units of `u reach`, a corner errs by 2 and a computed point of an edge by 11; seen from the
//!   link's start, by 16. A projection moves no farther than its point. The projection itself errs
//!   by 17 along the axis, for the product and the direction. It also errs by 4 for the length, and
//!   by 13 for the multiple of the axis. With the error of the point that is 49, below e. For a
//!   link with flat caps, subtracting the part across the axis adds 42. So every W is within `2 e`
//!   of the true one, leaving `36 u reach`, and D is within `2 e`.
//! - The gap errs by `2 e |AB|` for W and by `|W| e / 8` for AB. `3 e |AB| + |W| e / 8` are added
//!   to it, which includes its own rounding. `|AB|` is replaced by the sum of the magnitudes of its
//!   coordinates.
//! - h errs by `e / 4`. So condition 1 holds if
//!
//!   ```text
//!   <W(z), h> > |h| (sqrt(gap) + 2 e) + e |W(z)|.
//!   ```
//!
//!   The true product differs by at most `2 e |h| + (|W| + 2 e) e / 4`. The computed product
//!   differs by `11 u reach |W|`. The product of two errors is within the `36 u reach` left;
//!   otherwise `|W|` is below `6 e`, and condition 2 fails. The code avoids roots:
//!   `(sqrt(gap) + 2 e)^2` is at most `5/4 gap + 20 e^2`. The squares err by `8 u` of themselves,
//!   and so the sides by `14 u reach |h|`, which is within the `36 u reach` too. No square
//!   underflows, since `|h|` is above e if the right side is not 0.
//! - In condition 2 each length errs by `2 e`. The tangent errs by `3 e` more, because D(z) is
//!   known only within `2 e`. So it counts only if `gap < |W(z)|^2` and `|W(z)| > 12 e`. P errs by
//!   `25 u reach` from the link's start, which leaves W(P) within `2 e` too. A total of `12 e` is
//!   subtracted. So `5 e` remain by which the neighbour is nearer, far above the error of a
//!   measurement in double precision. The same margin keeps T from touching.

use crate::distance::lanes::Pack;
use crate::distance::{Mask, Scalar, Vec3};
use crate::pair::LinkLanes;

impl<L: Pack> LinkLanes<L> {
    /// Returns which triangles certainly lie on a slope towards a nearer one, one bit per lane.
    ///
    /// `across` are the opposite corners of the neighbours beyond the edges ab, bc and ca; NaN if
    /// there is no neighbour. `error` is the link's.
    #[inline(always)]
    pub(crate) fn culled_by_descent(
        &self,
        [a, b, c]: [Vec3<L>; 3],
        across: [Vec3<L>; 3],
        error: L,
    ) -> u64 {
        let (zero, one, half) = (error.zero(), error.one(), error.lit(0.5));
        let centre = (a + b + c) * error.lit(1.0 / 3.0);
        let up = self.offset_from_axis(centre);
        let [height_a, height_b, height_c] = [up.dot(a), up.dot(b), up.dot(c)];
        let a_is_top = height_b.le(height_a) & height_c.le(height_a);
        let b_is_top = height_c.le(height_b);
        let top = choose([a_is_top, b_is_top], a, b, c);
        let (from, to) =
            (choose([a_is_top, b_is_top], b, c, a), choose([a_is_top, b_is_top], c, a, b));
        let beyond = choose([a_is_top, b_is_top], across[1], across[2], across[0]);

        let along = to - from;
        let squared = along.norm_squared();
        let foot = (top - from).dot(along).over(squared).max(zero).min(one);
        let rise = (top - from).along(along, -foot);
        let edge = Edge { along, rise, error };

        let middle = (from + to) * half;
        let share = half + self.steps_to_lowest(self.way_to(middle).0, middle, along);
        let share = share.max(zero).min(one);
        let nearest = from.along(along, share);
        let (way, touching) = self.way_to(nearest);
        let (apart, fall) = (way.norm(), way.dot(along));
        let gap = edge.gap(apart, (fall * share).max(fall * (share - one)));
        let edge_at_least = edge.at_least(apart, gap);

        let to_corner = beyond - nearest;
        let step = self.steps_to_lowest(way, nearest, to_corner).max(zero).min(one);
        let beyond_edge = self.way_to(nearest.along(to_corner, step)).0.norm_squared();
        L::bits(
            edge.holds_nearest(way, apart, gap)
                & touching.lt(edge_at_least)
                & beyond_edge.lt(edge_at_least * edge_at_least),
        )
    }

    /// Returns the number of steps from a point to about the least D. NaN or infinite if D is
    /// constant along the step.
    #[inline(always)]
    fn steps_to_lowest(&self, way: Vec3<L>, point: Vec3<L>, step: Vec3<L>) -> L {
        let zero = self.length.zero();
        let height = (point - self.start).dot(self.shape.axis);
        let is_beside = zero.lt(height) & height.lt(self.length);
        let along_axis = is_beside.select(step.dot(self.shape.axis), zero);
        -way.dot(step) / (step.norm_squared() - along_axis * along_axis)
    }

    /// Returns W of a point, and the length of W for points that touch.
    #[inline(always)]
    fn way_to(&self, point: Vec3<L>) -> (Vec3<L>, L) {
        self.way_from_start(point - self.start)
    }

    /// Returns W of a point that is given relative to the link's start, and the length of W for
    /// points that touch.
    #[inline(always)]
    pub(crate) fn way_from_start(&self, relative: Vec3<L>) -> (Vec3<L>, L) {
        let (zero, radius) = (self.length.zero(), self.shape.radius);
        let height = relative.dot(self.shape.axis);
        let from_axis = relative.along(self.shape.axis, -height.max(zero).min(self.length));
        if !self.has_flat_cap() {
            return (from_axis, radius);
        }
        let [start, end] = self.shape.flat;
        let is_beyond_disc = (start & height.lt(zero)) | (end & self.length.lt(height));
        let arm = Vec3::select(is_beyond_disc, relative.along(self.shape.axis, -height), from_axis);
        // Over a disc or inside the link, W has no part across the axis.
        let reach = arm.norm();
        let share = radius.lt(reach).select(radius.over(reach), zero.one());
        (from_axis.along(arm, -share), zero)
    }
}

/// An edge of a triangle, in the terms of the module's derivation.
struct Edge<L: Scalar> {
    /// AB.
    along: Vec3<L>,
    /// h.
    rise: Vec3<L>,
    error: L,
}

impl<L: Pack> Edge<L> {
    /// Condition 1.
    #[inline(always)]
    fn holds_nearest(&self, way: Vec3<L>, apart: L, gap: L) -> L::Mask {
        let turn_squared = gap * gap.lit(1.25) + self.error * self.error * gap.lit(20.0);
        let rise = (way.dot(self.rise) - self.error * apart).max(gap.zero());
        (self.rise.norm_squared() * turn_squared).lt(rise * rise)
    }

    /// The gap with its rounding added.
    #[inline(always)]
    fn gap(&self, apart: L, gap: L) -> L {
        let length = self.along.x.abs() + self.along.y.abs() + self.along.z.abs();
        gap + self.error * (length * gap.lit(3.0) + apart * gap.lit(0.125))
    }

    /// A lower bound on D on the edge, less the margin by which the neighbour must be nearer.
    #[inline(always)]
    fn at_least(&self, apart: L, gap: L) -> L {
        apart - gap.over(apart) - self.error * gap.lit(12.0)
    }
}

/// Selects `a` if the first mask is true, else `b` if the second one is, else `c`. (A function,
/// because a closure may escape inlining.)
#[inline(always)]
fn choose<L: Pack>([first, second]: [L::Mask; 2], a: Vec3<L>, b: Vec3<L>, c: Vec3<L>) -> Vec3<L> {
    Vec3::select(first, a, Vec3::select(second, b, c))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::distance::lanes::Lane;
    use crate::distance::lanes::tests::levels;
    use crate::distance::{Scalar, dispatch};
    use crate::mesh::{BLOCK, Mesh, SearchFrame, ends_of, load_vertices, place_points};
    use crate::pair::{PlacedLink, SearchLink};
    use crate::robot::{Cap, ModifiedCylinder};
    use continuum_testing::Random;
    use fearless_simd::Level;
    use parry3d_f64::math::{Pose, Vector};

    /// Which of a block's triangles are on a slope.
    fn slopes_of(level: Level, searched: &SearchLink<f32>, rows: &[f32], across: &[f32]) -> u64 {
        dispatch!(level, simd => descents::<<f32 as Lane>::Pack<_>>(simd, searched, rows, across))
    }

    #[inline(always)]
    fn descents<L: Pack<Element = f32>>(
        token: L::Token,
        searched: &SearchLink<f32>,
        rows: &[f32],
        across: &[f32],
    ) -> u64 {
        let lanes = LinkLanes::<L>::new(token, searched);
        let (mut descents, error) = (0, L::splat(token, searched.error));
        for lane in (0..BLOCK).step_by(L::LANES) {
            let corners = load_vertices(token, rows, lane);
            descents |=
                lanes.culled_by_descent(corners, load_vertices(token, across, lane), error) << lane;
        }
        descents
    }

    /// A wall of 2 x 4 squares, cut in two, over a tilted plane: level or steep, even or rough,
    /// with slivers or without.
    fn wall(random: &mut Random) -> Mesh {
        let size = [0.02, 0.3, 1.0][random.below(3) as usize];
        let tilt = 10.0_f64.powi(-(random.below(7) as i32));
        let (rough, thin) = (
            tilt * [0.0, 0.1, 1.0][random.below(3) as usize],
            [1.0, 1e-4][random.below(2) as usize],
        );
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

    /// An axis that crosses an edge at a small angle: over the triangle at one end and beside it at
    /// the other.
    fn over_an_edge(random: &mut Random, mesh: &Mesh) -> (Vector, Vector) {
        let corners = mesh.corners(random.below(BLOCK as u32));
        let first = random.below(3) as usize;
        let [from, to, beyond] = [0, 1, 2].map(|k| corners[(first + k) % 3]);
        let (along, inwards) = (to - from, beyond - (from + to) * 0.5);
        let up = along.cross(inwards).normalize_or_zero() * along.length();
        let [low, high] = [random.between(0.0, 0.5), random.between(0.0, 0.5)];
        let inside = from
            + along * random.between(-0.3, 0.3)
            + inwards * random.between(0.0, 0.5)
            + up * low;
        (
            inside,
            to + along * random.between(-0.3, 0.3) - inwards * random.between(0.0, 0.5) + up * high,
        )
    }

    /// The nearest point is on an edge, and another triangle at that edge is nearer by more than
    /// measurements err.
    #[test]
    fn a_triangle_on_a_slope_has_a_nearer_neighbour() {
        let (mut found, mut others, mut flat) = (0, 0, 0);
        for seed in 0..6000 {
            let mut random = Random::new(seed);
            let mesh = wall(&mut random);
            let caps = [Cap::Flat, Cap::Round];
            let caps = [caps[random.below(2) as usize], caps[random.below(2) as usize]];
            let size = [0.02, 0.3, 1.0][random.below(3) as usize];
            let start =
                Vector::new(0.0, 0.0, random.between(0.0, 1.0) * size) + random.point() * size;
            // W turns most for a short link near a large triangle.
            let long = [1.0, 0.1, 0.01][random.below(3) as usize];
            let way =
                [random.point(), Vector::X, Vector::Z][random.below(3) as usize] * size * long;
            let radius = random.between(0.0, 0.3) * size * long;
            let (start, end) =
                if seed % 3 == 0 { over_an_edge(&mut random, &mesh) } else { (start, start + way) };
            let Ok(link) = ModifiedCylinder::new(start, end, radius, caps) else { continue };
            let link = PlacedLink::new(&link, &Pose::IDENTITY);
            let frame = SearchFrame::new(&mesh);
            let Some(searched) = SearchLink::<f32>::new(&link, &frame) else { continue };
            let (mut rows, mut across) = ([0.0; 9 * BLOCK], [0.0; 9 * BLOCK]);
            for triangle in 0..BLOCK as u32 {
                place_points(&frame, mesh.corners(triangle), &mut rows, triangle as usize);
                place_points(&frame, mesh.corners_across(triangle), &mut across, triangle as usize);
            }
            for level in levels() {
                let descents = slopes_of(level, &searched, &rows, &across);
                for triangle in 0..BLOCK as u32 {
                    if descents >> triangle & 1 == 0 {
                        others += 1;
                        continue;
                    }
                    let corners = mesh.corners(triangle);
                    let rounding = 32.0 * f64::UNIT_ROUNDOFF * link.extent_with(corners);
                    let distance = link.measure(0, corners).distance;
                    let is_on_slope = (3..6).any(|edge| {
                        let [from, to] = ends_of(corners, edge);
                        let is_lower = |other: u32| {
                            link.measure(0, mesh.corners(other)).distance + 4.0 * rounding
                                < distance
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
