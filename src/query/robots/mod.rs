//! Queries about two robots, and about one robot with itself.

mod balls;
mod beyond_arc;
mod descent;
mod own_faces;
mod pair_frame;
mod pair_minima;
mod robot_with_itself;
mod tubes;
mod turn_sums;
mod two_robots;

pub(crate) use beyond_arc::{
    BeyondMemory, chain_clears, chain_minimum, tube_clearance, tube_clears,
};
pub(crate) use robot_with_itself::{RobotWithItself, SelfMemory};
pub(crate) use tubes::{
    SelfTubeMemory, TubesMemory, clearance_between, clears_tubes, place_tubes, self_clears_tube,
};
pub(crate) use two_robots::{PairMemory, TwoRobots};
