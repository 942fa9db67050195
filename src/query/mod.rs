//! The questions, a room for each, with what each remembers.

pub(crate) mod clearance;
pub(crate) mod contacts;
pub(crate) mod motion;
pub(crate) mod nearest;
pub(crate) mod side;
