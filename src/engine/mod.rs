//! Who answers: the trait of all engines, and the engines.

pub(crate) mod bvh;
mod exhaustive;
mod proximity;

pub use bvh::BvhSearch;
pub use exhaustive::{Exhaustive, SearchPrecision};
pub(crate) use proximity::HasMesh;
pub use proximity::Proximity;
#[cfg(feature = "gpu")]
pub(crate) use proximity::pairs;
