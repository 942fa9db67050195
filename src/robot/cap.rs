/// The end of a [`ModifiedCylinder`](crate::ModifiedCylinder).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
pub enum Cap {
    /// A disc perpendicular to the axis: the link ends at its end point.
    Flat,
    /// An outward half ball of the link's radius, centred at the end point.
    Round,
}
