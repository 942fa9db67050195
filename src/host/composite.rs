//! Composite shapes, part by part. The boxes of the parts select candidates, loosened by a margin
//! for rounding.
//!
//! parry's own routines compare boxes without a margin. The boxes of two shapes that touch may miss
//! each other by a unit in the last place. A ray that grazes a box may be rounded past it. Here
//! every part that is skipped is proven to be farther away than the rounding error. So the best
//! answer of the parts is the answer of the whole.

use super::height_field::rounding;
use parry3d_f64::bounding_volume::{Aabb, BoundingVolume};
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::partitioning::BvhNode;
use parry3d_f64::query::{
    ClosestPoints, Contact, QueryDispatcher, Ray, RayCast, ShapeCastHit, ShapeCastOptions,
    ShapeIntersection, Unsupported,
};
use parry3d_f64::shape::{CompositeShape, Shape};
use std::cell::Cell;

/// A composite shape and another shape, whose pose is in the composite's frame.
pub(super) struct CompositePair<'a, D> {
    pub dispatcher: &'a D,
    pub parts: &'a dyn CompositeShape,
    pub pos12: &'a Pose,
    pub other: &'a dyn Shape,
}

impl<D: QueryDispatcher> CompositePair<'_, D> {
    /// Returns the first part that meets the other shape.
    pub fn intersection_test(&self) -> Result<ShapeIntersection, Unsupported> {
        for id in self.parts.bvh().intersect_aabb(&self.around(0.0)) {
            let found = self.ask(id, |_, pos12, part| {
                self.dispatcher.intersection_test(pos12, part, self.other)
            })?;
            if let Some((_, found)) = found.filter(|(_, found)| found.intersecting) {
                return Ok(ShapeIntersection { subshape1: id, ..found });
            }
        }
        Ok(ShapeIntersection::new(false))
    }

    /// Returns the deepest contact, or the nearest one.
    pub fn contact(&self, prediction: Real) -> Result<Option<Contact>, Unsupported> {
        let mut best: Option<Contact> = None;
        for id in self.parts.bvh().intersect_aabb(&self.around(prediction.max(0.0))) {
            let found = self.ask(id, |_, pos12, part| {
                self.dispatcher.contact(pos12, part, self.other, prediction)
            })?;
            let Some((place, Some(mut contact))) = found else { continue };
            if best.is_none_or(|best| contact.dist < best.dist) {
                if let Some(place) = place {
                    contact.transform1_by_mut(&place);
                }
                best = Some(Contact { subshape1: id, ..contact });
            }
        }
        Ok(best)
    }

    /// Returns the closest points of the nearest part.
    pub fn closest_points(&self, max_dist: Real) -> Result<ClosestPoints, Unsupported> {
        let (refused, around) = (Cell::new(false), self.around(0.0));
        // The search returns parts strictly nearer than its bound.
        let bound = max_dist.max(0.0).next_up().min(Real::MAX);
        let best = self.parts.bvh().find_best(
            bound,
            |node: &BvhNode, _| {
                (node.mins() - around.maxs)
                    .max(around.mins - node.maxs())
                    .max(Vector::ZERO)
                    .length()
            },
            |id, _| {
                let found = self
                    .ask(id, |_, pos12, part| {
                        let points =
                            self.dispatcher.closest_points(pos12, part, self.other, max_dist)?;
                        Ok(match points {
                            ClosestPoints::Disjoint => None,
                            ClosestPoints::Intersecting => Some((0.0, points)),
                            ClosestPoints::WithinMargin(point1, point2) => {
                                // The points are within the margin, even if their length rounds
                                // beyond it. A positive cost lets a part that overlaps win over
                                // points that coincide.
                                let length =
                                    (point1 - pos12 * point2).length().max(Real::MIN_POSITIVE);
                                Some((length.min(bound.next_down()), points))
                            }
                        })
                    })
                    .inspect_err(|_| refused.set(true));
                let (place, Some((cost, points))) = found.ok()?? else { return None };
                let points = match (points, place) {
                    (ClosestPoints::WithinMargin(point1, point2), Some(place)) => {
                        ClosestPoints::WithinMargin(place * point1, point2)
                    }
                    (points, _) => points,
                };
                Some((cost, points))
            },
        );
        if refused.get() {
            return Err(Unsupported);
        }
        Ok(best.map_or(ClosestPoints::Disjoint, |(_, (_, points))| points))
    }

    /// Returns the first hit of the other shape, which moves at `vel12`.
    pub fn cast_shapes(
        &self,
        vel12: Vector,
        options: ShapeCastOptions,
    ) -> Result<Option<ShapeCastHit>, Unsupported> {
        let (refused, latest) = (Cell::new(false), options.max_time_of_impact);
        let around = self.around(options.target_distance.max(0.0));
        let ray = Ray::new(Vector::ZERO, vel12);
        // The search returns hits strictly earlier than its bound. A bound above the largest number
        // would make it visit parts that are never hit.
        let bound = latest.next_up().min(Real::MAX);
        let first = self.parts.bvh().find_best(
            bound,
            |node: &BvhNode, so_far| {
                // The other shape's box shrinks to a point, and the part's box grows by it.
                let grown =
                    Aabb { mins: node.mins() - around.maxs, maxs: node.maxs() - around.mins };
                grown.cast_local_ray(&ray, so_far, true).unwrap_or(Real::MAX)
            },
            |id, _| {
                let hit = self.ask(id, |place, pos12, part| {
                    let vel12 = place.map_or(vel12, |place| place.rotation.inverse() * vel12);
                    self.dispatcher.cast_shapes(pos12, vel12, part, self.other, options)
                });
                let hit = hit.inspect_err(|_| refused.set(true));
                let (place, Some(hit)) = hit.ok()?? else { return None };
                let hit = place.map_or(hit, |place| hit.transform1_by(&place));
                Some((hit.time_of_impact, hit))
            },
        );
        if refused.get() {
            return Err(Unsupported);
        }
        let first = first.map(|(id, (_, hit))| ShapeCastHit { subshape1: id, ..hit });
        Ok(first.filter(|hit| hit.time_of_impact <= latest))
    }

    /// Runs `query` on a part, with the part's pose and the other shape's pose in the part's frame.
    /// Returns the part's pose and the result.
    fn ask<T>(
        &self,
        id: u32,
        query: impl Fn(Option<&Pose>, &Pose, &dyn Shape) -> Result<T, Unsupported>,
    ) -> Result<Option<(Option<Pose>, T)>, Unsupported> {
        let mut answer = Ok(None);
        self.parts.map_part_at(id, &mut |place, part, _| {
            let pos12 = place.map_or(*self.pos12, |place| place.inv_mul(self.pos12));
            answer = query(place, &pos12, part).map(|found| Some((place.copied(), found)));
        });
        answer
    }

    /// Returns the other shape's box, loosened by `margin` and by rounding.
    fn around(&self, margin: Real) -> Aabb {
        let bounds = self.other.compute_aabb(self.pos12);
        let rounding = rounding(&bounds, &self.parts.bvh().root_aabb());
        bounds.loosened(margin + rounding + 16.0 * Real::EPSILON * margin)
    }
}
