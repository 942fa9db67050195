//! Which part of a robot a search has proven clear of the mesh.

/// The shape that is proven farther than the margin from the mesh.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum ClearedBy {
    /// Every link by itself.
    Links,
    /// The capsule around all links.
    Capsule,
}
