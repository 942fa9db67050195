//! From one pose to another, of each of a batch.

use super::{place_in, together};
use crate::error::Refused;
use crate::input::{Poses, pose_of};
use mesh_files::Frame;
use parry_continuum::parry::math::Pose;
use pyo3::prelude::*;

const NAMES: [&str; 2] = ["start_pose", "end_pose"];

/// The poses at which motions begin and end, as matrices that belong to nobody else.
pub(super) struct Way {
    ends: [Vec<[f64; 16]>; 2],
    counts: [Option<usize>; 2],
}

impl Way {
    pub(super) fn new(
        start_pose: &Bound<'_, PyAny>,
        end_pose: &Bound<'_, PyAny>,
    ) -> PyResult<Self> {
        let [start, end] = [(start_pose, NAMES[0]), (end_pose, NAMES[1])].map(|(pose, name)| {
            let (poses, count) = Poses::batch(pose, name)?;
            Ok::<_, PyErr>((poses.matrices(0..count.unwrap_or(1)).to_vec(), count))
        });
        let [start, end] = [start?, end?];
        Ok(Self { ends: [start.0, end.0], counts: [start.1, end.1] })
    }

    /// How many there are, beside as many robots.
    pub(super) fn count(
        &self,
        py: Python<'_>,
        robots: &'static str,
        count: Option<usize>,
    ) -> PyResult<Option<usize>> {
        let [start, end] = self.counts;
        together(py, [(robots, count), (NAMES[0], start), (NAMES[1], end)])
    }

    /// The frame that points state in the frame of a base which the poses move. Other poses than
    /// the identity may lead into another frame.
    pub(super) fn frame(&self, stated: Option<Frame>) -> Option<Frame> {
        const IDENTITY: [f64; 16] =
            [1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1.];
        stated.filter(|_| self.ends.iter().flatten().any(|matrix| *matrix == IDENTITY))
    }

    /// The two poses at a place of the batch.
    pub(super) fn poses(&self, place: usize) -> Result<[Pose; 2], Refused> {
        let pose = |end: usize| {
            let matrices = &self.ends[end];
            let matrix = &matrices[place_in(self.counts[end], place)];
            pose_of(matrix).map_err(|refused| refused.of(NAMES[end]))
        };
        Ok([pose(0)?, pose(1)?])
    }
}
