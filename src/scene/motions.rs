//! Queries about robots that move in a scene.
//!
//! # Algorithm
//! 1. **Sweep** ([`MovingRobot`]). Make the first shapes of all robots, which finds most errors, and
//!    bound where each robot goes.
//! 2. **Structures**, in order, and for each structure the robots, in order. Skip a robot whose
//!    bound is beyond the margin. Query the others as
//!    [`BvhSearch::clears_motion`](crate::proximity::BvhSearch::clears_motion) does.
//! 3. **Robots.** Query the pairs that are not nested, then each robot and itself.
//! 4. The first contact ends the query. Without a contact the first error counts, then the earliest
//!    interval that is undecided.
//!
//! The queries share the shapes of their first intervals. They share nothing else, so each decides
//! as if it were the only one.

use super::Scene;
use super::moving_robot::{MovingRobot, MovingRobotMemory};
use super::queries::{of_robot, pairs_apart};
use crate::answer::{
    PlacementFault, ProximityError, RobotMotionAnswer, RobotsInContact, SceneError,
    SceneMotionAnswer, SceneMotionContact, UndecidedReason,
};
use crate::motion::Motion;
use crate::query::check_not_negative;
use crate::query::motion::MarginQuery;
use parry3d_f64::math::Real;

impl Scene {
    /// Decides whether robots that move at the same time keep all margins, at every time from 0 to
    /// 1: from structures, from one another, and each from itself.
    ///
    /// `motions` has one motion per robot, in the scene's frame. A robot at rest is a
    /// [`RigidMotion`](crate::RigidMotion) from a pose to the same pose. Motions of different types
    /// are given as `&dyn Motion`. `resolution` is a length. Structures without a margin are
    /// ignored. The margins [between robots](Self::set_robot_margin), except for
    /// [nested](Self::set_nested) ones, and [to themselves](Self::set_self_margin) are optional.
    ///
    /// One query replaces
    /// [`BvhSearch::clears_motion`](crate::proximity::BvhSearch::clears_motion) for each robot and
    /// structure, [`RobotPair::clears_motions`](crate::proximity::RobotPair::clears_motions) for
    /// each pair, and [`SelfQuery::clears_motion`](crate::proximity::SelfQuery::clears_motion) for
    /// each robot:
    ///
    /// - `Clear`: all of them are clear. This is proven for every instant, given the speeds that
    ///   the motions state.
    /// - `Contact`: the answer names the first of them with a contact, in this order: the
    ///   structures, and for each structure the robots; the pairs of robots; each robot and itself.
    ///   The contact may not be the first in time.
    /// - `Undecided`: none has a contact, and some are undecided. The answer has the earliest
    ///   interval, and its [reason](SceneMotionAnswer::reason).
    ///
    /// A structure that a robot certainly does not reach, by the shapes in the middle of the motion
    /// and the stated speeds, costs one test of its bounding box. The answer does not depend on
    /// earlier queries.
    ///
    /// ```
    /// use parry_continuum::{Chain, LinearMotion, Motion, RigidMotion, Tube};
    /// use parry_continuum::parry::{math::{Pose, Vector}, shape::Ball};
    /// use parry_continuum::proximity::{BvhSearch, Decision, Scene, SceneMotionContact};
    ///
    /// let (vertices, triangles) = Ball::new(10.0).to_trimesh(64, 32);
    /// let mut scene = Scene::new();
    /// scene.add("wall", BvhSearch::from_triangles(&vertices, &triangles)?, Some(1.0))?;
    /// scene.set_robot_margin(Some(0.5))?;
    ///
    /// let tips = [-3.0, 3.0].map(|x| [Vector::ZERO, Vector::new(x, 0.0, 5.0)]);
    /// let moving = LinearMotion::chain(&tips[0], &tips[1], &[0.5])?;
    /// let needle = Chain::capsules(&[Vector::new(0.0, 6.0, 5.0), Vector::new(0.0, 3.0, 5.0)], &[0.5])?;
    /// let at_rest = |y: f64| RigidMotion::new(Tube::from(&needle), [Pose::translation(0.0, y, 0.0); 2]);
    ///
    /// let second = at_rest(0.0)?;
    /// let answer = scene.clears_motion::<dyn Motion>(&[&moving, &second], 1e-3)?;
    /// assert!(answer.is_clear());
    /// let nearer = at_rest(-2.0)?;
    /// let answer = scene.clears_motion::<dyn Motion>(&[&moving, &nearer], 1e-3)?;
    /// assert_eq!(answer.decision, Decision::Contact);
    /// assert!(matches!(answer.contact, Some(SceneMotionContact::Robots { robots: [0, 1], .. })));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// A contact that is found first is reported instead of an error.
    /// - Nothing in the scene has a margin.
    /// - The resolution is negative or NaN.
    /// - A motion has no shape at some time, its sections change, or a stated speed is not finite.
    ///   The message has the robot's number, as for the next two.
    /// - A robot is out of range, or too fast for the resolution.
    /// - The robots have a margin to themselves, and a joint is too sharp, or a tube bends within
    ///   its radius.
    /// - The resolution is finer than rounding or the samples of a shape allow.
    pub fn clears_motion<M: Motion + ?Sized>(
        &mut self,
        motions: &[&M],
        resolution: Real,
    ) -> Result<SceneMotionAnswer, SceneError> {
        self.check_has_margin()?;
        check_not_negative("resolution", resolution).map_err(SceneError::Query)?;
        self.with_moving_robots(motions, |scene, robots| {
            let mut found = Findings::default();
            scene.clears_each(robots, resolution, &mut found);
            found.answer()
        })
    }

    /// Calls `ask` with the moving robots, which borrow the memory of the scene.
    ///
    /// # Errors
    /// A robot has no shape, or one that cannot be placed.
    fn with_moving_robots<M: Motion + ?Sized, T>(
        &mut self,
        motions: &[&M],
        ask: impl FnOnce(&mut Self, &[MovingRobot<M>]) -> Result<T, SceneError>,
    ) -> Result<T, SceneError> {
        let mut memory = std::mem::take(&mut self.moving);
        if memory.len() < motions.len() {
            memory.resize_with(motions.len(), MovingRobotMemory::default);
        }
        let (mut robots, mut failed) = (Vec::with_capacity(motions.len()), None);
        for (number, (motion, memory)) in motions.iter().zip(&mut memory).enumerate() {
            match MovingRobot::new(*motion, memory) {
                Ok(robot) => robots.push(robot),
                Err(error) => {
                    failed = Some(of_robot(number)(error));
                    break;
                }
            }
        }
        let answer = failed.map_or_else(|| ask(self, &robots), Err);
        for (robot, memory) in robots.into_iter().zip(&mut memory) {
            robot.give_back(memory);
        }
        self.moving = memory;
        answer
    }

    /// Asks all queries in order, up to the first contact.
    fn clears_each<M: Motion + ?Sized>(
        &mut self,
        robots: &[MovingRobot<M>],
        resolution: Real,
        found: &mut Findings,
    ) {
        for (number, structure) in self.structures.iter_mut().enumerate() {
            let Some(margin) = structure.margin else { continue };
            for (robot, moving) in robots.iter().enumerate() {
                if moving.is_beyond(structure, margin) {
                    continue;
                }
                let (motion, frame) = (moving.in_mesh(structure), structure.frame());
                let wanted = MarginQuery { margin, resolution };
                let answer = structure
                    .search
                    .ask_clears_motion(&motion, wanted, frame)
                    .map(|answer| Finding {
                        interval: answer.interval,
                        reason: answer.reason,
                        contact: answer.contact.map(|shape| SceneMotionContact::Structure {
                            structure: number as u32,
                            robot: robot as u32,
                            shape: structure.placed_shape(shape),
                        }),
                    })
                    .map_err(of_robot(robot));
                if found.ends_with(answer) {
                    return;
                }
            }
        }
        if let Some(margin) = self.robot_margin {
            for pair in pairs_apart(robots.len(), &self.nested) {
                let [a, b] = pair.map(|robot| robots[robot].in_scene());
                let answer = self
                    .pair
                    .clears_motions(&a, &b, margin, resolution)
                    .map(|answer| {
                        let robots = pair.map(|robot| robot as u32);
                        Finding::new(&answer, |shapes| SceneMotionContact::Robots {
                            robots,
                            shapes,
                        })
                    })
                    .map_err(|error| of_pair(pair, [&a, &b], error));
                if found.ends_with(answer) {
                    return;
                }
            }
        }
        if let Some(margin) = self.self_margin {
            for (number, moving) in robots.iter().enumerate() {
                let answer = self
                    .itself
                    .clears_motion(&moving.in_scene(), margin, resolution)
                    .map(|answer| {
                        let robot = number as u32;
                        Finding::new(&answer, |shapes| SceneMotionContact::Itself { robot, shapes })
                    })
                    .map_err(of_robot(number));
                if found.ends_with(answer) {
                    return;
                }
            }
        }
    }
}

/// The answer of one query.
struct Finding {
    interval: [Real; 2],
    contact: Option<SceneMotionContact>,
    /// Why it is undecided.
    reason: Option<UndecidedReason>,
}

impl Finding {
    fn new(
        answer: &RobotMotionAnswer,
        contact: impl FnOnce(RobotsInContact) -> SceneMotionContact,
    ) -> Self {
        let RobotMotionAnswer { interval, reason, .. } = *answer;
        Self { interval, reason, contact: answer.contact.map(contact) }
    }
}

/// The answers of all queries so far.
#[derive(Default)]
struct Findings {
    contact: Option<([Real; 2], SceneMotionContact)>,
    /// The first error.
    error: Option<SceneError>,
    /// The earliest interval that is undecided, and the reason.
    undecided: Option<([Real; 2], UndecidedReason)>,
}

impl Findings {
    /// Adds an answer. Returns whether no other query matters.
    fn ends_with(&mut self, answer: Result<Finding, SceneError>) -> bool {
        match answer {
            Err(error) => self.error = self.error.take().or(Some(error)),
            Ok(Finding { interval, contact: Some(contact), .. }) => {
                self.contact = Some((interval, contact));
            }
            Ok(Finding { interval, reason: Some(reason), .. }) => {
                if self.undecided.is_none_or(|(earliest, _)| interval[0] < earliest[0]) {
                    self.undecided = Some((interval, reason));
                }
            }
            Ok(_) => {}
        }
        self.contact.is_some()
    }

    fn answer(self) -> Result<SceneMotionAnswer, SceneError> {
        let Self { contact, error, undecided } = self;
        if let Some((interval, contact)) = contact {
            return Ok(SceneMotionAnswer::contact(interval[0], contact));
        }
        if let Some(error) = error {
            return Err(error);
        }
        Ok(undecided.map_or_else(SceneMotionAnswer::clear, SceneMotionAnswer::undecided))
    }
}

/// Attributes an error of two motions to one of the robots, if it is about one.
fn of_pair(robots: [usize; 2], motions: [&impl Motion; 2], error: ProximityError) -> SceneError {
    let of = |parameter: &str| robots[usize::from(parameter == "b")];
    match error {
        ProximityError::OneMotion { parameter, fault } => {
            of_robot(of(parameter))(ProximityError::Motion(fault))
        }
        ProximityError::Placement { parameter, fault } => of_robot(of(parameter))(match fault {
            PlacementFault::PoseNotFinite => ProximityError::PoseNotFinite,
            PlacementFault::PoseNotRigid { length } => ProximityError::PoseNotRigid { length },
            PlacementFault::OutOfRange { link, limit } => {
                ProximityError::OutOfRange { link, limit }
            }
            PlacementFault::TubeOutOfRange { limit } => ProximityError::TubeOutOfRange { limit },
        }),
        ProximityError::TooFast { section, .. } => {
            let speed = |motion: &dyn Motion| motion.speed(section, [0.0, 1.0], [0.0, 1.0]).point;
            let is_second = speed(motions[1]) > speed(motions[0]);
            of_robot(robots[usize::from(is_second)])(error)
        }
        error => SceneError::BetweenRobots(error),
    }
}
