//! Yes, no, or too close to tell.

/// Whether a margin is kept: by a tube, by a motion at every time, by all of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
pub enum Decision {
    /// The clearance is more than the margin. This is proven.
    Clear,
    /// The clearance is at most the margin. This is proven.
    Contact,
    /// Neither: the clearance is within the resolution of the margin; or the input, or a limit on
    /// the work, leaves it open.
    Undecided,
}

/// Why it stays open whether a motion keeps a margin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum UndecidedReason {
    /// A shape comes within the resolution of the margin, as far as it is known; or the end of a
    /// link becomes flat or round where that decides. A finer resolution may help.
    Near,
    /// The question has reached its limit of work. A coarser resolution helps, or a motion in
    /// several parts.
    Work,
}

impl Decision {
    /// The better of two answers to one question: one that decides, or else one that is no error.
    /// The second is asked for only if the first does not decide.
    ///
    /// # Errors
    /// Both are errors.
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
