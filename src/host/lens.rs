//! Points around the common region of two flat caps that face each other, seen along the contact's
//! normal.
//!
//! # Definitions
//! - `n`: the normal. `a1`, `a2`: the unit axes. `r1`, `r2`: the radii.
//! - `x`: a place in the plane across n, relative to the first centre. `c`: the second centre.
//!
//! Along n both discs project to ellipses in this plane; the intersection of the ellipses is
//! convex. On the normal line through x lies a point of each cap's plane:
//!
//! ```text
//! p = x - n (x . a1) / (n . a1),   q = x + n ((c - x) . a2) / (n . a2),
//! ```
//!
//! and x is in both ellipses if `|p| <= r1` and `|q - c| <= r2`. Along a ray in the plane each
//! condition is a quadratic inequality. So every point here lies on both caps, and the end of a ray
//! lies on a rim:
//!
//! 1. **Four rays** from the middle of the part of the line of centres that lies in both ellipses.
//!    Their directions are fixed on the first link, so a link at rest keeps its points.
//! 2. **Two rays along the rims' common chord**, if it is longer than the rest of the region: the
//!    tips of a narrow lens.

use super::axial::{perpendicular, unit};
use super::feature;
use super::support_points::{centre, faces_flat, outward};
use crate::robot::ModifiedCylinder;
use parry3d_f64::math::{Real, Vector};
use parry3d_f64::shape::PackedFeatureId;

/// If the discs share more than this part of the narrower one's width, the four rays suffice.
const NARROW: Real = 0.9;

/// Passes each point to `add`: the point on the first link, the distance to the second link along
/// the unit normal, and the names.
pub(super) fn collect(
    first: &ModifiedCylinder,
    second: &ModifiedCylinder,
    normal: Vector,
    mut add: impl FnMut(Vector, Real, [PackedFeatureId; 2]),
) {
    for end1 in (0..2).filter(|&end| faces_flat(first, normal, end)) {
        for end2 in (0..2).filter(|&end| faces_flat(second, -normal, end)) {
            let discs = [
                Disc {
                    centre: centre(first, end1),
                    axis: outward(first, end1),
                    radius: first.radius(),
                },
                Disc {
                    centre: centre(second, end2),
                    axis: outward(second, end2),
                    radius: second.radius(),
                },
            ];
            collect_between(&discs, normal, [end1, end2], &mut add);
        }
    }
}

fn collect_between(
    discs: &[Disc; 2],
    normal: Vector,
    [end1, end2]: [usize; 2],
    add: &mut impl FnMut(Vector, Real, [PackedFeatureId; 2]),
) {
    let [first, second] = discs;
    // Projected along the normal, relative to the first centre.
    let flattened = |v: Vector| v - normal * v.dot(normal);
    let apart = flattened(second.centre - first.centre);
    let directions = {
        let way = perpendicular(first.axis);
        [way, first.axis.cross(way), -way, -first.axis.cross(way)]
    };
    let along = unit(apart).or_else(|| unit(flattened(directions[0])));
    let Some(along) = along else { return };
    let between = apart.length();
    let [reach1, reach2] =
        discs.each_ref().map(|disc| disc.radius / disc.along_normal(along, normal).length());
    let (from, to) = ((-reach1).max(between - reach2), reach1.min(between + reach2));
    if from.is_nan() || to.is_nan() || from > to {
        return;
    }
    let mut add_end = |start: Vector, way: Vector, names: [PackedFeatureId; 2]| {
        let shares = discs.each_ref().map(|disc| disc.ray(start + first.centre, way, normal));
        let [Some(one), Some(other)] = shares else { return };
        let at = first.centre + start + way * one.min(other);
        let [on_first, on_second] = discs.each_ref().map(|disc| disc.height(at, normal));
        add(at + normal * on_first, on_second - on_first, names);
    };
    let middle = along * (0.5 * (from + to));
    for (corner, way) in directions.into_iter().enumerate() {
        let names = [feature::square_corner(end1, corner), feature::CAP[end2].into()];
        add_end(middle, flattened(way), names);
    }
    let narrower = reach1.min(reach2);
    if to - from < 2.0 * NARROW * narrower && between > (reach1 - reach2).abs() {
        let chord = along * (0.5 * (between + (reach1 - reach2) * (reach1 + reach2) / between));
        let way = normal.cross(along);
        for (way, name) in [way, -way].into_iter().zip(feature::RIM_ENDS[end1]) {
            add_end(chord, way, [PackedFeatureId::edge(name), feature::RIM[end2].into()]);
        }
    }
}

/// A flat cap.
struct Disc {
    centre: Vector,
    /// Unit vector out of the link.
    axis: Vector,
    radius: Real,
}

impl Disc {
    /// Returns the distance of the cap's plane from a place, along the normal.
    fn height(&self, at: Vector, normal: Vector) -> Real {
        (self.centre - at).dot(self.axis) / normal.dot(self.axis)
    }

    /// Returns the vector in the cap's plane whose projection along the normal is `way`.
    fn along_normal(&self, way: Vector, normal: Vector) -> Vector {
        way - normal * (way.dot(self.axis) / normal.dot(self.axis))
    }

    /// Returns the length of a ray until it leaves the disc's projection along the normal, if it
    /// starts inside.
    fn ray(&self, from: Vector, way: Vector, normal: Vector) -> Option<Real> {
        let (start, way) = (
            from + normal * self.height(from, normal) - self.centre,
            self.along_normal(way, normal),
        );
        let (squared, half) = (way.length_squared(), start.dot(way));
        let within = self.radius * self.radius - start.length_squared();
        if within < 0.0 || squared <= 0.0 {
            return None;
        }
        let root = (half * half + squared * within).sqrt();
        // Avoids the difference of two numbers of about equal size.
        Some(if half > 0.0 { within / (root + half) } else { (root - half) / squared })
    }
}
