//! Segments, and shapes that degenerate to a segment or a triangle, as triangles.
//!
//! Examples are a rounded triangle with border 0, and a box or a cone that is a line. parry's
//! iterations build tetrahedra from the difference of two shapes. For degenerate shapes the
//! tetrahedra have no volume, and parry may panic. This crate treats them as triangles, most of
//! them without area, and answers exactly. A thickness of up to [`MIN_SHARE`] of the shape's size
//! is ignored; the answers are off by that much.

use super::range::MIN_SHARE;
use super::robot_surface::links_of;
use parry3d_f64::math::{Real, Vector};
use parry3d_f64::shape::{Shape, Triangle, TypedShape};

/// The replacement of the other shape of a pair with a robot.
pub(super) struct ThinShape {
    stand_ins: [Option<Triangle>; 2],
}

impl ThinShape {
    pub fn of(g1: &dyn Shape, g2: &dyn Shape) -> Self {
        let stand_ins = match [links_of(g1), links_of(g2)] {
            [Some(_), None] => [None, triangle_of(g2)],
            [None, Some(_)] => [triangle_of(g1), None],
            _ => [None, None],
        };
        Self { stand_ins }
    }

    /// Returns the pair, with a triangle in place of the other shape if it is one.
    pub fn pair<'a>(&'a self, g1: &'a dyn Shape, g2: &'a dyn Shape) -> [&'a dyn Shape; 2] {
        let [first, second] = &self.stand_ins;
        let or = |stand_in: &'a Option<Triangle>, shape| {
            stand_in.as_ref().map_or(shape, |it| it as &dyn Shape)
        };
        [or(first, g1), or(second, g2)]
    }
}

/// Returns the triangle to which a shape degenerates, if it does.
fn triangle_of(shape: &dyn Shape) -> Option<Triangle> {
    let line = |a, b| Some(Triangle::new(a, b, b));
    let upright = |half_height: Real| line(Vector::Y * half_height, -Vector::Y * half_height);
    // Only for kinds that may be thin: this code runs for every pair of parts.
    let is_thin = |radius: Real| {
        let size = shape.compute_local_aabb().extents().max_element();
        // No thickness is a small share of an infinite size.
        let least = if size.is_finite() { 0.5 * MIN_SHARE * size } else { 0.0 };
        (0.0..=least).contains(&radius)
    };
    match shape.as_typed_shape() {
        TypedShape::Segment(segment) => line(segment.a, segment.b),
        TypedShape::RoundTriangle(round) if is_thin(round.border_radius) => Some(round.inner_shape),
        TypedShape::Cuboid(cuboid) => line_of_box(cuboid.half_extents, is_thin),
        TypedShape::RoundCuboid(round) if is_thin(round.border_radius) => {
            line_of_box(round.inner_shape.half_extents, is_thin)
        }
        TypedShape::Cylinder(cylinder) if cylinder.radius == 0.0 => upright(cylinder.half_height),
        TypedShape::RoundCylinder(round)
            if is_thin(round.border_radius) && is_thin(round.inner_shape.radius) =>
        {
            upright(round.inner_shape.half_height)
        }
        TypedShape::Cone(cone) if is_thin(cone.radius) => upright(cone.half_height),
        TypedShape::RoundCone(round)
            if is_thin(round.border_radius) && is_thin(round.inner_shape.radius) =>
        {
            upright(round.inner_shape.half_height)
        }
        _ => None,
    }
}

/// Returns the line to which a box degenerates, if two of its half extents are thin.
fn line_of_box(half_extents: Vector, is_thin: impl Fn(Real) -> bool) -> Option<Triangle> {
    let half = match half_extents.to_array().map(is_thin) {
        [_, true, true] => Vector::X * half_extents.x,
        [true, _, true] => Vector::Y * half_extents.y,
        [true, true, _] => Vector::Z * half_extents.z,
        _ => return None,
    };
    Some(Triangle::new(half, -half, -half))
}
