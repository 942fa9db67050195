//! Points around what two flat caps that face one another have in common, seen along the contact's
//! normal.
//!
//! Along the normal `n` both discs cast ellipses onto the plane across it, and what these have in
//! common is convex. Let `x` be a place in that plane, seen from the first centre, and `c` the
//! second. Above it lie a point of each cap's plane,
//!
//! ```text
//! p = x - n (x . a1) / (n . a1),   q = x + n ((c - x) . a2) / (n . a2),
//! ```
//!
//! with the unit axes `a1` and `a2`, and `x` is in both ellipses where `|p| <= r1` and `|q - c| <=
//! r2`. Along a ray in the plane either is a quadratic equation. So every point here is on both
//! caps, and where a ray ends, on a rim:
//!
//! 1. **Four rays** from the middle of what the line between the centres has in common with both,
//!    in directions that stay where they are on the first link, so that a link at rest keeps its
//!    points.
//! 2. **Two rays along the rims' common chord**, where it is longer than what is left between them:
//!    the tips of a narrow lens.

use super::axial::{perpendicular, unit};
use super::feature;
use super::support_points::{centre, faces_flat, outward};
use crate::robot::ModifiedCylinder;
use parry3d_f64::math::{Real, Vector};
use parry3d_f64::shape::PackedFeatureId;

/// Of two discs that have more of the narrower one's width in common than this share, the four rays
/// show enough.
const NARROW: Real = 0.9;

/// Hands the points to `add`: on the first link, how far it is from there to the second along the
/// unit normal, and the names.
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
    // Seen along the normal, from the first centre.
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
    /// How far the cap's plane is from a place along the normal.
    fn height(&self, at: Vector, normal: Vector) -> Real {
        (self.centre - at).dot(self.axis) / normal.dot(self.axis)
    }

    /// The way in the cap's plane that is seen along the normal as `way`.
    fn along_normal(&self, way: Vector, normal: Vector) -> Vector {
        way - normal * (way.dot(self.axis) / normal.dot(self.axis))
    }

    /// How far a ray from a place leads until it leaves the disc as it is seen along the normal, if
    /// it starts within.
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
        // Without a difference of what is about as large.
        Some(if half > 0.0 { within / (root + half) } else { (root - half) / squared })
    }
}
