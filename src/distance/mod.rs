//! The narrow phase: exact distances between pairs of simple shapes (paper, section III).
//!
//! Each pair has one public function, in a file of its own with its derivation. All functions are
//! branch-free and generic over [`Scalar`]: `f32`, `f64`, and [`DoubleDouble`] as a reference. Each
//! function scales its problem by an exact power of two. Finite input of any size therefore gives a
//! finite answer, unless the distance itself exceeds the largest number: then it is infinite.
//! Errors are within a few units in the last place of the problem's extent, the largest difference
//! between two of its coordinates or its radius.
//!
//! ```
//! use parry_continuum::distance::{Closest, Vec3, triangle_modified_cylinder};
//!
//! let triangle = [Vec3::new(1.0, -1.0, 3.0), Vec3::new(1.0, 1.0, 3.0), Vec3::new(-2.0, 0.0, 3.0)];
//! let (start, end) = (Vec3::new(0.0, 0.0, 0.0), Vec3::new(0.0, 0.0, 2.0));
//! // The first point is the triangle's, the second one the cylinder's.
//! let Closest { distance, point1, point2 } =
//!     triangle_modified_cylinder(triangle, start, end, 0.5, [false, true]);
//! assert_eq!((distance, point1.z, point2.z), (1.0, 3.0, 2.0));
//! let round = triangle_modified_cylinder(triangle, start, end, 0.5, [false, false]);
//! assert_eq!(round.distance, 0.5);
//! ```

#[cfg(any(test, feature = "laboratory"))]
mod at_level;
pub(crate) mod depth;
mod disc_disc;
mod disc_solver;
mod dispatch;
mod double_double;
mod face;
mod frame;
#[cfg(feature = "laboratory")]
#[doc(hidden)] // for this project's own studies and tests
pub mod laboratory;
pub(crate) mod lanes;
mod modified_cylinder_modified_cylinder;
mod plane_disc;
mod point_disc;
mod point_modified_cylinder;
mod point_triangle;
mod scalar;
mod segment_disc;
mod segment_segment;
mod segment_triangle;
pub(crate) mod single;
mod touching;
mod triangle_disc;
mod triangle_modified_cylinder;
mod unfused;
mod vec3;

pub(crate) use disc_solver::{Convex, DiscSolver};
pub(crate) use dispatch::{Widest, dispatch};
pub(crate) use face::Face;
pub(crate) use modified_cylinder_modified_cylinder::TwoLinks;
pub(crate) use point_modified_cylinder::{Link, gives_direction};
pub(crate) use scalar::Mask;
#[cfg(feature = "robots")]
pub(crate) use segment_segment::parameters as segment_parameters;
pub(crate) use triangle_modified_cylinder::Axial;

pub use disc_disc::disc_disc;
/// Double-double numbers, for this project's own tests and studies.
#[doc(hidden)]
pub use double_double::DoubleDouble;
pub use modified_cylinder_modified_cylinder::modified_cylinder_modified_cylinder;
pub use plane_disc::plane_disc;
pub use point_disc::point_disc;
pub use point_modified_cylinder::point_modified_cylinder;
pub use point_triangle::point_triangle;
pub use scalar::Scalar;
pub use segment_disc::segment_disc;
pub use segment_segment::segment_segment;
pub use segment_triangle::segment_triangle;
pub use triangle_disc::triangle_disc;
pub use triangle_modified_cylinder::{triangle_capsule, triangle_modified_cylinder};
pub(crate) use unfused::Unfused;
pub use vec3::Vec3;

/// The distance between two shapes, and a pair of points that realises it.
///
/// The fields are final, so solvers outside of this crate may construct it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closest<T> {
    /// The distance; 0 if the shapes have a point in common.
    pub distance: T,
    /// The closest point of the first shape in the function's name.
    pub point1: Vec3<T>,
    /// The closest point of the second shape.
    pub point2: Vec3<T>,
}

impl<T: Scalar> Closest<T> {
    /// Sets both points to one common point if the distance is 0: rounding may have separated them.
    #[inline(always)]
    pub(crate) fn met(self) -> Self {
        let meet = self.distance.le(self.distance.zero());
        Self { point2: Vec3::select(meet, self.point1, self.point2), ..self }
    }

    /// Returns `yes` where the mask is true, `no` elsewhere.
    #[inline(always)]
    pub(crate) fn select(mask: T::Mask, yes: Self, no: Self) -> Self {
        Self {
            distance: mask.select(yes.distance, no.distance),
            point1: Vec3::select(mask, yes.point1, no.point1),
            point2: Vec3::select(mask, yes.point2, no.point2),
        }
    }

    /// Returns the nearer of two answers.
    #[inline(always)]
    pub(crate) fn nearer(self, other: Self) -> Self {
        Self::select(other.distance.lt(self.distance), other, self)
    }
}
