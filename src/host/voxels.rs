//! Voxels, one by one.
//!
//! parry's cast against voxels visits all the empty cells on the way, and none of its queries
//! returns the voxel that answered. So this file visits the voxels itself, as
//! [`height_field`](super::height_field) visits elements.

use super::height_field::{reached, rounding, swept};
use parry3d_f64::bounding_volume::{Aabb, BoundingVolume};
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::query::{
    NonlinearRigidMotion, QueryDispatcher, ShapeCastHit, ShapeCastOptions, ShapeIntersection,
    Unsupported,
};
use parry3d_f64::shape::{Cuboid, Shape, Voxels};

/// Returns whether a shape, whose pose is in the voxels' frame, meets a voxel.
pub(super) fn intersection_test(
    dispatcher: &impl QueryDispatcher,
    pos12: &Pose,
    voxels: &Voxels,
    other: &dyn Shape,
) -> Result<ShapeIntersection, Unsupported> {
    let (bounds, root) = (other.compute_aabb(pos12), voxels.local_aabb());
    // Loosened before they are intersected: rounding may part the boxes of shapes that touch.
    let loose = rounding(&bounds, &root);
    let Some(common) = root.loosened(loose).intersection(&bounds.loosened(loose)) else {
        return Ok(ShapeIntersection::new(false));
    };
    let cube = Cuboid::new(voxels.voxel_size() * 0.5);
    for voxel in voxels.voxels_intersecting_local_aabb(&common) {
        let pos12 = Pose::from_translation(-voxel.center) * *pos12;
        let found = dispatcher.intersection_test(&pos12, &cube, other)?;
        if found.intersecting {
            return Ok(ShapeIntersection { subshape1: voxel.linear_id.flat_id() as u32, ..found });
        }
    }
    Ok(ShapeIntersection::new(false))
}

/// Returns the first hit of a shape that moves past voxels, as for a height field.
pub(super) fn cast(
    dispatcher: &impl QueryDispatcher,
    (pos12, vel12): (&Pose, Vector),
    voxels: &Voxels,
    other: &dyn Shape,
    options: ShapeCastOptions,
) -> Result<Option<ShapeCastHit>, Unsupported> {
    let start = other.compute_aabb(pos12);
    let root = voxels.local_aabb();
    let loose = options.target_distance.max(0.0) + rounding(&start, &root);
    let swept = swept(&start.loosened(loose), &root, vel12 * options.max_time_of_impact);
    first_voxel(voxels, &swept, |cube, place| {
        let pos12 = Pose::from_translation(-place) * *pos12;
        dispatcher.cast_shapes(&pos12, vel12, cube, other, options)
    })
}

/// Returns the first hit of a moving shape on moving voxels.
pub(super) fn cast_nonlinear(
    dispatcher: &impl QueryDispatcher,
    (motion1, voxels): (&NonlinearRigidMotion, &Voxels),
    (motion2, other): (&NonlinearRigidMotion, &dyn Shape),
    (start_time, end_time): (Real, Real),
    stop_at_penetration: bool,
) -> Result<Option<ShapeCastHit>, Unsupported> {
    let bounds = reached(motion1, (motion2, other), (start_time, end_time))?;
    first_voxel(voxels, &bounds, |cube, place| {
        let motion1 = motion1.prepend_translation(place);
        dispatcher.cast_shapes_nonlinear(
            &motion1,
            cube,
            motion2,
            other,
            start_time,
            end_time,
            stop_at_penetration,
        )
    })
}

/// Returns the first hit among the voxels in `bounds`. `cast` takes the voxel's shape and its
/// centre.
fn first_voxel(
    voxels: &Voxels,
    bounds: &Aabb,
    cast: impl Fn(&Cuboid, Vector) -> Result<Option<ShapeCastHit>, Unsupported>,
) -> Result<Option<ShapeCastHit>, Unsupported> {
    let cube = Cuboid::new(voxels.voxel_size() * 0.5);
    let Some(common) = voxels.local_aabb().intersection(bounds) else { return Ok(None) };
    let mut first: Option<ShapeCastHit> = None;
    for voxel in voxels.voxels_intersecting_local_aabb(&common) {
        let Some(hit) = cast(&cube, voxel.center)? else { continue };
        if first.is_none_or(|first| hit.time_of_impact < first.time_of_impact) {
            let subshape1 = voxel.linear_id.flat_id() as u32;
            first = Some(ShapeCastHit { subshape1, witness1: hit.witness1 + voxel.center, ..hit });
        }
    }
    Ok(first)
}
