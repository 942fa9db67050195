//! What of a robot is known to keep away from the mesh.

/// What is known to keep away from the mesh.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum ClearedBy {
    /// Every link by itself.
    Links,
    /// Even the capsule around all links.
    Capsule,
}
