//! What is built when it is first asked for, and shared by all threads.

use super::parallel::on_this_thread;
use std::sync::OnceLock;

/// Something that is built at the first question for it, by the thread that asks, alone.
///
/// Threads that ask meanwhile wait, tasks of a pool among them. So the builder must not wait for
/// the pool: a thread of the pool that waits for its helpers takes up other tasks, and one of these
/// may ask for the very thing that this thread has begun to build; and helpers that themselves wait
/// for it never come. Neither happens where a builder has no helpers, so it has none: what
/// [`each`](super::parallel::each) and the like do for it they do on its own thread.
#[derive(Clone)]
pub(crate) struct Lazy<T>(OnceLock<T>);

impl<T> Lazy<T> {
    pub(crate) const fn new() -> Self {
        Self(OnceLock::new())
    }

    /// Builds it alone, unless it is there.
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

    /// Leaves nothing: it is built again at the next question.
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

    /// Though the pool has nothing else to do.
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
