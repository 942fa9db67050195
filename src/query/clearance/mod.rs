//! The clearance of a tube, between bounds.

mod tube_search;

pub(crate) use tube_search::{Found, Start, TubeMemory, TubeSearch};
