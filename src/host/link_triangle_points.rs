//! A link and a triangle that meet, seen along a normal from the one to the other, and their
//! contact points so far.
//!
//! Every point is a pair, one of the link and one of the triangle, `dist` apart along the normal.
//! Points of the link that coincide are one: the nearest, and of equals the first. (Where the
//! triangle is parallel to the normal its near and its far edge lie over the same point of the
//! link.)

use super::feature::{self, SAME_POINT};
use super::link_triangle::face_normal;
use crate::robot::ModifiedCylinder;
use parry3d_f64::math::{Real, Vector};
use parry3d_f64::shape::PackedFeatureId;

/// How far outside a triangle a point may be to count as above it, in barycentric coordinates:
/// enough for rounding, so that no point is lost between two triangles.
const ON_EDGE: Real = 1e-9;

/// What rounding can do to the distance of a pair, as a share of the largest coordinate.
pub(super) const ROUNDING: Real = 64.0 * Real::EPSILON;

/// A point of the link, the distance of the triangle's point from it along the normal, and the
/// features that they belong to.
pub(super) struct MeetingPoint {
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
    /// Distances that differ by no more are equal.
    pub rounding: Real,
    pub points: Vec<MeetingPoint>,
}

impl<'a> Meeting<'a> {
    /// For coordinates and a radius that are at most `extent`.
    pub fn new(
        link: &'a ModifiedCylinder,
        triangle: [Vector; 3],
        normal: Vector,
        extent: Real,
    ) -> Self {
        let (size, rounding) = (link.length() + link.radius(), ROUNDING * extent);
        Self {
            link,
            triangle,
            normal,
            face: face_normal(triangle),
            size,
            rounding,
            points: Vec::new(),
        }
    }

    /// Adds a point of the link if the triangle's inside lies along the normal from it.
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

    /// Adds the closest points, unless one of the others is all but as close: then the nearest of
    /// these stands for them, with their distance, so that a link at rest which trembles a
    /// little keeps its points and their names. No point is closer than they are, which one may
    /// seem to be that lies beside the triangle's edge.
    ///
    /// The others keep their distances, to the last bit. Hosts choose by distance which points to
    /// hold a body with: made equal, the first would be chosen at every step, and what lies
    /// would be held on one side.
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
