//! The questions that a mesh is asked, a file for each.

mod certify;
mod clearance;
mod clears;
pub(crate) mod distance;
mod gradient;
mod motion;
mod motion_clearance;
mod per_link;
mod side;
pub(crate) mod two_robots;
mod within;
