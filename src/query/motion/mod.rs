//! Whether a motion keeps a margin, until when, and how near it comes.

mod failure;
mod least;
mod moment;
mod motion_search;
mod moving;
mod own_directions;
mod side;
mod waiting;

pub(crate) use moment::Wanted;
pub(crate) use motion_search::{MotionMemory, MotionSearch};
