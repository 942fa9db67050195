//! The motions of several robots at once, or as many sets of them as a batch has.

use super::{Motion, Moving, at, together};
use crate::error::Refused;
use crate::threads::Asked;
use pyo3::prelude::*;
use std::ops::Range;
use std::sync::Arc;

/// A motion for each robot; of a batch, each beside those at its place, or one beside all.
pub(crate) struct MotionList {
    motions: Vec<Arc<Vec<Moving>>>,
    count: Option<usize>,
}

impl MotionList {
    /// # Errors
    /// The list is empty, or the batches differ in size.
    pub(crate) fn new(py: Python<'_>, given: &[Bound<'_, Motion>]) -> PyResult<Self> {
        if given.is_empty() {
            let text = "`motions` is empty; give a list of at least one motion";
            return Err(Refused::other("bad_type", text).raise(py, None));
        }
        let parts: Vec<_> = given.iter().map(|motion| motion.get().parts()).collect();
        let named =
            |(place, part): (usize, &(Option<usize>, _))| (format!("motions[{place}]"), part.0);
        let count = together(py, parts.iter().enumerate().map(named))?;
        let motions = parts.into_iter().map(|(_, motions)| motions).collect();
        Ok(Self { motions, count })
    }
}

/// Some sets of a batch, which share its memory.
#[derive(Default)]
pub(crate) struct SomeLists {
    first: usize,
    motions: Vec<Arc<Vec<Moving>>>,
}

impl Asked for MotionList {
    type Block = SomeLists;
    type One<'a> = Vec<&'a Moving>;

    // One may take as long as thousands of robots.
    const FEW: usize = 2;

    fn count(&self) -> Option<usize> {
        self.count
    }

    fn copy(&self, range: Range<usize>, block: &mut SomeLists) -> Result<(), Refused> {
        *block = SomeLists { first: range.start, motions: self.motions.clone() };
        Ok(())
    }

    fn one(block: &SomeLists, place: usize) -> Vec<&Moving> {
        block.motions.iter().map(|motions| at(motions, block.first + place)).collect()
    }
}
