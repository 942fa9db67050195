//! Every triangle against every link, as the paper does on parallel hardware.

mod blocks;
mod engine;
mod kernels;
mod pass;
mod scan;

pub use engine::{Exhaustive, SearchPrecision};
