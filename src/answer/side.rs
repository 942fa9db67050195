//! The side of a mesh on which a point lies.

/// The side of a mesh on which a point lies.
///
/// The mesh's winding number w decides: the sum of the solid angles of its triangles, divided by 4
/// pi. For a closed mesh w is an integer, and not 0 inside. Triangles may face outward or inward,
/// if all do the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
pub enum Side {
    /// Proven: |w| > 3/4.
    Inside,
    /// Proven: |w| < 1/4.
    Outside,
    /// Neither: the point lies on the surface, within rounding; or a hole of the mesh covers at
    /// least a quarter of the view from the point.
    Undecided,
}
