//! Two links, or a link and a shape of parry that is a link too: a ball, a capsule or a cylinder.
//!
//! # Distance
//! The distance and the nearest points come from the distance kernels, which are exact for all
//! caps.
//!
//! # Contact
//! 1. A [closed form](super::link_link), if there is one.
//! 2. Otherwise two flat caps meet, or a flat cap is deep in the other link. While the links are
//!    apart, the contact is at their nearest points. If they overlap, it is the widest gap of
//!    [`depth`](crate::distance::depth).
//! 3. If the nearest points are close together, or equal, their direction is rounding. Then the
//!    directions of the features are tried, and the directions from a link without its outermost
//!    [layers](shrunk_links) to the other link. The thinnest layer whose removal separates
//!    the two gives a direction, for all positions of the rims.
//!
//! # Layers
//! A link without its outermost layer is its core. A shape that touches the link does not touch the
//! core. Without the layer of depth `t` the link is again a link: shorter by `t` at each flat end
//! and thinner by `t`. For a shape that meets the surface, the nearest point of the core has
//! exactly the normal of the link's surface there. At a rim that is met obliquely, the normal is
//! off by about `t`.

use super::axial::unit;
use super::link_link::{self, Answer, DIRECTION, FINE_DIRECTION, TouchPoint};
use super::link_triangle::LinkContact;
use super::range::in_range;
use crate::distance::Scalar;
use crate::pair::{NearestOfLinks, PlacedLink};
use crate::robot::{Cap, ModifiedCylinder};
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::query::{ClosestPoints, Contact, Unsupported};
use parry3d_f64::shape::{Shape, TypedShape};

/// Largest difference of a closed form and the distance kernels, relative to the largest
/// coordinate.
const CLOSED_FORM_ROUNDING: Real = 16.0 * Real::EPSILON;

/// Two links in one frame.
pub(super) struct LinkPair {
    /// Both in the frame of the first shape, before the rounding of another origin.
    placed: [ModifiedCylinder; 2],
    /// Both relative to the first link's start, scaled near one.
    pub links: [ModifiedCylinder; 2],
    /// The largest coordinate or radius of `links`.
    pub extent: Real,
    /// The first link's start.
    origin: Vector,
    /// The unit of `links` in the shapes' unit: a power of two.
    unit: Real,
}

impl LinkPair {
    /// Returns the pair, if both shapes are links and one of them is a link of this crate.
    ///
    /// # Errors
    /// [`Unsupported`] for numbers out of range.
    pub fn of(pos12: &Pose, g1: &dyn Shape, g2: &dyn Shape) -> Result<Option<Self>, Unsupported> {
        let Some([first, second]) = links_of_pair(g1, g2) else { return Ok(None) };
        Self::between(&first, &second.transformed(pos12)).map(Some)
    }

    /// Returns the pair of two links in one frame.
    ///
    /// # Errors
    /// [`Unsupported`] for numbers out of range.
    pub fn between(
        first: &ModifiedCylinder,
        second: &ModifiedCylinder,
    ) -> Result<Self, Unsupported> {
        let placed = [*first, *second];
        for link in &placed {
            in_range(link.start()).and(in_range(link.end()))?;
        }
        let origin = first.start();
        let moved = placed.map(|link| link.transformed(&Pose::from_translation(-origin)));
        let ends = moved.iter().flat_map(|link| [link.start(), link.end()]);
        let largest = ends.fold(Vector::ZERO, |most, end| most.max(end.abs())).max_element();
        let extent = moved.iter().fold(largest, |most, link| most.max(link.radius()));
        let scale = extent.power_of_two_to_unity();
        let links = moved.map(|link| {
            let (start, end) = (link.start() * scale, link.end() * scale);
            ModifiedCylinder::unchecked(start, end, link.radius() * scale, link.caps())
        });
        Ok(Self { placed, links, extent: extent * scale, origin, unit: 1.0 / scale })
    }

    pub fn distance(&self) -> Real {
        self.nearest().distance
    }

    pub fn closest_points(&self, pos12: &Pose, max_dist: Real) -> ClosestPoints {
        let nearest = self.nearest();
        if nearest.distance <= 0.0 {
            ClosestPoints::Intersecting
        } else if nearest.distance <= max_dist {
            ClosestPoints::WithinMargin(
                nearest.on_first,
                pos12.inverse_transform_point(nearest.on_second),
            )
        } else {
            ClosestPoints::Disjoint
        }
    }

    /// Returns their contact, if its `dist` is at most `prediction`.
    pub fn contact(&self, pos12: &Pose, prediction: Real) -> Option<Contact> {
        // Find an overlap first, then measure it.
        let touch = self.touch_within(prediction.max(0.0))?;
        let (point1, dist) = (self.place(touch.on_first), self.length(touch.dist));
        let point2 = self.place(touch.on_first + touch.normal * touch.dist);
        let normal2 = pos12.rotation.inverse() * -touch.normal;
        let contact = Contact::new(
            point1,
            pos12.inverse_transform_point(point2),
            touch.normal,
            normal2,
            dist,
        );
        (dist <= prediction).then_some(contact)
    }

    /// Returns their contact at any distance, in the first shape's frame.
    pub fn link_contact(&self) -> Option<LinkContact> {
        let touch = self.touch(Real::INFINITY)?;
        let [on_link, on_other] = [touch.on_first, touch.on_first + touch.normal * touch.dist]
            .map(|point| self.place(point));
        Some(LinkContact {
            distance: self.length(touch.dist),
            on_link,
            on_other,
            normal: touch.normal,
        })
    }

    /// Returns the contact of [`links`](Self::links), if they are at most `margin` apart. `margin`
    /// is in the shapes' unit and at least 0.
    ///
    /// Near the margin the [distance](Self::distance) decides, because the closed forms round
    /// differently.
    pub fn touch_within(&self, margin: Real) -> Option<TouchPoint> {
        let rounding = self.rounding();
        let mut touch = self.touch(margin + self.length(rounding))?;
        let within = margin / self.unit;
        if touch.dist > within {
            if touch.dist > within + rounding || self.distance() > margin {
                return None;
            }
            touch.dist = within;
        }
        Some(touch)
    }

    /// Returns how much farther apart [`links`](Self::links) can be than the links whose distance
    /// is measured. Another origin rounds their ends, which turns a flat cap by rounding over
    /// length.
    fn rounding(&self) -> Real {
        let flat = self.links.iter().filter(|link| link.caps().contains(&Cap::Flat));
        let turn = flat.map(|link| link.radius() / link.length()).fold(0.0, Real::max);
        CLOSED_FORM_ROUNDING * self.extent * (1.0 + turn)
    }

    /// Returns the contact, if they are at most `margin` apart. Near the margin either result is
    /// possible.
    fn touch(&self, margin: Real) -> Option<TouchPoint> {
        let [first, second] = &self.links;
        let margin = margin / self.unit;
        match link_link::touch(first, second, self.extent, margin) {
            Answer::Apart => None,
            Answer::TouchPoint(touch) => Some(touch),
            Answer::Unknown => self.touch_of_caps(margin),
        }
    }

    /// Converts a point of `links` to the first shape's frame.
    pub fn place(&self, point: Vector) -> Vector {
        self.origin + point * self.unit
    }

    /// Converts a length of `links` to the shapes' unit.
    pub fn length(&self, length: Real) -> Real {
        length * self.unit
    }

    fn touch_of_caps(&self, margin: Real) -> Option<TouchPoint> {
        let nearest = self.nearest();
        let dist = nearest.distance / self.unit;
        if dist > margin {
            return None;
        }
        let way = unit((nearest.on_second - nearest.on_first) / self.unit);
        let on_first = (nearest.on_first - self.origin) / self.unit;
        let [first, second] = &self.links;
        let pair = link_link::pair(first, second);
        let normal = match way.filter(|_| dist > 0.0) {
            Some(normal) if dist > FINE_DIRECTION * self.extent => pair.refined(normal).normal,
            way => {
                let gap = pair.widest([way, self.way_of_layers()].into_iter().flatten());
                if dist <= 0.0 {
                    // Rounding may report that touching links do not touch.
                    let dist = gap.width.min(0.0);
                    return Some(TouchPoint {
                        dist,
                        normal: gap.normal,
                        on_first: pair.touching_point(gap),
                    });
                }
                gap.normal
            }
        };
        Some(TouchPoint { dist, normal, on_first })
    }

    /// Returns the direction out of the first link that the removal of a layer gives.
    fn way_of_layers(&self) -> Option<Vector> {
        let [first, second] = &self.links;
        let is_swapped = thickest_layer(first) < thickest_layer(second);
        let (peeled, other) = if is_swapped { (second, first) } else { (first, second) };
        let other = PlacedLink::of(other);
        let out = shrunk_links(peeled).find_map(|(core, _)| {
            let nearest = PlacedLink::of(&core).measure_link(&other);
            let has_direction = nearest.distance > DIRECTION * self.extent;
            unit(nearest.on_second - nearest.on_first).filter(|_| has_direction)
        })?;
        Some(if is_swapped { -out } else { out })
    }

    fn nearest(&self) -> NearestOfLinks {
        let [first, second] = self.placed.each_ref().map(PlacedLink::of);
        first.measure_link(&second)
    }
}

/// Returns both shapes as links, if they are links and one of them is a link of this crate.
pub(super) fn links_of_pair(g1: &dyn Shape, g2: &dyn Shape) -> Option<[ModifiedCylinder; 2]> {
    let is_own = |shape: &dyn Shape| shape.as_shape::<ModifiedCylinder>().is_some();
    if is_own(g1) || is_own(g2) { Some([link_of(g1)?, link_of(g2)?]) } else { None }
}

/// Returns the link that a shape is equal to.
fn link_of(shape: &dyn Shape) -> Option<ModifiedCylinder> {
    match shape.as_typed_shape() {
        TypedShape::Ball(ball) => {
            ModifiedCylinder::capsule(Vector::ZERO, Vector::ZERO, ball.radius).ok()
        }
        TypedShape::Capsule(capsule) => ModifiedCylinder::try_from(capsule).ok(),
        TypedShape::Cylinder(cylinder) => {
            let half = Vector::Y * cylinder.half_height;
            ModifiedCylinder::cylinder(-half, half, cylinder.radius).ok()
        }
        _ => shape.as_shape::<ModifiedCylinder>().copied(),
    }
}

/// The depths of the layers, as shares of the largest possible depth.
const LAYERS: [Real; 5] = [1e-5, 1e-3, 0.03, 0.3, 1.0];

/// Returns the depth of the thickest layer.
fn thickest_layer(link: &ModifiedCylinder) -> Real {
    let is_flat = link.caps().contains(&Cap::Flat);
    if is_flat { link.radius().min(0.5 * link.length()) } else { link.radius() }
}

/// Yields the link without a layer and the layer's depth, from the thinnest to the thickest.
pub(super) fn shrunk_links(
    link: &ModifiedCylinder,
) -> impl Iterator<Item = (ModifiedCylinder, Real)> + use<> {
    let (link, most) = (*link, thickest_layer(link));
    LAYERS.into_iter().map(move |share| {
        let depth = share * most;
        let [back, front] = link.caps().map(|cap| if cap == Cap::Flat { depth } else { 0.0 });
        let (start, end) = (link.start() + link.axis() * back, link.end() - link.axis() * front);
        // A core that is not a valid link becomes the middle of its axis.
        let core = ModifiedCylinder::new(start, end, (link.radius() - depth).max(0.0), link.caps());
        let middle = 0.5 * start + 0.5 * end;
        let core = core.or_else(|_| ModifiedCylinder::capsule(middle, middle, 0.0));
        (core.unwrap_or(link), depth)
    })
}
