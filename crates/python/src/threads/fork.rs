//! How often this process and its ancestors have forked since the module was imported.

use std::sync::atomic::{AtomicU64, Ordering};

static FORKS: AtomicU64 = AtomicU64::new(0);

/// Another number in each child. A process id would not do: a grandchild may get that of a process
/// that is no more.
pub(crate) fn forks() -> u64 {
    FORKS.load(Ordering::Relaxed)
}

/// Begins to count forks, by Python or by a library.
pub(crate) fn watch_forks() {
    #[cfg(unix)]
    {
        static ONCE: std::sync::Once = std::sync::Once::new();
        extern "C" fn in_child() {
            FORKS.fetch_add(1, Ordering::Relaxed);
        }
        ONCE.call_once(|| {
            // SAFETY: the handler only adds to an atomic number, and lives as long as the module,
            // which is never unloaded. Should there be no memory for it, no child is noticed, as if
            // nobody forked.
            unsafe { libc::pthread_atfork(None, None, Some(in_child)) };
        });
    }
}
