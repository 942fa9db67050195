//! The contact manifold of a link and a triangle: points that share the contact's normal.
//!
//! The normal is the contact's own (see [`link_contact`](super::link_contact)), led through the constraints
//! that a mesh or a chain puts on it. Every point is a pair, one on the link's surface and one on the
//! triangle, `dist` apart along the normal, exactly:
//!
//! 1. **The crest** of the barrel, and what of the edges is across or along it: see [`crest`](super::crest).
//! 2. **A round cap** counts with its one point furthest along the normal.
//! 3. **A flat cap** that leans towards the triangle counts with four points of its rim that stay where they
//!    are on the link, with the rim's crossings with the edges, and with the corners below the disc. The rim's
//!    lowest point, at the contact's own azimuth, is the end of the crest.
//! 4. **The closest points themselves**, if none of the others are as close: a corner against the barrel, an
//!    edge across a cap.
//!
//! Points that coincide are one. Where the nearest is within the prediction, all count, so that the host sees
//! what a fast link is about to reach. Tolerances are relative to the link, so the unit of length does not
//! matter. Nothing is kept from one call to the next but what the host stores with its points, which are
//! matched by feature.

use super::axial::perpendicular;
use super::dispatcher::as_link_and_triangle;
use super::link_contact::{Local, face_normal};
use super::{crest, feature};
use crate::{Cap, ModifiedCylinder};
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::query::details::{NormalConstraints, NormalConstraintsPair};
use parry3d_f64::query::{ContactManifold, TrackedContact, Unsupported};
use parry3d_f64::shape::{PackedFeatureId, Shape};

/// How far outside a triangle a point may be to count as above it, in barycentric coordinates: enough for
/// rounding, so that no point is lost between two triangles.
const ON_EDGE: Real = 1e-9;
/// Points of the link that are closer together than this share of its size are one.
pub(super) const SAME_POINT: Real = 1e-6;
/// The cosine between the normal and the axis from which a flat cap counts as facing the triangle.
const FACING: Real = 0.5;
/// How much deeper than the overlap a point may be where a constraint has turned the normal; as in parry.
const DEEPER: Real = 5.0;
/// A normal turned by more than this was turned by a constraint, not by rounding.
const TURNED: Real = 1e-9;

/// Brings the manifold up to date, if the shapes are a link and a triangle in either order. Returns whether they are.
///
/// # Errors
/// [`Unsupported`] for a triangle that is not finite, or out of range.
pub(super) fn update<M, C: Default + Copy>(
    pos12: &Pose,
    (g1, g2): (&dyn Shape, &dyn Shape),
    constraints: (Option<&dyn NormalConstraints>, Option<&dyn NormalConstraints>),
    prediction: Real,
    manifold: &mut ContactManifold<M, C>,
) -> Result<bool, Unsupported> {
    if as_link_and_triangle(g1, g2)?.is_none() {
        return Ok(false);
    }
    let (link, triangle, link_is_first) =
        match (g1.as_shape::<ModifiedCylinder>(), g2.as_shape::<ModifiedCylinder>()) {
            (Some(link), None) => (link, g2.as_triangle(), true),
            (None, Some(link)) => (link, g1.as_triangle(), false),
            _ => return Ok(false),
        };
    let Some(triangle) = triangle else { return Ok(false) };
    let to_link = |p| if link_is_first { pos12 * p } else { pos12.inverse_transform_point(p) };
    let to_triangle = |p| if link_is_first { pos12.inverse_transform_point(p) } else { pos12 * p };
    let local = Local::new(link, triangle.vertices().map(to_link)).ok_or(Unsupported)?;

    let before = std::mem::take(&mut manifold.points);
    let found = local.contact();
    if found.distance * local.unit > prediction {
        return Ok(true);
    }
    let rotation = pos12.rotation;
    let (mut n1, mut n2) = if link_is_first {
        (found.normal, rotation.inverse() * -found.normal)
    } else {
        (rotation * -found.normal, found.normal)
    };
    if !constraints.project_local_normals(pos12, &mut n1, &mut n2) {
        return Ok(true);
    }
    let normal = if link_is_first { n1 } else { n2 };
    let is_turned = (normal - found.normal).length() > TURNED;

    let mut meeting = Meeting::new(&local, if is_turned { normal } else { found.normal });
    meeting.collect();
    let size = meeting.size;
    if !is_turned {
        meeting.add_closest(found.distance, found.on_link);
    }
    let deepest = if is_turned { DEEPER * found.distance.min(0.0) } else { Real::NEG_INFINITY };
    for point in meeting.points.iter().filter(|point| point.dist >= deepest - SAME_POINT * size) {
        let on_link = local.origin + point.on_link * local.unit;
        let on_triangle = local.origin + (point.on_link + meeting.normal * point.dist) * local.unit;
        manifold.points.push(TrackedContact::flipped(
            on_link,
            to_triangle(on_triangle),
            point.of_link,
            point.of_triangle,
            point.dist * local.unit,
            !link_is_first,
        ));
    }
    (manifold.local_n1, manifold.local_n2) = (n1, n2);
    manifold.match_contacts(&before);
    Ok(true)
}

/// A point of the link, the distance of the triangle's point from it along the normal, and the features that
/// they belong to.
struct Point {
    on_link: Vector,
    dist: Real,
    of_link: PackedFeatureId,
    of_triangle: PackedFeatureId,
}

/// A link and a triangle, seen along the normal from one to the other.
pub(super) struct Meeting<'a> {
    pub link: &'a ModifiedCylinder,
    triangle: [Vector; 3],
    pub normal: Vector,
    /// The triangle's unit normal, if it has an area.
    face: Option<Vector>,
    /// Length and radius of the link.
    pub size: Real,
    points: Vec<Point>,
}

impl<'a> Meeting<'a> {
    fn new(local: &'a Local, normal: Vector) -> Self {
        let (link, triangle) = (&local.link, local.triangle);
        let size = link.length() + link.radius();
        Self { link, triangle, normal, face: face_normal(triangle), size, points: Vec::new() }
    }

    fn collect(&mut self) {
        for end in 0..2 {
            let outward = self.outward(end);
            match self.link.caps()[end] {
                Cap::Round if self.normal.dot(outward) >= 0.0 => {
                    let lowest = self.centre(end) + self.normal * self.link.radius();
                    self.add_above_face(lowest, crest_end(end));
                }
                Cap::Flat if self.normal.dot(outward) >= FACING => self.collect_disc(end, outward),
                _ => {}
            }
        }
        crest::collect(self);
    }

    /// Case 3.
    fn collect_disc(&mut self, end: usize, outward: Vector) {
        let (centre, radius) = (self.centre(end), self.link.radius());
        let normal = self.normal;
        let lean = normal.dot(outward);
        let first = perpendicular(self.link.axis());
        let second = self.link.axis().cross(first);
        for (corner, way) in [first, second, -first, -second].into_iter().enumerate() {
            let id = feature::SQUARE + (4 * end + corner) as u32;
            self.add_above_face(centre + way * radius, PackedFeatureId::vertex(id));
        }
        // A point of the triangle, taken along the normal to the disc's plane, from the centre.
        let height = |q: Vector| (q - centre).dot(outward) / lean;
        let on_plane = |q: Vector| q - centre - normal * height(q);
        for (corner, q) in self.triangle.into_iter().enumerate() {
            if on_plane(q).length() <= radius {
                let at = (centre + on_plane(q), height(q));
                self.add(at.0, at.1, feature::CAP[end].into(), PackedFeatureId::vertex(corner as u32));
            }
        }
        for (j, (v, w)) in self.edges().into_iter().enumerate() {
            let (from, way) = (on_plane(v), on_plane(w) - on_plane(v));
            let squared = way.length_squared();
            let middle = -from.dot(way) / squared;
            let gap = (from + way * middle).length();
            // Not for an edge that the normal runs along.
            if squared > 0.0 && gap < radius {
                let half = ((radius - gap) * (radius + gap) / squared).sqrt();
                for (share, id) in [(middle - half, RIM[end][0]), (middle + half, RIM[end][1])] {
                    if 0.0 < share && share < 1.0 {
                        let q = v.lerp(w, share);
                        let at = (centre + on_plane(q), height(q));
                        self.add(at.0, at.1, PackedFeatureId::edge(id), PackedFeatureId::edge(j as u32));
                    }
                }
            }
        }
    }

    /// Case 4.
    fn add_closest(&mut self, distance: Real, on_link: Vector) {
        let least = self.points.iter().map(|point| point.dist).fold(Real::INFINITY, Real::min);
        if least > distance + SAME_POINT * self.size {
            self.add(on_link, distance, feature::BARREL.into(), PackedFeatureId::face(0));
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

    pub fn centre(&self, end: usize) -> Vector {
        if end == 0 { self.link.start() } else { self.link.end() }
    }

    pub fn outward(&self, end: usize) -> Vector {
        if end == 0 { -self.link.axis() } else { self.link.axis() }
    }
}

/// The name of an end of the crest, or of a round cap's lowest point, which it is when the link lies.
pub(super) fn crest_end(end: usize) -> PackedFeatureId {
    PackedFeatureId::vertex(end as u32)
}

/// Names of the points where the rim at either end comes over an edge and leaves it.
const RIM: [[u32; 2]; 2] = [
    [feature::RIM_CROSSINGS, feature::RIM_CROSSINGS + 1],
    [feature::RIM_CROSSINGS + 2, feature::RIM_CROSSINGS + 3],
];
