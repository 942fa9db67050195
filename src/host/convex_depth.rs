//! The least translation that separates a link from another convex shape of parry that it overlaps.
//!
//! parry's EPA gives one candidate. The other candidates are the normals at which the features of
//! the shapes allow a least translation, as for a [link and a triangle](crate::distance::depth):
//!
//! 1. the normals of the shape's faces, the link's axis, and the directions perpendicular to the
//!    axis and an edge;
//! 2. for the foremost corner along the best candidate of 1, and its edges: the directions to the
//!    axis, to the centres of round caps and to rims.
//!
//! Two support points measure each candidate, so the resulting translation always separates. A
//! shape with round parts of its own has a continuum of faces. For such a shape only EPA's answer
//! and the axes are tried.

use super::axial::{perpendicular, unit, unit_across};
use super::convex::ConvexPair;
use crate::distance::depth::across_rim;
use crate::robot::ModifiedCylinder;
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::query::{Contact, PointQuery, QueryDispatcher};
use parry3d_f64::shape::{ConvexPolyhedron, Shape, SupportMap, TypedShape};

/// Most searches for the foremost corner.
const ROUNDS: usize = 3;
/// Most projections from one shape to the other when searching the touching point.
const PROJECTIONS: usize = 8;
/// The search ends if the point moves by less than this share of the link's size.
const SETTLED: Real = 1e-9;
/// Normals whose angle has at least this cosine touch at one place.
const SAME_NORMAL: Real = 1.0 - 1e-10;
/// Rounding margin for the range of normals of an edge.
const ROUNDING: Real = 64.0 * Real::EPSILON;

/// The link and the other shape, in the frame of the pair.
struct PlacedConvex<'a> {
    link: ModifiedCylinder,
    axis: Option<Vector>,
    other: &'a dyn Shape,
    pose: Pose,
}

/// A gap and its normal, out of the first shape.
type Gap = (Real, Vector);

impl<L: QueryDispatcher> ConvexPair<'_, L> {
    /// Returns the contact with the least separating translation, if `contact` is an overlap.
    pub(super) fn shallowest(&self, contact: Contact) -> Contact {
        if contact.dist > 0.0 {
            return contact;
        }
        let (link, other, pose) = if self.link_is_first {
            (*self.link, self.shapes[1], *self.pos12)
        } else {
            (self.link.transformed(self.pos12), self.shapes[0], Pose::IDENTITY)
        };
        let placed = PlacedConvex { link, axis: unit(link.end() - link.start()), other, pose };
        let found = (self.gap(contact.normal1), contact.normal1);
        let mut best = found;
        let mut consider = |n: Vector| best = self.wider(best, n);
        placed.faces_and_products(&mut consider);
        for _ in 0..ROUNDS {
            let before = best;
            // Out of the link.
            let out = if self.link_is_first { before.1 } else { -before.1 };
            placed.around_corner(out, &mut |n| best = self.wider(best, n));
            if best.0 <= before.0 {
                break;
            }
        }
        let near = if best.1.dot(found.1) > SAME_NORMAL {
            contact.point1
        } else {
            self.touching(&placed, best)
        };
        self.report(best, near)
    }

    fn wider(&self, best: Gap, normal: Vector) -> Gap {
        let gap = self.gap(normal);
        if gap > best.0 { (gap, normal) } else { best }
    }

    /// Returns the point of the link that touches the other shape once they are moved apart, by
    /// alternating projections.
    fn touching(&self, placed: &PlacedConvex, (gap, normal): Gap) -> Vector {
        // The other shape is moved away from the link.
        let (out, toward_second) =
            if self.link_is_first { (normal, Vector::ZERO) } else { (-normal, normal * gap) };
        let apart = Pose::from_translation(-out * gap) * placed.pose;
        let middle = 0.5 * placed.link.start() + 0.5 * placed.link.end();
        let mut on_link = middle;
        for _ in 0..PROJECTIONS {
            let on_other = placed.other.project_point(&apart, on_link, true).point;
            let next = placed.link.project_local_point(on_other, true).point;
            let moved = (next - on_link).length();
            on_link = next;
            if moved <= SETTLED * (placed.link.length() + placed.link.radius()) {
                break;
            }
        }
        on_link - toward_second
    }

    /// Returns the contact near a point. Its points lie on the planes that bound the gap.
    fn report(&self, (gap, normal): Gap, near: Vector) -> Contact {
        let begin = self.support(0, normal).dot(normal);
        let onto = |height: Real| near + normal * (height - near.dot(normal));
        let (point1, point2) = (onto(begin), self.pos12.inverse_transform_point(onto(begin + gap)));
        let normal2 = self.pos12.rotation.inverse() * -normal;
        Contact::new(point1, point2, normal, normal2, gap)
    }
}

impl PlacedConvex<'_> {
    /// Candidates 1: the normals of the other shape's faces, the link's axis, and the directions
    /// perpendicular to the axis and an edge.
    fn faces_and_products(&self, consider: &mut impl FnMut(Vector)) {
        let rotation = self.pose.rotation;
        let axis = self.axis;
        let mut both_ways = |n: Option<Vector>| {
            if let Some(n) = n {
                consider(n);
                consider(-n);
            }
        };
        both_ways(axis);
        both_ways(axis.map(perpendicular));
        let product = |edge: Vector| axis.and_then(|axis| unit_across(edge.cross(axis), edge));
        match self.core() {
            TypedShape::Cuboid(_) => {
                for direction in Vector::AXES.map(|direction| rotation * direction) {
                    both_ways(Some(direction));
                    both_ways(product(direction));
                }
            }
            TypedShape::ConvexPolyhedron(hull) => {
                for face in hull.faces() {
                    both_ways(unit(rotation * face.normal));
                }
                for edge in hull.edges() {
                    let Some(direction) = unit(rotation * edge.dir) else { continue };
                    let normal = product(direction);
                    let faces =
                        edge.faces.map(|face| rotation * hull.faces()[face as usize].normal);
                    if normal.is_some_and(|n| is_between(n, faces, direction)) {
                        both_ways(normal);
                    }
                }
            }
            _ => {
                // parry's round shapes have the y axis.
                let own = rotation * Vector::Y;
                both_ways(unit(own));
                both_ways(product(own));
                let between = self.pose.translation - self.link.start();
                both_ways(unit_across(between, own));
                both_ways(axis.and_then(|axis| unit_across(between, axis)));
            }
        }
    }

    /// Candidates 2: the normals of the foremost corner against `out`, which points out of the
    /// link.
    fn around_corner(&self, out: Vector, consider: &mut impl FnMut(Vector)) {
        let Some(corner) = self.corner_toward(-out) else { return };
        let mut both_ways = |n: Option<Vector>| {
            if let Some(n) = n {
                consider(n);
                consider(-n);
            }
        };
        let mut edges = [Vector::ZERO; MAX_EDGES];
        let count = self.edges_at(corner, &mut edges);
        let edges = &edges[..count];
        let link = &self.link;
        let from_axis =
            |axis| unit_across(corner - link.start(), axis).unwrap_or_else(|| perpendicular(axis));
        both_ways(self.axis.map(from_axis));
        for (end, centre) in [link.start(), link.end()].into_iter().enumerate() {
            let offset = corner - centre;
            let outward = self.axis.map(|axis| if end == 0 { -axis } else { axis });
            match outward.filter(|_| link.flat()[end]) {
                None => {
                    both_ways(unit(offset));
                    edges.iter().for_each(|&edge| both_ways(unit_across(offset, edge)));
                }
                Some(way) => edges
                    .iter()
                    .for_each(|&edge| both_ways(across_rim(way, link.radius(), offset, edge))),
            }
        }
    }

    /// Returns the foremost corner along a unit vector, without the border of a round shape.
    fn corner_toward(&self, way: Vector) -> Option<Vector> {
        Some(match self.core() {
            TypedShape::Cuboid(cuboid) => cuboid.support_point_toward(&self.pose, way),
            TypedShape::ConvexPolyhedron(hull) => hull.support_point_toward(&self.pose, way),
            _ => self.other.as_support_map()?.support_point_toward(&self.pose, way),
        })
    }

    /// Writes the unit directions of the edges at a corner and returns their number.
    fn edges_at(&self, corner: Vector, edges: &mut [Vector; MAX_EDGES]) -> usize {
        let rotation = self.pose.rotation;
        let mut count = 0;
        let mut add = |edge: Option<Vector>| {
            if let (Some(edge), Some(slot)) = (edge, edges.get_mut(count)) {
                *slot = edge;
                count += 1;
            }
        };
        match self.core() {
            TypedShape::Cuboid(_) => {
                Vector::AXES.iter().for_each(|&axis| add(unit(rotation * axis)))
            }
            TypedShape::ConvexPolyhedron(hull) => {
                let nearest = nearest_vertex(hull, self.pose.inverse_transform_point(corner));
                let at_corner = hull.edges().iter().filter(|edge| edge.vertices.contains(&nearest));
                at_corner.for_each(|edge| add(unit(rotation * edge.dir)));
            }
            _ => {}
        }
        count
    }

    /// Returns the other shape without its round border, which does not change its normals.
    fn core(&self) -> TypedShape<'_> {
        match self.other.as_typed_shape() {
            TypedShape::RoundCuboid(round) => TypedShape::Cuboid(&round.inner_shape),
            TypedShape::RoundConvexPolyhedron(round) => {
                TypedShape::ConvexPolyhedron(&round.inner_shape)
            }
            shape => shape,
        }
    }
}

/// Most edges that are tried at a corner.
const MAX_EDGES: usize = 16;

/// Returns whether a normal or its opposite belongs to the edge between two faces with the normals
/// a and b. Both are perpendicular to `edge`.
fn is_between(n: Vector, [a, b]: [Vector; 2], edge: Vector) -> bool {
    let turn = |from: Vector, to: Vector| from.cross(to).dot(edge);
    let whole = turn(a, b);
    let sense = if whole < 0.0 { -1.0 } else { 1.0 };
    let lies = |n: Vector| sense * turn(a, n) >= -ROUNDING && sense * turn(n, b) >= -ROUNDING;
    lies(n) || lies(-n)
}

fn nearest_vertex(hull: &ConvexPolyhedron, point: Vector) -> u32 {
    let away = hull.points().iter().map(|&vertex| (vertex - point).length_squared());
    away.enumerate().min_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(index, _)| index as u32)
}
