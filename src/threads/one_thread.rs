//! In place of a pool, the thread that asks.

/// The number of threads that may work.
pub(super) fn threads() -> usize {
    1
}

/// Runs two closures.
pub(super) fn join(one: &mut dyn FnMut(), other: &mut dyn FnMut()) {
    one();
    other();
}

/// Calls `work` with each number below `count`.
pub(super) fn each(count: usize, work: &(dyn Fn(usize) + Sync)) {
    (0..count).for_each(work);
}
