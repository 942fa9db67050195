//! The threads that batches run on: the package's own, one for each core, or as many as
//! `RAYON_NUM_THREADS` says.

use super::fork::forks;
use super::held::Held;
use crate::error::Refused;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

/// The pool, and how often had been forked when it was made. It is never dropped: that of a parent
/// has threads that are not there, and waiting for them would take for ever.
static POOL: Held<Option<(u64, &'static ThreadPool)>> = Held::new(None);

/// This process's pool, made when it is first asked for.
pub(crate) fn pool(py: Python<'_>) -> PyResult<&'static ThreadPool> {
    POOL.with(py, |made| match *made {
        Some((then, pool)) if then == forks() => Ok(pool),
        _ => {
            let pool = ThreadPoolBuilder::new()
                .thread_name(|number| format!("parry_continuum {number}"))
                .build()?;
            let pool = &*Box::leak(Box::new(pool));
            *made = Some((forks(), pool));
            Ok(pool)
        }
    })
    .map_err(|error: rayon::ThreadPoolBuildError| {
        let text = format!(
            "no threads can be started ({error}); end other processes, or set RAYON_NUM_THREADS=1"
        );
        Refused::other("no_threads", text).raise(py, None)
    })
}
