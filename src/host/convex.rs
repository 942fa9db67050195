//! A link and another convex shape, by iterations of the inner dispatcher, with fallbacks.
//!
//! parry's GJK and EPA fail on some pairs that touch. From a distance of 1e-14 to an overlap of
//! 1e-2 they may report no contact for any prediction, or that GJK has not converged.
//!
//! # Definitions
//! - `gap(n)`, for a unit vector n: the distance along n from the first shape's support to the
//!   second's.
//! - Layer: the outermost part of the link (`layers.rs`). Core: the link without it.
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

use super::axial::{perpendicular, unit};
use super::layers::shrunk_links;
use super::range::largest;
use crate::robot::ModifiedCylinder;
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::query::{ClosestPoints, Contact, QueryDispatcher, Unsupported};
use parry3d_f64::shape::{Shape, SupportMap};

/// Rounding error relative to the largest coordinate.
const ROUNDING: Real = 64.0 * Real::EPSILON;

/// Largest difference of two iterations for the same pair, relative to the largest coordinate.
const ITERATED: Real = 1e-4;

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
        let mut found = self.inner.contact(self.pos12, g1, g2, within)?;
        if found.is_none() {
            let rounding = ROUNDING * largest(self.pos12, g1, g2);
            if self.are_apart_by(within + rounding) {
                return Ok(None);
            }
            found = self.inner.contact(self.pos12, g1, g2, Real::MAX)?;
        }
        let found = match found {
            Some(contact) if self.is_plain(contact.normal1, contact.dist) => Some(contact),
            Some(contact) => self.least(contact)?,
            None => self.contact_of_closest()?,
        };
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

    /// Returns the contact of an overlap, or of a pair whose normal is not confirmed, or a better
    /// one. EPA may report an overlap as large as the shapes for shapes that almost touch, and an
    /// overlap too small to separate others.
    fn least(&self, contact: Contact) -> Result<Option<Contact>, Unsupported> {
        let [g1, g2] = self.shapes;
        let points = self.inner.closest_points(self.pos12, g1, g2, Real::MAX)?;
        let is_apart = matches!(points, ClosestPoints::WithinMargin(..));
        let other = if is_apart { self.contact_of_closest() } else { self.contact_of_layers() }?;
        let rounding = ROUNDING * largest(self.pos12, g1, g2);
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
        let rounding = ROUNDING * largest(self.pos12, self.shapes[0], self.shapes[1]);
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
