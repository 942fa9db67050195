//! Why a label map gives no surface.

/// Why a label map gives no surface.
pub enum Fault {
    /// The file is invalid in its format.
    Broken(String),
    /// The file holds triangles.
    NoLabels,
    /// The file does not state the position of its voxels.
    NoPosition(String),
    /// A voxel has this value, which is not a label.
    NotALabel(f64),
    /// The surface would take this many bytes.
    TooLarge(u64),
    /// No voxel is inside the surface. If a label was requested, these are the labels of the
    /// voxels.
    NoneOf(Vec<u32>),
}

impl From<String> for Fault {
    fn from(reason: String) -> Self {
        Self::Broken(reason)
    }
}

impl From<&str> for Fault {
    fn from(reason: &str) -> Self {
        Self::Broken(reason.into())
    }
}
