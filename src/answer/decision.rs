//! The decision of a query with a margin, and why there is none.

/// Whether a tube, a motion at every time, or a whole scene keeps a margin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
pub enum Decision {
    /// Proven: the clearance is more than the margin.
    Clear,
    /// Proven: the clearance is at most the margin.
    Contact,
    /// Neither: the clearance is within the resolution of the margin; or the input, or a limit on
    /// the work, does not allow a decision.
    Undecided,
}

/// The reason why a query about a motion is undecided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum UndecidedReason {
    /// A shape comes within the resolution of the margin, up to its stated errors; or the end of a
    /// link becomes flat or round where that decides. A finer resolution may help.
    Near,
    /// The query has reached its limit of work. A coarser resolution helps, or a motion in several
    /// parts.
    Work,
}

impl Decision {
    /// Returns the better of two answers to one query: one that decides, or else one without an
    /// error. Computes the second only if the first does not decide.
    ///
    /// # Errors
    /// Both answers are errors.
    pub(crate) fn better_of<E>(
        first: Result<Self, E>,
        second: impl FnOnce() -> Result<Self, E>,
    ) -> Result<Self, E> {
        match first {
            Ok(Self::Undecided) => Ok(second().unwrap_or(Self::Undecided)),
            Ok(decided) => Ok(decided),
            Err(_) => second(),
        }
    }
}
