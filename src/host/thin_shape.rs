//! Segments, and shapes that are no more than a segment or a triangle, as triangles.
//!
//! Such shapes are a rounded triangle with a border of 0, or a box or a cone that is a line.
//! parry's iterations build tetrahedra from the difference of two shapes. With these the tetrahedra
//! have no volume, and parry may panic. To this crate they are triangles, most of them without an
//! area, and triangles are answered exactly. A thickness of up to [`MIN_SHARE`] of the shape's size
//! is left out, and the answers are off by that much.

use super::range::MIN_SHARE;
use super::robot_surface::links_of;
use parry3d_f64::math::{Real, Vector};
use parry3d_f64::shape::{Shape, Triangle, TypedShape};

/// What stands for the other shape of a pair with a robot.
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

    /// The pair, with a triangle in the place of the other shape, if it is one.
    pub fn pair<'a>(&'a self, g1: &'a dyn Shape, g2: &'a dyn Shape) -> [&'a dyn Shape; 2] {
        let [first, second] = &self.stand_ins;
        let or = |stand_in: &'a Option<Triangle>, shape| {
            stand_in.as_ref().map_or(shape, |it| it as &dyn Shape)
        };
        [or(first, g1), or(second, g2)]
    }
}

/// The triangle that a shape of another kind is, if it is one.
fn triangle_of(shape: &dyn Shape) -> Option<Triangle> {
    let line = |a, b| Some(Triangle::new(a, b, b));
    let upright = |half_height: Real| line(Vector::Y * half_height, -Vector::Y * half_height);
    // Only for the kinds that may be thin: every pair of parts comes by here.
    let is_thin = |radius: Real| {
        let size = shape.compute_local_aabb().extents().max_element();
        // Of a size that is not finite, nothing is a small share.
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

/// The line that a box is, if two of its half extents are thin.
fn line_of_box(half_extents: Vector, is_thin: impl Fn(Real) -> bool) -> Option<Triangle> {
    let half = match half_extents.to_array().map(is_thin) {
        [_, true, true] => Vector::X * half_extents.x,
        [true, _, true] => Vector::Y * half_extents.y,
        [true, true, _] => Vector::Z * half_extents.z,
        _ => return None,
    };
    Some(Triangle::new(half, -half, -half))
}
