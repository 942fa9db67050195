//! Values that are built at first use and shared by all threads.
//!
//! # Definitions
//! - Build: the closure of [`Lazy::get_or_build`]. It runs once, in the first thread that needs the
//!   value.
//! - Pool: the threads of rayon. A thread of the pool that waits for its helpers takes up other
//!   tasks.
//!
//! # Deadlock
//! **Claim.** A build never waits for a task that waits for the build.
//!
//! **Proof.** A build that used the pool could wait for such a task in two ways:
//!
//! 1. Its thread takes up a task that needs the same value.
//! 2. Its helpers wait for the value themselves.
//!
//! [`on_this_thread`] excludes both: the build has no helpers and takes up no tasks.

use super::parallel::on_this_thread;
use std::sync::OnceLock;

/// A value that the first thread to need it builds, on that thread alone.
///
/// Other threads that need the value wait for it, tasks of a pool included. During the build,
/// [`each`](super::parallel::each) and the like work on the builder's thread.
#[derive(Clone, Debug)]
pub(crate) struct Lazy<T>(OnceLock<T>);

impl<T> Lazy<T> {
    pub(crate) const fn new() -> Self {
        Self(OnceLock::new())
    }

    /// Returns the value, and builds it on this thread alone if it is missing.
    #[inline(always)] // most often it is there
    pub(crate) fn get_or_build(&self, build: impl FnOnce() -> T) -> &T {
        self.0.get_or_init(|| on_this_thread(build))
    }

    pub(crate) fn get(&self) -> Option<&T> {
        self.0.get()
    }

    pub(crate) fn get_mut(&mut self) -> Option<&mut T> {
        self.0.get_mut()
    }

    /// Removes the value: the next use builds it again.
    pub(crate) fn take(&mut self) -> Option<T> {
        self.0.take()
    }
}

#[cfg(all(test, feature = "parallel"))]
mod tests {
    use super::super::parallel::each;
    use super::*;
    use std::collections::HashSet;
    use std::sync::Mutex;
    use std::thread;
    use std::time::Duration;

    /// Although the pool is idle.
    #[test]
    fn a_builder_has_no_helpers() {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(16).build().unwrap();
        pool.install(|| {
            let seen = Mutex::new(HashSet::new());
            Lazy::new().get_or_build(|| {
                each(&mut [(); 64], |_, ()| {
                    thread::sleep(Duration::from_millis(1));
                    seen.lock().unwrap().insert(thread::current().id());
                });
            });
            assert_eq!(seen.into_inner().unwrap(), HashSet::from([thread::current().id()]));
        });
    }
}
