//! What a scene asks an engine. The numbers of its queries are checked, and robots are placed.

use super::search::BvhSearch;
use crate::answer::{Clearance, Decision, MotionAnswer, MotionClearance, ProximityError};
use crate::curve::Tube;
use crate::motion::Motion;
use crate::pair::PlacedRobot;
use crate::query::motion::{MarginQuery, MotionSearch, Sought};
use crate::query::nearest::ClearsSearch;
use parry3d_f64::math::{Pose, Real, Vector};

/// A motion in a structure of a scene.
pub(crate) struct SceneMotion<'a> {
    pub motion: &'a dyn Motion,
    /// As in [`MotionSearch`].
    pub frame: Option<(Real, Real)>,
    /// The vertices at the end of the motion, if they move.
    pub to: Option<&'a [Vector]>,
}

impl BvhSearch {
    /// Returns whether a robot that probably clears the mesh is farther than `margin`.
    ///
    /// Skips the guess at a link that crosses the wall, and the lower bounds of the last query.
    pub(crate) fn clears_unless_crossing(&mut self, robot: PlacedRobot, margin: Real) -> bool {
        let (search, last) = self.context().search();
        ClearsSearch { search, sides: None, robot, memory: &mut last.clears }
            .cleared_by(margin)
            .is_some()
    }

    /// [`clears_tube`](Self::clears_tube) for a tube in a scene. The margin and the resolution are
    /// checked. `frame`: the largest coordinate of the mesh and of its pose in the scene, if `pose`
    /// is the product of the tube's pose there and the inverse of the mesh's pose.
    pub(crate) fn ask_clears_tube(
        &mut self,
        tube: &Tube,
        pose: &Pose,
        wanted: MarginQuery,
        frame: Option<Real>,
    ) -> Result<Decision, ProximityError> {
        self.context().clears_tube(tube, pose, wanted, frame)
    }

    /// [`clearance`](Self::clearance) for a tube in a scene. The tolerance is checked; `frame` is
    /// as for `ask_clears_tube`.
    pub(crate) fn ask_clearance(
        &mut self,
        tube: &Tube,
        pose: &Pose,
        tolerance: Real,
        frame: Option<Real>,
    ) -> Result<Clearance, ProximityError> {
        self.context().clearance(tube, pose, tolerance, frame)
    }

    /// [`clears_motion`](Self::clears_motion) or [`time_of_contact`](Self::time_of_contact) in a
    /// scene.
    pub(crate) fn ask_margin(
        &mut self,
        asked: SceneMotion,
        wanted: MarginQuery,
        sought: Sought,
    ) -> Result<MotionAnswer, ProximityError> {
        self.scene_motion(asked).decide(wanted, sought)
    }

    /// [`clearance_of_motion`](Self::clearance_of_motion) in a scene; or a lower bound of at least
    /// `limit`.
    pub(crate) fn ask_clearance_of_motion(
        &mut self,
        asked: SceneMotion,
        tolerance: Real,
        limit: Real,
    ) -> Result<MotionClearance, ProximityError> {
        self.scene_motion(asked).clearance(tolerance, limit)
    }

    fn scene_motion<'a>(
        &'a mut self,
        SceneMotion { motion, frame, to }: SceneMotion<'a>,
    ) -> MotionSearch<'a> {
        let mut search = self.context().motion(motion);
        search.frame = frame;
        if let Some(to) = to {
            search.move_mesh(to);
        }
        search
    }
}
