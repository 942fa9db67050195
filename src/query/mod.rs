//! The questions, a room for each, with what each remembers.

#[cfg(feature = "tubes")]
pub(crate) mod clearance;
pub(crate) mod contacts;
#[cfg(feature = "tubes")]
pub(crate) mod motion;
pub(crate) mod nearest;
#[cfg(feature = "tubes")]
pub(crate) mod proof;
#[cfg(feature = "robots")]
pub(crate) mod robots;
pub(crate) mod side;

mod checks;

#[cfg(feature = "tubes")]
pub(crate) use checks::check_decision;
pub(crate) use checks::{check_bound, check_margin, check_not_negative};
