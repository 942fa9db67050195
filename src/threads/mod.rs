//! Work for all cores, and what is built by one thread while others may wait for it.

mod lazy;
mod parallel;

pub(crate) use lazy::Lazy;
pub(crate) use parallel::{both, each, in_chunks, threads};
