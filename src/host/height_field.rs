//! Height fields and moving composites, element by element, where parry's queries do not suffice.
//!
//! - parry's cast against a height field examines the starting cells only if the motion has no
//!   height component.
//! - parry's nonlinear cast against a composite bisects for the balls around the parts, without end
//!   if a number is large.
//! - None of parry's queries on fields returns the element that answered.
//!
//! So this file visits the elements itself: those whose boxes meet the box that the other shape
//! occupies, reaches or sweeps, loosened by a margin for rounding.

use parry3d_f64::bounding_volume::{Aabb, BoundingVolume};
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::query::{
    ClosestPoints, Contact, NonlinearRigidMotion, QueryDispatcher, ShapeCastHit, ShapeCastOptions,
    ShapeDistance, ShapeIntersection, Unsupported,
};
use parry3d_f64::shape::{CompositeShape, HeightField, Shape, Triangle};
use std::collections::HashSet;

/// A height field and another shape, whose pose is in the field's frame.
pub(super) struct HeightFieldPair<'a, D> {
    pub dispatcher: &'a D,
    pub field: &'a HeightField,
    pub pos12: &'a Pose,
    pub other: &'a dyn Shape,
}

impl<D: QueryDispatcher> HeightFieldPair<'_, D> {
    pub fn distance(&self) -> Result<ShapeDistance, Unsupported> {
        let near = self.distance_to(&self.some_element().ok_or(Unsupported)?)?.distance;
        let nearest = least_element(self.field, &self.around(near), |element| {
            let found = self.distance_to(element)?;
            Ok(Some((found.distance, found)))
        })?;
        let (id, found) = nearest.ok_or(Unsupported)?;
        Ok(ShapeDistance { subshape1: id, ..found })
    }

    pub fn closest_points(&self, max_dist: Real) -> Result<ClosestPoints, Unsupported> {
        let nearest = self.distance()?.subshape1;
        let element = self.field.triangle_at_id(nearest).ok_or(Unsupported)?;
        self.dispatcher.closest_points(self.pos12, &element, self.other, max_dist)
    }

    pub fn intersection_test(&self) -> Result<ShapeIntersection, Unsupported> {
        let touching = least_element(self.field, &self.around(0.0), |element| {
            let found = self.dispatcher.intersection_test(self.pos12, element, self.other)?;
            Ok(found.intersecting.then_some((0.0, found)))
        })?;
        Ok(touching.map_or(ShapeIntersection::new(false), |(id, found)| ShapeIntersection {
            subshape1: id,
            ..found
        }))
    }

    pub fn contact(&self, prediction: Real) -> Result<Option<Contact>, Unsupported> {
        let deepest = least_element(self.field, &self.around(prediction.max(0.0)), |element| {
            let contact = self.dispatcher.contact(self.pos12, element, self.other, prediction)?;
            Ok(contact.map(|contact| (contact.dist, contact)))
        })?;
        Ok(deepest.map(|(id, contact)| Contact { subshape1: id, ..contact }))
    }

    pub fn cast_shapes(
        &self,
        vel12: Vector,
        options: ShapeCastOptions,
    ) -> Result<Option<ShapeCastHit>, Unsupported> {
        let start = self.around(options.target_distance.max(0.0));
        let swept = swept(&start, self.field.root_aabb(), vel12 * options.max_time_of_impact);
        let first = least_element(self.field, &swept, |element| {
            let hit =
                self.dispatcher.cast_shapes(self.pos12, vel12, element, self.other, options)?;
            Ok(hit.map(|hit| (hit.time_of_impact, hit)))
        })?;
        Ok(first.map(|(id, hit)| ShapeCastHit { subshape1: id, ..hit }))
    }

    fn distance_to(&self, element: &Triangle) -> Result<ShapeDistance, Unsupported> {
        self.dispatcher.distance(self.pos12, element, self.other)
    }

    /// Returns the other shape's box, loosened by `margin` and by rounding.
    fn around(&self, margin: Real) -> Aabb {
        let bounds = self.other.compute_aabb(self.pos12);
        let rounding = rounding(&bounds, self.field.root_aabb());
        bounds.loosened(margin + rounding + 16.0 * Real::EPSILON * margin)
    }

    /// Returns an element below or above the other shape, or any element.
    fn some_element(&self) -> Option<Triangle> {
        let centre = self.other.compute_aabb(self.pos12).center();
        let (i, j) = self.field.closest_cell_at_point(centre);
        let (left, right) = self.field.triangles_at(i, j);
        left.or(right).or_else(|| self.field.triangles().next())
    }
}

/// Returns the first hit of a moving shape on a moving height field.
pub(super) fn cast_nonlinear(
    dispatcher: &dyn QueryDispatcher,
    (motion1, field): (&NonlinearRigidMotion, &HeightField),
    (motion2, other): (&NonlinearRigidMotion, &dyn Shape),
    (start_time, end_time): (Real, Real),
    stop_at_penetration: bool,
) -> Result<Option<ShapeCastHit>, Unsupported> {
    let (bounds, _) = reached(motion1, (motion2, other), (start_time, end_time))?;
    let first = least_element(field, &bounds, |element| {
        let hit = dispatcher.cast_shapes_nonlinear(
            motion1,
            element,
            motion2,
            other,
            start_time,
            end_time,
            stop_at_penetration,
        )?;
        Ok(hit.map(|hit| (hit.time_of_impact, hit)))
    })?;
    Ok(first.map(|(id, hit)| ShapeCastHit { subshape1: id, ..hit }))
}

/// Returns the margin for rounding when two boxes are tested for overlap.
pub(super) fn rounding(bounds: &Aabb, root: &Aabb) -> Real {
    let size =
        [bounds.mins, bounds.maxs, root.mins, root.maxs].map(|corner| corner.abs().max_element());
    16.0 * Real::EPSILON * size.into_iter().fold(0.0, Real::max)
}

/// Returns the box swept by a box along `path`, clipped to `root` because the path may be infinite.
pub(super) fn swept(start: &Aabb, root: &Aabb, path: Vector) -> Aabb {
    let mut swept = *start;
    for i in 0..3 {
        if path[i] > 0.0 {
            swept.maxs[i] = (start.maxs[i] + path[i]).min(root.maxs[i]).max(start.maxs[i]);
        } else if path[i] < 0.0 {
            swept.mins[i] = (start.mins[i] + path[i]).max(root.mins[i]).min(start.mins[i]);
        }
    }
    swept
}

/// Returns a box in the first shape's frame that contains the second shape at all times, and how
/// far the second shape moves from the middle of the time.
///
/// **Definitions.** c: the centre of the second shape's bounding ball. h: half of the time.
///
/// **Claim.** In the first shape's frame c travels at most `shift + h w lever` from its place at
/// the middle of the time. **Proof.** The relative speed of c is at most the difference of both
/// linear velocities, plus the swing of c about its own centre, plus w times the distance of c from
/// the first shape's centre. The first two are constant and sum up to `shift`; the distance is at
/// most the one in the middle plus `shift`.
pub(super) fn reached(
    motion1: &NonlinearRigidMotion,
    (motion2, other): (&NonlinearRigidMotion, &dyn Shape),
    (start_time, end_time): (Real, Real),
) -> Result<(Aabb, Real), Unsupported> {
    let (middle, half) = (0.5 * start_time + 0.5 * end_time, 0.5 * (end_time - start_time));
    let (pos1, pos2) = (motion1.position_at_time(middle), motion2.position_at_time(middle));
    let ball = other.compute_local_bounding_sphere();
    let centre = pos2 * ball.center;
    let swing = motion2.angvel.length() * (ball.center - motion2.local_center).length();
    let shift = half * ((motion1.linvel - motion2.linvel).length() + swing);
    let lever = (centre - pos1 * motion1.local_center).length() + shift;
    let travel = shift + half * motion1.angvel.length() * lever;
    let local = pos1.inverse_transform_point(centre);
    let reach = ball.radius + travel;
    let rounding = 16.0 * Real::EPSILON * (local.abs().max_element() + lever + reach);
    let bounds = Aabb::new(local, local).loosened((reach + rounding).max(0.0));
    if !(bounds.mins.is_finite() && bounds.maxs.is_finite()) {
        return Err(Unsupported);
    }
    Ok((bounds, travel))
}

/// Returns the first hit of a moving shape on the moving parts of a composite.
pub(super) fn cast_parts_nonlinear(
    dispatcher: &dyn QueryDispatcher,
    (motion1, parts): (&NonlinearRigidMotion, &dyn CompositeShape),
    (motion2, other): (&NonlinearRigidMotion, &dyn Shape),
    times: (Real, Real),
    stop_at_penetration: bool,
) -> Result<Option<ShapeCastHit>, Unsupported> {
    let size = other.compute_local_bounding_sphere().radius;
    let mut cast = PartsCast {
        dispatcher,
        sides: ((motion1, parts), (motion2, other)),
        times,
        stop_at_penetration,
        size,
        tried: HashSet::new(),
        first: None,
    };
    cast.search(times, MOST_HALVINGS)?;
    Ok(cast.first)
}

/// How often the time of a cast is halved. A thin shape on a long path meets fewer parts in each
/// part of the time.
const MOST_HALVINGS: u32 = 12;

/// A moving composite and another moving shape.
struct PartsCast<'a> {
    dispatcher: &'a dyn QueryDispatcher,
    sides: (
        (&'a NonlinearRigidMotion, &'a dyn CompositeShape),
        (&'a NonlinearRigidMotion, &'a dyn Shape),
    ),
    times: (Real, Real),
    stop_at_penetration: bool,
    /// The radius of the other shape's bounding ball.
    size: Real,
    /// The parts that have been cast, over the whole time until the first hit then known.
    tried: HashSet<u32>,
    first: Option<ShapeCastHit>,
}

impl PartsCast<'_> {
    /// Casts the parts that may be met between two times.
    fn search(&mut self, (from, to): (Real, Real), halvings: u32) -> Result<(), Unsupported> {
        if self.first.is_some_and(|first| first.time_of_impact <= from) {
            return Ok(());
        }
        let ((motion1, parts), (motion2, other)) = self.sides;
        // A shape without bounds, such as a half-space, may meet any part.
        let (bounds, travel) = reached(motion1, (motion2, other), (from, to))
            .unwrap_or((parts.bvh().root_aabb(), 0.0));
        if halvings > 0 && travel > self.size {
            if parts.bvh().intersect_aabb(&bounds).next().is_some() {
                let middle = 0.5 * from + 0.5 * to;
                self.search((from, middle), halvings - 1)?;
                self.search((middle, to), halvings - 1)?;
            }
            return Ok(());
        }
        for id in parts.bvh().intersect_aabb(&bounds) {
            if self.tried.insert(id) {
                self.cast(id)?;
            }
        }
        Ok(())
    }

    /// Casts one part.
    fn cast(&mut self, id: u32) -> Result<(), Unsupported> {
        let ((motion1, parts), (motion2, other)) = self.sides;
        let end = self.first.map_or(self.times.1, |first| first.time_of_impact);
        let mut found = Ok(None);
        parts.map_part_at(id, &mut |place, part, _| {
            let motion1 = place.map_or(*motion1, |place| motion1.prepend(*place));
            let hit = self.dispatcher.cast_shapes_nonlinear(
                &motion1,
                part,
                motion2,
                other,
                self.times.0,
                end,
                self.stop_at_penetration,
            );
            found =
                hit.map(|hit| hit.map(|hit| place.map_or(hit, |place| hit.transform1_by(place))));
        });
        if let Some(hit) = found?
            && self.first.is_none_or(|first| hit.time_of_impact < first.time_of_impact)
        {
            self.first = Some(ShapeCastHit { subshape1: id, ..hit });
        }
        Ok(())
    }
}

/// Returns the element in `bounds` of least cost, its id, and the rest of the result of `cost`.
fn least_element<T>(
    field: &HeightField,
    bounds: &Aabb,
    cost: impl Fn(&Triangle) -> Result<Option<(Real, T)>, Unsupported>,
) -> Result<Option<(u32, T)>, Unsupported> {
    let mut best: Result<Option<(Real, u32, T)>, Unsupported> = Ok(None);
    field.map_elements_in_local_aabb(bounds, &mut |id, element| {
        if let Ok(so_far) = &best {
            match cost(element) {
                Ok(Some((cost, what))) if so_far.as_ref().is_none_or(|so_far| cost < so_far.0) => {
                    best = Ok(Some((cost, id, what)));
                }
                Ok(_) => {}
                Err(refused) => best = Err(refused),
            }
        }
    });
    Ok(best?.map(|(_, id, what)| (id, what)))
}
