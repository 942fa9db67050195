//! A link and a triangle that meet, seen along a normal from the one to the other, and their contact points so far.
//!
//! Every point is a pair, one of the link and one of the triangle, `dist` apart along the normal. Points of the link
//! that coincide are one: the first.

use super::feature::SAME_POINT;
use super::link_triangle::face_normal;
use crate::ModifiedCylinder;
use parry3d_f64::math::{Real, Vector};
use parry3d_f64::shape::PackedFeatureId;

/// How far outside a triangle a point may be to count as above it, in barycentric coordinates: enough for
/// rounding, so that no point is lost between two triangles.
const ON_EDGE: Real = 1e-9;

/// A point of the link, the distance of the triangle's point from it along the normal, and the features that
/// they belong to.
pub(super) struct Point {
    pub on_link: Vector,
    pub dist: Real,
    pub of_link: PackedFeatureId,
    pub of_triangle: PackedFeatureId,
}

/// A link and a triangle, seen along the normal from one to the other.
pub(super) struct Meeting<'a> {
    pub link: &'a ModifiedCylinder,
    pub triangle: [Vector; 3],
    pub normal: Vector,
    /// The triangle's unit normal, if it has an area.
    face: Option<Vector>,
    /// Length and radius of the link.
    pub size: Real,
    pub points: Vec<Point>,
}

impl<'a> Meeting<'a> {
    pub fn new(link: &'a ModifiedCylinder, triangle: [Vector; 3], normal: Vector) -> Self {
        let size = link.length() + link.radius();
        Self { link, triangle, normal, face: face_normal(triangle), size, points: Vec::new() }
    }

    /// Adds a point of the link if the triangle's inside lies along the normal from it.
    pub fn add_above_face(&mut self, on_link: Vector, of_link: PackedFeatureId) {
        let Some(face) = self.face else { return };
        let [a, b, c] = self.triangle;
        let dist = (a - on_link).dot(face) / self.normal.dot(face);
        let foot = on_link + self.normal * dist;
        let area = (b - a).cross(c - a);
        let least = -ON_EDGE * area.length_squared();
        let is_inside = self.edges().into_iter().all(|(v, w)| (w - v).cross(foot - v).dot(area) >= least);
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
        let apart = SAME_POINT * self.size;
        let is_new = |point: &Point| (point.on_link - on_link).length() > apart;
        if dist.is_finite() && on_link.is_finite() && self.points.iter().all(is_new) {
            self.points.push(Point { on_link, dist, of_link, of_triangle });
        }
    }

    pub fn edges(&self) -> [(Vector, Vector); 3] {
        let [a, b, c] = self.triangle;
        [(a, b), (b, c), (c, a)]
    }
}
