//! The side of a mesh on which a point lies, by the winding number of the mesh, with error bounds.
//!
//! The generalised winding number is the sum of the signed solid angles of all triangles, over
//! `4 pi`. (Jacobson, Kavan and Sorkine-Hornung, "Robust inside-outside segmentation using
//! generalized winding numbers", 2013.) The number is whole for a closed mesh, and 0 at each
//! outside point.
//!
//! - `solid_angle`: the solid angle of a triangle; of many triangles far away (after Barill et al.,
//!   "Fast winding numbers for soups and clouds", 2018); their sum, and the side that it proves.
//! - `winding`: the traversal of the hierarchy.
//! - `surface`: the openings of a mesh, through which a robot changes sides without touching it.

mod solid_angle;
mod surface;
#[cfg(test)]
mod tests;
mod winding;

pub(crate) use solid_angle::SolidAngle;
pub(crate) use surface::Surface;
pub(crate) use winding::{FarFields, Winding};
