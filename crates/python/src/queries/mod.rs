//! The questions that a mesh is asked, a file for each.

pub(crate) mod certify;
pub(crate) mod chains;
pub(crate) mod clearance;
mod clears;
mod clears_sections;
pub(crate) mod distance;
mod doubts;
mod gradient;
mod motion;
mod motion_answer;
mod motion_clearance;
mod motion_while;
mod path;
mod per_link;
mod prove;
mod side;
pub(crate) mod two_robots;
mod way;
mod within;
