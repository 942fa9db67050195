//! Whether robots of sections of constant curvature keep a margin.

use crate::error::Refused;
use crate::input::{Poses, SectionRadii, Sections, of, pose_of, together};
use crate::mesh::Mesh;
use crate::output::array_or_number;
use crate::threads::{
    Asked, DeviceKind, FirstRefused, LARGEST_CHUNK, compute, device_failure, in_chunks, pool,
};
use parry_continuum::BendingSection;
use parry_continuum::parry::math::Pose;
use parry_continuum::proximity::ProximityError;
use pyo3::prelude::*;
use std::ops::Range;

/// Robots of a chunk for the GPU. Not measured: more would take more memory, fewer would wait more
/// often.
const AT_ONCE: usize = 1 << 18;

/// Robots of sections: one, or a batch.
struct BentRobots {
    sections: Sections,
    radii: SectionRadii,
    count: Option<usize>,
}

/// The sections of some robots.
#[derive(Default)]
struct SectionBlock {
    sections: Vec<BendingSection>,
    each: usize,
}

impl Asked for BentRobots {
    type Block = SectionBlock;
    type One<'a> = &'a [BendingSection];

    fn count(&self) -> Option<usize> {
        self.count
    }

    fn copy(&self, range: Range<usize>, block: &mut SectionBlock) -> Result<(), Refused> {
        block.each = self.sections.each;
        block.sections.clear();
        block.sections.extend(range.flat_map(|place| self.sections.at(place, &self.radii)));
        Ok(())
    }

    fn one(block: &SectionBlock, place: usize) -> &[BendingSection] {
        &block.sections[block.each * place..][..block.each]
    }
}

#[pymethods]
impl Mesh {
    /// Whether robots of sections of constant curvature keep more than a margin away.
    ///
    /// Each section becomes a polyline of segments of equal length with its ends on the arc; the
    /// answer is that of `clears` for these points, with fitted caps. On the GPU the device
    /// computes the points itself.
    ///
    /// Parameters
    /// ----------
    /// sections : (S, 3) or (B, S, 3) array
    ///     A row for each section, from the base: its length, and its curvature towards x and
    ///     towards y, in 1 / length, of the frame that is carried along the curve without twist.
    ///     The curve leaves the origin along z.
    /// radii : float, (S,) or (B, S) array
    ///     One radius for each section.
    /// segments : int
    ///     The number of segments of each section, at least 1.
    /// margin : float
    ///     A length, at least 0.
    /// pose : (4, 4) array, optional
    ///     From the frame of the robots to the mesh's.
    ///
    /// Returns
    /// -------
    /// bool or (B,) array of bool
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     The margin is negative or NaN, a length is not positive, a radius is negative, a number
    ///     is not finite, or the pose is not rigid.
    ///
    /// Examples
    /// --------
    /// >>> import numpy as np
    /// >>> from parry_continuum import Mesh
    /// >>> wall = Mesh([[9, -90, -90], [9, 90, -90], [9, 0, 90]], [[0, 1, 2]])
    /// >>> curvatures = np.linspace(0, 0.03, 4)  # of one section of 30 mm, towards the wall
    /// >>> sections = [[[30, curvature, 0]] for curvature in curvatures]
    /// >>> wall.clears_sections(sections, 0.5, segments=20, margin=0.5)
    /// array([ True,  True, False, False])
    #[pyo3(signature = (sections, radii, *, segments, margin, pose = None))]
    fn clears_sections<'py>(
        &self,
        py: Python<'py>,
        sections: &Bound<'py, PyAny>,
        radii: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = of::segments)] segments: u32,
        #[pyo3(from_py_with = of::margin)] margin: f64,
        pose: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let sections = Sections::new(sections, "sections")?;
        let radii = SectionRadii::new(radii, sections.each)?;
        let count = together(py, [("sections", sections.count), ("radii", radii.count)])?;
        let robots = BentRobots { sections, radii, count };
        let pose = pose.map_or(Ok(Pose::IDENTITY), one_pose)?;
        let (engine, segments) = (self.engine(py), segments as usize);
        let sizes = match engine.device() {
            DeviceKind::Cpu => BentRobots::FEW..=LARGEST_CHUNK,
            DeviceKind::Gpu => AT_ONCE..=AT_ONCE,
        };
        let ask = |block: &SectionBlock, rows: &mut [bool]| {
            let robots: Vec<_> =
                (0..rows.len()).map(|place| BentRobots::one(block, place)).collect();
            let (mut out, pool) = (Vec::new(), pool(py)?);
            let asked = if let Some(mut session) = engine.lend_device(py)? {
                let ask = || {
                    let search = &mut session.search;
                    search.clears_sections_batch(&robots, segments, &pose, margin, &mut out)
                };
                let asked = compute(py, || pool.install(ask));
                engine.take_back_device(py, asked.is_ok().then_some(session));
                asked?
            } else {
                let mut search = engine.search(py)?;
                let ask =
                    || search.clears_sections_batch(&robots, segments, &pose, margin, &mut out);
                compute(py, || pool.install(ask))?
            };
            let refused = keep(asked.map(|()| out), rows);
            Ok((rows.len(), refused.map_err(|refused| refused.raise(py, None))?))
        };
        let mut all = Vec::with_capacity(robots.len());
        in_chunks(py, &robots, (false, 1), sizes, ask, |_, found| all.extend_from_slice(found))?;
        array_or_number(py, robots.shape(&[]), all)
    }
}

/// Keeps the answers up to the first robot that is refused.
///
/// # Errors
/// All robots are refused, or the device has failed.
fn keep(
    answers: Result<Vec<Result<bool, ProximityError>>, ProximityError>,
    rows: &mut [bool],
) -> Result<FirstRefused, Refused> {
    let answers =
        answers.map_err(|error| device_failure(&error).unwrap_or_else(|| error.into()))?;
    for (place, (answer, row)) in answers.into_iter().zip(rows).enumerate() {
        match answer {
            Ok(clear) => *row = clear,
            Err(error) => return Ok(Some((place, error.into()))),
        }
    }
    Ok(None)
}

/// The pose of all robots.
fn one_pose(given: &Bound<'_, PyAny>) -> PyResult<Pose> {
    let py = given.py();
    let (poses, count) = Poses::batch(given, "pose")?;
    match (count, poses.matrices(0..count.unwrap_or(1))) {
        (None | Some(1), [matrix]) => {
            pose_of(matrix).map_err(|refused| refused.of("pose").raise(py, None))
        }
        _ => {
            let count = count.unwrap_or_default();
            let text = format!("`pose` has {count} poses; give one for all robots");
            Err(Refused::other("bad_shape", text).raise(py, None))
        }
    }
}
