//! The nearest triangle of every link, of the robot, and whether a margin is kept.

mod few_each;
mod joint;
pub(crate) mod memory;
mod minimum;
mod robot_search;
mod rough_sides;

pub(crate) use few_each::FewEach;
pub(crate) use joint::{JointSearch, Pairs};
pub(crate) use minimum::{MinimumSearch, OfLink};
pub(crate) use robot_search::RobotSearch;
pub(crate) use rough_sides::RoughSides;
