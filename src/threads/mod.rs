//! Work on all cores, and lazy values that one thread builds while others may wait for them.

mod lazy;
#[cfg(not(feature = "parallel"))]
mod one_thread;
mod parallel;
#[cfg(feature = "parallel")]
mod pool;

pub(crate) use lazy::Lazy;
#[cfg(not(feature = "parallel"))]
use one_thread as pool;
#[cfg(feature = "gpu")]
pub(crate) use parallel::on_this_thread;
#[cfg(feature = "exhaustive")]
pub(crate) use parallel::threads;
#[cfg(feature = "robots")]
pub(crate) use parallel::with_clones;
pub(crate) use parallel::{both, each, in_chunks};
