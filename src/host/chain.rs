//! The chain as one of parry's composite shapes. Its parts are its links.
//!
//! Neighbouring links overlap, so the meaning of a query depends on its side:
//!
//! - **From outside** the chain is the union of its links. The closest point and the first hit of
//!   the union are the best over the links, so they are exact.
//! - **From inside** queries see the links one by one, like queries on parry's `Compound`. A hollow
//!   ray stops at the next surface of any link. A point is projected to the nearest surface of any
//!   link, even if that surface lies within another link. So the depth of a point inside is never
//!   overestimated.
//!
//! Whether a point is inside is exact everywhere. Contact manifolds treat the chain as one surface:
//! a cap makes no contacts where a neighbour covers it and makes them (see
//! [`manifold`](super::manifold)).

use super::mass;
use crate::robot::length;
use crate::robot::{Chain, ModifiedCylinder};
use parry3d_f64::bounding_volume::{Aabb, BoundingSphere, BoundingVolume};
use parry3d_f64::mass_properties::MassProperties;
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::partitioning::{Bvh, BvhNode};
use parry3d_f64::query::details::NormalConstraints;
use parry3d_f64::query::{PointProjection, PointQuery, Ray, RayCast, RayIntersection};
use parry3d_f64::shape::{
    CompositeShape, FeatureId, Shape, ShapeType, SubShapeId, TypedCompositeShape, TypedShape,
};
use std::f64::consts::FRAC_PI_2;

/// Rounding error of a ray's hit, relative to the largest coordinate.
const HIT_ROUNDING: Real = 64.0 * Real::EPSILON;

/// A composite custom shape; part i is link i.
impl Shape for Chain {
    fn compute_local_aabb(&self) -> Aabb {
        self.local_aabb()
    }

    /// Returns a ball around the centre of the chain's box that contains the links' balls.
    fn compute_local_bounding_sphere(&self) -> BoundingSphere {
        let center = self.local_aabb().center();
        let reach = |link: &ModifiedCylinder| {
            let ball = link.compute_local_bounding_sphere();
            length(ball.center - center) + ball.radius
        };
        BoundingSphere::new(center, self.links().iter().map(reach).fold(0.0, Real::max))
    }

    fn clone_dyn(&self) -> Box<dyn Shape> {
        Box::new(self.clone())
    }

    /// Returns the chain of the scaled links, if each has a scaled link; see the link's
    /// `scale_dyn`.
    fn scale_dyn(&self, scale: Vector, num_subdivisions: u32) -> Option<Box<dyn Shape>> {
        let image =
            self.try_map(|link| link.scale_dyn(scale, num_subdivisions)?.as_shape().copied())?;
        Some(Box::new(image))
    }

    fn compute_aabb(&self, position: &Pose) -> Aabb {
        let boxes = self.links().iter().map(|link| link.aabb(position));
        boxes.reduce(|all, one| all.merged(&one)).unwrap_or_else(Aabb::new_invalid)
    }

    /// Returns the sum over the links. Overlaps of two links count twice: for a tube, approximately
    /// the half balls and wedges at its joints.
    fn mass_properties(&self, density: Real) -> MassProperties {
        mass::mass_properties_of_all(self.links(), density)
    }

    fn shape_type(&self) -> ShapeType {
        ShapeType::Custom
    }

    fn as_typed_shape(&self) -> TypedShape<'_> {
        TypedShape::Custom(self)
    }

    /// Returns the least radius of a link, or half of the chain's length if that is less. A joint
    /// is no end: a disc inside the chain is as thick as its neighbours. (rapier sweeps a body that
    /// moves by half of this in a step.)
    fn ccd_thickness(&self) -> Real {
        match self.links() {
            [link] => link.ccd_thickness(),
            links => {
                let length = links.iter().map(ModifiedCylinder::length).sum::<Real>();
                let radii = links.iter().map(ModifiedCylinder::radius);
                radii.fold(0.5 * length, Real::min)
            }
        }
    }

    fn ccd_angular_thickness(&self) -> Real {
        FRAC_PI_2
    }

    fn as_composite_shape(&self) -> Option<&(dyn CompositeShape + Sync)> {
        Some(self)
    }

    fn feature_normal_at_point(
        &self,
        subshape: SubShapeId,
        feature: FeatureId,
        point: Vector,
    ) -> Option<Vector> {
        self.links().get(subshape as usize)?.feature_normal_at_point(0, feature, point)
    }
}

impl CompositeShape for Chain {
    fn map_part_at(
        &self,
        shape_id: u32,
        f: &mut dyn FnMut(Option<&Pose>, &dyn Shape, Option<&dyn NormalConstraints>),
    ) {
        self.map_untyped_part_at(shape_id, f);
    }

    fn bvh(&self) -> &Bvh {
        Chain::bvh(self)
    }
}

impl TypedCompositeShape for Chain {
    type PartShape = ModifiedCylinder;
    type PartNormalConstraints = ();

    fn map_typed_part_at<T>(
        &self,
        shape_id: u32,
        mut f: impl FnMut(Option<&Pose>, &ModifiedCylinder, Option<&()>) -> T,
    ) -> Option<T> {
        let link = self.links().get(shape_id as usize)?;
        Some(f(None, link, None))
    }

    fn map_untyped_part_at<T>(
        &self,
        shape_id: u32,
        mut f: impl FnMut(Option<&Pose>, &dyn Shape, Option<&dyn NormalConstraints>) -> T,
    ) -> Option<T> {
        self.map_typed_part_at(shape_id, |pose, link, _| f(pose, link, None))
    }
}

/// The link whose surface, or whose solid, is nearest to a point.
struct NearestLink {
    link: usize,
    /// At least 0.
    distance: Real,
    /// Whether any link contains the point.
    is_inside: bool,
}

/// Returns `None` if `point` is not finite.
fn nearest_link(chain: &Chain, point: Vector, solid: bool) -> Option<NearestLink> {
    let (mut nearest, mut is_inside) = (None, false);
    for (link, shape) in chain.links().iter().enumerate() {
        let signed = shape.distance_to_local_point(point, false);
        let distance = if solid { signed.max(0.0) } else { signed.abs() };
        is_inside |= signed <= 0.0;
        if nearest.is_none_or(|(_, best)| distance < best) {
            nearest = Some((link, distance));
        }
    }
    let (link, distance) = nearest.filter(|_| point.is_finite())?;
    Some(NearestLink { link, distance, is_inside })
}

/// Exact from outside, link by link from inside (see the head of this file). The sub-shape of a
/// projection is its link.
impl PointQuery for Chain {
    fn project_local_point(&self, pt: Vector, solid: bool) -> PointProjection {
        let Some(nearest) = nearest_link(self, pt, solid) else {
            return PointProjection::new(false, pt);
        };
        let mut projection = self.links()[nearest.link].project_local_point(pt, solid);
        projection.is_inside = nearest.is_inside;
        projection.with_subshape(nearest.link as u32)
    }

    fn project_local_point_and_get_feature(&self, pt: Vector) -> (PointProjection, FeatureId) {
        let Some(nearest) = nearest_link(self, pt, false) else {
            return (PointProjection::new(false, pt), FeatureId::Unknown);
        };
        let (mut projection, feature) =
            self.links()[nearest.link].project_local_point_and_get_feature(pt);
        projection.is_inside = nearest.is_inside;
        (projection.with_subshape(nearest.link as u32), feature)
    }

    fn distance_to_local_point(&self, pt: Vector, solid: bool) -> Real {
        match nearest_link(self, pt, solid) {
            Some(nearest) if nearest.is_inside => 0.0 - nearest.distance,
            Some(nearest) => nearest.distance,
            None => pt.length(),
        }
    }

    fn contains_local_point(&self, pt: Vector) -> bool {
        self.links().iter().any(|link| link.contains_local_point(pt))
    }
}

/// Exact from outside, link by link from inside (see the head of this file). The sub-shape of a hit
/// is its link.
impl RayCast for Chain {
    fn cast_local_ray_and_get_normal(
        &self,
        ray: &Ray,
        max_time_of_impact: Real,
        solid: bool,
    ) -> Option<RayIntersection> {
        // The search returns hits strictly before its bound.
        let bound = max_time_of_impact.next_up().min(Real::MAX);
        let first = self.bvh().find_best(
            bound,
            |node: &BvhNode, _| earliest(node, ray),
            |link, _| {
                let link = self.links().get(link as usize)?;
                let hit = link.cast_local_ray_and_get_normal(ray, max_time_of_impact, solid)?;
                Some((hit.time_of_impact, hit))
            },
        );
        first.map(|(link, (_, hit))| hit.with_subshape(link))
    }
}

/// Returns a time before which the ray hits no link in the node: a lower bound on the computed
/// times, too. A flat end may lie in a face of its box, so the box is loosened by the rounding
/// error of a hit.
fn earliest(node: &BvhNode, ray: &Ray) -> Real {
    let bounds = Aabb { mins: node.mins(), maxs: node.maxs() };
    let places = [bounds.mins, bounds.maxs, ray.origin].map(|place| place.abs().max_element());
    let rounding = HIT_ROUNDING * places.into_iter().fold(0.0, Real::max);
    let entry = bounds.loosened(rounding).cast_local_ray(ray, Real::MAX, true);
    entry.map_or(Real::MAX, |time| time * (1.0 - HIT_ROUNDING))
}
