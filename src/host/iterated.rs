//! A pair that parry's iterations answer, in a unit that suits them.
//!
//! GJK and EPA stop at absolute tolerances: a squared length, area or height of 2e-15. In metres
//! this is a large share of a thin link. So the pair is scaled by a power of two that brings its
//! largest coordinate to [`SIZE`], and the answers are scaled back. Powers of two are exact: a pair
//! that is 2^k times as large has answers that are 2^k times as large, bit for bit.

use super::range::{self, largest};
use super::robot_surface::links_of;
use crate::distance::Scalar;
use crate::robot::ModifiedCylinder;
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::query::{ClosestPoints, Contact, Unsupported};
use parry3d_f64::shape::{Shape, ShapeType};

/// The largest coordinate of a scaled pair, up to a factor of two. (Measured with
/// `tests/host/parrys.rs`: at 1, errors are up to 2e-4 of a link's radius; from 64 to 2^24, up to
/// 2e-6.)
const SIZE: Real = 4096.0;

/// A pair of shapes for the inner dispatcher.
pub(super) struct IteratedPair<'a> {
    /// The second shape's pose in the first's frame, in the pair's unit.
    pub pos12: Pose,
    shapes: [&'a dyn Shape; 2],
    images: Option<[Box<dyn Shape>; 2]>,
    /// The pair's unit in the shapes' unit: a power of two.
    pub unit: Real,
}

impl<'a> IteratedPair<'a> {
    /// Returns the pair. Only a pair with a link is scaled, and only if its other shape has a
    /// scaled image, as all of parry's shapes have.
    ///
    /// # Errors
    /// [`Unsupported`] for a link beyond the range of parry's iterations, where they panic or
    /// return NaN.
    pub fn of(pos12: &Pose, g1: &'a dyn Shape, g2: &'a dyn Shape) -> Result<Self, Unsupported> {
        let as_it_is = Self { pos12: *pos12, shapes: [g1, g2], images: None, unit: 1.0 };
        if links_of(g1).or(links_of(g2)).is_none() {
            return Ok(as_it_is);
        }
        if !range::is_iterated(pos12, g1, g2) {
            return Err(Unsupported);
        }
        let scale = SIZE * largest(pos12, g1, g2).power_of_two_to_unity();
        let (Some(first), Some(second)) = (image(g1, scale), image(g2, scale)) else {
            return Ok(as_it_is);
        };
        let pos12 = Pose::from_parts(pos12.translation * scale, pos12.rotation);
        Ok(Self { pos12, images: Some([first, second]), unit: 1.0 / scale, ..as_it_is })
    }

    pub fn shapes(&self) -> [&dyn Shape; 2] {
        match &self.images {
            Some([first, second]) => [&**first, &**second],
            None => self.shapes,
        }
    }

    /// Converts a length to the pair's unit.
    pub fn length(&self, length: Real) -> Real {
        (length / self.unit).clamp(-Real::MAX, Real::MAX)
    }

    /// Converts a contact to the shapes' unit.
    pub fn restore(&self, contact: Contact) -> Contact {
        Contact {
            point1: contact.point1 * self.unit,
            point2: contact.point2 * self.unit,
            dist: contact.dist * self.unit,
            ..contact
        }
    }

    /// Converts closest points to the shapes' unit.
    pub fn restore_points(&self, points: ClosestPoints) -> ClosestPoints {
        match points {
            ClosestPoints::WithinMargin(point1, point2) => {
                ClosestPoints::WithinMargin(point1 * self.unit, point2 * self.unit)
            }
            other => other,
        }
    }
}

/// Returns the scaled shape.
fn image(shape: &dyn Shape, scale: Real) -> Option<Box<dyn Shape>> {
    if let Some(link) = shape.as_shape::<ModifiedCylinder>() {
        let (start, end) = (link.start() * scale, link.end() * scale);
        return Some(Box::new(ModifiedCylinder::unchecked(
            start,
            end,
            link.radius() * scale,
            link.caps(),
        )));
    }
    let mut image = shape.scale_dyn(Vector::splat(scale), 0)?;
    // parry does not scale the border of a round shape. This library makes no `dyn Shape` of one:
    // that would compile parry's iterations again for each kind.
    let border = match image.shape_type() {
        ShapeType::RoundCuboid => image.as_round_cuboid_mut().map(|it| &mut it.border_radius),
        ShapeType::RoundTriangle => image.as_round_triangle_mut().map(|it| &mut it.border_radius),
        ShapeType::RoundCylinder => image.as_round_cylinder_mut().map(|it| &mut it.border_radius),
        ShapeType::RoundCone => image.as_round_cone_mut().map(|it| &mut it.border_radius),
        ShapeType::RoundConvexPolyhedron => {
            image.as_round_convex_polyhedron_mut().map(|it| &mut it.border_radius)
        }
        _ => None,
    };
    if let Some(border) = border {
        *border *= scale;
    }
    Some(image)
}
