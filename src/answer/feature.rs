//! The parts of a link and a triangle at their closest points.

/// A part of a link.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LinkFeature {
    /// The surface around the axis, between its ends.
    Side,
    /// The cap at the start, flat or round.
    StartCap,
    /// The cap at the end, flat or round.
    EndCap,
}

/// A part of a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TriangleFeature {
    /// The interior.
    Face,
    /// The edge from this corner (0, 1 or 2) to the next.
    Edge(u8),
    /// This corner (0, 1 or 2).
    Vertex(u8),
}

/// The features at the closest points of a link and a triangle.
///
/// ```
/// use parry_continuum::proximity::{ContactFeature, LinkFeature, TriangleFeature};
///
/// /// Whether the tip of an instrument could cut into an edge of the wall.
/// fn is_sharp(feature: ContactFeature) -> bool {
///     feature.link == LinkFeature::EndCap && !matches!(feature.triangle, TriangleFeature::Face)
/// }
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct ContactFeature {
    /// The part of the link.
    pub link: LinkFeature,
    /// The part of the triangle, up to rounding.
    pub triangle: TriangleFeature,
}
