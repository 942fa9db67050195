//! The search for separating planes.
//!
//! One plane separates a group of triangles from a run of bodies, or the larger of both is halved
//! and each half is tried.
//!
//! - **Groups** are formed by a rule that the checker of a proof repeats. The first group contains
//!   all triangles. A group is halved in the order of its triangles' least coordinates, along the
//!   axis on which these coordinates spread most.
//! - **Candidate normals** ([`between_hulls`], [`between_pair`]) may be wrong: a plane counts only
//!   after it is shown to separate both.
//! - **The test** ([`ProofBody::is_below`]): whether a plane certainly has a body on one side.
//!
//! # Definitions
//! - q: the normal of a plane, of whole numbers below 2^53, so q is exact. |q|_1: the sum of the
//!   magnitudes of its coordinates.
//! - level: the least q . v over some vertices. m: the largest coordinate. r: the radius of a disc.
//!   w: the axis of the body.
//!
//! # Rounding
//! 1. The level and a height q . p err by 3 u |q|_1 m each. An end p that was moved along the axis
//!    errs by at most 18 u m: the way is at most 2 m long and errs by 8 u of itself.
//! 2. The reach of a ball or disc, and the free space around it, are sums and products of a few
//!    nonnegative numbers. They err by 12 u of themselves.
//! 3. For a disc, q x w is divided by |w|. It errs by 8 u |q| |w|, as w is rounded too, so the disc
//!    reaches farther by 8 u r |q|.
//! 4. Underflow is less than the least normal number times |q|_1.
//!
//! So a body is certainly below a plane if 32 u |q|_1 m and 16 u of each other term are added.

use crate::answer::LinkProximity;
use crate::distance::Scalar;
use crate::mesh::Mesh;
use crate::pair::{PlacedLink, PlacedPair, add_contacts};
use fearless_simd::Level;
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::query::gjk::{CsoPoint, GJKResult, VoronoiSimplex, closest_points};
use parry3d_f64::shape::SupportMap;
use std::ops::Range;

/// The bits of a plane's coordinates, tried in order: planes are written out, so few bits are
/// preferred.
const BITS: [u32; 4] = [7, 12, 22, 50];

/// A step of the proof, for its checker.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Step {
    /// Halve the triangles.
    Triangles,
    /// Halve the pieces.
    Pieces,
    /// Check that the plane separates both: q . x is less on the robot's side.
    Plane([i64; 3]),
}

/// A search for separating planes in one mesh.
pub(crate) struct PlaneSearch<'a> {
    level: Level,
    groups: Groups<'a>,
}

impl<'a> PlaneSearch<'a> {
    pub(crate) fn new(level: Level, mesh: &'a Mesh) -> Self {
        Self { level, groups: Groups::new(mesh) }
    }

    pub(crate) fn mesh(&self) -> &'a Mesh {
        self.groups.mesh
    }

    /// Returns the steps that separate all triangles from all bodies; `None` if a body is too near
    /// a triangle, or within rounding of that.
    pub(crate) fn steps(&mut self, bodies: &[ProofBody]) -> Option<Vec<Step>> {
        let mut steps = Vec::new();
        self.part(ALL, bodies, 0..bodies.len(), &mut steps).then_some(steps)
    }

    fn part(
        &mut self,
        group: usize,
        bodies: &[ProofBody],
        run: Range<usize>,
        steps: &mut Vec<Step>,
    ) -> bool {
        if let Some(plane) = self.plane(group, &bodies[run.clone()]) {
            steps.push(Step::Plane(plane));
            return true;
        }
        let (triangles, pieces) = (self.groups.get(group).triangles.len(), run.len());
        let [low, high] = self.groups.get(group).bounds;
        let is_larger = (high - low).length_squared() >= squared_diagonal(&bodies[run.clone()]);
        if triangles > 1 && (pieces == 1 || is_larger) {
            steps.push(Step::Triangles);
            let halves = self.groups.halves(group);
            return halves.into_iter().all(|half| self.part(half, bodies, run.clone(), steps));
        }
        if pieces > 1 {
            steps.push(Step::Pieces);
            let middle = run.start.midpoint(run.end);
            let halves = [run.start..middle, middle..run.end];
            return halves.into_iter().all(|half| self.part(group, bodies, half, steps));
        }
        false
    }

    /// Returns a plane that separates a group from a run of bodies.
    fn plane(&self, group: usize, bodies: &[ProofBody]) -> Option<[i64; 3]> {
        let wall = self.groups.get(group);
        let most = bodies.iter().flat_map(|body| body.ends).map(|end| end.abs().max_element());
        let most = most.fold(wall.reach(), Real::max);
        let separates = |q: Vector| {
            let offset = wall.offset(q);
            bodies.iter().all(|body| body.is_below(q, offset, most))
        };
        let try_along = |way: Vector| {
            BITS.iter().filter_map(|&bits| in_bits(way, bits)).find(|q| separates(*q))
        };
        let found = between_hulls(wall, bodies).and_then(try_along).or_else(|| {
            let (&[triangle], [body]) = (&*wall.triangles, bodies) else { return None };
            let ways = between_pair(self.level, self.groups.mesh, triangle, body);
            ways.into_iter().flatten().find_map(try_along)
        });
        found.map(|q| q.to_array().map(|number| number as i64))
    }
}

/// Returns a direction in whole numbers of at most `bits` bits.
fn in_bits(way: Vector, bits: u32) -> Option<Vector> {
    let largest = way.abs().max_element();
    let q = (way / largest * 2.0_f64.powi(bits as i32)).round();
    (largest > 0.0 && q.is_finite()).then_some(q)
}

/// Returns the squared diagonal of the bounding box of the bodies' ends.
fn squared_diagonal(bodies: &[ProofBody]) -> Real {
    let [low, high] = box_around(NOWHERE, bodies.iter().flat_map(|body| &body.ends));
    (high - low).length_squared()
}

/// The corners of a box that contains nothing.
const NOWHERE: [Vector; 2] = [Vector::INFINITY, Vector::NEG_INFINITY];

/// Returns the corners of a box, extended by points.
fn box_around<'a>(
    corners: [Vector; 2],
    points: impl IntoIterator<Item = &'a Vector>,
) -> [Vector; 2] {
    points.into_iter().fold(corners, |[low, high], point| [low.min(*point), high.max(*point)])
}

/// The groups of a mesh that the search has used.
struct Groups<'a> {
    mesh: &'a Mesh,
    /// The least coordinates of each triangle.
    low: Vec<[Real; 3]>,
    groups: Vec<Group>,
}

/// A set of triangles.
struct Group {
    triangles: Vec<u32>,
    /// Their vertices without duplicates.
    vertices: Vec<Vector>,
    /// The corners of their bounding box.
    bounds: [Vector; 2],
    halves: Option<[usize; 2]>,
}

/// The group of all triangles.
const ALL: usize = 0;

impl<'a> Groups<'a> {
    fn new(mesh: &'a Mesh) -> Self {
        let low = |triangle: u32| {
            let [a, b, c] = mesh.corners(triangle);
            // Maps -0 to 0.
            (a.min(b).min(c) + Vector::ZERO).to_array()
        };
        let all = 0..mesh.len() as u32;
        let mut groups = Self { mesh, low: all.clone().map(low).collect(), groups: Vec::new() };
        groups.add(all.collect());
        groups
    }

    fn get(&self, group: usize) -> &Group {
        &self.groups[group]
    }

    fn add(&mut self, triangles: Vec<u32>) -> usize {
        let indices = self.mesh.indices();
        let mut vertices: Vec<u32> =
            triangles.iter().flat_map(|&triangle| indices[triangle as usize]).collect();
        vertices.sort_unstable();
        vertices.dedup();
        let vertices: Vec<_> =
            vertices.iter().map(|&vertex| self.mesh.vertices()[vertex as usize]).collect();
        let bounds = box_around(NOWHERE, &vertices);
        self.groups.push(Group { triangles, vertices, bounds, halves: None });
        self.groups.len() - 1
    }

    /// Returns the two halves of a group of more than one triangle.
    fn halves(&mut self, group: usize) -> [usize; 2] {
        if let Some(halves) = self.groups[group].halves {
            return halves;
        }
        let mut triangles = self.groups[group].triangles.clone();
        let spread = |axis: usize| {
            let all = triangles.iter().map(|&triangle| self.low[triangle as usize][axis]);
            let (least, most) =
                all.fold((Real::INFINITY, Real::NEG_INFINITY), |(l, m), x| (l.min(x), m.max(x)));
            most - least
        };
        let spreads = [spread(0), spread(1), spread(2)];
        // Ties take the first axis.
        let axis =
            (1..3).fold(0, |axis, other| if spreads[other] > spreads[axis] { other } else { axis });
        let key = |triangle: &u32| self.low[*triangle as usize][axis];
        triangles.sort_unstable_by(|a, b| key(a).total_cmp(&key(b)).then(a.cmp(b)));
        let second = triangles.split_off(triangles.len() / 2);
        let halves = [self.add(triangles), self.add(second)];
        self.groups[group].halves = Some(halves);
        halves
    }
}

impl Group {
    /// Returns the largest magnitude of a coordinate.
    fn reach(&self) -> Real {
        self.bounds[0].abs().max(self.bounds[1].abs()).max_element()
    }

    /// Returns the least q . v over the vertices: the offset of the farthest plane q . x = offset
    /// behind which the bodies may lie.
    fn offset(&self, q: Vector) -> Real {
        self.vertices.iter().fold(Real::INFINITY, |offset, vertex| offset.min(q.dot(*vertex)))
    }
}

/// Points, translated and scaled to near 1.
struct PointSet<'a> {
    points: Vec<&'a Vector>,
    centre: Vector,
    scale: Real,
}

impl SupportMap for PointSet<'_> {
    fn local_support_point(&self, direction: Vector) -> Vector {
        let farther = |a: (Real, Vector), point: &&Vector| {
            let height = direction.dot(**point);
            if height > a.0 { (height, **point) } else { a }
        };
        let (_, point) = self.points.iter().fold((Real::NEG_INFINITY, self.centre), farther);
        (point - self.centre) * self.scale
    }
}

/// Returns the vector from the bodies' axes to the group's hull along their shortest distance
/// (parry's GJK); `None` if they touch.
fn between_hulls(group: &Group, bodies: &[ProofBody]) -> Option<Vector> {
    let ends = bodies.iter().flat_map(|body| &body.ends);
    let [low, high] = box_around(group.bounds, ends.clone());
    let size = (high - low).max_element();
    let scale = if size > 0.0 { 1.0 / size } else { 1.0 };
    let centre = 0.5 * low + 0.5 * high;
    let wall = PointSet { points: group.vertices.iter().collect(), centre, scale };
    let robot = PointSet { points: ends.collect(), centre, scale };
    let mut simplex = VoronoiSimplex::new();
    simplex.reset(CsoPoint::from_shapes(&Pose::IDENTITY, &robot, &wall, Vector::X));
    match closest_points(&Pose::IDENTITY, &robot, &wall, Real::MAX, true, &mut simplex) {
        GJKResult::ClosestPoints(on_robot, on_wall, _) => Some(on_wall - on_robot),
        _ => None,
    }
}

/// Returns candidate normals between a body and one triangle.
fn between_pair(level: Level, mesh: &Mesh, triangle: u32, body: &ProofBody) -> [Option<Vector>; 4] {
    let (corners, [start, end]) = (mesh.corners(triangle), body.ends);
    let link = PlacedLink::between(start, end, body.radius, body.flat);
    let answer: LinkProximity = link.answer(0, &link.measure(triangle, corners));
    let place = PlacedPair::new(&link, corners, 0.0);
    let mut contacts = Vec::new();
    add_contacts(level, &[answer], |_| place, &mut contacts);
    let from_features = contacts.first().and_then(|contact| contact.normal).map(|normal| -normal);
    let face = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    [from_features, Some(answer.witness.on_mesh - answer.witness.on_robot), Some(face), Some(-face)]
}

/// The convex hull of two ends, and the free space required around it.
///
/// An end is a disc perpendicular to the axis, or the half ball beyond that disc. If both ends
/// coincide, the body is a ball and both must be round.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ProofBody {
    pub ends: [Vector; 2],
    /// A vector along the line between the ends. The ends are rounded; discs are across this.
    pub axis: Vector,
    pub flat: [bool; 2],
    pub radius: Real,
    pub around: Real,
}

impl ProofBody {
    /// Whether the body and the free space around it certainly lie below the plane q . x = offset.
    /// `most` bounds the coordinates of the ends and of points on the plane.
    fn is_below(&self, q: Vector, offset: Real, most: Real) -> bool {
        let slack = 16.0 * f64::UNIT_ROUNDOFF;
        let (length, sum) = (q.length(), q.abs().element_sum());
        let axis = self.axis;
        if axis == Vector::ZERO && self.flat != [false; 2] {
            // The checker rejects a disc without a direction.
            return false;
        }
        let across = q.cross(axis).length() / axis.length();
        // Which ends face the plane. Without an axis both halves of the ball count.
        let out = [q.dot(axis) <= 0.0, q.dot(axis) >= 0.0];
        self.ends.iter().zip(self.flat).zip(out).all(|((end, flat), is_out)| {
            let is_disc = (flat || !is_out) && axis != Vector::ZERO;
            let reach = self.radius * if is_disc { across.min(length) } else { length };
            let needed =
                (reach + self.around * length) * (1.0 + slack) + self.radius * length * slack;
            let below = offset - q.dot(*end);
            below > needed + 2.0 * slack * sum * most + sum * Real::MIN_POSITIVE
        })
    }
}
