//! A link and another convex shape, by iterations of the inner dispatcher, with fallbacks.
//!
//! parry's GJK and EPA fail on some pairs that touch. From a distance of 1e-14 to an overlap of
//! 1e-2 they may report no contact for any prediction, or that GJK has not converged.
//!
//! # Definitions
//! - `gap(n)`, for a unit vector n: the distance along n from the first shape's support to the
//!   second's.
//! - Layer: the outermost part of the link ([`shrunk_links`]). Core: the link without it.
//!
//! # Bounds
//! For every n, `gap(n)` is at most the distance of the shapes. If `gap(n) < 0`, a translation by
//! it along n separates them. So a good n is enough.
//!
//! # Algorithm
//! 1. **Iterate.** Accept the inner dispatcher's normal if its gap confirms it (`is_plain`).
//! 2. **Layers.** Otherwise try the direction from a core to the other shape, from thin layers to
//!    thick ones. If it is off by about the layer's depth, the gap loses about the square of that.
//! 3. **Axes.** If even the innermost core overlaps, take the best of a few directions of both
//!    shapes.
//!
//! # Depth
//! The least translation that separates a link from another convex shape of parry that it overlaps.
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
use super::link_pair::shrunk_links;
use super::range::largest;
use crate::distance::depth::across_rim;
use crate::robot::ModifiedCylinder;
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::query::{ClosestPoints, Contact, PointQuery, QueryDispatcher, Unsupported};
use parry3d_f64::shape::{ConvexPolyhedron, Shape, SupportMap, TypedShape};

/// Rounding error of a distance between support points, relative to the largest coordinate.
const SUPPORT_ROUNDING: Real = 64.0 * Real::EPSILON;

/// Largest difference of two iterations for the same pair, relative to the largest coordinate.
const ITERATED: Real = 1e-4;

/// Largest distance across the normal of the two points of a contact, relative to the largest
/// coordinate. parry's relative tolerance is 5e-8.
const REALISED: Real = 1e-6;

/// A link and another convex shape, in either order.
pub(super) struct ConvexPair<'a, L> {
    inner: &'a L,
    pub(super) pos12: &'a Pose,
    pub(super) shapes: [&'a dyn Shape; 2],
    supports: [&'a dyn SupportMap; 2],
    pub(super) link: &'a ModifiedCylinder,
    pub(super) link_is_first: bool,
}

impl<'a, L: QueryDispatcher> ConvexPair<'a, L> {
    /// Returns the pair, if the shapes are one. `inner` answers first.
    pub fn of(inner: &'a L, pos12: &'a Pose, g1: &'a dyn Shape, g2: &'a dyn Shape) -> Option<Self> {
        let (link, link_is_first) =
            g1.as_shape().map(|link| (link, true)).or(g2.as_shape().map(|link| (link, false)))?;
        let supports = [g1.as_support_map()?, g2.as_support_map()?];
        Some(Self { inner, pos12, shapes: [g1, g2], supports, link, link_is_first })
    }

    /// Returns the distance.
    ///
    /// # Errors
    /// [`Unsupported`] if the inner dispatcher refuses the pair.
    pub fn distance(&self) -> Result<Real, Unsupported> {
        Ok(match self.closest_points(Real::MAX)? {
            ClosestPoints::WithinMargin(point1, point2) => (point1 - self.pos12 * point2).length(),
            _ => 0.0,
        })
    }

    /// Returns the closest points, if they are at most `max_dist` apart.
    ///
    /// # Errors
    /// [`Unsupported`] if the inner dispatcher refuses the pair.
    pub fn closest_points(&self, max_dist: Real) -> Result<ClosestPoints, Unsupported> {
        let [g1, g2] = self.shapes;
        let within = max_dist.max(0.0);
        let found = self.inner.closest_points(self.pos12, g1, g2, within)?;
        match found {
            ClosestPoints::WithinMargin(point1, point2) => {
                let way = self.pos12 * point2 - point1;
                let distance = way.length();
                let is_plain = unit(way).is_some_and(|normal| self.is_plain(normal, distance));
                if !is_plain
                    && let Some(contact) = self.contact(Real::MAX)?
                    && contact.dist <= 0.5 * distance
                {
                    return Ok(closest_points_of(&contact, max_dist));
                }
                Ok(if distance > max_dist { ClosestPoints::Disjoint } else { found })
            }
            ClosestPoints::Disjoint if !self.are_apart_by(within) => {
                let contact = self.contact_of_layers()?;
                Ok(contact.map_or(found, |contact| closest_points_of(&contact, max_dist)))
            }
            _ => Ok(found),
        }
    }

    /// Returns the contact, if its `dist` is at most `prediction`.
    ///
    /// # Errors
    /// [`Unsupported`] if the inner dispatcher refuses the pair.
    pub fn contact(&self, prediction: Real) -> Result<Option<Contact>, Unsupported> {
        let [g1, g2] = self.shapes;
        // Find an overlap first, then measure it.
        let within = prediction.max(0.0);
        let mut found = self.inner.contact(self.pos12, g1, g2, within)?.filter(is_sound);
        if found.is_none() {
            let rounding = SUPPORT_ROUNDING * largest(self.pos12, g1, g2);
            if self.are_apart_by(within + rounding) {
                return Ok(None);
            }
            found = self.inner.contact(self.pos12, g1, g2, Real::MAX)?.filter(is_sound);
        }
        let found = match found {
            Some(contact) if self.is_plain(contact.normal1, contact.dist) => Some(contact),
            Some(contact) => self.least(contact)?,
            None => self.contact_of_closest()?,
        }
        .map(|contact| self.realised(contact));
        // The distance, which other iterations compute, decides whether it is within the
        // prediction.
        Ok(match found {
            Some(contact) if contact.dist <= prediction => Some(contact),
            Some(contact) if prediction >= 0.0 => {
                let beyond = contact.dist - prediction;
                let may_be_within = beyond <= ITERATED * largest(self.pos12, g1, g2);
                let is_within = may_be_within && self.distance()? <= prediction;
                is_within.then_some(Contact { dist: prediction, ..contact })
            }
            _ => None,
        })
    }

    /// Returns the contact of a pair that is apart with points that are as far apart as it states.
    ///
    /// parry's contact is the distance along its normal of two points, which may lie far apart
    /// across it: EPA and a GJK that stops early return such points for a face and an edge that are
    /// level within rounding. `gap(normal)` is then the distance, if the two touch after a
    /// translation by it: alternating projections find the place.
    fn realised(&self, contact: Contact) -> Contact {
        let way = self.pos12 * contact.point2 - contact.point1;
        let aside = (way - contact.normal1 * contact.dist).length();
        let most = REALISED * largest(self.pos12, self.shapes[0], self.shapes[1]);
        if contact.dist <= 0.0 || aside <= most {
            return contact;
        }
        let best = (self.gap(contact.normal1), contact.normal1);
        self.report(best, self.touching(&self.placed_convex(), best))
    }

    /// Returns the contact of an overlap, or of a pair whose normal is not confirmed, or a better
    /// one. EPA may report an overlap as large as the shapes for shapes that almost touch, and an
    /// overlap too small to separate others.
    fn least(&self, contact: Contact) -> Result<Option<Contact>, Unsupported> {
        let [g1, g2] = self.shapes;
        let points = self.inner.closest_points(self.pos12, g1, g2, Real::MAX)?;
        let is_apart = matches!(points, ClosestPoints::WithinMargin(..));
        let other = if is_apart { self.contact_of_closest() } else { self.contact_of_layers() }?;
        let rounding = SUPPORT_ROUNDING * largest(self.pos12, g1, g2);
        // The translation needed along this normal, and the points that it implies.
        let dist = contact.dist.min(self.gap(contact.normal1));
        if let Some(less) = other.filter(|other| other.dist > dist + rounding) {
            return Ok(Some(less));
        }
        let on_second = contact.point1 + contact.normal1 * dist;
        let falls_short = dist < contact.dist - rounding;
        let point2 = if falls_short {
            self.pos12.inverse_transform_point(on_second)
        } else {
            contact.point2
        };
        Ok(Some(Contact { dist, point2, ..contact }))
    }

    /// Returns the contact by the closest points, if these give a direction, or by the layers.
    fn contact_of_closest(&self) -> Result<Option<Contact>, Unsupported> {
        let [g1, g2] = self.shapes;
        if let ClosestPoints::WithinMargin(point1, point2) =
            self.inner.closest_points(self.pos12, g1, g2, Real::MAX)?
            && let Some(normal) = unit(self.pos12 * point2 - point1)
        {
            let dist = (self.pos12 * point2 - point1).dot(normal);
            if self.is_plain(normal, dist) {
                let normal2 = self.pos12.rotation.inverse() * -normal;
                return Ok(Some(Contact::new(point1, point2, normal, normal2, dist)));
            }
        }
        self.contact_of_layers()
    }

    /// Returns the contact along the normal of step 2 or 3. It separates the two.
    fn contact_of_layers(&self) -> Result<Option<Contact>, Unsupported> {
        let Some((gap, normal, near)) = self.widest_of_layers()?.or_else(|| self.widest_of_axes())
        else {
            return Ok(None);
        };
        // The points lie on the planes that bound the gap.
        let [begin, end] =
            [self.support(0, normal), self.support(1, -normal)].map(|point| point.dot(normal));
        let onto = |height: Real| near + normal * (height - near.dot(normal));
        let [point1, point2] = [onto(begin), self.pos12.inverse_transform_point(onto(end))];
        let normal2 = self.pos12.rotation.inverse() * -normal;
        Ok(Some(Contact::new(point1, point2, normal, normal2, gap)))
    }

    /// Step 2: returns the widest gap, its normal, and the point of the link's core.
    fn widest_of_layers(&self) -> Result<Option<(Real, Vector, Vector)>, Unsupported> {
        let mut best: Option<(Real, Vector, Vector)> = None;
        let rounding = SUPPORT_ROUNDING * largest(self.pos12, self.shapes[0], self.shapes[1]);
        for (core, depth) in shrunk_links(self.link) {
            let [first, second]: [&dyn Shape; 2] =
                if self.link_is_first { [&core, self.shapes[1]] } else { [self.shapes[0], &core] };
            let points = self.inner.closest_points(self.pos12, first, second, Real::MAX)?;
            let ClosestPoints::WithinMargin(point1, point2) = points else { continue };
            let ends = [point1, self.pos12 * point2];
            let Some(normal) = unit(ends[1] - ends[0]) else { continue };
            let gap = self.gap(normal);
            if best.is_none_or(|(most, ..)| gap > most) {
                best = Some((gap, normal, ends[usize::from(!self.link_is_first)]));
            }
            // Thicker layers cannot improve it.
            if (ends[1] - ends[0]).dot(normal) > 0.5 * depth && depth > rounding {
                break;
            }
        }
        Ok(best)
    }

    /// Step 3: returns the widest gap among the direction between the boxes' centres, the link's
    /// axis, directions across the axis, and the coordinate axes.
    fn widest_of_axes(&self) -> Option<(Real, Vector, Vector)> {
        let boxes = [self.shapes[0].compute_local_aabb(), self.shapes[1].compute_aabb(self.pos12)];
        let axis = self.placed(self.link.axis());
        let across = perpendicular(unit(axis).unwrap_or(Vector::X));
        let between = boxes[1].center() - boxes[0].center();
        let centre = 0.5 * self.link.start() + 0.5 * self.link.end();
        let middle = if self.link_is_first { centre } else { self.pos12 * centre };
        let ways = [between, axis, across, axis.cross(across), axis.cross(axis.cross(between))];
        let ways = ways
            .into_iter()
            .chain(Vector::AXES)
            .filter_map(unit)
            .flat_map(|normal| [normal, -normal]);
        let widest =
            ways.map(|normal| (self.gap(normal), normal)).max_by(|a, b| a.0.total_cmp(&b.0));
        widest.map(|(gap, normal)| (gap, normal, middle))
    }

    /// Returns whether the two are apart and the gap along `normal` confirms at least half of the
    /// distance reported by GJK.
    ///
    /// For shapes that touch, GJK may report a distance as large as the shapes. For shapes that
    /// overlap, it may report that they almost touch. Even if it is right, rounding may turn the
    /// direction between close points. An unconfirmed pair is examined further.
    fn is_plain(&self, normal: Vector, distance: Real) -> bool {
        distance > 0.0 && self.gap(normal) > 0.5 * distance
    }

    /// Returns whether a simple direction proves that the two are farther apart than `margin`.
    fn are_apart_by(&self, margin: Real) -> bool {
        let boxes = [self.shapes[0].compute_local_aabb(), self.shapes[1].compute_aabb(self.pos12)];
        let between = boxes[1].center() - boxes[0].center();
        let axis = unit(self.placed(self.link.axis()));
        let radial = axis.and_then(|axis| unit(between - axis * axis.dot(between)));
        [unit(between), radial].into_iter().flatten().any(|normal| self.gap(normal) > margin)
    }

    /// Returns `gap(normal)`.
    pub(super) fn gap(&self, normal: Vector) -> Real {
        (self.support(1, -normal) - self.support(0, normal)).dot(normal)
    }

    /// Returns the support point of one shape along a unit vector, in the first shape's frame.
    pub(super) fn support(&self, which: usize, normal: Vector) -> Vector {
        if which == 0 {
            self.supports[0].local_support_point_toward(normal)
        } else {
            self.supports[1].support_point_toward(self.pos12, normal)
        }
    }

    /// Returns a direction of the link in the first shape's frame.
    fn placed(&self, direction: Vector) -> Vector {
        if self.link_is_first { direction } else { self.pos12.rotation * direction }
    }
}

/// Returns whether the numbers of a contact are finite and its normals have a direction. EPA may
/// return NaN or normals of 0 for shapes without height, and for shapes with one centre.
pub(super) fn is_sound(contact: &Contact) -> bool {
    let is_unit = |normal: Vector| (normal.length_squared() - 1.0).abs() < 1e-3;
    let points = [contact.point1, contact.point2];
    contact.dist.is_finite()
        && points.iter().all(|point| point.is_finite())
        && is_unit(contact.normal1)
        && is_unit(contact.normal2)
}

/// Returns the closest points of a contact within `max_dist`.
fn closest_points_of(contact: &Contact, max_dist: Real) -> ClosestPoints {
    if contact.dist <= 0.0 {
        ClosestPoints::Intersecting
    } else if contact.dist <= max_dist {
        ClosestPoints::WithinMargin(contact.point1, contact.point2)
    } else {
        ClosestPoints::Disjoint
    }
}

/// Most searches for the foremost corner.
const ROUNDS: usize = 3;
/// Most projections from one shape to the other when searching the touching point.
const PROJECTIONS: usize = 8;
/// The search ends if the point moves by less than this share of the link's size.
const SETTLED: Real = 1e-9;
/// Normals whose angle has at least this cosine touch at one place.
const SAME_NORMAL: Real = 1.0 - 1e-10;
/// Rounding margin for the range of normals of an edge.
const TURN_ROUNDING: Real = 64.0 * Real::EPSILON;

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
        let placed = self.placed_convex();
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

    /// Returns the link and the other shape in the frame of the pair.
    fn placed_convex(&self) -> PlacedConvex<'_> {
        let (link, other, pose) = if self.link_is_first {
            (*self.link, self.shapes[1], *self.pos12)
        } else {
            (self.link.transformed(self.pos12), self.shapes[0], Pose::IDENTITY)
        };
        PlacedConvex { link, axis: unit(link.end() - link.start()), other, pose }
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
    let lies =
        |n: Vector| sense * turn(a, n) >= -TURN_ROUNDING && sense * turn(n, b) >= -TURN_ROUNDING;
    lies(n) || lies(-n)
}

fn nearest_vertex(hull: &ConvexPolyhedron, point: Vector) -> u32 {
    let away = hull.points().iter().map(|&vertex| (vertex - point).length_squared());
    away.enumerate().min_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(index, _)| index as u32)
}
