//! Robots beside robots: how near the links of one are to those of another.

mod balls;
mod descent;
mod heights;
mod local_minima;
mod one_robot;
mod outline;
mod own_faces;
mod own_tube;
mod tubes;
mod two_robots;

pub(crate) use one_robot::{OneRobot, OwnMemory};
pub(crate) use own_tube::{OwnTubeMemory, own_tube_clears};
pub(crate) use tubes::{TubesMemory, clearance_between, place_tubes, tubes_clear};
pub(crate) use two_robots::{PairMemory, TwoRobots};
