//! How a mesh winds around a point: the solid angle under which the point sees it, with a bound on
//! its error.
//!
//! The generalised winding number (Jacobson, Kavan and Sorkine-Hornung, "Robust inside-outside
//! segmentation using generalized winding numbers", 2013) is the sum of the signed solid angles of
//! all triangles, over 4 pi. A closed mesh winds around every point a whole number of times: never
//! around those outside.
//!
//! `solid_angle` is that of a triangle, `far_field` that of many triangles far away (after Barill
//! et al., "Fast winding numbers for soups and clouds", 2018), and both bound their error.
//! `angle_sum` adds them up and decides on the side.

mod angle_sum;
mod far_field;
mod solid_angle;
#[cfg(test)]
mod tests;
mod winding;

pub(crate) use angle_sum::SolidAngle;
pub(crate) use winding::{FarFields, Winding};
