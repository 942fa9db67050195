//! Certificates: proven bounds on the distance of a link and a triangle, in double-double
//! arithmetic; and the shapes in exact coordinates, which certificates of two links share.
//!
//! # Definitions
//! - **Upper bound**: the distance between a point of one shape and a point of the other, plus the
//!   distances of the points from their shapes.
//! - **Lower bound**: for a unit direction `n`, the least `<n, x>` over one shape minus the largest
//!   `<n, x>` over the other. A plane with the normal `n` separates the two by this amount.
//!
//! # Claim
//! Both bounds hold for all points and all `n`. A bad choice makes them wide, never wrong.
//!
//! **Proof.** [`ExactLink`] computes the least `<n, x>` and the distance from a point for the
//! numbers as given: a direction that is not exactly a unit vector, and a point that is rounded,
//! are valid arguments. [`CERTIFICATE_ROUNDING`] covers the rounding of the bounds.
//!
//! # Choice of points and direction
//! The narrow phase at twice the precision supplies the points and `n`. The rounding of `n` would
//! loosen the lower bound of links that nearly touch; here it is far below the precision of `f64`.
//! Where it is not, because two candidates are equally near, the normals of the features (faces,
//! edges, axis) are tried as well.

use super::answer_check::{check_ends, corners, link_of, placed_link, rigid_pose};
use crate::answer::{Certificate, LinkProximity, ProximityError};
use crate::distance::{DoubleDouble, Scalar, Vec3, gives_direction, single, triangle_disc};
use crate::mesh::check_vertex;
use crate::robot::{Chain, ModifiedCylinder, distance_to_segment};
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::shape::TriMesh;

impl Certificate {
    /// Returns proven bounds on the distance between a link at a pose and a triangle.
    ///
    /// - `link`: in the robot's frame. `pose`: of the robot in the mesh's frame.
    /// - `triangle`: the vertices in the mesh's frame.
    ///
    /// # Errors
    /// The pose is not finite or moves the link out of range, or a vertex is not finite or out of
    /// range.
    pub fn between(
        link: &ModifiedCylinder,
        pose: &Pose,
        triangle: [Vector; 3],
    ) -> Result<Self, ProximityError> {
        for (vertex, point) in triangle.into_iter().enumerate() {
            check_vertex(vertex, point)?;
        }
        Ok(CertifiedLink::new(link, pose, 0)?.bounds(triangle))
    }
}

impl LinkProximity {
    /// Returns proven bounds on the distance between this answer's link and triangle, rounding
    /// included.
    ///
    /// The bounds lie within a few units in the last place of each other, or of the problem's
    /// extent if link and triangle nearly touch. A link that penetrates has `lower` 0.
    ///
    /// Pass the same robot, pose and mesh as to the query. `mesh` may be any mesh with the same
    /// triangles; it need not be the engine's. If
    /// [`set_vertices`](crate::proximity::Proximity::set_vertices) moved the engine's mesh, build
    /// `mesh` from [`vertices`](crate::proximity::Proximity::vertices) and
    /// [`triangles`](crate::proximity::Proximity::triangles).
    ///
    /// # Errors
    /// - The answer's link or triangle does not exist.
    /// - The pose is not finite or moves the link out of range.
    /// - A vertex of the triangle is not finite or out of range.
    /// - The answer does not fit the two: it is about another robot, another pose, or a mesh that
    ///   has moved since.
    ///
    /// ```
    /// use parry_continuum::Chain;
    /// use parry_continuum::parry::{math::{Pose, Vector}, shape::TriMesh};
    /// use parry_continuum::proximity::{BvhSearch, Proximity};
    ///
    /// let wall =
    ///     [Vector::new(-9.0, -9.0, 3.0), Vector::new(9.0, -9.0, 3.0), Vector::new(0.0, 9.0, 3.1)];
    /// let mesh = TriMesh::new(wall.to_vec(), vec![[0, 1, 2]])?;
    /// let robot = Chain::from_centreline(&[Vector::ZERO, Vector::X], &[0.5])?;
    /// let closest = BvhSearch::new(&mesh)?.minimum(&robot, &Pose::IDENTITY)?;
    /// let proof = closest.certify(&robot, &Pose::IDENTITY, &mesh)?;
    /// assert!(proof.lower <= closest.distance && closest.distance <= proof.upper);
    /// assert!(proof.upper - proof.lower < 1e-15);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn certify(
        &self,
        robot: &Chain,
        pose: &Pose,
        mesh: &TriMesh,
    ) -> Result<Certificate, ProximityError> {
        let link = placed_link(self, robot, pose)?;
        let corners = corners(mesh.vertices(), mesh.indices(), self.witness.triangle as usize)?;
        let measured = link.measure(self.witness.triangle, corners);
        self.check_answer(&measured, || link, corners)?;
        Ok(self.certified(robot, pose)?.bounds(corners))
    }

    /// Returns proven bounds on the distance between this answer's link and the whole mesh: no
    /// other triangle is nearer than `lower`.
    ///
    /// The search visits every triangle, and measures those near the link at twice the precision.
    /// It takes far longer than the query.
    ///
    /// # Errors
    /// As for [`LinkProximity::certify`], for any vertex in use.
    pub fn certify_among_all(
        &self,
        robot: &Chain,
        pose: &Pose,
        mesh: &TriMesh,
    ) -> Result<Certificate, ProximityError> {
        let own = self.certify(robot, pose, mesh)?;
        let link = self.certified(robot, pose)?;
        let mut all = own;
        for triangle in 0..mesh.indices().len() {
            let triangle = corners(mesh.vertices(), mesh.indices(), triangle)?;
            if link.at_least(triangle) < own.lower {
                let other = link.bounds(triangle);
                all.lower = all.lower.min(other.lower);
                all.upper = all.upper.min(other.upper);
            }
        }
        Ok(all)
    }

    fn certified(&self, robot: &Chain, pose: &Pose) -> Result<CertifiedLink, ProximityError> {
        CertifiedLink::new(link_of(self, robot)?, pose, self.link as usize)
    }
}

impl CertifiedLink {
    /// Returns a lower bound by a sphere around the triangle, in `f64`.
    fn at_least(&self, [a, b, c]: [Vector; 3]) -> Real {
        let far = largest([self.start, self.end, a, b, c]).max(self.radius);
        let unit = far.power_of_two_to_unity();
        let [start, end, a, b, c] = [self.start, self.end, a, b, c].map(|point| point * unit);
        // Any centre is valid.
        let centre = a * 0.5 + (b * 0.25 + c * 0.25);
        let sphere = (a - centre).length().max((b - centre).length()).max((c - centre).length());
        let away = distance_to_segment(centre, start, end);
        // All numbers are below 8, and each results from a few roundings.
        (away - sphere - self.radius * unit - 64.0 * Real::EPSILON) / unit
    }

    fn bounds(&self, triangle: [Vector; 3]) -> Certificate {
        let [a, b, c] = triangle;
        let Some(frame) = ExactFrame::around(self.start, [self.end, a, b, c], self.radius) else {
            return Certificate { lower: 0.0, upper: 0.0 }; // one point
        };
        let pair = ExactLinkTriangle {
            triangle: triangle.map(|corner| frame.point(corner)),
            link: self.exact(&frame),
        };
        let (lower, upper) = pair.bounds();
        frame.certificate(lower, upper)
    }
}

/// A link and a triangle, in coordinates up to 2 relative to the link's start.
struct ExactLinkTriangle {
    triangle: [ExactPoint; 3],
    link: ExactLink,
}

impl ExactLinkTriangle {
    fn bounds(&self) -> (Number, Number) {
        let ExactLink { start, along, axis, radius, flat } = self.link;
        let closest = single::triangle_link(self.triangle, start, along, radius, flat);
        let between = (closest.point1 - closest.point2).norm();
        let off = self.triangle_to(closest.point1) + self.link.distance_to(closest.point2);
        // If two cases of the narrow phase tie, the direction of another candidate may be better.
        let discs = [start, along].map(|rim| triangle_disc(self.triangle, rim, axis, radius));
        let lower = [closest, discs[0], discs[1]]
            .map(|candidate| self.apart((candidate.point2 - candidate.point1).normalised()))
            .into_iter()
            .fold(Number::ZERO, Scalar::max);
        tightened(lower, between + off, || self.apart_by_features())
    }

    /// Returns the separations by planes whose normals come from features: the face, the axis and
    /// an edge, an edge and an end, the axis and a vertex.
    fn apart_by_features(&self) -> impl Iterator<Item = Number> {
        let [a, b, c] = self.triangle;
        let (axis, end) = (self.link.axis, self.link.along);
        let across = |direction: ExactPoint, from: ExactPoint| {
            let unit = direction.normalised();
            from - unit * unit.dot(from)
        };
        let edges = [(a, b), (b, c), (c, a)].into_iter().flat_map(move |(from, to)| {
            let edge = to - from;
            [axis.cross(edge), across(edge, from), across(edge, from - end)]
        });
        let vertices = self.triangle.map(|vertex| across(axis, vertex));
        let all = edges.chain(vertices).chain([(b - a).cross(c - a)]).map(Vec3::normalised);
        all.flat_map(|direction| [self.apart(direction), self.apart(-direction)])
    }

    /// Returns the separation by a plane with the normal `direction`, from triangle to link.
    fn apart(&self, direction: ExactPoint) -> Number {
        let [a, b, c] = self.triangle.map(|vertex| vertex.dot(direction));
        self.link.lowest(direction) - a.max(b).max(c)
    }

    /// Returns an upper bound on the distance of `point` from the triangle.
    fn triangle_to(&self, point: ExactPoint) -> Number {
        let [a, b, c] = self.triangle;
        let on_edge = |from: ExactPoint, to: ExactPoint| {
            let edge = to - from;
            let squared = edge.norm_squared();
            let t = edge.dot(point - from).max(Number::ZERO).min(squared).over(squared);
            (point - from - edge * t).norm()
        };
        let edges = on_edge(a, b).min(on_edge(b, c)).min(on_edge(c, a));
        // Non-negative weights give a point of the triangle, also if they are rounded.
        let normal = (b - a).cross(c - a);
        let area = |p: ExactPoint, q: ExactPoint| {
            normal.dot((p - point).cross(q - point)).max(Number::ZERO)
        };
        let (u, v, w) = (area(b, c), area(c, a), area(a, b));
        let sum = u + v + w;
        if sum.le(Number::ZERO) {
            return edges;
        }
        let inside = a * u.over(sum) + b * v.over(sum) + c * w.over(sum);
        edges.min((point - inside).norm())
    }
}

/// Returns the bounds, widened by rounding. If they are more than 4 u of the extent apart, the best
/// separation by a feature raises `lower` first: the difference of points that nearly touch is less
/// precise than the directions of their features.
pub(super) fn tightened<I: Iterator<Item = Number>>(
    lower: Number,
    upper: Number,
    by_features: impl FnOnce() -> I,
) -> (Number, Number) {
    let is_tight = (upper - lower).le((2.0 * f64::EPSILON).into());
    let lower = if is_tight { lower } else { by_features().fold(lower, Scalar::max) };
    (lower - CERTIFICATE_ROUNDING.into(), upper + CERTIFICATE_ROUNDING.into())
}

pub(super) type Number = DoubleDouble;
pub(super) type ExactPoint = Vec3<DoubleDouble>;

/// The largest rounding error of any bound of a certificate, where no coordinate exceeds 2: a
/// hundred operations, each wrong by 2^-102 of numbers below 16, plus underflow.
pub(super) const CERTIFICATE_ROUNDING: f64 = f64::from_bits((1023 - 88) << 52);

/// Returns the largest magnitude of a coordinate.
pub(super) fn largest<const N: usize>(points: [Vector; N]) -> Real {
    points.iter().map(|point| point.abs().max_element()).fold(0.0, Real::max)
}

/// A pair's own coordinates, in which differences are exact and the largest is near one.
#[derive(Clone, Copy)]
pub(super) struct ExactFrame {
    origin: Vector,
    coarse: Real,
    fine: Real,
}

impl ExactFrame {
    /// Returns the frame at `origin`, in which no coordinate and no radius exceeds 2; `None` if all
    /// points coincide.
    pub(super) fn around<const N: usize>(
        origin: Vector,
        points: [Vector; N],
        radius: Real,
    ) -> Option<Self> {
        // Relative to the origin every coordinate is an exact double-double, and the largest is
        // brought near one. Small numbers beside large coordinates must not underflow first, so
        // `coarse` is at least 1.
        let far = largest(points).max(largest([origin])).max(radius);
        let coarse = far.power_of_two_to_unity().max(1.0);
        let extent =
            largest(points.map(|point| point * coarse - origin * coarse)).max(radius * coarse);
        (extent > 0.0).then(|| Self { origin, coarse, fine: extent.power_of_two_to_unity() })
    }

    pub(super) fn point(&self, point: Vector) -> ExactPoint {
        self.way(self.origin, point)
    }

    /// Returns the vector from one point to another, exactly.
    fn way(&self, from: Vector, to: Vector) -> ExactPoint {
        let (from, to) = ((from * self.coarse).to_array(), (to * self.coarse).to_array());
        let along = |axis: usize| (Number::from(to[axis]) - from[axis].into()) * self.fine.into();
        Vec3::new(along(0), along(1), along(2))
    }

    fn length(&self, length: Real) -> Number {
        Number::from(length * self.coarse) * self.fine.into()
    }

    /// Returns bounds of this frame in the caller's unit, widened by one number for the rounding to
    /// `f64` and back to that unit.
    pub(super) fn certificate(&self, lower: Number, upper: Number) -> Certificate {
        let back = |bound: Number| bound.rounded() / self.fine / self.coarse;
        Certificate { lower: back(lower).next_down().max(0.0), upper: back(upper).next_up() }
    }
}

/// A link in `f64`, in the frame in which two shapes are compared.
pub(super) struct CertifiedLink {
    pub start: Vector,
    pub end: Vector,
    pub radius: Real,
    pub flat: [bool; 2],
}

impl CertifiedLink {
    /// Returns the link at `pose`. `number` is its position in its chain.
    pub(super) fn new(
        link: &ModifiedCylinder,
        pose: &Pose,
        number: usize,
    ) -> Result<Self, ProximityError> {
        let link = link.transformed(&rigid_pose(pose)?);
        let (start, end) = (link.start(), link.end());
        check_ends(number, [start, end])?;
        Ok(Self { start, end, radius: link.radius(), flat: link.flat() })
    }

    /// Returns the link in exact coordinates.
    pub(super) fn exact(&self, frame: &ExactFrame) -> ExactLink {
        let along = frame.way(self.start, self.end);
        // As in the narrow phase, a length whose square underflows beside the other shape gives no
        // direction.
        let squared =
            Vec3::new(along.x.rounded(), along.y.rounded(), along.z.rounded()).norm_squared();
        let zero = Vec3::new(Number::ZERO, Number::ZERO, Number::ZERO);
        let axis = if gives_direction(squared) { along.normalised() } else { zero };
        let start = frame.point(self.start);
        ExactLink { start, along, axis, radius: frame.length(self.radius), flat: self.flat }
    }
}

/// A link in coordinates up to 2.
#[derive(Clone, Copy)]
pub(super) struct ExactLink {
    pub start: ExactPoint,
    /// The vector from start to end.
    pub along: ExactPoint,
    /// The unit direction, or zero if it has none.
    pub axis: ExactPoint,
    pub radius: Number,
    pub flat: [bool; 2],
}

impl ExactLink {
    pub(super) fn end(&self) -> ExactPoint {
        self.start + self.along
    }

    /// Returns a lower bound on `<direction, x>` over the link.
    pub(super) fn lowest(&self, direction: ExactPoint) -> Number {
        let along = direction.dot(self.axis);
        let across = (direction - self.axis * along).norm() * self.radius;
        let lowest = |height: Number, inward: Number, flat: bool| {
            // A round cap extends by its ball in directions from beyond its end, otherwise only by
            // its rim.
            height
                - if flat || inward.lt((-CERTIFICATE_ROUNDING).into()) {
                    across
                } else {
                    self.radius
                }
        };
        let start = lowest(self.start.dot(direction), along, self.flat[0]);
        start.min(lowest(self.end().dot(direction), -along, self.flat[1]))
    }

    /// Returns an upper bound on the distance of `point` from the link.
    pub(super) fn distance_to(&self, point: ExactPoint) -> Number {
        let zero = Number::ZERO;
        let from_start = point - self.start;
        let from_end = from_start - self.along;
        let along = from_start.dot(self.axis);
        let (above, below) = (from_end.dot(self.axis), -along);
        let radial = (from_start - self.axis * along).norm();
        let beside = (radial - self.radius).max(zero);
        let (beyond, from, flat) = if zero.lt(above) {
            (above, from_end, self.flat[1])
        } else {
            (below, from_start, self.flat[0])
        };
        if !zero.lt(beyond) {
            beside
        } else if flat {
            (beyond * beyond + beside * beside).sqrt()
        } else {
            (from.norm() - self.radius).max(zero)
        }
    }
}
