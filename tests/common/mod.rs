//! What the host's tests share with all others.

pub use continuum_testing::*;
