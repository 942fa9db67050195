//! Work on the threads of a pool. No other file uses one. Nothing here is generic, so the pool's
//! code is compiled once.

use rayon::prelude::*;

pub(super) use rayon::current_num_threads as threads;

/// Runs two closures.
pub(super) fn join(one: &mut (dyn FnMut() + Send), other: &mut (dyn FnMut() + Send)) {
    rayon::join(one, other);
}

/// Calls `work` with each number below `count`.
pub(super) fn each(count: usize, work: &(dyn Fn(usize) + Sync)) {
    (0..count).into_par_iter().for_each(work);
}
