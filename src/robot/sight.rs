//! How far a chord may go: what a vertex sees of the stretch ahead through its vertices' gates.
//!
//! Let a chord from a vertex a to a later one t be admissible, and v a vertex in between that is
//! farther than the tolerance from a. Then the point c of the chord nearest to v is not a, and c,
//! being on the chord, lies in the direction of t. The angle between c - a and v - a is at most
//! asin(tolerance / |v - a|). So **t lies in a cone around v - a**, the *gate* of v, whatever the
//! stretch does in between, and however far away t is. Where the gates of two vertices have no
//! direction in common, no later vertex at all can be the end of a chord from a: these two are a
//! *wall*.
//!
//! The gates are narrowed down in coordinates: x along an axis, y in one of four directions across
//! it, 45 degrees apart. Let tau be the tolerance with room for rounding. The axis goes through the
//! first vertex at least 4 tau away. Its own gate keeps all slopes y / x of later targets within
//! tan(asin(1/4)), so that sqrt(1 + slope^2) <= 4 / sqrt(15). And for a vertex (x, y) with x > tau
//! and its nearest point (x', y') of the chord, x' > 0, and with s = y' / x' the chord's slope
//!
//! > |y - s x| = |(y - y') - s (x - x')| <= tau sqrt(1 + s^2), so that |s - y / x| <= (tau 4 /
//! > sqrt(15)) / x.
//!
//! Each direction keeps the interval of the slopes that are left. An empty one is a wall.
//!
//! Conversely, a chord passes a vertex (x, y, z) at the plane through it across the axis, if 0 < x
//! <= the target's x. It is within the tolerance there if its four slopes are within cos(22.5
//! degrees) tolerance / x of the vertex's: these make an octagon inside the disc. Vertices within
//! the tolerance of a are so of every chord. A target that all of these hold for needs no look at
//! the vertices, and one outside the first intervals neither. The two radii differ by 12 %, and for
//! an arc, whose chords deviate with the square of their length, the lengths that remain in
//! question by 6 %.
//!
//! # Rounding
//! Everything is scaled by the power of two that brings the extent of the stretch near one.
//! Coordinates, slopes times x and the comparisons of [`ChordTarget`](super::compare::ChordTarget)
//! are then all off by less than 2^-45. 2^-40 is added to the tolerance where it rules out and
//! taken from it where it admits.

use crate::distance::Scalar;
use parry3d_f64::math::{Real, Vector};

/// Room for rounding, where the extent of the stretch is less than two.
const SLACK: Real = Real::from_bits((1023 - 40) << 52);

/// Room for rounding of [`Sight::is_wall`]: the mean of two squares is no less than their roots'
/// product.
const ANGLE_SLACK: Real = Real::from_bits((1023 - 47) << 52);

/// 4 / sqrt(15), rounded up, and cos(22.5 degrees), rounded down.
const STEEPEST: Real = 1.032_795_559;
const OCTAGON: Real = 0.923_879_532;

/// A stretch, as it is looked at.
pub(super) struct Sight<'a> {
    stretch: &'a [Vector],
    scale: Real,
    /// The tolerance with room for rounding, either way; scaled.
    widened: Real,
    narrowed: Real,
}

/// A vertex that a chord from where we stand may reach.
pub(super) struct ChordTarget {
    pub(super) vertex: usize,
    /// Whether the chord is admissible; otherwise it is in question.
    pub(super) is_sure: bool,
}

/// Two vertices beyond which no chord goes that starts from where they are a wall, the farther one
/// last.
#[derive(Clone, Copy)]
pub(super) struct SightLimit(usize, usize);

impl SightLimit {
    /// Two vertices, the nearer one first, that are a wall if [`Sight::is_wall`] says so.
    pub(super) fn new(near: usize, far: usize) -> Self {
        Self(near, far)
    }

    /// The last vertex that a chord may reach.
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

    /// Fills `targets` with the open vertices that a chord from a vertex may reach, in order, and
    /// returns the wall behind the last, if there is one.
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

    /// Whether two vertices that are a wall to some vertex are one to this vertex too: whether the
    /// angle between them exceeds the sum of half their gates' angles a and b, or cos(angle) <
    /// cos(a + b), times both distances.
    ///
    /// Differences of coordinates are exact up to a share of 2^-53 of themselves, so that with
    /// distances of at least sqrt(2) tau either side is off by less than 2^-47 of the product
    /// of the distances.
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

/// A vertex seen from the origin: how far along the axis, and how far across it in four directions.
struct SeenVertex {
    along: Real,
    across: [Real; 4],
    distance_squared: Real,
}

/// The slopes that are left.
struct Gates {
    axes: [Vector; 3],
    low: [Real; 4],
    high: [Real; 4],
    /// The vertices whose gates end there.
    low_by: [usize; 4],
    high_by: [usize; 4],
    /// The slopes that are sure to pass, by a chord that reaches so far along the axis.
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

    /// Whether a chord to this place passes all gates for sure, or nothing if it does not.
    fn view(&self, place: &SeenVertex, widened: Real) -> Option<bool> {
        // The axis is at least 4 tau along, and its nearest point of the chord at least 3 tau.
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

    /// Takes away what does not pass the gate of a vertex; a wall, if nothing is left.
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
            // Within the tolerance of every chord.
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

    /// Two gates that just touch are no wall, and two that just do not are one.
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
