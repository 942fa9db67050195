//! The link as one of parry's shapes.
//!
//! Bounds are the smallest of their kind. For the ball around a link with one flat and one round
//! end: a ball centred on the axis `c` from the flat end's centre must reach the rim, `sqrt(c^2 +
//! r^2)`, and the pole of the half ball, `l - c + r`. The first grows with `c`, the second falls,
//! so the smallest ball has both equal: `c = l (l + 2 r) / (2 (l + r))`, which lies between the
//! ends.

use super::{feature, mass};
use crate::robot::{Cap, ModifiedCylinder};
use parry3d_f64::bounding_volume::{Aabb, BoundingSphere};
use parry3d_f64::mass_properties::MassProperties;
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::shape::{
    FeatureId, PolygonalFeatureMap, Shape, ShapeType, SubShapeId, SupportMap, TypedShape,
};
use std::f64::consts::FRAC_PI_2;

/// A convex custom shape. Its faces are 0, the barrel, 1 and 2, the start and end cap; its edges 0
/// and 1, the rims of the flat caps.
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
            // l + r - c, with the middle of the axis at l / 2 and the pole at l + r.
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

    /// The scaled link, where it is a link again: under a scale whose three factors have the same
    /// magnitude; for a wire, under every scale; and for a cylinder along a coordinate axis,
    /// under one whose other two factors have the same magnitude. Otherwise nothing, because
    /// the true image has elliptic sections. The number of subdivisions plays no part.
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

    /// The radius of the largest ball that fits into the link.
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

/// Where the smallest ball around a link with one flat end has its centre, from that end (see the
/// head of this file).
fn from_flat_end(l: Real, r: Real) -> Real {
    // l (l + 2 r) / (2 (l + r)) without the product of two lengths.
    0.5 * l * (1.0 + r / (l + r))
}

/// What the radius is multiplied by under a scale with these magnitudes, if the image is a link.
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
