//! Runs a WGSL function over many small records of numbers, one GPU thread per record, through
//! `wgpu`: Vulkan, Metal or Direct3D 12.
//!
//! A [`Device`] is a GPU, opened in one [`Precision`]. A [`Kernel`] is the text of a function and
//! how many numbers it takes and gives. A [`Batch`] runs it over as many problems as there are:
//!
//! ```no_run
//! use gpu_batch::{Batch, Device, Kernel, Precision};
//!
//! let text = "fn solve(problem: u32, answer: u32) {
//!     answers[answer] = sqrt(problems[problem] * problems[problem + 1u]);
//! }";
//! let device = Device::open(Precision::F32)?;
//! println!("{}", device.adapter());
//! let mut means = Batch::new(&device, &Kernel::new("geometric_mean", text, 2, 1))?;
//! let mut answers = Vec::new();
//! means.run([1.0, 4.0, 9.0, 4.0], |answer| answers.push(answer[0]))?;
//! assert_eq!(answers, [2.0, 6.0]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The functions that a kernel may use are in [`wgsl`].
//!
//! # Kernels of more than one step
//! For several kernels, buffers that stay, or data other than numbers, use the parts. A [`Device`]
//! compiles a [`Shader`], makes buffers and groups of them, and reads back what a submission wrote,
//! or says why there is nothing to read. A [`Watch`] reports failures of the device, a [`Clock`]
//! measures the time of a pass, and [`record!`] declares what Rust writes and
//! WGSL reads.
#![forbid(unsafe_code)]
#![warn(missing_debug_implementations, missing_docs)]

mod adapter;
mod arithmetic;
mod batch;
mod binding;
mod clock;
mod device;
mod error;
mod failure;
mod failures;
mod kernel;
mod precision;
mod record;
mod shader;
#[cfg(test)]
mod tests;
pub mod wgsl;

pub use adapter::Adapter;
pub use batch::Batch;
pub use binding::Binding;
pub use clock::{Clock, READINGS};
pub use device::{Device, Submitted};
pub use error::DeviceError;
pub use failure::DeviceFailure;
pub use failures::Watch;
pub use kernel::Kernel;
pub use precision::Precision;
pub use record::{Field, Record};
pub use shader::Shader;
pub use wgpu;

/// Runs the code in the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
