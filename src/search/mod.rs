//! Finds the candidate triangles of a link: through a hierarchy, or exhaustively.

pub(crate) mod exhaustive;
pub(crate) mod hierarchy;
