//! The range of numbers that is answered.

use crate::robot::{COORDINATE_LIMIT, Chain};
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::query::Unsupported;
use parry3d_f64::shape::{Shape, TypedShape};
use std::ops::RangeInclusive;

/// The largest coordinate of a pair that is scaled for parry's iterations. Beyond, the power of two
/// or what it makes of the smaller coordinates is out of the range of f64.
const ITERATED_RANGE: RangeInclusive<Real> = 1.0 / COORDINATE_LIMIT..=COORDINATE_LIMIT;

/// The least size of a shape beside the largest coordinate that iterations can tell from nothing:
/// 2^-40.
pub(super) const MIN_SHARE: Real = Real::from_bits((1023 - 40) << 52);

/// A pose that every shape can be moved by: finite, within range, with a rotation of unit length.
pub(super) fn check_pose(pose: &Pose) -> Result<(), Unsupported> {
    let largest = pose.translation.abs().max_element();
    let is_rigid = pose.is_finite() && pose.rotation.is_normalized();
    if is_rigid && largest <= COORDINATE_LIMIT { Ok(()) } else { Err(Unsupported) }
}

/// A number that distances or times can be compared with.
pub(super) fn check_margin(margin: Real) -> Result<(), Unsupported> {
    if margin.is_nan() { Err(Unsupported) } else { Ok(()) }
}

/// The largest coordinate, if all are within the range that is answered.
pub(super) fn in_range(point: Vector) -> Result<Real, Unsupported> {
    let largest = point.abs().max_element();
    // Written so that NaN is out of range too.
    if point.is_finite() && largest <= COORDINATE_LIMIT { Ok(largest) } else { Err(Unsupported) }
}

/// The largest coordinate of a pair in the frame of the first shape.
pub(super) fn largest(pos12: &Pose, g1: &dyn Shape, g2: &dyn Shape) -> Real {
    let boxes = [g1.compute_local_aabb(), g2.compute_aabb(pos12)];
    let corners = boxes.iter().flat_map(|bounds| [bounds.mins, bounds.maxs]);
    corners.map(|corner| corner.abs()).fold(Vector::ZERO, Vector::max).max_element()
}

/// What rounding can have taken from the meeting of the boxes of two shapes and of their parts; 0
/// for shapes without bounds. A box's corner is a sum of four products, or a vertex that is moved:
/// a few units in the last place of the largest coordinate each. A turn makes no coordinate larger
/// than a length, which is less than twice the largest before.
pub(super) fn rounding_of_boxes(pos12: &Pose, g1: &dyn Shape, g2: &dyn Shape) -> Real {
    let largest = reach(g1).max(2.0 * reach(g2) + pos12.translation.abs().max_element());
    if largest <= COORDINATE_LIMIT { 16.0 * Real::EPSILON * largest } else { 0.0 }
}

/// Depths of contacts that differ by no more are equal: 16 u times the largest coordinate. A shape
/// without bounds, such as a half-space, has no size of its own.
pub(super) fn rounding_of_depths(pos12: &Pose, g1: &dyn Shape, g2: &dyn Shape) -> Real {
    let offset = pos12.translation.abs().max_element();
    let sizes = [reach(g1), reach(g2), offset].into_iter().filter(|&size| size <= COORDINATE_LIMIT);
    8.0 * Real::EPSILON * sizes.fold(0.0, Real::max)
}

/// No coordinate of a shape in its own frame is larger.
fn reach(shape: &dyn Shape) -> Real {
    if let Some(chain) = shape.as_shape::<Chain>() {
        return chain.reach(); // its box would ask every link
    }
    let bounds = shape.compute_local_aabb();
    bounds.mins.abs().max(bounds.maxs.abs()).max_element()
}

/// Whether a pair is within the range of parry's iterations. Beyond it they panic or answer NaN:
/// where the smaller shape is lost in the rounding of what is large, and where a number is not
/// finite.
pub(super) fn is_iterated(pos12: &Pose, g1: &dyn Shape, g2: &dyn Shape) -> bool {
    let largest = largest(pos12, g1, g2);
    // Each in its own frame: a turned infinity is NaN, which the extremes of a box leave out.
    let boxes = [g1.compute_local_aabb(), g2.compute_local_aabb()];
    let is_finite = boxes.iter().all(|bounds| bounds.mins.is_finite() && bounds.maxs.is_finite());
    let sizes = boxes.iter().map(|bounds| bounds.extents().max_element());
    let is_seen = sizes.into_iter().all(|size| size == 0.0 || size >= MIN_SHARE * largest);
    is_finite && has_numbers(g1) && has_numbers(g2) && ITERATED_RANGE.contains(&largest) && is_seen
}

/// Whether no corner of a shape is NaN, which boxes leave out.
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
