//! Shapes that consist of others, part by part: the boxes of parts choose which are asked, loosened
//! by what rounding can have taken from them.
//!
//! parry's own routines compare the boxes as they are. Of two shapes that touch, the boxes may miss
//! each other by a unit in the last place, and a ray that grazes a box may be rounded past it. All
//! that is left out here is proven to be further away than rounding can be wrong; so what the parts
//! say is what the whole says.

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

/// A shape that consists of parts and another shape, whose pose is in the first's frame.
pub(super) struct CompositePair<'a, D> {
    pub dispatcher: &'a D,
    pub parts: &'a dyn CompositeShape,
    pub pos12: &'a Pose,
    pub other: &'a dyn Shape,
}

impl<D: QueryDispatcher> CompositePair<'_, D> {
    /// The first part that is found to meet the other shape.
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

    /// The deepest contact, or the nearest.
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

    /// The closest points of the nearest part.
    pub fn closest_points(&self, max_dist: Real) -> Result<ClosestPoints, Unsupported> {
        let (refused, around) = (Cell::new(false), self.around(0.0));
        // The search wants parts strictly nearer than its bound.
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
                                // It is within the margin, however its length is rounded, and of
                                // points that coincide another part
                                // may still say that it is met.
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

    /// The first hit of the other shape, which moves at `vel12`.
    pub fn cast_shapes(
        &self,
        vel12: Vector,
        options: ShapeCastOptions,
    ) -> Result<Option<ShapeCastHit>, Unsupported> {
        let (refused, latest) = (Cell::new(false), options.max_time_of_impact);
        let around = self.around(options.target_distance.max(0.0));
        let ray = Ray::new(Vector::ZERO, vel12);
        // The search wants hits strictly earlier than its bound, and goes through all that is never
        // met for a bound above the largest number.
        let bound = latest.next_up().min(Real::MAX);
        let first = self.parts.bvh().find_best(
            bound,
            |node: &BvhNode, so_far| {
                // Where the other shape's box, shrunk to a point, meets the part's, grown by it.
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

    /// What `query` says of a part, whose place it is told with the other shape's pose in the
    /// part's frame; and that place.
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

    /// The other shape's box, loosened by `margin` and by rounding.
    fn around(&self, margin: Real) -> Aabb {
        let bounds = self.other.compute_aabb(self.pos12);
        let rounding = rounding(&bounds, &self.parts.bvh().root_aabb());
        bounds.loosened(margin + rounding + 16.0 * Real::EPSILON * margin)
    }
}
