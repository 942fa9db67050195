//! Two motions at once, or as many pairs of them as a batch has.

use super::{Motion, Moving, at, together};
use crate::error::Refused;
use crate::threads::Asked;
use pyo3::prelude::*;
use std::ops::Range;
use std::sync::Arc;

/// A motion of one robot beside one of another; of a batch, each beside the one at its place, or
/// one beside all.
pub(crate) struct MotionPair {
    motions: [Arc<Vec<Moving>>; 2],
    count: Option<usize>,
}

impl MotionPair {
    /// # Errors
    /// There are not as many of the one as of the other.
    pub(crate) fn new(first: &Bound<'_, Motion>, second: &Bound<'_, Motion>) -> PyResult<Self> {
        let [(one, a), (other, b)] = [first, second].map(|motion| motion.get().parts());
        let count = together(first.py(), [("a", one), ("b", other)])?;
        Ok(Self { motions: [a, b], count })
    }
}

/// Some pairs of a batch, which share its memory.
#[derive(Default)]
pub(crate) struct SomePairs {
    first: usize,
    motions: [Arc<Vec<Moving>>; 2],
}

impl Asked for MotionPair {
    type Block = SomePairs;
    type One<'a> = [&'a Moving; 2];

    // One may take as long as thousands of robots.
    const FEW: usize = 2;

    fn count(&self) -> Option<usize> {
        self.count
    }

    fn copy(&self, range: Range<usize>, block: &mut SomePairs) -> Result<(), Refused> {
        let [first, second] = &self.motions;
        *block = SomePairs { first: range.start, motions: [Arc::clone(first), Arc::clone(second)] };
        Ok(())
    }

    fn one(block: &SomePairs, place: usize) -> [&Moving; 2] {
        let [first, second] = &block.motions;
        [at(first, block.first + place), at(second, block.first + place)]
    }
}
