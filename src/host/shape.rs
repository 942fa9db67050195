//! The link as one of parry's shapes.
//!
//! Bounds are the smallest of their kind.
//!
//! # Bounding ball with one flat and one round end
//! Let c be the distance of the ball's centre from the flat end's centre, along the axis; l the
//! length, r the radius. The ball must reach the rim, at `sqrt(c^2 + r^2)`, and the pole of the
//! half ball, at `l - c + r`. The first grows with c, the second falls. So the smallest ball has
//! both equal: `c = l (l + 2 r) / (2 (l + r))`, which lies between the ends.

use super::{feature, mass};
use crate::robot::{Cap, ModifiedCylinder};
use parry3d_f64::bounding_volume::{Aabb, BoundingSphere};
use parry3d_f64::mass_properties::MassProperties;
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::shape::{
    FeatureId, PolygonalFeatureMap, Shape, ShapeType, SubShapeId, SupportMap, TypedShape,
};
use std::f64::consts::FRAC_PI_2;

/// A convex custom shape. Faces: 0 is the barrel, 1 and 2 are the start and the end cap. Edges: 0
/// and 1 are the rims of flat caps.
impl Shape for ModifiedCylinder {
    fn compute_local_aabb(&self) -> Aabb {
        self.local_aabb()
    }

    fn compute_local_bounding_sphere(&self) -> BoundingSphere {
        let (l, r) = (self.length(), self.radius());
        let [start, end] = self.caps();
        let reach = match (start, end) {
            (Cap::Round, Cap::Round) => 0.5 * l + r,
            (Cap::Flat, Cap::Flat) => (0.5 * l).hypot(r),
            // l + r - c: the distance from the centre to the pole.
            _ => l + r - from_flat_end(l, r),
        };
        let share = match (start, end) {
            (Cap::Flat, Cap::Round) => from_flat_end(l, r) / l,
            (Cap::Round, Cap::Flat) => 1.0 - from_flat_end(l, r) / l,
            _ => 0.5,
        };
        BoundingSphere::new(self.start() * (1.0 - share) + self.end() * share, reach)
    }

    fn clone_dyn(&self) -> Box<dyn Shape> {
        Box::new(*self)
    }

    /// Returns the scaled link, if the image is a link; otherwise `None`, because the image has
    /// elliptic sections. The image is a link
    ///
    /// - if all three factors have the same magnitude;
    /// - for a wire;
    /// - for a cylinder along a coordinate axis, if the other two factors have the same magnitude.
    ///
    /// The number of subdivisions is ignored.
    fn scale_dyn(&self, scale: Vector, _num_subdivisions: u32) -> Option<Box<dyn Shape>> {
        let radius = self.radius() * radial_factor(self, scale.abs())?;
        let scaled = Self::new(self.start() * scale, self.end() * scale, radius, self.caps());
        scaled.ok().map(|link| Box::new(link) as Box<dyn Shape>)
    }

    fn compute_aabb(&self, position: &Pose) -> Aabb {
        self.aabb(position)
    }

    fn mass_properties(&self, density: Real) -> MassProperties {
        mass::mass_properties(self, density)
    }

    fn shape_type(&self) -> ShapeType {
        ShapeType::Custom
    }

    fn as_typed_shape(&self) -> TypedShape<'_> {
        TypedShape::Custom(self)
    }

    /// Returns the radius of the largest ball that fits into the link.
    fn ccd_thickness(&self) -> Real {
        let (l, r) = (self.length(), self.radius());
        match self.caps() {
            [Cap::Round, Cap::Round] => r,
            [Cap::Flat, Cap::Flat] => r.min(0.5 * l),
            _ => r.min(0.5 * l + 0.5 * r),
        }
    }

    fn ccd_angular_thickness(&self) -> Real {
        FRAC_PI_2
    }

    fn is_convex(&self) -> bool {
        true
    }

    fn as_support_map(&self) -> Option<&dyn SupportMap> {
        Some(self)
    }

    fn as_polygonal_feature_map(&self) -> Option<(&dyn PolygonalFeatureMap, Real)> {
        Some((self, 0.0))
    }

    fn feature_normal_at_point(
        &self,
        _subshape: SubShapeId,
        feature: FeatureId,
        point: Vector,
    ) -> Option<Vector> {
        feature::normal(self, feature, point)
    }
}

/// Returns c, the distance of the smallest bounding ball's centre from the flat end (see the head
/// of this file).
fn from_flat_end(l: Real, r: Real) -> Real {
    // l (l + 2 r) / (2 (l + r)), without the product of two lengths.
    0.5 * l * (1.0 + r / (l + r))
}

/// Returns the factor of the radius under a scale with these magnitudes, if the image is a link.
fn radial_factor(link: &ModifiedCylinder, scale: Vector) -> Option<Real> {
    let [x, y, z] = scale.to_array();
    if (x == y && y == z) || link.radius() == 0.0 {
        return Some(x);
    }
    if link.caps() != [Cap::Flat; 2] {
        return None;
    }
    let span = link.end() - link.start();
    match [span.x != 0.0, span.y != 0.0, span.z != 0.0] {
        [true, false, false] if y == z => Some(y),
        [false, true, false] if z == x => Some(z),
        [false, false, true] if x == y => Some(x),
        _ => None,
    }
}
