//! Bounds on the distance of the cross-sections of two parts that are an arc length apart.
//!
//! # Definitions
//! - Two parts with the places s in `[a, b]` and s' in `[a', b']`, and shares u, v in `[0, 1]`.
//! - **Domain**: the polygon of all (u, v) with s' - s >= `arc`: the unit square clipped by a line.
//! - D(u, v): the vector between both interpolations. It is affine, so its values over the domain
//!   are the convex polygon around its values D_i at the corners.
//! - n: any unit vector. `R(n)`: an upper bound on how far the discs of a part reach along n.
//!
//! # Lower bound
//! **Claim.** Each pair of cross-sections is at least min <n, D_i> - R(n) - R'(-n) - off - off'
//! apart.
//! **Proof.** The points of both differ by D, the radius vectors and the deviations. Take the
//! product with n. A linear function on the domain is least at a corner.
//!
//! Caps belong to the ends of a part. They are bounded by the corners with u = 0, u = 1, v = 0 or
//! v = 1, because a linear function on an edge of the domain is least at a corner too.
//!
//! # Choice of n
//! 1. The direction of the shortest D. For it, min <n, D_i> = |D|, because the D form a convex set.
//!    So the bound is exact for round links, whose nearest points lie along the shortest D, and for
//!    discs whose nearest points lie in the plane of n and both axes.
//! 2. The direction between the nearest points of the two cross-sections there.
//! 3. For two straight links ([`polish`]): the direction between the nearest points of both links,
//!    or of the two discs `arc` apart that are nearest. By strong duality this bound equals the
//!    distance.
//! 4. For two straight links, the sum of both directions too. If they nearly agree and D is as
//!    short as rounding, D has no direction.
//!
//! # Shortest D
//! If the shortest D of the unit square is in the domain, it is the shortest. Otherwise the
//! shortest is on the clipping line, because |D| is convex.
//!
//! # Nearest discs on the clipping line
//! Links are straight. So the set of all (q, p, p') with p and p' in the two discs at the place q
//! of the line is convex, and the least distance f(q) of two discs is a convex function. Its slope
//! is <n, dD/dq> for the direction n between the nearest points. [`polish`] bisects by its sign.

use super::parts::Part;
use crate::distance::{Vec3, disc_disc, segment_parameters};
use crate::pair::PlacedLink;
use crate::robot::share_along;
use parry3d_f64::math::{Real, Vector};

/// Trials on the clipping line: bisection of shares of 53 bits. The first trial is the place of the
/// shortest D, which is the place of the nearest discs if both turn alike.
const MOST_TRIALS: u32 = 54;

/// Two cross-sections with a small distance.
#[derive(Clone, Copy, Debug)]
pub(super) struct NearPlaces {
    pub distance: Real,
    pub shares: [Real; 2],
    pub points: [Vector; 2],
}

/// The domain of a pair.
struct Domain {
    corners: [[Real; 2]; 5],
    count: usize,
    /// The two corners on the clipping line, if it crosses the unit square.
    cut: [[Real; 2]; 2],
    is_cut: bool,
}

impl Domain {
    /// Clips the unit square; `None` if no place of `two` is `arc` beyond a place of `one`.
    fn new([one, two]: [&Part; 2], arc: Real) -> Option<Self> {
        let most = two.arcs[1] - one.arcs[0] - arc;
        if most < 0.0 {
            return None;
        }
        let [a, b] = [one.length(), two.length()];
        // s' - s - arc at the corners, by the differences of the near ends.
        let beyond = [
            two.arcs[0] - one.arcs[0] - arc,
            two.arcs[0] - one.arcs[1] - arc,
            two.arcs[1] - one.arcs[1] - arc,
            most,
        ];
        const SQUARE: [[Real; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let mut domain =
            Self { corners: [[0.0; 2]; 5], count: 0, cut: [[0.0; 2]; 2], is_cut: false };
        let mut cuts = 0;
        for k in 0..4 {
            let next = (k + 1) % 4;
            if beyond[k] >= 0.0 {
                domain.push(SQUARE[k]);
            }
            if (beyond[k] >= 0.0) != (beyond[next] >= 0.0) {
                // The edge's length is at least the difference of both values, and not 0.
                let along = (beyond[k] / if k % 2 == 0 { a } else { b }).abs().min(1.0);
                let [from, to] = [SQUARE[k], SQUARE[next]];
                let cut = [0, 1].map(|i| from[i] + (to[i] - from[i]) * along);
                domain.push(cut);
                domain.cut[cuts.min(1)] = cut;
                cuts += 1;
            }
        }
        domain.is_cut = cuts == 2;
        Some(domain)
    }

    fn push(&mut self, corner: [Real; 2]) {
        // A convex polygon with one clipped side has at most five corners.
        if let Some(place) = self.corners.get_mut(self.count) {
            *place = corner;
            self.count += 1;
        }
    }

    fn corners(&self) -> &[[Real; 2]] {
        &self.corners[..self.count]
    }

    /// Returns the shares of the shortest D, and D.
    fn shortest(&self, [one, two]: [&Part; 2], arc: Real) -> ([Real; 2], Vector) {
        let [e, f] = [one, two].map(|part| part.ends[1] - part.ends[0]);
        let between = |[u, v]: [Real; 2]| two.place(v) - one.place(u);
        let way = Vec3::from(one.ends[0] - two.ends[0]);
        let free = segment_parameters(way, Vec3::from(e), Vec3::from(f));
        let shares = [free.s, free.t];
        if !self.is_cut || two.arc(shares[1]) - one.arc(shares[0]) >= arc {
            return (shares, between(shares));
        }
        let [from, to] = self.cut.map(between);
        let shares = self.on_cut(share_along(-from, to - from));
        (shares, between(shares))
    }

    /// Returns the place at a share of the clipping line.
    fn on_cut(&self, share: Real) -> [Real; 2] {
        let [from, to] = self.cut;
        if share >= 1.0 { to } else { [0, 1].map(|k| from[k] + (to[k] - from[k]) * share) }
    }

    /// Returns the share of the clipping line that is nearest to a place.
    fn share_of_cut(&self, shares: [Real; 2]) -> Real {
        let [from, to] = self.cut;
        let along = [to[0] - from[0], to[1] - from[1]];
        let product = (shares[0] - from[0]) * along[0] + (shares[1] - from[1]) * along[1];
        let share = product / (along[0] * along[0] + along[1] * along[1]);
        // Without a length this is NaN; the comparison turns NaN into 0.
        if share > 0.0 { share.min(1.0) } else { 0.0 }
    }

    /// Returns the lower bound of the direction `n`.
    fn lower(&self, [one, two]: [&Part; 2], n: Vector) -> Real {
        let least = |is_there: &dyn Fn([Real; 2]) -> bool| {
            let corners = self.corners().iter().filter(|corner| is_there(**corner));
            let along = corners.map(|&[u, v]| n.dot(two.place(v) - one.place(u)));
            along.fold(Real::INFINITY, Real::min)
        };
        let reaches = [one.disc_reach(n), two.disc_reach(-n)];
        let mut lower = least(&|_| true) - reaches[0] - reaches[1];
        if one.has_caps() || two.has_caps() {
            // Discs and caps: the reach, and the share at which it applies.
            let sets = |part: &Part, reach: Real, n: Vector| {
                let cap = |end| part.cap_reach(end, n).map(|reach| (reach, Some(end as Real)));
                [Some((reach, None)), cap(0), cap(1)].into_iter().flatten()
            };
            let at = |share: Real, end: Option<Real>| end.is_none_or(|end| share == end);
            for (first, s) in sets(one, reaches[0], n) {
                for (second, t) in sets(two, reaches[1], -n) {
                    lower = lower.min(least(&|[u, v]| at(u, s) && at(v, t)) - first - second);
                }
            }
        }
        lower - one.off - two.off
    }
}

/// Returns a lower bound on the distance of a pair, and two near cross-sections if both are leaves
/// and the bound is below `enough`; `None` if no two places are `arc` apart.
pub(super) fn measure(
    parts: [&Part; 2],
    arc: Real,
    enough: Real,
) -> Option<(Real, Option<NearPlaces>)> {
    let domain = Domain::new(parts, arc)?;
    let (shares, between) = domain.shortest(parts, arc);
    let lower = domain.lower(parts, between.normalize_or_zero());
    if lower >= enough || !parts.iter().all(|part| part.is_leaf()) {
        return Some((lower, None));
    }
    let places = near_places(parts, shares);
    let [from, to] = places.points;
    let lower = lower.max(domain.lower(parts, (to - from).normalize_or_zero()));
    Some((lower, Some(places)))
}

/// Returns two points of the cross-sections at two shares, the nearest of the radii that reach
/// farthest along the vector between the centres.
pub(super) fn near_places([one, two]: [&Part; 2], shares: [Real; 2]) -> NearPlaces {
    let centres = [one.place(shares[0]), two.place(shares[1])];
    let n = (centres[1] - centres[0]).normalize_or_zero();
    let radii = [one.radius_towards(shares[0], n), two.radius_towards(shares[1], -n)];
    let way = Vec3::from(centres[0] - centres[1]);
    let nearest = segment_parameters(way, Vec3::from(radii[0]), Vec3::from(radii[1]));
    let points = [centres[0] + radii[0] * nearest.s, centres[1] + radii[1] * nearest.t];
    let error = one.error_of_radius() + two.error_of_radius();
    NearPlaces { distance: Vector::from(nearest.gap).length() + error, shares, points }
}

/// Returns a better lower bound than `lower` for two straight links, and two near cross-sections.
///
/// It ends once both differ by at most `slack`, or the lower bound is `enough`.
pub(super) fn polish(
    parts: [&Part; 2],
    arc: Real,
    slack: Real,
    [mut lower, enough]: [Real; 2],
) -> Option<(Real, NearPlaces)> {
    let domain = Domain::new(parts, arc)?;
    let [one, two] = parts;
    let (shares, _) = domain.shortest(parts, arc);
    let mut best = NearPlaces { distance: Real::INFINITY, shares, points: [Vector::ZERO; 2] };
    let mut offer = |distance: Real, shares: [Real; 2], points: [Vector; 2]| -> (bool, Vector) {
        let n = (points[1] - points[0]).normalize_or_zero();
        lower = lower.max(domain.lower(parts, n));
        if distance < best.distance {
            best = NearPlaces { distance, shares, points };
        }
        (lower + slack >= best.distance || lower >= enough, n)
    };
    let mut is_done = false;
    if domain.is_cut {
        let (mut low, mut high, mut trial) = (0.0, 1.0, domain.share_of_cut(shares));
        let [from, to] = domain.cut.map(|[u, v]| two.place(v) - one.place(u));
        let along = to - from;
        for _ in 0..MOST_TRIALS {
            let shares = domain.on_cut(trial);
            let (distance, points) = nearest_of_discs(parts, shares);
            let n;
            (is_done, n) = offer(distance, shares, points);
            if is_done {
                break;
            }
            if n.dot(along) > 0.0 {
                high = trial
            } else {
                low = trial
            }
            trial = 0.5 * (low + high);
        }
    }
    if !is_done {
        let whole = parts.map(|part| {
            let is_flat = part.caps.map(|cap| cap.is_none());
            PlacedLink::between(part.ends[0], part.ends[1], part.radius, is_flat)
        });
        let nearest = whole[0].measure_link(&whole[1]);
        let points = [nearest.on_first, nearest.on_second];
        let shares = [whole[0].share_of(points[0]), whole[1].share_of(points[1])];
        let is_beyond = !domain.is_cut || two.arc(shares[1]) - one.arc(shares[0]) >= arc;
        offer(if is_beyond { nearest.distance } else { Real::INFINITY }, shares, points);
        let bisector = (one.direction + two.direction).normalize_or_zero();
        lower = lower.max(domain.lower(parts, bisector));
    }
    Some((lower, best))
}

fn nearest_of_discs([one, two]: [&Part; 2], [u, v]: [Real; 2]) -> (Real, [Vector; 2]) {
    let centres = [one.place(u), two.place(v)];
    let nearest = disc_disc(
        Vec3::from(centres[0]),
        Vec3::from(one.direction),
        one.radius,
        Vec3::from(centres[1]),
        Vec3::from(two.direction),
        two.radius,
    );
    (nearest.distance, [nearest.point1, nearest.point2].map(Vector::from))
}
