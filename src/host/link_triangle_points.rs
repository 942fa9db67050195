//! The contact points of a link and a triangle, seen along a normal from the link to the triangle.
//!
//! Every point is a pair, one of the link and one of the triangle, `dist` apart along the normal.
//! Coincident points of the link count as one: the nearest, and among equals the first. (If the
//! triangle is parallel to the normal, its near and its far edge lie over the same point of the
//! link.)

use super::feature::{self, SAME_POINT};
use super::link_triangle::face_normal;
use crate::robot::ModifiedCylinder;
use parry3d_f64::math::{Real, Vector};
use parry3d_f64::shape::PackedFeatureId;

/// How far outside a triangle a point may be to count as above it, in barycentric coordinates.
/// Covers rounding, so that no point is lost between two triangles.
const ON_EDGE: Real = 1e-9;

/// A triangle less high than this share of the largest coordinate is only a line: rounding decides
/// its normal, and nearly any point would count as above it. Its edges make its contacts, and they
/// are at most this far from its inside.
const FLAT: Real = 1e-9;

/// Rounding error of the distance of a pair, relative to the largest coordinate.
pub(super) const POINT_ROUNDING: Real = 64.0 * Real::EPSILON;

/// A point of the link, the distance of the triangle's point from it along the normal, and the
/// features of both.
pub(super) struct MeetingPoint {
    pub on_link: Vector,
    pub dist: Real,
    pub of_link: PackedFeatureId,
    pub of_triangle: PackedFeatureId,
}

/// A link and a triangle, seen along the normal from the link to the triangle.
pub(super) struct Meeting<'a> {
    pub link: &'a ModifiedCylinder,
    pub triangle: [Vector; 3],
    pub normal: Vector,
    /// The triangle's unit normal; `None` for a triangle that is only a line.
    face: Option<Vector>,
    /// Length and radius of the link.
    pub size: Real,
    /// Distances that differ by at most this are equal.
    pub rounding: Real,
    pub points: Vec<MeetingPoint>,
}

impl<'a> Meeting<'a> {
    /// For coordinates and a radius of at most `extent`.
    pub fn new(
        link: &'a ModifiedCylinder,
        triangle: [Vector; 3],
        normal: Vector,
        extent: Real,
    ) -> Self {
        let (size, rounding) = (link.length() + link.radius(), POINT_ROUNDING * extent);
        Self {
            link,
            triangle,
            normal,
            face: face_normal(triangle).filter(|_| height(triangle) > FLAT * extent),
            size,
            rounding,
            points: Vec::new(),
        }
    }

    /// Adds a point of the link if the normal line through it meets the triangle's inside.
    pub fn add_above_face(&mut self, on_link: Vector, of_link: PackedFeatureId) {
        let Some(face) = self.face else { return };
        let [a, b, c] = self.triangle;
        let dist = (a - on_link).dot(face) / self.normal.dot(face);
        let foot = on_link + self.normal * dist;
        let area = (b - a).cross(c - a);
        let least = -ON_EDGE * area.length_squared();
        let is_inside =
            self.edges().into_iter().all(|(v, w)| (w - v).cross(foot - v).dot(area) >= least);
        if is_inside {
            self.add(on_link, dist, of_link, PackedFeatureId::face(0));
        }
    }

    pub fn add(
        &mut self,
        on_link: Vector,
        dist: Real,
        of_link: PackedFeatureId,
        of_triangle: PackedFeatureId,
    ) {
        if !(dist.is_finite() && on_link.is_finite()) {
            return;
        }
        let (apart, point) =
            (SAME_POINT * self.size, MeetingPoint { on_link, dist, of_link, of_triangle });
        match self.points.iter_mut().find(|point| (point.on_link - on_link).length() <= apart) {
            Some(same) if dist < same.dist - self.rounding => *same = point,
            Some(_) => {}
            None => self.points.push(point),
        }
    }

    /// Adds the closest points, unless another point is almost as close. In that case the nearest
    /// such point gets their distance, so that a link at rest that vibrates slightly keeps its
    /// points and their names. No point is closer than the closest points; a point beside the
    /// triangle's edge may appear to be.
    ///
    /// The other points keep their distances bit for bit. Hosts select supporting points by
    /// distance: with equal distances they would select the first at every step and hold a lying
    /// body on one side.
    pub fn add_closest(&mut self, distance: Real, on_link: Vector) {
        let least = self.points.iter().map(|point| point.dist).fold(Real::INFINITY, Real::min);
        if least > distance + SAME_POINT * self.size {
            return self.add(on_link, distance, feature::BARREL.into(), PackedFeatureId::face(0));
        }
        let enough = least.max(distance);
        for point in self.points.iter_mut().filter(|point| point.dist <= enough) {
            point.dist = distance;
        }
    }

    pub fn edges(&self) -> [(Vector, Vector); 3] {
        let [a, b, c] = self.triangle;
        [(a, b), (b, c), (c, a)]
    }
}

/// Returns the height of a triangle above its longest edge.
fn height([a, b, c]: [Vector; 3]) -> Real {
    let longest = [b - a, c - b, a - c].map(Vector::length).into_iter().fold(0.0, Real::max);
    if longest > 0.0 { (b - a).cross(c - a).length() / longest } else { 0.0 }
}
