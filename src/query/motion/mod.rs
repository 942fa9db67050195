//! Queries about motions: whether a margin is kept, until when, and bounds on the least clearance.

mod approach_bound;
mod current_shape;
mod half_displacement;
mod interval_test;
mod intervals;
mod minimum_policy;
mod minimum_rounds;
mod motion_clearance;
#[cfg(feature = "robots")]
mod motion_pair;
mod motion_search;
#[cfg(feature = "robots")]
mod moving_pair;
mod moving_tube;
#[cfg(feature = "robots")]
mod moving_tube_with_itself;
mod pending_piece;
mod refinement;
mod relative_motion;
#[cfg(feature = "robots")]
mod self_motion;
mod separating_planes;

pub(crate) use approach_bound::half_length;
#[cfg(feature = "robots")]
pub(crate) use approach_bound::midpoint;
pub(crate) use interval_test::MarginQuery;
pub(crate) use intervals::Sought;
#[cfg(feature = "robots")]
pub(crate) use motion_pair::{MAX_PAIRS_FOR_BOUNDS, MotionPair, MotionsMemory};
pub(crate) use motion_search::{MotionMemory, MotionSearch};
#[cfg(feature = "robots")]
pub(crate) use self_motion::{SelfMotionMemory, self_decides_motion};
