//! One link, placed in the mesh's frame and ready to meet triangles.

use super::{LinkProximity, MeshError, ProximityError};
use crate::distance::{Axial, Closest, Convex, DiscSolver, Face, Link, Scalar, Vec3};
use crate::robot::{COORDINATE_LIMIT, Cap, Envelope, ModifiedCylinder};
use parry3d_f64::math::{Pose, Real, Vector};

/// What rounding can add to a bound: all scaled numbers are below 2.
pub(super) const SLACK: Real = 64.0 * f64::UNIT_ROUNDOFF;

/// A triangle and its closest points, in the probe's units.
#[derive(Clone, Copy)]
pub(crate) struct Found {
    pub triangle: u32,
    pub closest: Closest<f64>,
}

/// A link against which triangles of one mesh are measured.
///
/// Triangles are moved to the link's start and multiplied by a power of two that brings mesh and link near
/// one, so that the kernels neither overflow nor vanish and their rounding does not depend on the place.
/// Distances and bounds here are in these *scaled* units.
#[derive(Clone, Copy)]
pub(crate) struct Probe {
    start: Vector,
    end: Vector,
    scale: Real,
    link: Link<f64>,
    length: Real,
}

impl Probe {
    /// The link at `pose`, in the scale of [`scale_for`].
    pub(crate) fn new(link: &ModifiedCylinder, pose: &Pose, scale: Real) -> Self {
        let (start, end) = (pose * link.start(), pose * link.end());
        let flat = link.caps().map(|cap| cap == Cap::Flat);
        let local = to_vec3((end - start) * scale);
        Self { start, end, scale, length: local.norm(), link: Link::new(local, link.radius() * scale, flat) }
    }

    /// The ends of the axis, in the mesh's frame.
    pub(crate) fn ends(&self) -> [Vector; 2] {
        [self.start, self.end]
    }

    /// The link in scaled units, from its start.
    pub(crate) fn link(&self) -> &Link<f64> {
        &self.link
    }

    /// A length of the mesh's frame in scaled units.
    pub(crate) fn scaled(&self, length: Real) -> Real {
        length * self.scale
    }

    /// As [`beyond`], in the scale of this probe.
    pub(crate) fn beyond(&self, margin: Real) -> Real {
        beyond(margin, self.scale)
    }

    /// The closest points of the link and a triangle, in scaled units and from the link's start, if they are
    /// closer than `bound`. The cheaper bounds spare the flat caps.
    pub(crate) fn nearer_than(&self, bound: Real, triangle: [Vector; 3]) -> Option<Closest<f64>> {
        self.nearer_than_by::<Convex>(bound, triangle)
    }

    /// As [`Probe::nearer_than`], with the discs by the route `S`.
    pub(crate) fn nearer_than_by<S: DiscSolver<f64>>(
        &self,
        bound: Real,
        triangle: [Vector; 3],
    ) -> Option<Closest<f64>> {
        let vertices = self.local(triangle);
        if self.at_least(vertices) > bound {
            return None;
        }
        let face = Face::new(vertices);
        let axial = Axial::new(&self.link, &face);
        let closest = if !axial.beyond_flat_cap() {
            axial.without_caps(&self.link)
        } else if axial.cap_bounds(&self.link, &face).0 >= bound {
            return None;
        } else {
            axial.with_caps_by::<S>(&self.link, &face)
        };
        (closest.distance < bound).then(|| closest.met())
    }

    /// From the axis point nearest to `point` to that point.
    fn offset_from_axis(&self, point: Vec3<f64>) -> Vec3<f64> {
        let t = point.dot(self.link.axis).max(0.0).min(self.length);
        point.along(self.link.axis, -t)
    }

    /// A lower bound for a triangle in scaled units, by the plane of [`Probe::distance_to_box`].
    fn at_least(&self, [a, b, c]: [Vec3<f64>; 3]) -> Real {
        let centre = (a + b + c) * (1.0 / 3.0);
        let normal = self.offset_from_axis(centre);
        let beyond = normal.dot(a).min(normal.dot(b)).min(normal.dot(c)) - self.link.reach_along(normal);
        beyond.over(normal.norm()) - self.link.radius - SLACK
    }

    /// The closest points of the link and a triangle, in scaled units and from the link's start.
    pub(crate) fn closest(&self, triangle: [Vector; 3]) -> Closest<f64> {
        self.closest_by::<Convex>(triangle)
    }

    /// As [`Probe::closest`], with the discs by the route `S`.
    pub(crate) fn closest_by<S: DiscSolver<f64>>(&self, triangle: [Vector; 3]) -> Closest<f64> {
        let face = Face::new(self.local(triangle));
        let axial = Axial::new(&self.link, &face);
        let closest = if axial.beyond_flat_cap() {
            axial.with_caps_by::<S>(&self.link, &face)
        } else {
            axial.without_caps(&self.link)
        };
        closest.met()
    }

    fn local(&self, triangle: [Vector; 3]) -> [Vec3<f64>; 3] {
        triangle.map(|vertex| to_vec3((vertex - self.start) * self.scale))
    }

    /// A lower bound on the distance between the link and anything in the box, in scaled units, less what
    /// rounding may have added.
    ///
    /// With c the box's centre and v the way to it from the nearest axis point, the whole axis lies behind a plane
    /// with normal v before its ends, and the box beyond the one through its corner on that side. But for rounding
    /// the bound is |v| - <|v|, h> / |v| with h the half extents: off by about h^2 / |v|, next to nothing for a small
    /// box. It serves better than the distance between the boxes of link and node, which a slanted link fills
    /// badly.
    pub(crate) fn distance_to_box(&self, mins: Vector, maxs: Vector) -> Real {
        let half = (maxs - mins) * (0.5 * self.scale);
        let centre = to_vec3((mins - self.start) * self.scale + half);
        let to_centre = self.offset_from_axis(centre);
        let corner = half.dot(Vector::from_array(to_centre.into()).abs());
        let beyond = to_centre.dot(centre) - self.link.reach_along(to_centre) - corner;
        (beyond.over(to_centre.norm()) - self.link.radius - SLACK).max(0.0)
    }

    /// An answer in the mesh's frame.
    pub(crate) fn report(&self, link: usize, found: &Found) -> LinkProximity {
        let place = |point: Vec3<f64>| self.start + Vector::from_array(point.into()) / self.scale;
        LinkProximity {
            link: link as u32,
            triangle: found.triangle,
            distance: found.closest.distance / self.scale,
            on_robot: place(found.closest.point2),
            on_mesh: place(found.closest.point1),
        }
    }
}

/// Makes a probe of every link, all in the same scale. `mesh_reach` is the largest coordinate of the mesh.
///
/// # Errors
/// The pose is not finite or moves a link out of range.
pub(crate) fn place(
    links: &[ModifiedCylinder],
    pose: &Pose,
    mesh_reach: Real,
    probes: &mut Vec<Probe>,
) -> Result<(), ProximityError> {
    let scale = scale_for(links, None, pose, mesh_reach)?;
    probes.clear();
    probes.extend(links.iter().map(|link| Probe::new(link, pose, scale)));
    Ok(())
}

/// The power of two that brings mesh and robot near one. A capsule around all links spares looking at each.
///
/// # Errors
/// The pose is not finite or moves a link out of range.
pub(crate) fn scale_for(
    links: &[ModifiedCylinder],
    envelope: Option<&Envelope>,
    pose: &Pose,
    mesh_reach: Real,
) -> Result<Real, ProximityError> {
    if !pose.is_finite() {
        return Err(ProximityError::PoseNotFinite);
    }
    let mut reach = envelope.map_or(Real::INFINITY, |around| {
        reach_of(pose * around.start).max(reach_of(pose * around.end)) + around.radius
    });
    // Link by link where the capsule is out of range, or there is none.
    if reach.is_nan() || reach > COORDINATE_LIMIT {
        reach = 0.0;
        for (index, link) in links.iter().enumerate() {
            for point in [pose * link.start(), pose * link.end()] {
                // Written so that NaN is out of range too.
                if !point.to_array().iter().all(|value| value.abs() <= COORDINATE_LIMIT) {
                    return Err(ProximityError::OutOfRange { link: index, limit: COORDINATE_LIMIT });
                }
                reach = reach.max(reach_of(point)).max(link.radius());
            }
        }
    }
    Ok(reach.max(mesh_reach).power_of_two_to_unity())
}

/// What everything that is reported as at most `margin` away is nearer than, in scaled units.
pub(crate) fn beyond(margin: Real, scale: Real) -> Real {
    // A report among the subnormal numbers of the mesh's frame is rounded once more, by half the least of them.
    let rounding = if margin < Real::MIN_POSITIVE { 0.5 * (Real::from_bits(1) * scale) } else { 0.0 };
    (margin * scale + rounding).next_up()
}

/// The largest magnitude of a coordinate.
fn reach_of(point: Vector) -> Real {
    point.abs().max_element()
}

/// The largest magnitude of the vertices' coordinates.
pub(crate) fn check_vertices(vertices: &[Vector]) -> Result<Real, MeshError> {
    // Written so that NaN is out of range too.
    if !vertices.iter().all(|point| point.abs().cmple(Vector::splat(COORDINATE_LIMIT)).all()) {
        for (vertex, point) in vertices.iter().enumerate() {
            check_vertex(vertex, *point)?;
        }
    }
    Ok(vertices.iter().fold(Vector::ZERO, |reach, point| reach.max(point.abs())).max_element())
}

/// As [`check_vertices`], for the vertices of a mesh of `expected` that has moved.
pub(crate) fn check_moved(vertices: &[Vector], expected: usize) -> Result<Real, MeshError> {
    if vertices.len() != expected {
        return Err(MeshError::VertexCount { expected, got: vertices.len() });
    }
    check_vertices(vertices)
}

/// Whether a margin can be kept.
pub(crate) fn check_margin(margin: Real) -> Result<(), ProximityError> {
    if margin.is_nan() || margin < 0.0 { Err(ProximityError::BadMargin { margin }) } else { Ok(()) }
}

/// Whether a vertex can be used; `vertex` is its place in the mesh.
pub(crate) fn check_vertex(vertex: usize, point: Vector) -> Result<(), MeshError> {
    for value in point.to_array() {
        if !value.is_finite() {
            return Err(MeshError::NotFinite { vertex, value });
        }
        if value.abs() > COORDINATE_LIMIT {
            return Err(MeshError::OutOfRange { vertex, value, limit: COORDINATE_LIMIT });
        }
    }
    Ok(())
}

fn to_vec3(vector: Vector) -> Vec3<f64> {
    Vec3::from(vector.to_array())
}
