//! On which side of a mesh a point is.

/// On which side of a mesh a point is.
///
/// The mesh's winding number w decides, the sum of the solid angles of its triangles over 4 pi.
/// Around a closed mesh it is a whole number, and not 0 inside. Triangles may face outward or
/// inward, as long as all do the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
pub enum Side {
    /// |w| > 3/4 for certain.
    Inside,
    /// |w| < 1/4 for certain.
    Outside,
    /// Neither: the point lies on a triangle, as far as rounding can tell, or a hole of the mesh
    /// covers a quarter or more of what it sees.
    Undecided,
}
