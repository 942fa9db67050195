//! Yes, no, or too close to tell.

/// Whether a tube keeps a margin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
pub enum Decision {
    /// Its clearance is more than the margin.
    Clear,
    /// Its clearance is at most the margin.
    Touches,
    /// Its clearance is within the resolution of the margin.
    Undecided,
}
