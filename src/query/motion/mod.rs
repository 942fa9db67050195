//! Whether a motion keeps a margin, until when, and how near it comes.

mod failure;
mod fast;
mod intervals;
mod least;
mod moment;
mod motion_search;
mod moves;
mod moving;
mod moving_own;
mod moving_pair;
mod own_directions;
mod own_motion;
mod pace;
mod present;
mod progress;
mod side;
mod two_motions;
mod waiting;

pub(crate) use moment::Wanted;
pub(crate) use motion_search::{MotionMemory, MotionSearch};
pub(crate) use own_motion::{OwnMotionMemory, own_motion_clears};
pub(crate) use two_motions::{MotionsMemory, TwoMotions};
