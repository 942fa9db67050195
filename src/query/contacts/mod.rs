//! Every place where a link is near the mesh: the local minima of the distance.

mod across;
mod feet;
mod flood;
mod gathering;
mod lists;
mod local_minima;
mod long_rings;
mod near_triangle;
mod passes;
mod prominence;
mod search;
mod slopes;
mod wall;
mod wall_pieces;

pub(crate) use across::Across;
#[cfg(feature = "gpu")]
pub(crate) use local_minima::contacts_by_all_triangles;
pub(crate) use local_minima::{LocalMinima, RobotContacts};
pub(crate) use prominence::Asked;
pub(crate) use search::ContactSearch;
pub(crate) use wall::Wall;
