//! Yes, no, or too close to tell.

/// Whether a margin is kept: by a tube, by a motion at every time, by all of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
pub enum Decision {
    /// The clearance is more than the margin. This is proven.
    Clear,
    /// The clearance is at most the margin. This is proven.
    Contact,
    /// Neither: the clearance is within the resolution of the margin; or the input, or a limit on the work, leaves it open.
    Undecided,
}

impl Decision {
    /// The better of two answers to one question: one that decides, or else one that is no error. The second is asked for only if
    /// the first does not decide.
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
