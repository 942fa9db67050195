//! Whether a motion keeps a margin, and until when.

mod moment;
mod motion_search;

pub(crate) use motion_search::{MotionMemory, MotionSearch};
