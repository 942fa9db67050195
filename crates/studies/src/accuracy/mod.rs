//! How exact the answers are: on the reference cases ([`mod@reference`]), and on seeded problems
//! that are driven to an extreme. The program `accuracy` writes the tables, `tests/accuracy.rs`
//! computes them again.

pub mod certificates;
pub mod engines;
#[cfg(feature = "gpu")]
pub mod gpu;
pub mod measure;
mod packed;
pub mod problems;
pub mod reference;
pub mod tables;

/// How many problems there are for every power of ten.
pub const EACH: usize = 12;

/// The largest size of the tables' range in f64 and f32, as a power of two: distances beyond could
/// overflow.
pub const LARGEST: [i32; 2] = [1019, 123];
