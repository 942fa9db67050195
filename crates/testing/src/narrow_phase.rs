//! The functions of the narrow phase, compiled once for every kind of number. The library's own
//! functions are inlined into each caller.

use parry_continuum::distance::{self, Closest, Scalar, Vec3};

macro_rules! called {
    ($($name:ident($($argument:ident: $Type:ty),*);)*) => {$(
        #[doc = concat!("[`distance::", stringify!($name), "`]")]
        #[inline(never)]
        pub fn $name<T: Scalar>($($argument: $Type),*) -> Closest<T> {
            distance::$name($($argument),*)
        }
    )*};
}

called! {
    segment_triangle(segment: [Vec3<T>; 2], triangle: [Vec3<T>; 3]);
    segment_disc(segment: [Vec3<T>; 2], centre: Vec3<T>, normal: Vec3<T>, radius: T);
    triangle_disc(triangle: [Vec3<T>; 3], centre: Vec3<T>, normal: Vec3<T>, radius: T);
    point_modified_cylinder(point: Vec3<T>, start: Vec3<T>, end: Vec3<T>, radius: T, flat: [T::Mask; 2]);
    triangle_capsule(triangle: [Vec3<T>; 3], start: Vec3<T>, end: Vec3<T>, radius: T);
    triangle_modified_cylinder(triangle: [Vec3<T>; 3], start: Vec3<T>, end: Vec3<T>, radius: T, flat: [T::Mask; 2]);
    disc_disc(centre1: Vec3<T>, normal1: Vec3<T>, radius1: T, centre2: Vec3<T>, normal2: Vec3<T>, radius2: T);
    modified_cylinder_modified_cylinder(
        axis1: [Vec3<T>; 2], radius1: T, flat1: [T::Mask; 2], axis2: [Vec3<T>; 2], radius2: T, flat2: [T::Mask; 2]
    );
}
