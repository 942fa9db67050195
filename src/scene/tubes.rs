//! Queries about tubes in a scene.

use super::Scene;
use super::least_slack::{BoundedSlack, LeastSlack};
use super::moving_robot::RestingTube;
use super::queries::{beside, of_pair, of_robot, pairs_apart};
use crate::answer::{Clearance, Decision, RobotClearance, SceneClearance, SceneError, ScenePlace};
use crate::curve::Tube;
use crate::query::check_not_negative;
use crate::query::motion::MarginQuery;
use crate::refine::PlacedTube;
use parry3d_f64::math::{Pose, Real};

impl Scene {
    /// Decides whether all tubes keep all margins: from structures, from one another, and each from
    /// itself.
    ///
    /// Each pose maps its tube's frame to the scene's frame. `resolution` is a length. Structures
    /// without a margin are ignored. The margins [between robots](Self::set_robot_margin), except
    /// for [nested](Self::set_nested) ones, and [to themselves](Self::set_self_margin) are
    /// optional.
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
    /// A contact that is found is reported instead of the last two errors, before or after them.
    /// - Nothing in the scene has a margin.
    /// - The resolution is negative or NaN.
    /// - A pose is not finite or not rigid, or moves its tube out of range. The message has the
    ///   robot's number.
    /// - [`set_vertices`](Self::set_vertices) has opened the mesh of a solid structure.
    /// - The robots have a margin to themselves, without an [arc length](Self::set_self_arc), and a
    ///   tube bends within its radius.
    /// - Samples do not allow a decision at that resolution, or a curve is not finite somewhere.
    pub fn clears_tube(
        &mut self,
        tubes: &[(&Tube, Pose)],
        resolution: Real,
    ) -> Result<Decision, SceneError> {
        self.check_has_margin()?;
        check_not_negative("resolution", resolution).map_err(SceneError::Query)?;
        self.bounds()?;
        let resting = resting(tubes)?;
        let mut found = Decisions::default();
        for structure in &mut self.structures {
            for (robot, (tube, pose)) in tubes.iter().enumerate() {
                let Some(margin) = structure.margin_from(robot) else { continue };
                if resting[robot].at_least(structure) > margin {
                    continue;
                }
                let (pose, frame) = (structure.in_mesh(pose), structure.frame());
                let wanted = MarginQuery { margin, resolution };
                let answer = structure.search.ask_clears_tube(tube, &pose, wanted, frame);
                let answer = structure.decide_tube(answer, tube, &pose);
                if found.ends_with(answer.map_err(beside(structure, robot))) {
                    return Ok(Decision::Contact);
                }
            }
        }
        if let Some(margin) = self.robot_margin {
            for [first, second] in pairs_apart(tubes.len(), &self.nested) {
                let [(a, pose_a), (b, pose_b)] = [&tubes[first], &tubes[second]];
                let answer = self.pair.clears_tubes(a, pose_a, b, pose_b, margin, resolution);
                if found.ends_with(answer.map_err(of_pair([first, second]))) {
                    return Ok(Decision::Contact);
                }
            }
        }
        if let Some(margin) = self.self_margin {
            for (robot, (tube, _)) in tubes.iter().enumerate() {
                let answer = match self.self_arc {
                    None => self.itself.clears_tube(tube, margin, resolution),
                    Some(arc) => self.itself.clears_tube_beyond(tube, arc, margin, resolution),
                };
                if found.ends_with(answer.map_err(of_robot(robot))) {
                    return Ok(Decision::Contact);
                }
            }
        }
        found.decision()
    }

    /// Bounds the least slack of tubes: of the tubes and the structures with a margin, and between
    /// the tubes, if they have one.
    ///
    /// Returns `None` if there is no tube or no such margin. `lower` <= least slack <= `upper`.
    /// `tolerance` is a length: the bounds differ by at most the tolerance if the tubes allow that
    /// ([`resolved`](SceneClearance::resolved)). Each pose maps its tube's frame to the scene's
    /// frame. The margins of robots to themselves do not count.
    ///
    /// ```
    /// use parry_continuum::{Chain, Tube};
    /// use parry_continuum::parry::{math::{Pose, Vector}, shape::Ball};
    /// use parry_continuum::proximity::{BvhSearch, Scene, ScenePlace};
    ///
    /// let mut scene = Scene::new();
    /// for (name, radius, margin) in [("wall", 10.0, 1.0), ("vessel", 1.0, 2.0)] {
    ///     let (vertices, triangles) = Ball::new(radius).to_trimesh(64, 32);
    ///     scene.add(name, BvhSearch::from_triangles(&vertices, &triangles)?, Some(margin))?;
    /// }
    /// let tube = Tube::from(&Chain::from_centreline(&[Vector::ZERO, Vector::Z * 3.0], &[0.5])?);
    /// let robots = [(&tube, Pose::translation(4.0, 0.0, 0.0))];
    /// let least = scene.clearance(&robots, 1e-3)?.ok_or("no margin")?;
    /// assert!(least.lower < 0.51 && 0.5 <= least.upper); // 4 - 1 - 0.5 from the vessel
    /// assert!(matches!(least.place, ScenePlace::Structure { structure: 1, .. }));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// - The tolerance is negative or NaN.
    /// - A pose is not finite or not rigid, or moves its tube out of range. The message has the
    ///   robot's number.
    /// - [`set_vertices`](Self::set_vertices) has opened the mesh of a solid structure.
    /// - A curve is not finite somewhere.
    pub fn clearance(
        &mut self,
        tubes: &[(&Tube, Pose)],
        tolerance: Real,
    ) -> Result<Option<SceneClearance>, SceneError> {
        check_not_negative("tolerance", tolerance).map_err(SceneError::Query)?;
        self.bounds()?;
        let resting = resting(tubes)?;
        let mut least = LeastSlack::new();
        for (bound, [number, robot]) in
            self.by_slack(tubes.len(), |_, structure, robot| resting[robot].at_least(structure))
        {
            if bound > least.upper() {
                break;
            }
            let structure = &mut self.structures[number];
            let Some(margin) = structure.margin_from(robot) else { continue };
            let (tube, pose) = &tubes[robot];
            let (pose, frame) = (structure.in_mesh(pose), structure.frame());
            let found = structure
                .search
                .ask_clearance(tube, &pose, tolerance, frame)
                .and_then(|found| structure.clearance_of_tube(found, tube, &pose));
            let Clearance { lower, upper, uncertainty, section, witness, .. } =
                found.map_err(beside(structure, robot))?;
            let witness = structure.placed_witness(witness);
            let (structure, of) = (number as u32, robot as u32);
            let place = ScenePlace::Structure { structure, robot: of, section, witness };
            least.offer([0, number, robot], margin, [lower, upper], uncertainty, place);
        }
        if let Some(margin) = self.robot_margin {
            for pair in pairs_apart(tubes.len(), &self.nested) {
                let [(a, pose_a), (b, pose_b)] = pair.map(|robot| &tubes[robot]);
                let found = self.pair.clearance(a, pose_a, b, pose_b, tolerance);
                let RobotClearance { lower, upper, uncertainty, sections, witness, .. } =
                    found.map_err(of_pair(pair))?;
                let robots = pair.map(|robot| robot as u32);
                let place = ScenePlace::Robots { robots, sections, witness };
                least.offer([1, pair[0], pair[1]], margin, [lower, upper], uncertainty, place);
            }
        }
        Ok(least.answer(tolerance).map(|found| {
            let BoundedSlack { lower, upper, resolved, uncertainty, place } = found;
            SceneClearance { lower, upper, resolved, uncertainty, place }
        }))
    }
}

/// The bodies around the tubes.
///
/// # Errors
/// A tube has no section, or its pose is not finite or not rigid or moves it out of range.
fn resting(tubes: &[(&Tube, Pose)]) -> Result<Vec<RestingTube>, SceneError> {
    let place = |(robot, (tube, pose)): (usize, &(&Tube, Pose))| {
        let placed = PlacedTube::new(tube, pose, 0.0).map_err(of_robot(robot))?;
        Ok(RestingTube::new(&placed))
    };
    tubes.iter().enumerate().map(place).collect()
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
