//! The contact of a link and a triangle: the distance or the least separating translation, and the
//! normal.
//!
//! Directions and gaps are defined in `distance/depth`: `gap(n)` is the distance along n from the
//! end of the link to the beginning of the triangle.
//!
//! 1. **Apart.** Points and distance come from the distance kernel. Rounding turns their difference
//!    by the extent over the distance, so it is a poor normal at small distances. The normals of
//!    features have no such error: the face's normal, the axis, the products of axis and edges, and
//!    the direction from the axis to the triangle made perpendicular to either. The one with the
//!    largest gap is the contact's normal. If none of them separates the two, for example if a rim
//!    almost touches an edge obliquely, the candidates of case 3 are tried too.
//! 2. **Overlapping; the axis is outside by more than rounding, and no flat cap is near.** A
//!    capsule is its axis enlarged by a ball. So the least translation is along the direction from
//!    the axis to the triangle, and its length is `radius - F` for their distance F. The part cut
//!    off by a flat cap gives no shorter translation, if the cap is at least as far along the axis
//!    as the overlap is deep: see `distance/depth/foot.rs`.
//! 3. **Otherwise**, the direction with the largest gap among the candidates of case 1 and of
//!    `distance/depth/separation.rs`, which contain the least translation. Moved apart by it, the
//!    two touch; the touching points are the contact's points.

use super::axial::{power_of_two, to_flat, unit};
pub(super) use crate::distance::depth::face_normal;
use crate::distance::depth::{self, GAP_ROUNDING};
use crate::distance::{Link, Vec3, segment_triangle, single};
use crate::robot::{Cap, ModifiedCylinder};
use parry3d_f64::math::{Real, Vector};
use parry3d_f64::query::Unsupported;
use parry3d_f64::shape::{Shape, Triangle};

/// A link and a finite triangle, in either order.
pub(super) struct LinkTrianglePair<'a> {
    pub link: &'a ModifiedCylinder,
    pub triangle: &'a Triangle,
    pub link_is_first: bool,
}

impl<'a> LinkTrianglePair<'a> {
    /// Returns the pair, if the shapes are one.
    ///
    /// # Errors
    /// [`Unsupported`] if the triangle is not finite.
    pub fn of(g1: &'a dyn Shape, g2: &'a dyn Shape) -> Result<Option<Self>, Unsupported> {
        let (first, second) =
            (g1.as_shape::<ModifiedCylinder>(), g2.as_shape::<ModifiedCylinder>());
        let (link, triangle, link_is_first) = match (first, second) {
            (Some(link), None) => (link, g2.as_triangle(), true),
            (None, Some(link)) => (link, g1.as_triangle(), false),
            _ => return Ok(None),
        };
        triangle.map(|triangle| Self::new(link, triangle, link_is_first)).transpose()
    }

    /// Returns the pair of a link and a triangle.
    ///
    /// # Errors
    /// [`Unsupported`] if the triangle is not finite.
    pub fn new(
        link: &'a ModifiedCylinder,
        triangle: &'a Triangle,
        link_is_first: bool,
    ) -> Result<Self, Unsupported> {
        let is_finite = triangle.vertices().iter().all(|vertex| vertex.is_finite());
        if is_finite { Ok(Self { link, triangle, link_is_first }) } else { Err(Unsupported) }
    }
}

/// The contact of a link and a triangle, another link or a convex shape, in the frame of both.
#[derive(Clone, Copy)]
pub(super) struct LinkContact {
    /// Distance, or minus the length of the least separating translation.
    pub distance: Real,
    /// A point of the link. In an overlap it lies beyond the other shape's surface.
    pub on_link: Vector,
    /// A point of the other shape, `distance` from the link's point along the normal.
    pub on_other: Vector,
    /// Unit vector from the link to the other shape.
    pub normal: Vector,
}

/// Returns distance and closest points of a link and a triangle in one frame, the link's point
/// first.
pub(super) fn closest(link: &ModifiedCylinder, triangle: [Vector; 3]) -> (Real, Vector, Vector) {
    let flat = link.flat();
    let (start, end) = (Vec3::from(link.start()), Vec3::from(link.end()));
    let closest = single::triangle_link(triangle.map(Vec3::from), start, end, link.radius(), flat);
    (closest.distance, Vector::from(closest.point2), Vector::from(closest.point1))
}

/// Returns the contact of `link` and a finite `triangle` at any distance; `None` if the numbers
/// leave the range of f64.
pub(super) fn contact(link: &ModifiedCylinder, triangle: [Vector; 3]) -> Option<LinkContact> {
    let local = Local::new(link, triangle)?;
    let found = local.contact_within(Real::INFINITY)?;
    Some(LinkContact {
        distance: found.distance * local.unit,
        on_link: local.origin + found.on_link * local.unit,
        on_other: local.origin + found.on_other * local.unit,
        normal: found.normal,
    })
}

/// The pair relative to the link's start, scaled so that coordinates and the radius are at most 1.
pub(super) struct Local {
    /// The link's start in the caller's frame.
    pub origin: Vector,
    /// The local unit in the caller's unit.
    pub unit: Real,
    pub link: ModifiedCylinder,
    pub triangle: [Vector; 3],
}

impl Local {
    /// Returns `None` if the numbers leave the range of f64.
    pub fn new(link: &ModifiedCylinder, triangle: [Vector; 3]) -> Option<Self> {
        let origin = link.start();
        let span = link.end() - origin;
        let offsets = triangle.map(|vertex| vertex - origin);
        let extent =
            offsets.iter().fold(span.abs(), |most, offset| most.max(offset.abs())).max_element();
        let (down, unit) = power_of_two(2.0 * extent.max(link.radius()));
        let end = span * down;
        // A link too short for the extent of the pair counts as a ball.
        let caps = if end == Vector::ZERO { [Cap::Round; 2] } else { link.caps() };
        let link = ModifiedCylinder::new(Vector::ZERO, end, link.radius() * down, caps).ok()?;
        let triangle = offsets.map(|offset| offset * down);
        triangle.iter().all(|vertex| vertex.is_finite()).then_some(Self {
            origin,
            unit,
            link,
            triangle,
        })
    }

    /// Returns the contact in local units, if the two are at most `margin` apart.
    pub fn contact_within(&self, margin: Real) -> Option<LinkContact> {
        let (link, radius) = (&self.link, self.link.radius());
        let axis = [Vec3::from(link.start()), Vec3::from(link.end())];
        let to_axis = segment_triangle(axis, self.triangle.map(Vec3::from));
        // A link is contained in its capsule.
        if to_axis.distance - radius > margin + GAP_ROUNDING {
            return None;
        }
        let on_axis = Vector::from(to_axis.point1);
        let from_axis = Vector::from(to_axis.point2) - on_axis;
        let outward = unit(from_axis);
        let to_flat = to_flat(link, on_axis);
        let pair = depth::LinkTriangle::new(
            Link::new(link.end().into(), radius, link.flat()),
            self.triangle,
        );

        if let (Some(outward), true) = (outward, to_flat > GAP_ROUNDING) {
            let distance = to_axis.distance - radius;
            if distance > margin {
                return None;
            }
            // Cases 1 and 2.
            if distance > 0.0
                || (to_axis.distance > GAP_ROUNDING && to_flat > GAP_ROUNDING - distance)
            {
                let normal = pair.widest_gap([Some(outward), None], distance).normal;
                let (on_link, on_other) = (on_axis + normal * radius, on_axis + from_axis);
                return Some(LinkContact { distance, on_link, on_other, normal });
            }
        }
        let (distance, on_link, on_other) = closest(link, self.triangle);
        if distance > margin {
            return None;
        }
        // Case 1.
        if distance > 0.0 {
            let mut best = pair.widest_gap([unit(on_other - on_link), outward], distance);
            if best.gap <= 0.0 {
                best = pair.widest_of_all(best);
            }
            return Some(LinkContact { distance, on_link, on_other, normal: best.normal });
        }
        // Case 3.
        let depth::Way { gap, normal } = pair.least_translation(outward);
        let distance = gap.min(0.0);
        let (_, on_link, on_moved) =
            closest(link, self.triangle.map(|vertex| vertex - normal * distance));
        Some(LinkContact { distance, on_link, on_other: on_moved + normal * distance, normal })
    }
}
