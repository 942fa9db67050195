//! Two links, or a link and one of parry's shapes that is a link too: a capsule or a cylinder.
//!
//! Their distance is that of the narrow phase, exact for all caps.
//!
//! Their contact is that of the [closed forms](super::link_link) where there is one. Otherwise the two are two flat caps, or a
//! flat cap deep in the other link. While they are apart parry's iterations answer, and where they overlap
//! [`depth`](crate::distance::depth) does.

use super::convex::ConvexPair;
use super::link_link::{self, Answer};
use super::range::in_range;
use crate::pair::{NearestOfLinks, PlacedLink};
use crate::robot::ModifiedCylinder;
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::query::{ClosestPoints, Contact, QueryDispatcher, Unsupported};
use parry3d_f64::shape::{Shape, TypedShape};

/// Two links in one frame, which is the first shape's but for its origin.
pub(super) struct LinkPair {
    /// Both in the frame of the first shape: what is moved to another origin is rounded once more.
    placed: [ModifiedCylinder; 2],
    pub links: [ModifiedCylinder; 2],
    /// The frame's origin in that of the first shape: the first link's start.
    pub origin: Vector,
    /// The largest coordinate or radius.
    pub extent: Real,
}

impl LinkPair {
    /// The pair, if the shapes are one and one of them is a link of this crate.
    pub fn of(pos12: &Pose, g1: &dyn Shape, g2: &dyn Shape) -> Option<Self> {
        let is_own = |shape: &dyn Shape| shape.as_shape::<ModifiedCylinder>().is_some();
        if !is_own(g1) && !is_own(g2) {
            return None;
        }
        let (link1, link2) = (link_of(g1)?, link_of(g2)?);
        let origin = link1.start();
        let placed = [link1, link2.transformed(pos12)];
        let links = placed.map(|link| link.transformed(&Pose::from_translation(-origin)));
        let ends = links.iter().flat_map(|link| [link.start(), link.end()]);
        let largest = ends.fold(Vector::ZERO, |most, end| most.max(end.abs())).max_element();
        let extent = links.iter().fold(largest, |most, link| most.max(link.radius()));
        Some(Self { placed, links, origin, extent })
    }

    /// # Errors
    /// [`Unsupported`] for numbers out of range.
    pub fn distance(&self) -> Result<Real, Unsupported> {
        self.nearest().map(|nearest| nearest.distance)
    }

    /// # Errors
    /// [`Unsupported`] for numbers out of range.
    pub fn closest_points(&self, pos12: &Pose, max_dist: Real) -> Result<ClosestPoints, Unsupported> {
        let nearest = self.nearest()?;
        Ok(if nearest.distance <= 0.0 {
            ClosestPoints::Intersecting
        } else if nearest.distance <= max_dist {
            let point2 = pos12.inverse_transform_point(nearest.on_second);
            ClosestPoints::WithinMargin(nearest.on_first, point2)
        } else {
            ClosestPoints::Disjoint
        })
    }

    fn nearest(&self) -> Result<NearestOfLinks, Unsupported> {
        for link in &self.placed {
            in_range(link.start()).and(in_range(link.end()))?;
        }
        let [first, second] = self.placed.each_ref().map(PlacedLink::of);
        Ok(first.measure_link(&second))
    }

    /// Their contact, if they are at most `prediction` apart. `convex` is the same pair to parry.
    ///
    /// # Errors
    /// [`Unsupported`] for what the inner dispatcher refuses.
    pub fn contact<L: QueryDispatcher>(
        &self,
        convex: &ConvexPair<L>,
        pos12: &Pose,
        prediction: Real,
    ) -> Result<Option<Contact>, Unsupported> {
        let [first, second] = &self.links;
        // An overlap is found first, then measured.
        let overlap = match link_link::touch(first, second, self.extent, prediction.max(0.0)) {
            Answer::Apart => return Ok(None),
            Answer::Touch(touch) => {
                return Ok(Some(self.report(pos12, touch.on_first, touch.normal, touch.dist))
                    .filter(|contact| contact.dist <= prediction));
            }
            Answer::Unknown { overlap } => overlap,
        };
        let mut hint = None;
        if !overlap {
            match convex.contact(prediction)? {
                Some(found) if found.dist <= 0.0 => hint = Some(found.normal1),
                found => return Ok(found),
            }
        }
        let pair = link_link::pair(first, second);
        let gap = pair.widest(hint);
        let on_first = pair.touching_point(gap);
        Ok(Some(self.report(pos12, on_first, gap.normal, gap.width))
            .filter(|contact| contact.dist <= prediction))
    }

    fn report(&self, pos12: &Pose, on_first: Vector, normal: Vector, dist: Real) -> Contact {
        let (point1, point2) = (self.origin + on_first, self.origin + on_first + normal * dist);
        let normal2 = pos12.rotation.inverse() * -normal;
        Contact::new(point1, pos12.inverse_transform_point(point2), normal, normal2, dist)
    }
}

/// The link that a shape is.
fn link_of(shape: &dyn Shape) -> Option<ModifiedCylinder> {
    match shape.as_typed_shape() {
        TypedShape::Capsule(capsule) => ModifiedCylinder::try_from(capsule).ok(),
        TypedShape::Cylinder(cylinder) => {
            let half = Vector::Y * cylinder.half_height;
            ModifiedCylinder::cylinder(-half, half, cylinder.radius).ok()
        }
        _ => shape.as_shape::<ModifiedCylinder>().copied(),
    }
}
