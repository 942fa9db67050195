//! A motion of sections of constant curvature.

use super::{Motion, Moving, Recipe, place_in, together};
use crate::error::Refused;
use crate::input::{Poses, SectionRadii, Sections, pose_of};
use parry_continuum::parry::math::Pose;
use pyo3::prelude::*;

/// The motion of a robot of sections of constant curvature, whose lengths and curvatures change
/// evenly: of a tendon robot, or of concentric tubes that do not twist.
///
/// The base stands still, and the curve leaves its origin along z; `MovingBase` moves it. A section
/// has the curvature (x, y), 1 / length, towards x and y of the frame that is carried along the
/// curve without twist.
///
/// Parameters
/// ----------
/// start, end : (S, 3) or (B, S, 3) arrays
///     A row for each section, from the base: its length, and its curvature towards x and towards
///     y, at the times 0 and 1.
/// radii : float, (S,) or (B, S) array
///     One radius for each section.
/// pose : (4, 4) or (B, 4, 4) array, optional
///     From the frame of the base to the mesh's.
///
/// Raises
/// ------
/// ContinuumError
///     The two differ in their number of sections, a length is not positive, a number is not
///     finite, a section bends within its radius where it ends in a flat face, or the pose is not
///     rigid.
///
/// Examples
/// --------
/// >>> import numpy as np
/// >>> from parry_continuum import BendingMotion, Mesh
/// >>> wall = Mesh([[9, -90, -90], [9, 90, -90], [9, 0, 90]], [[0, 1, 2]])
/// >>> motion = BendingMotion([[30, 0, 0]], [[30, 0.01, 0]], 0.5)  # straight, then an arc in x
/// >>> found = wall.clearance_of_motion(motion, tolerance=0.001)
/// >>> tip = (1 - np.cos(0.3)) / 0.01 + 0.5 * np.cos(0.3)
/// >>> bool(found.lower <= 9 - tip <= found.upper)
/// True
#[pyclass(frozen, extends = Motion, module = "parry_continuum")]
pub(crate) struct BendingMotion;

#[pymethods]
impl BendingMotion {
    #[new]
    #[pyo3(signature = (start, end, radii, *, pose = None))]
    fn new(
        py: Python<'_>,
        start: &Bound<'_, PyAny>,
        end: &Bound<'_, PyAny>,
        radii: &Bound<'_, PyAny>,
        pose: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let (given, given_pose) = ([start, end, radii], pose.cloned());
        let (start, end) = (Sections::new(start, "start")?, Sections::new(end, "end")?);
        if start.each != end.each {
            let text = format!(
                "`start` has {} sections and `end` {}; give as many of both",
                start.each, end.each
            );
            return Err(Refused::other("sections_differ", text).raise(py, None));
        }
        let radii = SectionRadii::new(radii, start.each)?;
        let (poses, pose_count) = match pose {
            Some(pose) => {
                let (poses, count) = Poses::batch(pose, "pose")?;
                (poses.matrices(0..count.unwrap_or(1)).to_vec(), count)
            }
            None => (Vec::new(), None),
        };
        let count = together(
            py,
            [
                ("start", start.count),
                ("end", end.count),
                ("radii", radii.count),
                ("pose", pose_count),
            ],
        )?;
        let motion = Motion::new(py, count, |place| {
            let pose = match pose_count {
                Some(_) => pose_of(&poses[place_in(pose_count, place)]),
                None => poses.first().map_or(Ok(Pose::IDENTITY), pose_of),
            };
            let pose = pose.map_err(|refused| refused.of("pose"))?;
            let [start, end] =
                [&start, &end].map(|sections| sections.at(place, &radii).collect::<Vec<_>>());
            Ok(Moving::Bending(parry_continuum::BendingMotion::new(&start, &end, pose)?))
        })?;
        let recipe = Recipe::new(py, None, &given, &[("pose", given_pose)])?;
        Ok(motion.with_recipe(recipe).into_class(Self))
    }
}
