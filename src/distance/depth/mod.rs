//! The depth of an overlap: the least translation that separates two simple shapes.
//!
//! All functions use double precision, in coordinates relative to the link's start and near one.

mod direction;
mod ellipse;
mod foot;
mod link_link;
mod link_triangle;
mod separation;
mod way_out;

pub(crate) use direction::{perpendicular, unit, unit_across};
pub(crate) use foot::to_flat;
pub(crate) use link_link::{LinkLink, SolidLink};
pub(crate) use link_triangle::{GAP_ROUNDING, LinkTriangle, Way, face_normal};
pub(crate) use separation::across_rim;
pub(crate) use way_out::WayOut;
