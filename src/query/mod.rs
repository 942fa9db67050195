//! The questions, a room for each, with what each remembers.

pub(crate) mod clearance;
pub(crate) mod contacts;
pub(crate) mod motion;
pub(crate) mod nearest;
pub(crate) mod proof;
pub(crate) mod robots;
pub(crate) mod side;

mod checks;

pub(crate) use checks::{check_bound, check_decision, check_margin, check_not_negative};
