//! Which pairs can matter: through a hierarchy, or exhaustively.

pub(crate) mod exhaustive;
pub(crate) mod hierarchy;
