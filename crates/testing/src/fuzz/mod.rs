//! The fuzz targets. Each body accepts any bytes and panics if a promise is broken. The fuzzer
//! calls the bodies through `fuzz/fuzz_targets` for hours, the test suite through
//! `tests/proximity/fuzz.rs` briefly.

mod aligned;
mod chain_mesh;
mod coherence;
mod constructors;
mod dispatcher;
mod link_triangle;
mod mesh_file;
mod motions;
mod robots;
mod root_finders;
mod scenes;
mod source;
mod touching;
mod tube;

pub use aligned::{ALIGNED, Visited, aligned};
pub use chain_mesh::chain_mesh;
pub use coherence::coherence;
pub use constructors::constructors;
pub use dispatcher::dispatcher;
pub use link_triangle::link_triangle;
pub use mesh_file::mesh_file;
pub use motions::motions;
pub use robots::robots;
pub use root_finders::root_finders;
pub use scenes::scenes;
pub use touching::touching;
pub use tube::tube;
