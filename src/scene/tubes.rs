//! Queries about tubes in a scene.

use super::Scene;
use super::queries::{of_robot, pairs_apart};
use crate::answer::{Decision, SceneError};
use crate::curve::Tube;
use crate::query::check_not_negative;
use crate::refine::PlacedTube;
use parry3d_f64::math::{Pose, Real};

impl Scene {
    /// Decides whether all tubes keep all margins: from structures, from one another, and each from
    /// itself.
    ///
    /// Each pose maps its tube's frame to the scene's frame. `resolution` is a length. Structures
    /// without a margin are ignored. The margins [between robots](Self::set_robot_margin), except
    /// for [nested](Self::set_nested) ones, and [to themselves](Self::set_self_margin) are optional.
    ///
    /// - `Clear`: proven for all structures, pairs of robots, and robots with themselves.
    /// - `Contact`: proven for one of them.
    /// - `Undecided`: none has a contact, and some are undecided: within the resolution of the
    ///   margin, or for the reasons of
    ///   [`BvhSearch::clears_tube`](crate::proximity::BvhSearch::clears_tube),
    ///   [`RobotPair::clears_tubes`](crate::proximity::RobotPair::clears_tubes) and
    ///   [`SelfQuery::clears_tube`](crate::proximity::SelfQuery::clears_tube).
    ///
    /// ```
    /// use parry_continuum::{Chain, Tube};
    /// use parry_continuum::parry::{math::{Pose, Vector}, shape::Ball};
    /// use parry_continuum::proximity::{BvhSearch, Decision, Scene};
    ///
    /// let (vertices, triangles) = Ball::new(10.0).to_trimesh(64, 32);
    /// let mut scene = Scene::new();
    /// scene.add("wall", BvhSearch::from_triangles(&vertices, &triangles)?, Some(1.0))?;
    /// let tube = Tube::from(&Chain::from_centreline(&[Vector::ZERO, Vector::Z * 5.0], &[0.5])?);
    /// assert_eq!(scene.clears_tube(&[(&tube, Pose::IDENTITY)], 1e-3)?, Decision::Clear);
    /// let moved = Pose::translation(0.0, 0.0, 4.5);
    /// assert_eq!(scene.clears_tube(&[(&tube, moved)], 1e-3)?, Decision::Contact);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// A contact that is found first is reported instead of the last two errors.
    /// - Nothing in the scene has a margin.
    /// - The resolution is negative or NaN.
    /// - A pose is not finite or not rigid, or moves its tube out of range. The message has the
    ///   robot's number.
    /// - The robots have a margin to themselves, and a tube bends within its radius.
    /// - Samples do not allow a decision at that resolution, or a curve is not finite somewhere.
    pub fn clears_tube(
        &mut self,
        tubes: &[(&Tube, Pose)],
        resolution: Real,
    ) -> Result<Decision, SceneError> {
        self.check_has_margin()?;
        check_not_negative("resolution", resolution).map_err(SceneError::Query)?;
        for (robot, (tube, pose)) in tubes.iter().enumerate() {
            PlacedTube::new(tube, pose, 0.0).map_err(of_robot(robot))?;
        }
        let mut found = Decisions::default();
        for structure in &mut self.structures {
            let Some(margin) = structure.margin else { continue };
            for (robot, (tube, pose)) in tubes.iter().enumerate() {
                let (pose, frame) = (structure.in_mesh(pose), structure.frame());
                let search = &mut structure.search;
                let answer = search.ask_clears_tube(tube, &pose, [margin, resolution], frame);
                if found.ends_with(answer.map_err(of_robot(robot))) {
                    return Ok(Decision::Contact);
                }
            }
        }
        if let Some(margin) = self.robot_margin {
            for [first, second] in pairs_apart(tubes.len(), &self.nested) {
                let [(a, pose_a), (b, pose_b)] = [&tubes[first], &tubes[second]];
                let answer = self.pair.clears_tubes(a, pose_a, b, pose_b, margin, resolution);
                if found.ends_with(answer.map_err(SceneError::BetweenRobots)) {
                    return Ok(Decision::Contact);
                }
            }
        }
        if let Some(margin) = self.self_margin {
            for (robot, (tube, _)) in tubes.iter().enumerate() {
                let answer = self.itself.clears_tube(tube, margin, resolution);
                if found.ends_with(answer.map_err(of_robot(robot))) {
                    return Ok(Decision::Contact);
                }
            }
        }
        found.decision()
    }
}

/// The decisions of all queries so far.
#[derive(Default)]
struct Decisions {
    /// The first error.
    error: Option<SceneError>,
    is_undecided: bool,
}

impl Decisions {
    /// Adds a decision. Returns whether it is a contact, after which no other query matters.
    fn ends_with(&mut self, answer: Result<Decision, SceneError>) -> bool {
        match answer {
            Err(error) => self.error = self.error.take().or(Some(error)),
            Ok(decision) => {
                self.is_undecided |= decision == Decision::Undecided;
                return decision == Decision::Contact;
            }
        }
        false
    }

    fn decision(self) -> Result<Decision, SceneError> {
        match self {
            Self { error: Some(error), .. } => Err(error),
            Self { is_undecided: true, .. } => Ok(Decision::Undecided),
            _ => Ok(Decision::Clear),
        }
    }
}
