//! Finds the candidate triangles of a link: through a hierarchy, or exhaustively.

#[cfg(feature = "exhaustive")]
pub(crate) mod exhaustive;
pub(crate) mod hierarchy;
