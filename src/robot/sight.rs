//! How far chords from a vertex may reach: gates and walls.
//!
//! # Definitions
//! - `a`: the vertex where the chord starts. `t`: a later vertex where it ends. `v`: a vertex
//!   between them. Admissible: as in `simplify`.
//! - *Gate* of v, if v is farther than the tolerance from a: the cone of directions from a within
//!   the angle `asin(tolerance / |v - a|)` of `v - a`.
//! - *Wall*: two vertices whose gates have no direction in common.
//! - `tau`: the tolerance plus a margin for rounding.
//!
//! # Gates and walls
//! **Claim.** If the chord from a to t is admissible, `t - a` lies in the gate of every v. So no
//! chord from a ends behind a wall.
//!
//! **Proof.** Let c be the point of the chord nearest to v. Since `|v - a| > tolerance`, c is not
//! a, so `c - a` has the direction of `t - a`. As `|v - c| <= tolerance`, the angle between `c - a`
//! and `v - a` is at most `asin(tolerance / |v - a|)`. This holds for every shape of the run in
//! between and for every distance of t.
//!
//! # Slopes
//! Gates are intersected in coordinates: x along an axis, y in one of four directions across it, 45
//! degrees apart. The axis leads from a through the first vertex at least `4 tau` away. The gate of
//! that vertex keeps every slope `s = y / x` of a later target within `tan(asin(1/4))`, so
//! `sqrt(1 + s^2) <= 4 / sqrt(15)`.
//!
//! **Claim.** For a vertex (x, y) with `x > tau`, `|s - y / x| <= tau (4 / sqrt(15)) / x`.
//!
//! **Proof.** Let (x', y') be the point of the chord nearest to the vertex; `x' > 0`,
//! `s = y' / x'`. Then `|y - s x| = |(y - y') - s (x - x')| <= tau sqrt(1 + s^2)`.
//!
//! Each direction keeps the interval of the remaining slopes. An empty interval is a wall.
//!
//! # Certain targets
//! Conversely, consider the plane across the axis at a vertex (x, y, z) with `0 < x <=` the
//! target's x. The chord is within the tolerance there if its four slopes are within
//! `cos(22.5 degrees) tolerance / x` of the vertex's slopes: the four strips form an octagon inside
//! the disc. A vertex within the tolerance of a is within the tolerance of every chord from a.
//!
//! A target that meets these conditions for all vertices is admissible. A target outside the
//! intervals of the first kind is not. Only the others are compared with the vertices. The two
//! radii differ by 12 %. On an arc, where the deviation grows with the square of a chord's length,
//! 6 % of the lengths remain open.
//!
//! # Rounding
//! A power of two scales the extent of the run near one. Coordinates, slopes times x and the
//! comparisons of `ToleranceSegment` are then off by less than 2^-45. The tolerance is increased by
//! 2^-40 where it excludes, and reduced by 2^-40 where it admits.

use crate::distance::Scalar;
use parry3d_f64::math::{Real, Vector};

/// Margin for rounding, if the extent of the run is less than two.
const SLACK: Real = Real::from_bits((1023 - 40) << 52);

/// Margin for rounding in [`Sight::is_wall`], times the sum of the two squared distances, which is
/// at least twice their product.
const ANGLE_SLACK: Real = Real::from_bits((1023 - 47) << 52);

/// `4 / sqrt(15)`, rounded up, and `cos(22.5 degrees)`, rounded down.
const STEEPEST: Real = 1.032_795_559;
const OCTAGON: Real = 0.923_879_532;

/// A run, scaled for queries.
pub(super) struct Sight<'a> {
    stretch: &'a [Vector],
    scale: Real,
    /// The scaled tolerance, plus and minus the margin for rounding.
    widened: Real,
    narrowed: Real,
}

/// A vertex that a chord may reach.
pub(super) struct ChordTarget {
    pub(super) vertex: usize,
    /// Whether the chord is certainly admissible; otherwise it must be compared.
    pub(super) is_sure: bool,
}

/// A wall as seen from some vertex: the nearer vertex first, the farther one last.
#[derive(Clone, Copy)]
pub(super) struct SightLimit(usize, usize);

impl SightLimit {
    /// Two vertices, the nearer one first. [`Sight::is_wall`] decides whether they are a wall.
    pub(super) fn new(near: usize, far: usize) -> Self {
        Self(near, far)
    }

    /// Returns the last vertex that a chord may reach.
    pub(super) fn vertex(self) -> usize {
        self.1
    }
}

impl<'a> Sight<'a> {
    pub(super) fn new(stretch: &'a [Vector], tolerance: Real) -> Self {
        let (low, high) =
            stretch.iter().fold((Vector::INFINITY, Vector::NEG_INFINITY), |(low, high), &p| {
                (low.min(p), high.max(p))
            });
        let scale = (high - low).element_sum().power_of_two_to_unity();
        let tolerance = tolerance * scale;
        Self { stretch, scale, widened: tolerance + SLACK, narrowed: tolerance - SLACK }
    }

    /// Fills `targets` with the open vertices that a chord from `from` may reach, in order.
    ///
    /// Returns the wall that ended the walk, if there is one.
    pub(super) fn look(
        &self,
        from: usize,
        is_open: impl Fn(usize) -> bool,
        targets: &mut Vec<ChordTarget>,
    ) -> Option<SightLimit> {
        targets.clear();
        let least = 16.0 * self.widened * self.widened;
        let is_ahead = |vertex: &usize| self.between(from, *vertex).length_squared() >= least;
        let vertices = from + 1..self.stretch.len();
        let axis = vertices.clone().find(is_ahead);
        let unsure = from + 1..axis.map_or(vertices.end, |axis| axis + 1);
        targets.extend(
            unsure
                .clone()
                .filter(|&vertex| is_open(vertex))
                .map(|vertex| ChordTarget { vertex, is_sure: false }),
        );
        let mut gates = Gates::along(self.between(from, axis?));
        for vertex in unsure.clone() {
            let place = gates.place(self.between(from, vertex));
            if let Some(wall) = gates.narrow(vertex, &place, self) {
                return Some(wall);
            }
        }
        for vertex in unsure.end..vertices.end {
            let place = gates.place(self.between(from, vertex));
            if is_open(vertex)
                && let Some(is_sure) = gates.view(&place, self.widened)
            {
                targets.push(ChordTarget { vertex, is_sure });
            }
            if let Some(wall) = gates.narrow(vertex, &place, self) {
                return Some(wall);
            }
        }
        None
    }

    /// Returns whether the gates of two vertices are a wall as seen from `from`.
    ///
    /// Let p and q lead to the vertices, and let a and b be the half angles of their gates. The
    /// test is `angle(p, q) > a + b`, that is `p . q < |p| |q| cos(a + b)`.
    ///
    /// **Rounding.** Differences of coordinates are exact up to 2^-53 of themselves. With distances
    /// of at least `sqrt(2) tau` either side is off by less than 2^-47 of `|p| |q|`.
    pub(super) fn is_wall(&self, from: usize, SightLimit(near, far): SightLimit) -> bool {
        let room = self.widened * self.widened;
        let (p, q) = (self.between(from, near), self.between(from, far));
        let (p_squared, q_squared) = (p.length_squared(), q.length_squared());
        let cosine = ((p_squared - room) * (q_squared - room)).sqrt() - room;
        from < near
            && p_squared.min(q_squared) > 2.0 * room
            && p.dot(q) < cosine - ANGLE_SLACK * (p_squared + q_squared)
    }

    fn between(&self, from: usize, to: usize) -> Vector {
        (self.stretch[to] - self.stretch[from]) * self.scale
    }
}

/// A vertex relative to the start: x along the axis, y in the four directions across it.
struct SeenVertex {
    along: Real,
    across: [Real; 4],
    distance_squared: Real,
}

/// The intervals of slopes that remain.
struct Gates {
    axes: [Vector; 3],
    low: [Real; 4],
    high: [Real; 4],
    /// The vertices whose gates bound the intervals.
    low_by: [usize; 4],
    high_by: [usize; 4],
    /// The slopes that certainly pass, for a target at least `sure_from` along the axis.
    sure_low: [Real; 4],
    sure_high: [Real; 4],
    sure_from: Real,
}

impl Gates {
    fn along(axis: Vector) -> Self {
        let axis = axis.normalize();
        let (y, z) = axis.any_orthonormal_pair();
        Self {
            axes: [axis, y, z],
            low: [Real::NEG_INFINITY; 4],
            high: [Real::INFINITY; 4],
            low_by: [0; 4],
            high_by: [0; 4],
            sure_low: [Real::NEG_INFINITY; 4],
            sure_high: [Real::INFINITY; 4],
            sure_from: 0.0,
        }
    }

    fn place(&self, p: Vector) -> SeenVertex {
        let [along, y, z] = self.axes.map(|axis| axis.dot(p));
        let diagonals = [y + z, y - z].map(|sum| sum * std::f64::consts::FRAC_1_SQRT_2);
        SeenVertex {
            along,
            across: [y, z, diagonals[0], diagonals[1]],
            distance_squared: p.length_squared(),
        }
    }

    /// Returns whether a chord to `place` certainly passes all gates; `None` if it certainly fails.
    fn view(&self, place: &SeenVertex, widened: Real) -> Option<bool> {
        // The axis vertex is at least 4 tau along; its nearest point of the chord at least 3 tau.
        if place.along <= widened {
            return None;
        }
        let slopes = place.across.map(|across| across / place.along);
        let within = |low: &[Real; 4], high: &[Real; 4]| {
            (0..4).all(|k| low[k] <= slopes[k] && slopes[k] <= high[k])
        };
        let is_sure = || place.along >= self.sure_from && within(&self.sure_low, &self.sure_high);
        within(&self.low, &self.high).then(is_sure)
    }

    /// Narrows the intervals by the gate of a vertex. Returns a wall if an interval is empty.
    fn narrow(&mut self, vertex: usize, place: &SeenVertex, sight: &Sight) -> Option<SightLimit> {
        let shares = 1.0 / place.along;
        if place.along > sight.widened {
            let margin = sight.widened * STEEPEST * shares;
            for k in 0..4 {
                let slope = place.across[k] * shares;
                if slope - margin > self.low[k] {
                    (self.low[k], self.low_by[k]) = (slope - margin, vertex);
                }
                if slope + margin < self.high[k] {
                    (self.high[k], self.high_by[k]) = (slope + margin, vertex);
                }
                if self.low[k] > self.high[k] {
                    let by = [self.low_by[k], self.high_by[k]];
                    return Some(SightLimit(by[0].min(by[1]), by[0].max(by[1])));
                }
            }
        }
        let narrowed = sight.narrowed.max(0.0);
        if place.distance_squared <= narrowed * narrowed {
            // Within the tolerance of every chord from here.
        } else if narrowed > 0.0 && place.along > SLACK {
            let margin = narrowed * OCTAGON * shares;
            for k in 0..4 {
                let slope = place.across[k] * shares;
                self.sure_low[k] = self.sure_low[k].max(slope - margin);
                self.sure_high[k] = self.sure_high[k].min(slope + margin);
            }
            self.sure_from = self.sure_from.max(place.along);
        } else {
            self.sure_from = Real::INFINITY;
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two gates that barely touch are no wall; two that barely miss each other are.
    #[test]
    fn a_wall_is_where_two_gates_part() {
        for (near, far) in [(0.2, 0.9), (0.5, 0.51), (0.9, 0.3)] {
            for tolerance in [0.1, 1e-3, 1e-5] {
                for part in [-1e-3, 1e-3] {
                    let angle =
                        (Real::asin(tolerance / near) + Real::asin(tolerance / far)) * (1.0 + part);
                    let (sin, cos) = angle.sin_cos();
                    let far = Vector::new(0.6 * cos, sin, 0.8 * cos) * far;
                    let stretch = [Vector::ZERO, Vector::new(0.6, 0.0, 0.8) * near, far];
                    let wall = Sight::new(&stretch, tolerance).is_wall(0, SightLimit::new(1, 2));
                    assert_eq!(wall, part > 0.0, "{near} {far} {tolerance} {part}");
                }
            }
        }
    }
}
