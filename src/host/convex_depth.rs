//! The least translation that separates a link from another convex shape of parry's that it
//! overlaps.
//!
//! What parry's EPA finds is one candidate. The others are the normals in which the least
//! translation can be by the shapes' features, as for a [link and a
//! triangle](crate::distance::depth): the shape's faces, the link's axis, what is perpendicular to
//! the axis and an edge; and, of the corner that lies foremost along the best of these, with its
//! edges, the ways to the axis, to the centres of round caps and to rims. Each is measured by the
//! two supports, whatever it is, so that the translation separates. A shape with round parts of its
//! own has a continuum of faces: of it EPA's answer and the axes are all there is.

use super::axial::{perpendicular, unit, unit_across};
use super::convex::ConvexPair;
use crate::distance::depth::across_rim;
use crate::robot::ModifiedCylinder;
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::query::{Contact, PointQuery, QueryDispatcher};
use parry3d_f64::shape::{ConvexPolyhedron, Shape, SupportMap, TypedShape};

/// How often the corner that lies foremost is looked for again.
const ROUNDS: usize = 3;
/// How often a point is taken from one shape to the other to find where they touch.
const PROJECTIONS: usize = 8;
/// It has settled where it moves by less than this share of the link's size.
const SETTLED: Real = 1e-9;
/// Normals as near as this to each other, as a cosine, touch at one place.
const SAME_NORMAL: Real = 1.0 - 1e-10;
/// By how much rounding can put a normal outside of those that an edge has.
const ROUNDING: Real = 64.0 * Real::EPSILON;

/// The link and the other shape's place, in the frame of the pair.
struct PlacedConvex<'a> {
    link: ModifiedCylinder,
    axis: Option<Vector>,
    other: &'a dyn Shape,
    pose: Pose,
}

/// A gap and the normal out of the first shape that has it.
type Gap = (Real, Vector);

impl<L: QueryDispatcher> ConvexPair<'_, L> {
    /// The contact with the least of the translations that separate the two, if it is one of an
    /// overlap.
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

    /// Where the link touches the other shape once they are moved apart, by going from the one to
    /// the other and back.
    fn touching(&self, placed: &PlacedConvex, (gap, normal): Gap) -> Vector {
        // The other is moved away from the link.
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

    /// The contact near a point, its own points on the planes between which the gap is.
    fn report(&self, (gap, normal): Gap, near: Vector) -> Contact {
        let begin = self.support(0, normal).dot(normal);
        let onto = |height: Real| near + normal * (height - near.dot(normal));
        let (point1, point2) = (onto(begin), self.pos12.inverse_transform_point(onto(begin + gap)));
        let normal2 = self.pos12.rotation.inverse() * -normal;
        Contact::new(point1, point2, normal, normal2, gap)
    }
}

impl PlacedConvex<'_> {
    /// The normals of the other shape's faces, the link's axis, and what is perpendicular to it and
    /// to an edge.
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
                // Shapes of parry's that are round have the y axis.
                let own = rotation * Vector::Y;
                both_ways(unit(own));
                both_ways(product(own));
                let between = self.pose.translation - self.link.start();
                both_ways(unit_across(between, own));
                both_ways(axis.and_then(|axis| unit_across(between, axis)));
            }
        }
    }

    /// The normals that the corner has that lies foremost against `out`, which is out of the link.
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

    /// The corner that lies foremost along a unit vector, borders left out.
    fn corner_toward(&self, way: Vector) -> Option<Vector> {
        Some(match self.core() {
            TypedShape::Cuboid(cuboid) => cuboid.support_point_toward(&self.pose, way),
            TypedShape::ConvexPolyhedron(hull) => hull.support_point_toward(&self.pose, way),
            _ => self.other.as_support_map()?.support_point_toward(&self.pose, way),
        })
    }

    /// The unit directions of the edges at a corner.
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

    /// The other shape without its border: what is round around a shape leaves its normals as they
    /// are.
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

/// Of a corner with more edges only so many are looked at.
const MAX_EDGES: usize = 16;

/// Whether a normal or its opposite is one that an edge between two faces has. All but the normal
/// lie across the edge.
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
