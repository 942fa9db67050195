//! Applies every public function of the narrow phase to one input.

use crate::Case;
use crate::narrow_phase::{
    point_modified_cylinder, segment_disc, segment_triangle, triangle_capsule, triangle_disc,
    triangle_modified_cylinder,
};
use crate::precision::{Precision, extent, vector};
use crate::problems::Problem;
use parry_continuum::distance::*;
use parry_continuum::parry::math::Vector;

/// A triangle, a plane through its first vertex, a link, and a disc around the link's end.
#[derive(Clone, Copy, Debug)]
pub struct Input<T> {
    pub triangle: [Vec3<T>; 3],
    pub plane_normal: Vec3<T>,
    pub start: Vec3<T>,
    pub end: Vec3<T>,
    pub disc_normal: Vec3<T>,
    pub radius: T,
}

/// The names of the answers of [`Input::answers`].
pub const KERNELS: [&str; 15] = [
    "segment-segment",
    "point-triangle",
    "segment-triangle",
    "point-disc",
    "segment-disc",
    "plane-disc",
    "triangle-disc",
    "point-link, round",
    "point-link, flat",
    "point-link, flat end",
    "triangle-capsule",
    "triangle-link, round",
    "triangle-link, flat",
    "triangle-link, flat start",
    "triangle-link, flat end",
];

impl<T: Scalar> Input<T> {
    /// Returns the answer of every kernel.
    pub fn answers(&self) -> [Closest<T>; KERNELS.len()] {
        let Self { triangle, plane_normal, start, end, disc_normal, radius } = *self;
        let [a, b, _] = triangle;
        let (yes, no) = (radius.le(radius), radius.lt(radius));
        let to_point = |flat| point_modified_cylinder(a, start, end, radius, flat);
        let to_triangle = |flat| triangle_modified_cylinder(triangle, start, end, radius, flat);
        [
            segment_segment([start, end], [a, b]),
            point_triangle(end, triangle),
            segment_triangle([start, end], triangle),
            point_disc(a, end, disc_normal, radius),
            segment_disc([a, b], end, disc_normal, radius),
            plane_disc(a, plane_normal, end, disc_normal, radius),
            triangle_disc(triangle, end, disc_normal, radius),
            to_point([no, no]),
            to_point([yes, yes]),
            to_point([no, yes]),
            triangle_capsule(triangle, start, end, radius),
            to_triangle([no, no]),
            to_triangle([yes, yes]),
            to_triangle([yes, no]),
            to_triangle([no, yes]),
        ]
    }

    pub fn map<U>(&self, number: impl Fn(T) -> U) -> Input<U> {
        let vector = |v: Vec3<T>| Vec3::new(number(v.x), number(v.y), number(v.z));
        Input {
            triangle: self.triangle.map(vector),
            plane_normal: vector(self.plane_normal),
            start: vector(self.start),
            end: vector(self.end),
            disc_normal: vector(self.disc_normal),
            radius: number(self.radius),
        }
    }
}

impl<T: Precision> Input<T> {
    /// Returns the extent of each kernel's pair: the largest coordinate difference of two of its
    /// points, or its radius.
    pub fn extents(&self) -> [f64; KERNELS.len()] {
        self.parts().map(|(points, radius)| extent(&points, radius))
    }

    /// Returns the points of each kernel's pair, and its radius if it has one.
    pub fn parts(&self) -> [(Vec<Vector>, f64); KERNELS.len()] {
        let [a, b, c] = self.triangle.map(vector);
        let (start, end, radius) = (vector(self.start), vector(self.end), self.radius.into());
        let link = || (vec![a, b, c, start, end], radius);
        let point_link = || (vec![a, start, end], radius);
        [
            (vec![start, end, a, b], 0.0),
            (vec![end, a, b, c], 0.0),
            (vec![start, end, a, b, c], 0.0),
            (vec![a, end], radius),
            (vec![a, b, end], radius),
            (vec![a, end], radius),
            (vec![a, b, c, end], radius),
            point_link(),
            point_link(),
            point_link(),
            link(),
            link(),
            link(),
            link(),
            link(),
        ]
    }
}

impl From<&Problem> for Input<f64> {
    fn from(problem: &Problem) -> Self {
        let vec3 = |v: Vector| Vec3::from(v.to_array());
        let [a, b, c] = problem.triangle;
        Self {
            triangle: problem.triangle.map(vec3),
            plane_normal: vec3((b - a).cross(c - a)),
            start: vec3(problem.start),
            end: vec3(problem.end),
            disc_normal: vec3(problem.end - problem.start),
            radius: problem.radius,
        }
    }
}

impl From<&Case> for Input<f64> {
    /// Derives the missing parts of the case from the given ones.
    fn from(case: &Case) -> Self {
        let ([start, end], triangle) = match case.kind.as_str() {
            "segment_segment" => ([case.s0, case.s1], [case.u0, case.u1, case.s1]),
            "point_triangle" => ([case.tri[0], case.p], case.tri),
            "segment_triangle" => ([case.s0, case.s1], case.tri),
            "point_disc" => ([case.n, case.c], [case.p, case.n, case.c]),
            "segment_disc" => ([case.n, case.c], [case.s0, case.s1, case.c]),
            "triangle_disc" => ([case.tri[1], case.c], case.tri),
            _ => ([case.p0, case.p1], case.tri),
        };
        let [a, b, c] = triangle.map(Vec3::from);
        let (start, end) = (Vec3::from(start), Vec3::from(end));
        let disc_normal = if case.n == [0.0; 3] { end - start } else { Vec3::from(case.n) };
        Self { triangle: [a, b, c], plane_normal: c - a, start, end, disc_normal, radius: case.r }
    }
}
