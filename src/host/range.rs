//! The range of numbers for which queries are answered.

use crate::robot::{COORDINATE_LIMIT, Chain};
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::query::Unsupported;
use parry3d_f64::shape::{Shape, TypedShape};
use std::ops::RangeInclusive;

/// The range of the largest coordinate of a pair that is scaled for parry's iterations. Beyond it,
/// the power of two or the scaled smaller coordinates leave the range of f64.
const ITERATED_RANGE: RangeInclusive<Real> = 1.0 / COORDINATE_LIMIT..=COORDINATE_LIMIT;

/// The least size of a shape, relative to the largest coordinate, that iterations can resolve:
/// 2^-40.
pub(super) const MIN_SHARE: Real = Real::from_bits((1023 - 40) << 52);

/// Checks that a pose is finite and in range, with a rotation of unit length.
pub(super) fn check_pose(pose: &Pose) -> Result<(), Unsupported> {
    let largest = pose.translation.abs().max_element();
    let is_rigid = pose.is_finite() && pose.rotation.is_normalized();
    if is_rigid && largest <= COORDINATE_LIMIT { Ok(()) } else { Err(Unsupported) }
}

/// Checks that a distance or a time is not NaN.
pub(super) fn check_margin(margin: Real) -> Result<(), Unsupported> {
    if margin.is_nan() { Err(Unsupported) } else { Ok(()) }
}

/// Returns the largest coordinate, if all coordinates are in range.
pub(super) fn in_range(point: Vector) -> Result<Real, Unsupported> {
    let largest = point.abs().max_element();
    // Written so that NaN is out of range.
    if point.is_finite() && largest <= COORDINATE_LIMIT { Ok(largest) } else { Err(Unsupported) }
}

/// Returns the largest coordinate of a pair in the frame of the first shape.
pub(super) fn largest(pos12: &Pose, g1: &dyn Shape, g2: &dyn Shape) -> Real {
    let boxes = [g1.compute_local_aabb(), g2.compute_aabb(pos12)];
    let corners = boxes.iter().flat_map(|bounds| [bounds.mins, bounds.maxs]);
    corners.map(|corner| corner.abs()).fold(Vector::ZERO, Vector::max).max_element()
}

/// Returns the margin for rounding in a test of the boxes of two shapes and of their parts; 0 for
/// shapes without bounds.
///
/// A box's corner is a sum of four products, or a moved vertex: it errs by a few units in the last
/// place of the largest coordinate. A rotation makes no coordinate larger than a length, which is
/// less than twice the largest coordinate before.
pub(super) fn rounding_of_boxes(pos12: &Pose, g1: &dyn Shape, g2: &dyn Shape) -> Real {
    let largest = reach(g1).max(2.0 * reach(g2) + pos12.translation.abs().max_element());
    if largest <= COORDINATE_LIMIT { 16.0 * Real::EPSILON * largest } else { 0.0 }
}

/// Returns the difference up to which depths of contacts are equal: 16 u times the largest
/// coordinate. A shape without bounds, such as a half-space, has no size of its own.
pub(super) fn rounding_of_depths(pos12: &Pose, g1: &dyn Shape, g2: &dyn Shape) -> Real {
    let offset = pos12.translation.abs().max_element();
    let sizes = [reach(g1), reach(g2), offset].into_iter().filter(|&size| size <= COORDINATE_LIMIT);
    8.0 * Real::EPSILON * sizes.fold(0.0, Real::max)
}

/// Returns an upper bound on the coordinates of a shape in its own frame.
fn reach(shape: &dyn Shape) -> Real {
    if let Some(chain) = shape.as_shape::<Chain>() {
        return chain.reach(); // its box would ask every link
    }
    let bounds = shape.compute_local_aabb();
    bounds.mins.abs().max(bounds.maxs.abs()).max_element()
}

/// Returns whether a pair is in the range of parry's iterations. Outside they panic or return NaN:
/// if the smaller shape is lost in the rounding of the larger numbers, or if a number is not
/// finite.
pub(super) fn is_iterated(pos12: &Pose, g1: &dyn Shape, g2: &dyn Shape) -> bool {
    let largest = largest(pos12, g1, g2);
    // Each box in its own frame: a rotated infinity is NaN, which box extremes ignore.
    let boxes = [g1.compute_local_aabb(), g2.compute_local_aabb()];
    let is_finite = boxes.iter().all(|bounds| bounds.mins.is_finite() && bounds.maxs.is_finite());
    let sizes = boxes.iter().map(|bounds| bounds.extents().max_element());
    let is_seen = sizes.into_iter().all(|size| size == 0.0 || size >= MIN_SHARE * largest);
    is_finite && has_numbers(g1) && has_numbers(g2) && ITERATED_RANGE.contains(&largest) && is_seen
}

/// Returns whether no corner of a shape is NaN, which boxes ignore.
fn has_numbers(shape: &dyn Shape) -> bool {
    let is_finite = |points: &[Vector]| points.iter().all(|point| point.is_finite());
    match shape.as_typed_shape() {
        TypedShape::Capsule(capsule) => is_finite(&[capsule.segment.a, capsule.segment.b]),
        TypedShape::RoundTriangle(round) => is_finite(round.inner_shape.vertices()),
        TypedShape::ConvexPolyhedron(hull) => is_finite(hull.points()),
        TypedShape::RoundConvexPolyhedron(round) => is_finite(round.inner_shape.points()),
        _ => true,
    }
}
