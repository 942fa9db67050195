//! Every link against every triangle, one pair after another, with the discs by any route: what the
//! paper's tables time.

use crate::Number;
use parry_continuum::distance::laboratory::{DiscSolver, triangle_modified_cylinder_by};
use parry_continuum::distance::{Scalar, Vec3, segment_triangle};
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::{Cap, Chain, ModifiedCylinder};
use std::marker::PhantomData;

/// Triangles in the precision `T`, to be looked at with the route `S` to a disc. As the paper's
/// engines do, it solves a disc only where the axis' nearest point is at a flat end.
pub struct EveryPair<T: Scalar, S> {
    /// Where coordinates in the precision `T` count from.
    centre: Vector,
    triangles: Vec<[Vec3<T>; 3]>,
    exact: Vec<[Vector; 3]>,
    route: PhantomData<fn() -> S>,
}

/// The nearest triangle of a link.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// Measured in `f64`, by the same route.
    pub distance: f64,
    /// The first of the nearest, within the resolution of `T`.
    pub triangle: usize,
}

/// A link in the precision `T`.
struct Link<T: Scalar> {
    start: Vec3<T>,
    /// Counted from the start.
    end: Vec3<T>,
    radius: T,
    flat: [bool; 2],
}

impl<T: Number> Link<T> {
    fn new(link: &ModifiedCylinder, pose: &Pose, centre: Vector) -> Self {
        let [start, end] = [link.start(), link.end()].map(|end| point::<T>(pose * end, centre));
        let flat = link.caps().map(|cap| cap == Cap::Flat);
        Self { start, end: end - start, radius: T::of(link.radius()), flat }
    }

    fn distance<S: DiscSolver<T>>(&self, triangle: [Vec3<T>; 3]) -> T {
        let Self { start, end, radius, flat } = *self;
        let origin = Vec3::from([T::ZERO; 3]);
        let triangle = triangle.map(|vertex| vertex - start);
        let axis = segment_triangle([origin, end], triangle);
        let before_start = axis.point1 == origin || axis.point2.dot(end) < T::ZERO;
        let beyond_end = axis.point1 == end || T::ZERO < (axis.point2 - end).dot(end);
        if (flat[0] && before_start) || (flat[1] && beyond_end) {
            triangle_modified_cylinder_by::<S, T>(triangle, origin, end, radius, flat).distance
        } else {
            Scalar::max(axis.distance - radius, T::ZERO)
        }
    }
}

fn point<T: Number>(point: Vector, centre: Vector) -> Vec3<T> {
    Vec3::from((point - centre).to_array().map(T::of))
}

impl<T: Number, S: DiscSolver<T> + DiscSolver<f64>> EveryPair<T, S> {
    /// The triangles of `mesh`.
    pub fn new(mesh: &TriMesh) -> Self {
        let centre = mesh.local_aabb().center();
        let exact: Vec<_> = mesh
            .indices()
            .iter()
            .map(|corners| corners.map(|i| mesh.vertices()[i as usize]))
            .collect();
        let triangles =
            exact.iter().map(|triangle| triangle.map(|vertex| point(vertex, centre))).collect();
        Self { centre, triangles, exact, route: PhantomData }
    }

    /// The nearest triangle of every link, in order.
    pub fn per_link(&self, robot: &Chain, pose: &Pose) -> Vec<Nearest> {
        robot.links().iter().map(|link| self.nearest(link, pose)).collect()
    }

    fn nearest(&self, link: &ModifiedCylinder, pose: &Pose) -> Nearest {
        let rounded = Link::<T>::new(link, pose, self.centre);
        let mut least = (None, 0);
        for (place, triangle) in self.triangles.iter().enumerate() {
            let distance = rounded.distance::<S>(*triangle);
            if least.0.is_none_or(|least| distance < least) {
                least = (Some(distance), place);
            }
        }
        let exact = self.exact[least.1].map(|vertex| point(vertex, Vector::ZERO));
        let distance = Link::<f64>::new(link, pose, Vector::ZERO).distance::<S>(exact);
        Nearest { distance, triangle: least.1 }
    }
}
