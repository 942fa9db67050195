//! The separation of a link and a triangle along one direction.
//!
//! ```text
//!      ________              /|
//!     |  link  |<-- gap --->/ | triangle      ---> n
//!     |________|            \ |
//!                            \|
//! ```
//!
//! # Definitions
//! For a unit vector `n`, `gap(n)` is the distance, along `n`, from the last point of the link to
//! the first point of the triangle. It is negative if the two overlap along `n`.
//!
//! # Claim
//! Moving the triangle by `-gap(n)` along `n` puts a plane between the two, for every `n`. So every
//! `n` gives
//! - a lower bound on the distance while the two are apart; the best `n` attains it;
//! - a separating translation if they overlap; the best `n` gives the least.

use super::direction::{perpendicular, unit, unit_across};
use super::separation;
use crate::distance::{Face, Link, Vec3};
use parry3d_f64::math::{Real, Vector};

/// A bound on the rounding of a distance or a gap, for numbers near one: 16 u.
/// `distance/touching.rs` measures 8 u, and adds as much where a small distance counts as 0.
pub(crate) const GAP_ROUNDING: Real = 8.0 * Real::EPSILON;

/// A gap must exceed the best one by this amount to replace it in the least translation.
const NO_GAIN: Real = 0.25 * GAP_ROUNDING;

/// A link and a triangle, relative to the link's start and near one.
#[derive(Clone, Copy)]
pub(crate) struct LinkTriangle {
    pub link: Link<Real>,
    pub triangle: [Vector; 3],
}

/// A direction and its gap.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Way {
    pub gap: Real,
    /// The unit vector from link to triangle.
    pub normal: Vector,
}

impl LinkTriangle {
    pub(crate) fn new(link: Link<Real>, triangle: [Vector; 3]) -> Self {
        // Without an axis there is no cap.
        let has_axis = link.axis != Vec3::zero(0.0);
        Self { link: Link { flat: link.flat.map(|flat| flat && has_axis), ..link }, triangle }
    }

    /// Returns the largest gap and its direction.
    ///
    /// The candidates are `more`, the normals of the features, and `more` made perpendicular to the
    /// edges and the axis. Returns early with the first gap that is at least `enough`, within
    /// rounding.
    pub(crate) fn widest_gap(&self, more: [Option<Vector>; 2], enough: Real) -> Way {
        let enough = enough - GAP_ROUNDING;
        let [a, b, c] = self.triangle;
        let edges = [b - a, c - b, a - c];
        let axis = Vector::from(self.link.axis);
        // A fallback: a direction across the axis or an edge.
        let across =
            perpendicular(unit(axis).or(edges.into_iter().find_map(unit)).unwrap_or(Vector::X));
        let mut best = Way { gap: Real::NEG_INFINITY, normal: across };
        // The first of equal gaps is kept, so `more` goes first.
        for n in more.into_iter().flatten() {
            best = self.wider(best, n);
        }
        if best.gap >= enough {
            return best;
        }
        let face = face_normal(self.triangle);
        for n in face.into_iter().flat_map(|n| [n, -n]) {
            best = self.wider(best, n);
        }
        if best.gap >= enough {
            return best;
        }
        let edges = edges.map(unit);
        let products = edges.iter().flatten().map(|edge| unit(edge.cross(axis)));
        let lines = [unit(axis), Some(across)].into_iter().chain(products).flatten();
        let straight = || edges.into_iter().chain([unit(axis)]).flatten();
        let turned = more
            .into_iter()
            .flatten()
            .flat_map(|n| straight().map(move |line| unit_across(n, line)));
        for n in turned.flatten().chain(lines.flat_map(|n| [n, -n])) {
            best = self.wider(best, n);
        }
        best
    }

    /// Returns `best`, or the best direction in which a least translation can lie.
    pub(crate) fn widest_of_all(&self, mut best: Way) -> Way {
        separation::directions(&self.link, self.triangle, |n| best = self.wider(best, n));
        best
    }

    /// Returns the least translation that separates the two, or the best separating plane if they
    /// are apart. `outward` points from the axis to the triangle, if known.
    ///
    /// Around the best direction the gap changes with the square of the angle: a direction that
    /// rounding has turned by 1e-8 may seem equally good or better. So the directions of the table
    /// go first, features before curves. Another direction replaces them only if it is better by
    /// more than rounding.
    pub(crate) fn least_translation(&self, outward: Option<Vector>) -> Way {
        let mut best: Option<Way> = None;
        let mut consider = |normal: Vector| {
            let gap = self.gap(normal);
            if best.is_none_or(|best| gap > best.gap + NO_GAIN) {
                best = Some(Way { gap, normal });
            }
        };
        face_normal(self.triangle).into_iter().flat_map(|n| [n, -n]).for_each(&mut consider);
        separation::directions(&self.link, self.triangle, &mut consider);
        let other = self.widest_gap([outward, None], Real::INFINITY);
        best.filter(|best| other.gap <= best.gap + NO_GAIN).unwrap_or(other)
    }

    /// Returns `best` or `normal`, whichever has the larger gap.
    fn wider(&self, best: Way, normal: Vector) -> Way {
        let gap = self.gap(normal);
        if gap > best.gap { Way { gap, normal } } else { best }
    }

    /// Returns `gap(n)`.
    pub(super) fn gap(&self, n: Vector) -> Real {
        let (centre, reach) = self.reach(n);
        let beyond = self.triangle.map(|vertex| (vertex - centre).dot(n));
        beyond[0].min(beyond[1]).min(beyond[2]) - reach
    }

    /// Returns the end of the axis that the link's farthest point along a unit vector belongs to,
    /// and how far this point lies beyond that end.
    fn reach(&self, n: Vector) -> (Vector, Real) {
        let Link { end, axis, radius, flat } = self.link;
        let axis = Vector::from(axis);
        let lean = axis.dot(n);
        let at_end = lean > 0.0;
        let share = if flat[usize::from(at_end)] { (n - axis * lean).length() } else { 1.0 };
        (if at_end { end.into() } else { Vector::ZERO }, share * radius)
    }
}

/// Returns the unit normal of a triangle with numbers near one, if it has one.
pub(crate) fn face_normal(triangle: [Vector; 3]) -> Option<Vector> {
    unit(Vector::from(Face::new(triangle.map(Vec3::from)).normal()))
}
