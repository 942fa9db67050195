//! Work on all cores, and lazy values that one thread builds while others may wait for them.

mod lazy;
mod parallel;

pub(crate) use lazy::Lazy;
#[cfg(feature = "gpu")]
pub(crate) use parallel::on_this_thread;
#[cfg(feature = "robots")]
pub(crate) use parallel::with_clones;
pub(crate) use parallel::{both, each, in_chunks, threads};
