//! Work without the GIL, whose defects are exceptions.

use crate::error::Refused;
use pyo3::prelude::*;
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread::Builder;
use std::time::Duration;

/// Runs `work` without the GIL. A panic is a defect of the library, and raises the exception of
/// this package.
pub(crate) fn compute<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    let done = py.detach(|| catch_unwind(AssertUnwindSafe(work)));
    done.map_err(|panic| defect(&*panic).raise(py, None))
}

/// Signals are looked at this often.
const TICK: Duration = Duration::from_millis(50);

/// Does what may take long without the GIL, and ends at Ctrl-C. The work then goes on by itself,
/// and its result is dropped.
pub(crate) fn interruptible<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce() -> T + Send + 'static,
) -> PyResult<T> {
    let (sender, mut receiver) = channel();
    let run = move || {
        // Nobody receives it after Ctrl-C.
        let _ = sender.send(catch_unwind(AssertUnwindSafe(work)));
    };
    let thread = Builder::new().name("parry_continuum reads".to_owned());
    thread.spawn(run).map_err(|error| {
        let text = format!("no thread can be started ({error}); end other processes");
        Refused::other("no_threads", text).raise(py, None)
    })?;
    loop {
        let (waiting, received) = py.detach(move || {
            let received = receiver.recv_timeout(TICK);
            (receiver, received)
        });
        receiver = waiting;
        match received {
            Ok(done) => return done.map_err(|panic| defect(&*panic).raise(py, None)),
            Err(RecvTimeoutError::Timeout) => py.check_signals()?,
            Err(RecvTimeoutError::Disconnected) => {
                return Err(defect(&"the thread that reads has ended").raise(py, None));
            }
        }
    }
}

fn defect(panic: &(dyn Any + Send)) -> Refused {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    let text = text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_default();
    Refused::other(
        "defect",
        format!("this is a defect of parry-continuum, please report it: {text}"),
    )
}
