//! Threads, processes and the GIL: who holds what, when.
//!
//! - Arrays are read with the GIL, and copied: a thread of Python's may write to them as soon as it
//!   is given up.
//! - All that computes does so without the GIL, on copies and on sessions of its own.
//! - What may take long by itself, such as reading a file, runs on a thread of its own, so that
//!   Ctrl-C ends it (`interruptible`).
//! - A lock of this package is taken only with the GIL, and given back before the GIL is. So when
//!   Python forks, which takes the GIL, no lock is taken, and the child finds all of them free.
//! - The threads of a pool do not live on in a child, so a child has a pool of its own (`pool`).
//!   What another thread was in the middle of building in the library stays half built for ever in
//!   the child, so the child builds it again (`engine`).
//! - One thread at a time has a mesh's search on the GPU; the others ask the CPU (`device`). A
//!   child has no GPU of its parent's.

mod compute;
mod device;
mod each;
mod engine;
mod fork;
#[cfg(feature = "gpu")]
mod gpu;
#[cfg(not(feature = "gpu"))]
#[path = "no_gpu.rs"]
mod gpu;
mod held;
mod points;
mod pool;

pub(crate) use compute::{compute, interruptible};
pub(crate) use device::{DeviceKind, DeviceSession};
pub(crate) use each::{
    Asked, FirstRefused, LARGEST_CHUNK, Lender, Rows, alone, answer_each, answer_each_or_kind,
    ask_each, in_chunks,
};
pub(crate) use engine::{Engine, Session};
pub(crate) use fork::watch_forks;
pub(crate) use gpu::{device_failure, is_available};
pub(crate) use held::Held;
pub(crate) use points::ask_points;
pub(crate) use pool::pool;
