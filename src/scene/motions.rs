//! Queries about robots that move in a scene: whether they keep all margins, until when, and the
//! least slack.
//!
//! # Algorithm
//! 1. **Sweep** ([`MovingRobot`]). Make the first shapes of all robots, which finds most errors,
//!    and bound where each robot goes.
//! 2. **Structures** and robots, the least lower bound on the slack first: a contact is probably
//!    found at once. Skip those whose bound is beyond the margin. Query the others as
//!    [`BvhSearch::clears_motion`](crate::proximity::BvhSearch::clears_motion) does.
//! 3. **Robots.** Query the pairs that are not nested, then each robot and itself.
//! 4. **Answer.** The first contact ends the query; `time_of_contact` continues and keeps the
//!    earliest contact. Without a contact the answer is the first error, or else the earliest
//!    undecided interval.
//!
//! The least slack combines the slacks of the structures, then of the pairs of robots, each nearest
//! first by their bounds ([`LeastSlack`]). All pairs of robots share one limit of work; each but
//! the last takes at most half of the remaining work.
//!
//! The queries share the shapes of their first intervals. They share nothing else, so each decides
//! as if it were the only one.

use super::Scene;
use super::least_slack::{BoundedSlack, LeastSlack};
use super::moving_robot::{MovingRobot, MovingRobotMemory};
use super::queries::{beside, of_pair, of_robot, of_structure, pairs_apart};
use super::structure::{Structure, place_witness};
use super::structure_end::{MovingStructure, StructureEnd, seen_from};
use crate::answer::{
    Clearance, MotionAnswer, MotionClearance, ProximityError, RobotMotionAnswer,
    RobotMotionClearance, RobotsInContact, SceneError, SceneMotionAnswer, SceneMotionClearance,
    SceneMotionContact, ScenePlace, ShapeInContact, Side, UndecidedReason,
};
use crate::curve::Tube;
use crate::engine::SceneMotion;
use crate::motion::Motion;
use crate::query::check_not_negative;
use crate::query::motion::{MAX_PAIRS_FOR_BOUNDS, MarginQuery, Sought};
use parry3d_f64::math::{Pose, Real};

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
    /// - `Contact`: the answer names the first contact in the order of the queries: robots and
    ///   structures, the nearest by their bounds first; then pairs of robots; then each robot and
    ///   itself. Another contact may be earlier in time.
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
    /// let needle =
    ///     Chain::capsules(&[Vector::new(0.0, 6.0, 5.0), Vector::new(0.0, 3.0, 5.0)], &[0.5])?;
    /// let at_rest =
    ///     |y: f64| RigidMotion::new(Tube::from(&needle), [Pose::translation(0.0, y, 0.0); 2]);
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
    /// A contact that is found is reported instead of an error, before or after it.
    /// - Nothing in the scene has a margin.
    /// - The margin of robots to themselves is by [arc length](Self::set_self_arc).
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
        self.decide_motions(motions, &[], resolution, Sought::Any)
    }

    /// [`clears_motion`](Self::clears_motion) while structures move, too.
    ///
    /// `ends` has the numbers of the structures that move, and where each of them is at t = 1. A
    /// structure that is not listed rests. The scene itself stays as it is.
    ///
    /// `Clear` is proven for every instant. The points of a contact are the points of robot and
    /// structure at the time of the contact.
    ///
    /// ```
    /// use parry_continuum::{Chain, RigidMotion, Tube};
    /// use parry_continuum::parry::{math::{Pose, Vector}, shape::Ball};
    /// use parry_continuum::proximity::{BvhSearch, Scene, StructureEnd};
    ///
    /// let (vertices, triangles) = Ball::new(1.0).to_trimesh(32, 16);
    /// let mut scene = Scene::new();
    /// let vessel =
    ///     scene.add("vessel", BvhSearch::from_triangles(&vertices, &triangles)?, Some(0.5))?;
    /// scene.set_pose(vessel, &Pose::translation(4.0, 0.0, 3.0))?;
    /// let needle = Tube::from(&Chain::capsules(&[Vector::ZERO, Vector::Z * 6.0], &[0.5])?);
    /// let at_rest = RigidMotion::new(needle, [Pose::IDENTITY; 2])?;
    /// let moves_to = |x: f64| [(vessel, StructureEnd::Pose(Pose::translation(x, 0.0, 3.0)))];
    /// assert!(scene.clears_motion_while(&moves_to(2.5), &[&at_rest], 1e-3)?.is_clear());
    /// assert!(!scene.clears_motion_while(&moves_to(1.5), &[&at_rest], 1e-3)?.is_clear());
    /// let grown: Vec<_> = vertices.iter().map(|vertex| vertex * 3.5).collect();
    /// let grows = [(vessel, StructureEnd::Vertices(&grown))];
    /// assert!(!scene.clears_motion_while(&grows, &[&at_rest], 1e-3)?.is_clear());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`clears_motion`](Self::clears_motion); or:
    /// - There is no such structure.
    /// - A pose is not finite, not rigid or out of range.
    /// - The number of vertices differs from that of the mesh, or one is not finite or out of
    ///   range. The message names the structure.
    /// - The vertices open the mesh of a solid structure.
    pub fn clears_motion_while<M: Motion + ?Sized>(
        &mut self,
        ends: &[(usize, StructureEnd)],
        motions: &[&M],
        resolution: Real,
    ) -> Result<SceneMotionAnswer, SceneError> {
        self.decide_motions(motions, ends, resolution, Sought::Any)
    }

    /// Bounds the time at which moving robots first violate a margin.
    ///
    /// Arguments and decisions are as for [`clears_motion`](Self::clears_motion). The contact of
    /// the answer is the earliest of all. The answer's [`interval`](SceneMotionAnswer::interval) is
    /// `[clear_until, t]`: all margins are provably kept until `clear_until`, and the contact is at
    /// t. Between the two times the touching place moves by at most `resolution`. The times are
    /// farther apart only where a margin may be violated before, within the resolution.
    ///
    /// ```
    /// use parry_continuum::{LinearMotion, parry::{math::Vector, shape::Ball}};
    /// use parry_continuum::proximity::{BvhSearch, Scene};
    ///
    /// let (vertices, triangles) = Ball::new(10.0).to_trimesh(64, 32);
    /// let mut scene = Scene::new();
    /// scene.add("wall", BvhSearch::from_triangles(&vertices, &triangles)?, Some(0.0))?;
    /// let from = [Vector::ZERO, Vector::Z];
    /// let motion =
    ///     LinearMotion::chain(&from, &from.map(|point| point + Vector::Z * 20.0), &[0.01])?;
    /// let found = scene.time_of_contact(&[&motion], 1e-3)?;
    /// let [clear_until, t] = found.interval;
    /// // The tip has moved by 9 of 20.
    /// assert!(clear_until <= 0.45 && 0.449 <= t && t - clear_until <= 1e-3);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`clears_motion`](Self::clears_motion).
    pub fn time_of_contact<M: Motion + ?Sized>(
        &mut self,
        motions: &[&M],
        resolution: Real,
    ) -> Result<SceneMotionAnswer, SceneError> {
        self.decide_motions(motions, &[], resolution, Sought::First)
    }

    /// Bounds the least slack of moving robots over all times from 0 to 1: of the robots and the
    /// structures with a margin, and between the robots, if they have one.
    ///
    /// Returns `None` if there is no robot or no such margin. `lower` <= least slack <= `upper`.
    /// `tolerance` is a length: the bounds differ by at most the tolerance if the motions' shapes
    /// allow that ([`resolved`](SceneMotionClearance::resolved)), within a million pairs of pieces
    /// for all pairs of robots. Of several pairs the nearest takes at most half of them, and each
    /// later one at most half of the rest. The margins of robots to themselves do not count.
    ///
    /// ```
    /// use parry_continuum::{LinearMotion, parry::{math::Vector, shape::Ball}};
    /// use parry_continuum::proximity::{BvhSearch, Scene};
    ///
    /// let (vertices, triangles) = Ball::new(10.0).to_trimesh(64, 32);
    /// let mut scene = Scene::new();
    /// scene.add("wall", BvhSearch::from_triangles(&vertices, &triangles)?, Some(1.0))?;
    /// let tips = [-4.0, 4.0].map(|x| [Vector::Z * 2.0, Vector::new(x, 0.0, 6.0)]);
    /// let motion = LinearMotion::chain(&tips[0], &tips[1], &[0.5])?;
    /// let least = scene.clearance_of_motion(&[&motion], 1e-3)?.ok_or("no margin")?;
    /// assert!(least.resolved && 1.0 < least.lower && least.upper <= least.lower + 1e-3);
    /// println!("{} mm at t = {}, {:?}", least.upper, least.t, least.place);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// - The tolerance is negative or NaN.
    /// - A motion has no shape at some time, its sections change, or a stated speed is not finite.
    ///   The message has the robot's number, as for the next one.
    /// - A robot is out of range.
    pub fn clearance_of_motion<M: Motion + ?Sized>(
        &mut self,
        motions: &[&M],
        tolerance: Real,
    ) -> Result<Option<SceneMotionClearance>, SceneError> {
        check_not_negative("tolerance", tolerance).map_err(SceneError::Query)?;
        self.bounds()?;
        let least = self.with_moving_robots(motions, |scene, robots| {
            scene.least_slack(robots, tolerance, MAX_PAIRS_FOR_BOUNDS)
        })?;
        let found = least.answer(tolerance);
        Ok(found.map(|BoundedSlack { lower, upper, resolved, uncertainty, place: (t, place) }| {
            SceneMotionClearance { lower, upper, resolved, uncertainty, t, place }
        }))
    }

    /// Tests at most `left` pairs of pieces of robots.
    fn least_slack(
        &mut self,
        robots: &[MovingRobot],
        tolerance: Real,
        mut left: u32,
    ) -> Result<LeastSlack<(Real, ScenePlace)>, SceneError> {
        let mut least = LeastSlack::new();
        for (bound, [number, robot]) in
            self.by_slack(robots.len(), |_, structure, robot| robots[robot].at_least(structure))
        {
            if bound > least.upper() {
                break;
            }
            let structure = &mut self.structures[number];
            let Some(margin) = structure.margin_from(robot) else { continue };
            let motion = robots[robot].in_mesh(structure);
            let frame = structure.frame().map(|size| (size, 1.0));
            let asked = SceneMotion { motion: &motion, frame, to: None };
            let found = structure
                .search
                .ask_clearance_of_motion(asked, tolerance, least.limit(margin))
                .and_then(|found| clearance_of_solid(found, &robots[robot], structure));
            let MotionClearance { lower, upper, uncertainty, t, section, witness, .. } =
                found.map_err(beside(structure, robot))?;
            let witness = structure.placed_witness(witness);
            let (structure, of) = (number as u32, robot as u32);
            let place = ScenePlace::Structure { structure, robot: of, section, witness };
            least.offer([0, number, robot], margin, [lower, upper], uncertainty, (t, place));
        }
        let Some(margin) = self.robot_margin else { return Ok(least) };
        let mut order: Vec<_> = pairs_apart(robots.len(), &self.nested)
            .map(|pair| {
                let [at_least, middle] = robots[pair[0]].at_least_from(&robots[pair[1]]);
                let slack = at_least.max(0.0) - margin;
                // An infinite margin and an infinite bound.
                let bound = if slack.is_nan() { Real::NEG_INFINITY } else { slack.next_down() };
                (bound, [middle, at_least], pair)
            })
            .collect();
        order.sort_unstable_by(|one, other| {
            let by_bound = one.0.total_cmp(&other.0).then(one.1[0].total_cmp(&other.1[0]));
            by_bound.then(one.2.cmp(&other.2))
        });
        let last = order.len().saturating_sub(1);
        for (number, (bound, [_, at_least], pair)) in order.into_iter().enumerate() {
            if bound > least.upper() {
                break;
            }
            // A pair that needs all of the work leaves half of it to the others.
            let kept = if number == last { 0 } else { left / 2 };
            left -= kept;
            let [a, b] = pair.map(|robot| robots[robot].in_scene());
            let limit = least.limit(margin);
            let RobotMotionClearance { lower, upper, uncertainty, t, sections, witness, .. } = self
                .pair
                .ask_clearance_of_motion([&a, &b], tolerance, limit, &mut left)
                .map_err(|error| of_motions(pair, [&a, &b], error))?;
            left += kept;
            let robots = pair.map(|robot| robot as u32);
            let place = ScenePlace::Robots { robots, sections, witness };
            let bounds = [lower.max(at_least), upper];
            least.offer([1, pair[0], pair[1]], margin, bounds, uncertainty, (t, place));
        }
        Ok(least)
    }

    fn decide_motions<M: Motion + ?Sized>(
        &mut self,
        motions: &[&M],
        ends: &[(usize, StructureEnd)],
        resolution: Real,
        sought: Sought,
    ) -> Result<SceneMotionAnswer, SceneError> {
        self.check_has_margin()?;
        // A motion states how fast places move, and not how its arc lengths change.
        if self.self_margin.and(self.self_arc).is_some() {
            return Err(SceneError::SelfArcOfMotion);
        }
        check_not_negative("resolution", resolution).map_err(SceneError::Query)?;
        self.bounds()?;
        let mut moving = Vec::with_capacity(ends.len());
        for (number, end) in ends {
            let structure = &*self.structure(*number)?;
            let moves = MovingStructure::new(structure, end);
            moving.push((*number, moves.map_err(|error| of_structure(structure, error))?));
            if let StructureEnd::Vertices(to) = end {
                structure.check_solid_at(to)?;
            }
        }
        self.with_moving_robots(motions, |scene, robots| {
            let mut found = Findings::new(sought);
            scene.decide_each(robots, &moving, resolution, &mut found);
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
        ask: impl FnOnce(&mut Self, &[MovingRobot]) -> Result<T, SceneError>,
    ) -> Result<T, SceneError> {
        let mut memory = std::mem::take(&mut self.moving);
        if memory.len() < motions.len() {
            memory.resize_with(motions.len(), MovingRobotMemory::default);
        }
        let (mut robots, mut failed) = (Vec::with_capacity(motions.len()), None);
        for (number, (motion, memory)) in motions.iter().zip(&mut memory).enumerate() {
            match MovingRobot::new(motion, memory) {
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

    /// Asks all queries in order, until the answer is known.
    fn decide_each(
        &mut self,
        robots: &[MovingRobot],
        moving: &[(usize, MovingStructure)],
        resolution: Real,
        found: &mut Findings,
    ) {
        let sought = found.sought;
        // Of several ends the last one counts.
        let end_of = |number: usize| {
            moving.iter().rev().find(|(moving, _)| *moving == number).map(|(_, end)| end)
        };
        let order = self.by_slack(robots.len(), |number, structure, robot| {
            end_of(number).map_or_else(
                || robots[robot].at_least(structure),
                |end| robots[robot].at_least_moving(structure, end),
            )
        });
        // The others are beyond their margin.
        for (_, [number, robot]) in order.into_iter().take_while(|(slack, _)| *slack <= 0.0) {
            let structure = &mut self.structures[number];
            let Some(margin) = structure.margin_from(robot) else { continue };
            let wanted = MarginQuery { margin, resolution };
            let answer =
                decide_structure(&robots[robot], structure, end_of(number), wanted, sought);
            let answer = decide_solid(answer, &robots[robot], structure)
                .map(|answer| Finding {
                    interval: answer.interval,
                    reason: answer.reason,
                    contact: answer.contact.map(|shape| SceneMotionContact::Structure {
                        structure: number as u32,
                        robot: robot as u32,
                        shape,
                    }),
                })
                .map_err(beside(structure, robot));
            if found.ends_with(answer) {
                return;
            }
        }
        if let Some(margin) = self.robot_margin {
            for pair in pairs_apart(robots.len(), &self.nested) {
                let [a, b] = pair.map(|robot| robots[robot].in_scene());
                let answer = self
                    .pair
                    .ask_motions([&a, &b], MarginQuery { margin, resolution }, sought)
                    .map(|answer| {
                        let robots = pair.map(|robot| robot as u32);
                        Finding::new(&answer, |shapes| SceneMotionContact::Robots {
                            robots,
                            shapes,
                        })
                    })
                    .map_err(|error| of_motions(pair, [&a, &b], error));
                if found.ends_with(answer) {
                    return;
                }
            }
        }
        if let Some(margin) = self.self_margin {
            for (number, asked) in robots.iter().enumerate() {
                let answer = self
                    .itself
                    .ask_motion(&asked.in_scene(), MarginQuery { margin, resolution }, sought)
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
struct Findings {
    sought: Sought,
    contact: Option<([Real; 2], SceneMotionContact)>,
    /// The first error.
    error: Option<SceneError>,
    /// The earliest interval that is undecided, and the reason.
    undecided: Option<([Real; 2], UndecidedReason)>,
    /// Until when all queries with a contact are clear.
    clear_until: Real,
}

impl Findings {
    fn new(sought: Sought) -> Self {
        Self { sought, contact: None, error: None, undecided: None, clear_until: 1.0 }
    }

    /// Adds an answer. Returns whether no other query matters.
    fn ends_with(&mut self, answer: Result<Finding, SceneError>) -> bool {
        match answer {
            Err(error) => self.error = self.error.take().or(Some(error)),
            Ok(Finding { interval, contact: Some(contact), .. }) => {
                self.clear_until = self.clear_until.min(interval[0]);
                if self.contact.is_none_or(|(first, _)| interval[1] < first[1]) {
                    self.contact = Some((interval, contact));
                }
            }
            Ok(Finding { interval, reason: Some(reason), .. }) => {
                if self.undecided.is_none_or(|(earliest, _)| interval[0] < earliest[0]) {
                    self.undecided = Some((interval, reason));
                }
            }
            Ok(_) => {}
        }
        self.sought == Sought::Any && self.contact.is_some()
    }

    fn answer(self) -> Result<SceneMotionAnswer, SceneError> {
        let Self { contact, error, undecided, clear_until, .. } = self;
        if let Some((_, contact)) = contact {
            let unknown = undecided.map_or(clear_until, |(times, _)| times[0].min(clear_until));
            // A query with an error proves nothing.
            let clear_until = if error.is_some() { 0.0 } else { unknown.min(contact.t()) };
            return Ok(SceneMotionAnswer::contact(clear_until, contact));
        }
        if let Some(error) = error {
            return Err(error);
        }
        Ok(undecided.map_or_else(SceneMotionAnswer::clear, SceneMotionAnswer::undecided))
    }
}

/// Decides about one robot and one structure, which moves if it has an `end`. The points of the
/// answer are in the scene's frame.
fn decide_structure(
    robot: &MovingRobot,
    structure: &mut Structure,
    end: Option<&MovingStructure>,
    wanted: MarginQuery,
    sought: Sought,
) -> Result<MotionAnswer, ProximityError> {
    let motion = robot.in_mesh(structure);
    let mut answer = match end {
        None => {
            let frame = structure.frame().map(|size| (size, 1.0));
            let asked = SceneMotion { motion: &motion, frame, to: None };
            structure.search.ask_margin(asked, wanted, sought)?
        }
        Some(MovingStructure::Deformed { to, size, .. }) => {
            let asked = SceneMotion { motion: &motion, frame: Some((*size, 1.0)), to: Some(to) };
            structure.search.ask_margin(asked, wanted, sought)?
        }
        Some(MovingStructure::Posed { bases, size, .. }) => {
            let motion = seen_from(robot.in_scene(), *bases)?;
            // Twice as many products of poses as in a structure at rest.
            let asked = SceneMotion { motion: &motion, frame: Some((*size, 2.0)), to: None };
            structure.search.ask_margin(asked, wanted, sought)?
        }
    };
    if let Some(contact) = &mut answer.contact {
        contact.witness = match end {
            None => structure.placed_witness(contact.witness),
            Some(end) => place_witness(&end.pose(structure, contact.t), contact.witness),
        };
    }
    Ok(answer)
}

/// Returns the answer about a solid and a robot, given the answer about its surface. The structure
/// is where it is at t = 0. A contact of the surface stays one if the side cannot be found.
fn decide_solid(
    of_surface: Result<MotionAnswer, ProximityError>,
    robot: &MovingRobot,
    structure: &mut Structure,
) -> Result<MotionAnswer, ProximityError> {
    let contact = of_surface.as_ref().ok().and_then(|answer| answer.contact);
    match (decide_at_start(of_surface, robot, structure), contact) {
        (Err(_), Some(shape)) => Ok(MotionAnswer::contact(0.0, shape)),
        (answer, _) => answer,
    }
}

fn decide_at_start(
    of_surface: Result<MotionAnswer, ProximityError>,
    robot: &MovingRobot,
    structure: &mut Structure,
) -> Result<MotionAnswer, ProximityError> {
    if !structure.is_solid {
        return of_surface;
    }
    let is_apart = |answer: &MotionAnswer| answer.is_clear() || answer.interval[0] > 0.0;
    let is_apart = of_surface.as_ref().is_ok_and(is_apart);
    let (tube, pose) = at_start(robot, structure)?;
    match structure.side_of_tube(&tube, &pose, is_apart) {
        Side::Outside => of_surface,
        Side::Undecided => Ok(match of_surface {
            Ok(MotionAnswer { contact: Some(shape), .. }) => MotionAnswer::contact(0.0, shape),
            _ => MotionAnswer::undecided(([0.0, 1.0], UndecidedReason::Near)),
        }),
        Side::Inside => {
            let Clearance { section, witness, .. } = structure.clearance_inside(&tube, &pose)?;
            let witness = structure.placed_witness(witness);
            let shape = ShapeInContact { t: 0.0, upper: 0.0, section, witness };
            Ok(MotionAnswer::contact(0.0, shape))
        }
    }
}

/// Returns the least clearance of a solid and a robot, given the clearance of its surface.
fn clearance_of_solid(
    of_surface: MotionClearance,
    robot: &MovingRobot,
    structure: &mut Structure,
) -> Result<MotionClearance, ProximityError> {
    if !structure.is_solid {
        return Ok(of_surface);
    }
    let (tube, pose) = at_start(robot, structure)?;
    match structure.side_of_tube(&tube, &pose, of_surface.lower > 0.0) {
        Side::Outside => Ok(of_surface),
        Side::Undecided => Ok(MotionClearance { lower: 0.0, ..of_surface }),
        Side::Inside => {
            let Clearance { section, witness, .. } = structure.clearance_inside(&tube, &pose)?;
            let [lower, upper, uncertainty, t] = [0.0; 4];
            Ok(MotionClearance { lower, upper, uncertainty, t, section, witness, ..of_surface })
        }
    }
}

/// The shape of a robot at t = 0, and its pose in the mesh's frame.
fn at_start(robot: &MovingRobot, structure: &Structure) -> Result<(Tube, Pose), ProximityError> {
    let mut tube = Tube::empty();
    let pose = robot.in_mesh(structure).shape(0.0, &mut tube)?;
    Ok((tube, pose))
}

/// Attributes an error of two motions to the robot that causes it: of two that have the section,
/// the faster one. A motion is never asked for a section that its robot does not have.
fn of_motions(robots: [usize; 2], motions: [&dyn Motion; 2], error: ProximityError) -> SceneError {
    let ProximityError::TooFast { section, .. } = error else { return of_pair(robots)(error) };
    let [first, second] = motions.map(|motion| {
        let mut tube = Tube::empty();
        let has_it = motion.shape(0.5, &mut tube).is_ok() && section < tube.sections().len();
        has_it.then(|| motion.speed(section, [0.0, 1.0], [0.0, 1.0]).point)
    });
    of_robot(robots[usize::from(second > first)])(error)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::LinearMotion;
    use parry3d_f64::math::Vector;

    /// All pairs of robots share one limit of work: what one pair needs is not enough for four
    /// equal ones, and four times as much is.
    #[test]
    fn pairs_of_robots_share_the_work() {
        let bend = |x: Real, y: Real, turn: Real| {
            let points: Vec<_> = (0..=8)
                .map(|k| Real::from(k) / 8.0)
                .map(|s| Vector::new(x + turn * s * s, y, 10.0 * s))
                .collect();
            points
        };
        let robot = |x: Real, y: Real, turn: Real| {
            LinearMotion::chain(&bend(x, y, 0.0), &bend(x, y, turn), &[0.5; 8]).unwrap()
        };
        let robots: Vec<_> = (0..4)
            .map(|pair| 100.0 * Real::from(pair))
            .flat_map(|y| [robot(0.0, y, 1.0), robot(4.0, y, -1.0)])
            .collect();
        let mut scene = Scene::new();
        scene.set_robot_margin(Some(0.0)).unwrap();
        let mut is_enough = |count: usize, pairs: u32| {
            let motions: Vec<_> = robots[..count].iter().collect();
            let least = scene
                .with_moving_robots(&motions, |scene, robots| {
                    scene.least_slack(robots, 1e-3, pairs)
                })
                .unwrap();
            least.answer(1e-3).unwrap().resolved
        };
        let mut pairs = 1;
        while !is_enough(2, pairs) {
            pairs *= 2;
        }
        assert!(pairs > 16 && !is_enough(8, pairs) && is_enough(8, 4 * pairs), "{pairs}");

        // A third robot passes at a distance of 21, on a diagonal. Its boxes meet the boxes
        // of the others, so bounds on its distance need work, which no other pair uses up.
        let [from, to] = [bend(-30.0, 0.0, 0.0), bend(0.0, -30.0, 0.0)];
        let third = LinearMotion::chain(&from, &to, &[0.5; 8]);
        let motions = [&robots[0], &robots[1], &third.unwrap()];
        for order in [[0, 1, 2], [2, 0, 1], [1, 2, 0]] {
            let motions = order.map(|robot| motions[robot]);
            let least = scene.with_moving_robots(&motions, |scene, robots| {
                scene.least_slack(robots, 1e-9, 64 * pairs)
            });
            let BoundedSlack { lower, upper, .. } = least.unwrap().answer(1e-9).unwrap();
            // At t = 1 the tips are 2 apart, and their rims reach 1/2 across links of the slope
            // (1 - (7/8)^2) / 1.25.
            let gap = 2.0 - 1.0 / Real::hypot(1.0, 0.1875);
            assert!(0.9 < lower && lower <= gap && gap <= upper + 1e-9, "{lower} {upper}");
        }
    }
}
