//! Where on a triangle the point nearest to a link can lie, a pack of triangles at a time, in the
//! precision of the search.
//!
//! # Definitions
//! - B: the axis of the link if both caps are round, otherwise the link.
//! - W(x): the vector to a point x from the nearest point of B.
//! - m: the point of the triangle that is nearest to B; `v = W(m)`.
//! - z: any point of the triangle. Here it is the nearest point of the edge that is nearest to the
//!   axis.
//! - X, Y, Z: corners.
//!
//! **Claim 1.** If `<v, X - Y> > 0`, the corner X has no share in m: m lies on the edge opposite to
//! X. If two corners have no share, m is the third.
//!
//! **Proof.** `<v, x - m> >= 0` for every point x of the triangle. If X had a share in m, moving
//! that share to Y would bring m nearer.
//!
//! **Claim 2.** v is close to W(z), however uncertain m is along two parallels:
//!
//! ```text
//! |v - W(z)|^2 <= gap,   gap = max over the corners Z of -<W(z), Z - z>.
//! ```
//!
//! **Proof.** W is firmly nonexpansive (see `descent_cull`). So
//!
//! ```text
//! |v - W(z)|^2 <= <v, m - z> - <W(z), m - z> <= -<W(z), m - z> <= gap.
//! ```
//!
//! The gap is the duality gap of Frank and Wolfe.
//!
//! # Rounding
//! Let e be the link's `error`, `64 u reach`.
//! - z is a computed point of an edge, so W(z) is within `2 e` of the true one, leaving
//!   `36 u reach` (see `descent_cull`).
//! - The gap errs by `2 e |Z - z|` for W(z), and by `|W| e / 4` for Z and z.
//! - The corners are each rounded by less than `e / 16`.
//!
//! Let l be the longest of the `Z - z`, and `t = sqrt(gap + 3 e l + |W| e / 4) + 2 e`. Then
//! `<v, X - Y> > 0` if
//!
//! ```text
//! <W, X - Y> > t |X - Y| + (|W| + t) e / 8.
//! ```
//!
//! The computation itself errs by at most `8 u |W| |X - Y|`. That is within the `36 u reach` left,
//! since `|W|` is below `3.5 reach`.

use crate::distance::lanes::Pack;
use crate::distance::{Axial, Face, Scalar, Vec3};
use crate::pair::{LinkLanes, Nearer};

/// Where the nearest points of a pack of triangles can lie, one bit per lane.
pub(crate) struct FeatureMask {
    /// For each corner: it certainly has no share in the nearest point.
    pub away: [u64; 3],
    /// For each of the edges ab, bc and ca: it is certainly farther than the nearest point, by more
    /// than the rounding of measured distances.
    pub beyond: [u64; 3],
}

/// Two measured distances certainly differ, beyond their own rounding, if the computed axis
/// distances differ by this many `error`: one for each axis distance, and one for the rounding of
/// each measured distance, which is `32 u extent` in double precision (`local_minima`).
pub(crate) const CERTAIN_GAP: f64 = 4.0;

impl<L: Pack> LinkLanes<L> {
    /// Returns which triangles may be nearer than the bound whose axis limit is `limit`, and where
    /// their nearest points can lie.
    ///
    /// `corners` are in the order of [`Face::vertices`]; `error` is the link's.
    #[inline(always)]
    pub(crate) fn nearer_and_features(
        &self,
        corners: [Vec3<L>; 3],
        limit: L,
        error: L,
    ) -> (Nearer<L>, FeatureMask) {
        let face = Face::in_order(corners).seen_from(self.start);
        let axial = Axial::new(&self.shape, &face);
        let nearer = self.nearer(&axial, &face, limit);
        let certain = error * error.lit(CERTAIN_GAP);
        let away = self.corners_away(corners, &axial, error);
        // Triangles that may touch tie at distance 0.
        let is_apart = (self.shape.radius + certain).lt(nearer.lower);
        let upper = nearer.upper + certain;
        let [first, second, third] = axial.edges_squared;
        let beyond = [
            L::bits(is_apart & upper.lt(first.sqrt())),
            L::bits(is_apart & upper.lt(second.sqrt())),
            L::bits(is_apart & upper.lt(third.sqrt())),
        ];
        (nearer, FeatureMask { away, beyond })
    }

    #[inline(always)]
    fn corners_away(&self, corners: [Vec3<L>; 3], axial: &Axial<L>, error: L) -> [u64; 3] {
        let [a, b, c] = [corners[0] - self.start, corners[1] - self.start, corners[2] - self.start];
        let (zero, one) = (error.zero(), error.one());
        let [ab, bc, ca] = axial.edges_squared;
        let (ab_is_nearest, bc_is_nearest) = (ab.le(bc) & ab.le(ca), bc.le(ca));
        let from = Vec3::select(ab_is_nearest, a, Vec3::select(bc_is_nearest, b, c));
        let to = Vec3::select(ab_is_nearest, b, Vec3::select(bc_is_nearest, c, a));
        let edge = to - from;
        let share = (axial.on_triangle - from).dot(edge).over(edge.norm_squared());
        let point = from.along(edge, share.max(zero).min(one));
        let (way, _) = self.way_from_start(point);
        let apart = way.norm();
        let [to_a, to_b, to_c] = [a - point, b - point, c - point];
        let fall = zero.max(-way.dot(to_a)).max(-way.dot(to_b)).max(-way.dot(to_c));
        let longest = to_a.norm_squared().max(to_b.norm_squared()).max(to_c.norm_squared()).sqrt();
        let gap = fall + error * (longest * error.lit(3.0) + apart * error.lit(0.25));
        let turn = gap.sqrt() + error + error;
        let rest = (apart + turn) * error * error.lit(0.125);
        let slope = Slope { way, turn_squared: turn * turn, rest };
        let ([a_b, b_a], [b_c, c_b], [c_a, a_c]) = (slope.of(a, b), slope.of(b, c), slope.of(c, a));
        [a_b | a_c, b_a | b_c, c_a | c_b].map(L::bits)
    }
}

/// The vector W(z) with its uncertainty.
struct Slope<L: Scalar> {
    way: Vec3<L>,
    /// `t^2`.
    turn_squared: L,
    /// `(|W| + t) e / 8`.
    rest: L,
}

impl<L: Scalar> Slope<L> {
    /// Returns whether `a` is certainly uphill from `b`, and `b` from `a`.
    #[inline(always)]
    fn of(&self, a: Vec3<L>, b: Vec3<L>) -> [L::Mask; 2] {
        let edge = a - b;
        let rise = self.way.dot(edge);
        let steep = rise.abs() - self.rest;
        let zero = rise.zero();
        let is_steep = zero.lt(steep) & (self.turn_squared * edge.norm_squared()).lt(steep * steep);
        [is_steep & zero.lt(rise), is_steep & rise.lt(zero)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::distance::dispatch;
    use crate::distance::lanes::Lane;
    use crate::distance::lanes::tests::levels;
    use crate::mesh::{
        BLOCK, Mesh, PART_WITHOUT, SearchFrame, ends_of, first_of_face, load_vertices, place_face,
        rotated,
    };
    use crate::pair::{PlacedLink, SearchLink};
    use crate::robot::{Cap, ModifiedCylinder};
    use continuum_testing::Random;
    use fearless_simd::Level;
    use parry3d_f64::math::{Pose, Vector};

    /// The features of a block of triangles.
    fn feet_of<E: Lane>(
        level: Level,
        searched: &SearchLink<E>,
        rows: &[E],
    ) -> [FeatureMask; BLOCK] {
        let mut features = [(); BLOCK].map(|()| FeatureMask { away: [0; 3], beyond: [0; 3] });
        dispatch!(level, simd => fill::<E::Pack<_>>(simd, searched, rows, &mut features));
        features
    }

    /// The bits of each lane, moved to the lowest bit.
    #[inline(always)]
    fn fill<L: Pack>(
        token: L::Token,
        searched: &SearchLink<L::Element>,
        rows: &[L::Element],
        features: &mut [FeatureMask; BLOCK],
    ) where
        L::Element: Lane,
    {
        let lanes = LinkLanes::<L>::new(token, searched);
        let (far, error) =
            (L::splat(token, L::Element::round(1e9)), L::splat(token, searched.error));
        for lane in (0..BLOCK).step_by(L::LANES) {
            let (_, pack) = lanes.nearer_and_features(load_vertices(token, rows, lane), far, error);
            for place in 0..L::LANES {
                let lowest = |lanes: [u64; 3]| lanes.map(|lanes| lanes >> place & 1);
                features[lane + place] =
                    FeatureMask { away: lowest(pack.away), beyond: lowest(pack.beyond) };
            }
        }
    }

    /// Counts what was certain: the nearest point lies on an edge, on a corner, or not on an edge
    /// (for each of the three edges).
    #[derive(Debug, Default)]
    struct Census([usize; 5]);

    fn judge<E: Lane>(seed: u64, census: &mut Census) {
        let mut random = Random::new(seed);
        // Nearly level triangles below a link, so that small tilts decide which corner is uphill.
        let tilt = 10.0_f64.powi(-(random.below(10) as i32));
        let size = [0.02, 0.3, 1.0][random.below(3) as usize];
        let corners: Vec<_> = (0..3 * BLOCK)
            .map(|_| {
                Vector::new(
                    random.point().x * size,
                    random.point().x * size,
                    random.point().x * tilt,
                )
            })
            .collect();
        let caps = [Cap::Flat, Cap::Round];
        let caps = [caps[random.below(2) as usize], caps[random.below(2) as usize]];
        let start = Vector::new(0.0, 0.0, random.between(0.0, 1.0)) + random.point() * size;
        let way =
            if random.below(3) == 0 { random.point() } else { Vector::X + random.point() * tilt };
        let radius = random.between(0.0, 0.2);
        let Ok(link) = ModifiedCylinder::new(start, start + way, radius, caps) else { return };
        let link = PlacedLink::new(&link, &Pose::IDENTITY);
        let triangles = (0..BLOCK as u32).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
        let mesh = Mesh::of(corners, triangles);
        let frame = SearchFrame::new(&mesh);
        let Some(searched) = SearchLink::<E>::new(&link, &frame) else { return };
        let mut rows = vec![E::default(); 9 * BLOCK];
        (0..BLOCK).for_each(|lane| place_face(&frame, &mesh, lane as u32, &mut rows, lane));
        for level in levels() {
            for (lane, features) in feet_of(level, &searched, &rows).iter().enumerate() {
                let corners = rotated(
                    mesh.corners(lane as u32),
                    first_of_face::<E>(&frame, &mesh, lane as u32),
                );
                let distance = link.measure(0, corners).distance;
                let to_part = |part: usize| {
                    let [from, to] = ends_of(corners, part);
                    link.measure(0, [from, to, to]).distance
                };
                let rounding = 32.0 * f64::UNIT_ROUNDOFF * link.extent_with(corners);
                let [a, b, c] = features.away;
                if let Some(part) = PART_WITHOUT[(a | b << 1 | c << 2) as usize] {
                    let (part, beyond) = (usize::from(part), to_part(usize::from(part)) - distance);
                    assert!(beyond <= rounding, "{seed}, {level:?}, {lane}: {beyond} at {part}");
                    census.0[usize::from(part < 3)] += 1;
                }
                for edge in (0..3).filter(|&edge| features.beyond[edge] == 1) {
                    let to_edge = to_part(3 + edge);
                    assert!(
                        to_edge > distance + 4.0 * rounding,
                        "{seed}, {level:?}, {lane}: {to_edge} {distance} at {edge}"
                    );
                    census.0[2 + edge] += 1;
                }
            }
        }
    }

    #[test]
    fn a_nearest_point_lies_where_it_certainly_lies() {
        let (mut single, mut double) = (Census::default(), Census::default());
        for seed in 0..4000 {
            judge::<f32>(seed, &mut single);
            judge::<f64>(seed, &mut double);
        }
        for Census(seen) in [single, double] {
            assert!(seen.iter().all(|&count| count > 500), "{seen:?}");
        }
    }
}
