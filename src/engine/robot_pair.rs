//! Queries about two robots, and about one robot and itself.
//!
//! [`RobotPair`] checks the arguments, places the robots and holds the warm starts. [`TwoRobots`],
//! [`place_tubes`] and [`MotionPair`] answer for two robots. [`RobotWithItself`],
//! [`self_clears_tube`] and [`self_clears_motion`] answer for one robot and itself; the module of
//! [`RobotWithItself`] derives which pairs of parts count.

use crate::answer::{Decision, ProximityError, RobotClearance, RobotMotionAnswer, RobotProximity};
use crate::curve::Tube;
use crate::motion::Motion;
use crate::query::motion::{
    MarginQuery, MotionPair, MotionsMemory, SelfMotionMemory, self_clears_motion,
};
use crate::query::robots::{
    PairMemory, RobotWithItself, SelfMemory, SelfTubeMemory, TubesMemory, TwoRobots,
    clearance_between, clears_tubes, place_tubes, self_clears_tube,
};
use crate::query::{check_decision, check_margin, check_not_negative};
use crate::robot::Chain;
use parry3d_f64::math::{Pose, Real};

/// Exact queries about two robots: the closest links, and whether all links keep a margin.
///
/// The last answers warm-start the next query. Any robots and poses may follow; small motions are
/// answered fastest. A clone copies the memory. Each thread should have its own pair. [`between`]
/// and [`clears_between`] are the same without a memory.
///
/// Each pose places its robot in a common frame; answers are in this frame. Distances are unsigned,
/// 0 if the robots touch or overlap, and as exact as distances to a mesh.
///
/// ```
/// use parry_continuum::{Chain, proximity::RobotPair};
/// use parry_continuum::parry::math::{Pose, Vector};
///
/// let catheter = Chain::from_centreline(&[Vector::ZERO, Vector::Z * 40.0], &[1.0])?;
/// let endoscope = Chain::from_centreline(&[Vector::ZERO, Vector::Z * 30.0, Vector::new(5.0, 0.0, 40.0)], &[2.0, 2.0])?;
/// let mut pair = RobotPair::new();
/// for step in 0..10 {
///     let beside = Pose::translation(6.0 + f64::from(step), 0.0, 0.0);
///     let closest = pair.minimum(&catheter, &Pose::IDENTITY, &endoscope, &beside)?;
///     println!("links {:?} are {} mm apart", closest.links, closest.distance);
/// #   assert!((closest.distance - 3.0 - f64::from(step)).abs() < 1e-12);
/// }
/// assert!(pair.clears(&catheter, &Pose::IDENTITY, &endoscope, &Pose::translation(6.0, 0.0, 0.0), 2.5)?);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct RobotPair {
    memory: PairMemory,
    own: SelfMemory,
    tubes: TubesMemory,
    own_tube: SelfTubeMemory,
    motions: MotionsMemory,
    own_motion: SelfMotionMemory,
}

/// The names of the parameters in errors.
const POSES: [&str; 2] = ["pose_a", "pose_b"];
const MOTIONS: [&str; 2] = ["a", "b"];

impl RobotPair {
    /// Makes a pair with an empty memory.
    pub fn new() -> Self {
        Self::default()
    }

    /// Forgets the last answers: the next query starts without a warm start.
    pub fn forget(&mut self) {
        self.memory.forget();
        self.own.forget();
        self.tubes.forget();
    }

    /// Returns the two closest links. Ties return the lowest link of `a`, then the lowest of `b`.
    ///
    /// # Errors
    /// A pose is not finite or not rigid, or moves a link out of range.
    pub fn minimum(
        &mut self,
        a: &Chain,
        pose_a: &Pose,
        b: &Chain,
        pose_b: &Pose,
    ) -> Result<RobotProximity, ProximityError> {
        Ok(TwoRobots::new([a, b], [pose_a, pose_b], POSES)?.minimum(&mut self.memory))
    }

    /// Finds the closest link of `b` for each link of `a`, in order. `out` is cleared first.
    ///
    /// # Errors
    /// As [`minimum`](Self::minimum).
    pub fn per_link(
        &mut self,
        a: &Chain,
        pose_a: &Pose,
        b: &Chain,
        pose_b: &Pose,
        out: &mut Vec<RobotProximity>,
    ) -> Result<(), ProximityError> {
        out.clear();
        TwoRobots::new([a, b], [pose_a, pose_b], POSES)?.per_link(&mut self.memory, out);
        Ok(())
    }

    /// Returns whether every link of `a` is farther than `margin` from every link of `b`.
    ///
    /// True exactly if the distance of [`minimum`](Self::minimum) exceeds the margin.
    ///
    /// # Errors
    /// As [`minimum`](Self::minimum), or the margin is negative or NaN.
    pub fn clears(
        &mut self,
        a: &Chain,
        pose_a: &Pose,
        b: &Chain,
        pose_b: &Pose,
        margin: Real,
    ) -> Result<bool, ProximityError> {
        check_margin(margin)?;
        Ok(TwoRobots::new([a, b], [pose_a, pose_b], POSES)?.clears(margin, &mut self.memory))
    }

    /// Finds every place where the robots are at most `margin` apart, in the order of the links.
    ///
    /// A place is a pair of links (i, j) at a local minimum: no neighbouring pair, one link on
    /// along either robot or both, is closer. Neighbouring pairs at equal distance count as one
    /// place, at the lowest links. So two robots that overlap along several links have one place
    /// there. `out` is cleared first.
    ///
    /// # Errors
    /// As [`clears`](Self::clears).
    pub fn contacts_within(
        &mut self,
        a: &Chain,
        pose_a: &Pose,
        b: &Chain,
        pose_b: &Pose,
        margin: Real,
        out: &mut Vec<RobotProximity>,
    ) -> Result<(), ProximityError> {
        out.clear();
        check_margin(margin)?;
        TwoRobots::new([a, b], [pose_a, pose_b], POSES)?.contacts_within(
            margin,
            &mut self.memory,
            out,
        );
        Ok(())
    }

    /// Bounds the clearance of two tubes from both sides.
    ///
    /// `tolerance` is a length: the bounds differ by at most the tolerance if the tubes allow that.
    /// The bounds hold for the tubes as they were given, all rounding included: `lower` <=
    /// clearance <= `upper`. The points of the answer realise `upper`. Both bounds allow for the
    /// errors that the tubes state of themselves.
    ///
    /// The answer always has bounds. [`resolved`](RobotClearance::resolved) says whether they meet
    /// the tolerance, as for [`BvhSearch::clearance`](crate::proximity::BvhSearch::clearance).
    ///
    /// The work grows with the number of pieces near one another, about as 1 / sqrt(tolerance) if
    /// the tubes cross. It also grows with the product of the numbers of sections.
    ///
    /// ```
    /// use parry_continuum::{Tube, proximity::RobotPair};
    /// use parry_continuum::parry::math::{Pose, Vector};
    ///
    /// let arc: Vec<_> = (0..=60).map(|k| f64::from(k) / 60.0).map(|a| Vector::new(a.cos(), 0.0, a.sin()) * 30.0).collect();
    /// let tube = Tube::from_samples(&arc, &[1.0; 60], Some([Vector::Z, Vector::new(-1.0_f64.sin(), 0.0, 1.0_f64.cos())]))?;
    /// // The same tube, turned around its base. Its tip bends to the other side.
    /// let turned = Pose::new(Vector::X * 65.0, Vector::Z * std::f64::consts::PI);
    /// let found = RobotPair::new().clearance(&tube, &Pose::IDENTITY, &tube, &turned, 0.01)?;
    /// assert!(found.resolved && found.lower <= 3.0 && 3.0 <= found.upper && found.upper - found.lower <= 0.01);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// - The tolerance is negative or NaN.
    /// - The curve of a tube is not finite somewhere.
    /// - A pose is not finite or not rigid, or moves its tube out of range.
    pub fn clearance(
        &mut self,
        a: &Tube,
        pose_a: &Pose,
        b: &Tube,
        pose_b: &Pose,
        tolerance: Real,
    ) -> Result<RobotClearance, ProximityError> {
        check_not_negative("tolerance", tolerance)?;
        let mut tubes = place_tubes([a, b], [pose_a, pose_b], POSES)?;
        clearance_between(&mut tubes, &mut self.tubes, tolerance)
    }

    /// Decides whether two tubes are farther than `margin` apart.
    ///
    /// `margin` and `resolution` are lengths. `Clear` and `Contact` are proven. `Undecided` occurs
    /// only if the clearance is within `resolution` of the margin, or if 65,536 pairs of pieces do
    /// not decide.
    ///
    /// # Errors
    /// The margin or the resolution is negative or NaN, samples do not allow a decision at that
    /// resolution, or as [`clearance`](Self::clearance). A contact that is found first is reported
    /// before any error about the curves elsewhere.
    pub fn clears_tubes(
        &mut self,
        a: &Tube,
        pose_a: &Pose,
        b: &Tube,
        pose_b: &Pose,
        margin: Real,
        resolution: Real,
    ) -> Result<Decision, ProximityError> {
        check_decision(margin, resolution)?;
        let mut tubes = place_tubes([a, b], [pose_a, pose_b], POSES)?;
        clears_tubes(&mut tubes, &mut self.tubes, margin, resolution)
    }

    /// Decides whether two robots that move at the same time stay farther than `margin` apart, at
    /// every time from 0 to 1.
    ///
    /// Both motions place their robot in a common frame. A robot at rest is a
    /// [`RigidMotion`](crate::RigidMotion) from a pose to the same pose. `margin` and `resolution`
    /// are lengths.
    ///
    /// - `Clear` is proven for every instant from the speeds that the motions state.
    /// - `Contact` names a time, and two points of the shapes at that time that are at most the
    ///   margin apart.
    /// - `Undecided`: the robots come within `resolution` of the margin, beyond the errors that
    ///   they state of themselves. Or an end that comes near turns from flat to round. Or the query
    ///   ends after 65,536 shapes of each robot, or after a million pairs of pieces in total. The
    ///   [reason](RobotMotionAnswer::reason) says which.
    ///
    /// The work is one query about two tubes for each time that the proof needs. Slow robots with a
    /// wide gap need few times. The stated speeds are premises: see
    /// [`verify_motion`](crate::verify_motion).
    ///
    /// ```
    /// use parry_continuum::{LinearMotion, parry::math::Vector, proximity::{Decision, RobotPair}};
    ///
    /// // Two needles whose tips pass one another.
    /// let needle = |y: f64, x: [f64; 2]| {
    ///     let ends = x.map(|x| [Vector::new(0.0, y, -40.0), Vector::new(x, y, 0.0)]);
    ///     LinearMotion::chain(&ends[0], &ends[1], &[1.0])
    /// };
    /// let (first, second) = (needle(0.0, [-10.0, 10.0])?, needle(3.0, [10.0, -10.0])?);
    /// let mut pair = RobotPair::new();
    /// assert!(pair.clears_motion(&first, &second, 0.9, 1e-3)?.is_clear());
    /// let found = pair.clears_motion(&first, &second, 1.5, 1e-3)?;
    /// assert_eq!(found.decision, Decision::Contact);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// - The margin or the resolution is negative or NaN.
    /// - A motion has no shape at some time, its sections change, or a stated speed is not finite.
    /// - A robot is out of range.
    /// - The resolution is finer than rounding or the samples of a shape allow, or a motion is too
    ///   fast to be divided that finely.
    pub fn clears_motion(
        &mut self,
        a: &impl Motion,
        b: &impl Motion,
        margin: Real,
        resolution: Real,
    ) -> Result<RobotMotionAnswer, ProximityError> {
        check_decision(margin, resolution)?;
        let mut motions = MotionPair { memory: &mut self.motions, motions: (a, b), names: MOTIONS };
        motions.clear(MarginQuery { margin, resolution })
    }

    /// [`self_minimum`], with a memory.
    ///
    /// # Errors
    /// As [`self_minimum`].
    pub fn self_minimum(
        &mut self,
        robot: &Chain,
    ) -> Result<Option<RobotProximity>, ProximityError> {
        Ok(RobotWithItself::new(robot, &mut self.own)?.minimum(&mut self.own))
    }

    /// [`self_clears`], with reused memory.
    ///
    /// # Errors
    /// As [`self_clears`].
    pub fn self_clears(&mut self, robot: &Chain, margin: Real) -> Result<bool, ProximityError> {
        check_margin(margin)?;
        Ok(RobotWithItself::new(robot, &mut self.own)?.clears(margin, &mut self.own))
    }

    /// [`tube_self_clears`], with reused memory.
    ///
    /// # Errors
    /// As [`tube_self_clears`].
    pub fn tube_self_clears(
        &mut self,
        tube: &Tube,
        margin: Real,
        resolution: Real,
    ) -> Result<Decision, ProximityError> {
        check_decision(margin, resolution)?;
        self_clears_tube(tube, &mut self.own_tube, margin, resolution)
    }

    /// [`motion_self_clears`], with reused memory.
    ///
    /// # Errors
    /// As [`motion_self_clears`].
    pub fn motion_self_clears(
        &mut self,
        motion: &impl Motion,
        margin: Real,
        resolution: Real,
    ) -> Result<RobotMotionAnswer, ProximityError> {
        check_decision(margin, resolution)?;
        self_clears_motion(motion, &mut self.own_motion, MarginQuery { margin, resolution })
    }
}

/// Returns the two closest links of two robots: [`RobotPair::minimum`] without a memory.
///
/// # Errors
/// As [`RobotPair::minimum`].
///
/// ```
/// use parry_continuum::{Chain, proximity::between};
/// use parry_continuum::parry::math::{Pose, Vector};
///
/// let robot = Chain::from_centreline(&[Vector::ZERO, Vector::Z * 40.0], &[1.0])?;
/// // Tip to tip: the second robot comes from the other side.
/// let facing = Pose::new(Vector::Z * 85.0, Vector::X * std::f64::consts::PI);
/// let closest = between(&robot, &Pose::IDENTITY, &robot, &facing)?;
/// assert!((closest.distance - 5.0).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn between(
    a: &Chain,
    pose_a: &Pose,
    b: &Chain,
    pose_b: &Pose,
) -> Result<RobotProximity, ProximityError> {
    RobotPair::new().minimum(a, pose_a, b, pose_b)
}

/// Returns whether two robots are farther than `margin` apart: [`RobotPair::clears`] without a
/// memory.
///
/// # Errors
/// As [`RobotPair::clears`].
///
/// ```
/// use parry_continuum::{Chain, proximity::clears_between};
/// use parry_continuum::parry::math::{Pose, Vector};
///
/// let robot = Chain::from_centreline(&[Vector::ZERO, Vector::Z * 40.0], &[1.0])?;
/// let beside = Pose::translation(3.0, 0.0, 0.0);
/// assert!(clears_between(&robot, &Pose::IDENTITY, &robot, &beside, 0.5)?);
/// assert!(!clears_between(&robot, &Pose::IDENTITY, &robot, &beside, 1.0)?); // exactly at the margin is not clear
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn clears_between(
    a: &Chain,
    pose_a: &Pose,
    b: &Chain,
    pose_b: &Pose,
    margin: Real,
) -> Result<bool, ProximityError> {
    RobotPair::new().clears(a, pose_a, b, pose_b, margin)
}

/// Returns the place where a robot comes closest to itself, or `None` if no two of its parts can.
///
/// `None` occurs for a robot that is straight or bends too little. Parts that are close only
/// because they are neighbours do not count. The query considers these pairs of parts:
///
/// 1. Two links with a turn of at least pi between them. The turn is the sum of the angles of the
///    joints.
/// 2. A face and a link, with a turn of at least pi / 2. A face is the base or the tip, if flat, or
///    the wider side of a step, also if round.
/// 3. Two faces that look at one another, at any turn: the end of a link and the start of a later
///    one.
///
/// A face counts if three conditions hold at the nearest place:
///
/// - The way to the other part leaves the face outwards.
/// - The robot leads nowhere nearer from there.
/// - The adjoining link does not contain the nearest point of the face.
///
/// So the shoulders of a taper never meet. Radii that differ by less than a share of 2^-32 are no
/// step.
///
/// No other two places can be a local minimum of the distance, however the robot bends. A closed
/// curve turns by at least 2 pi (Fenchel's theorem), and the two corners of arc and chord take at
/// most pi of it. So a bend never collides with its own neighbourhood, and no number of neighbours
/// has to be chosen.
///
/// # Errors
/// A joint is so sharp that its links overlap over more than half of the shorter one: r tan(angle /
/// 2) > length / 2. The rule above holds for tubes that are thinner than their bends.
///
/// ```
/// use parry_continuum::{Chain, proximity::self_minimum};
/// use parry_continuum::parry::math::Vector;
///
/// // A hairpin: two straight legs, and half a circle of radius 10 between them.
/// let angles = (0..=20).map(|k| std::f64::consts::PI * f64::from(k) / 20.0);
/// let arc = angles.map(|a| Vector::new(10.0 * (1.0 - a.cos()), 0.0, 30.0 + 10.0 * a.sin()));
/// let points: Vec<_> = [Vector::ZERO].into_iter().chain(arc).chain([Vector::new(20.0, 0.0, 0.0)]).collect();
/// let robot = Chain::from_centreline(&points, &[1.5; 22])?;
/// let closest = self_minimum(&robot)?.ok_or("too straight")?;
/// assert!((closest.distance - 17.0).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn self_minimum(robot: &Chain) -> Result<Option<RobotProximity>, ProximityError> {
    RobotPair::new().self_minimum(robot)
}

/// Returns whether a robot keeps a margin to itself.
///
/// True exactly if [`self_minimum`] returns `None` or a distance of more than `margin`.
///
/// # Errors
/// As [`self_minimum`], or the margin is negative or NaN.
///
/// ```
/// use parry_continuum::{Chain, proximity::self_clears};
/// use parry_continuum::parry::math::Vector;
///
/// let straight = Chain::from_centreline(&[Vector::ZERO, Vector::Z, 2.0 * Vector::Z], &[3.0, 3.0])?;
/// assert!(self_clears(&straight, 100.0)?);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn self_clears(robot: &Chain, margin: Real) -> Result<bool, ProximityError> {
    RobotPair::new().self_clears(robot, margin)
}

/// Decides whether a tube is farther than `margin` from itself.
///
/// The query considers the same parts as [`self_minimum`], on the curve itself:
///
/// 1. Two places with a turn of at least pi between them.
/// 2. A flat face and a place in front of it, with a turn of at least pi / 2.
/// 3. Two faces that look at one another.
///
/// It leaves out a piece if the robot leads nearer to the face from every place of the piece. So a
/// bend never collides with its own neighbourhood.
///
/// `margin` and `resolution` are lengths. `Clear` and `Contact` are proven. All distances allow for
/// the errors that the tube states of itself; the parts are selected on the curve as it was given.
/// `Undecided` occurs only if
///
/// - the distance of such parts is within `resolution` of the margin, or within the stated errors;
/// - the margin is as wide as the tightest bend: at least 1 / curvature - r beside a step, and at
///   least 2 / curvature - r1 - r2 elsewhere. The known curve may then leave open which parts
///   count;
/// - the samples are too few to show how far the curve turns; or
/// - 65,536 pairs of pieces do not decide.
///
/// # Errors
/// - The margin or the resolution is negative or NaN.
/// - The tube bends, or may bend, within its radius somewhere.
/// - The tube is made from a chain with a joint that is too sharp for [`self_minimum`].
/// - Samples do not allow a decision at that resolution, or the curve of the tube is not finite
///   somewhere.
///
/// ```
/// use parry_continuum::{Tube, proximity::{Decision, tube_self_clears}};
/// use parry_continuum::parry::math::Vector;
///
/// // Two turns of a coil of radius 10 and pitch 4; the wire has radius 1.
/// let angles = (0..=240).map(|k| std::f64::consts::PI * f64::from(k) / 60.0);
/// let rise = 4.0 / (2.0 * std::f64::consts::PI);
/// let coil: Vec<_> = angles.map(|a| Vector::new(10.0 * a.cos(), 10.0 * a.sin(), rise * a)).collect();
/// let along = Vector::new(0.0, 10.0, rise); // at both ends, after whole turns
/// let tube = Tube::with_constant_radius(&coil, 1.0, Some([along; 2]))?;
/// assert_eq!(tube_self_clears(&tube, 1.9, 0.01)?, Decision::Clear);
/// assert_eq!(tube_self_clears(&tube, 2.1, 0.01)?, Decision::Contact);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn tube_self_clears(
    tube: &Tube,
    margin: Real,
    resolution: Real,
) -> Result<Decision, ProximityError> {
    RobotPair::new().tube_self_clears(tube, margin, resolution)
}

/// Decides whether a moving robot stays farther than `margin` from itself, at every time from 0 to
/// 1.
///
/// - `Clear` is proven from the speeds and turns that the motion states. At no instant are two
///   places closest to one another and at most the margin apart, unless they are neighbours.
/// - `Contact` names a time at which the shape violates the margin in the sense of
///   [`tube_self_clears`], and two points of that shape in the mesh's frame.
/// - `Undecided`: the robot comes within `resolution` of the margin, beyond the errors that it
///   states of itself. Or margin or samples are among the cases that [`tube_self_clears`] leaves
///   undecided. Or an end that comes near turns from flat to round. Or the query ends after 65,536
///   shapes, or after 262,144 pairs of pieces in total. The [reason](RobotMotionAnswer::reason)
///   says which.
///
/// The work is one query about a tube and itself for each time that the proof needs. It needs four
/// to eight times per rad that a part of the robot turns, and more near a contact.
///
/// **Premises.** The stated speeds and turns hold: see [`verify_motion`](crate::verify_motion). At
/// all times [`tube_self_clears`] accepts the robot: it bends by less than 1 / radius. The query
/// checks the latter only for the shapes that it visits.
///
/// ```
/// use parry_continuum::{LinearMotion, parry::math::Vector, proximity::{Decision, motion_self_clears}};
///
/// // A hairpin of straight links. Its tip swings past its base.
/// let hairpin = |y: f64| [[0.0, 0.0, 0.0], [0.0, 0.0, 40.0], [8.0, 0.0, 40.0], [4.0, y, 2.0]].map(Vector::from_array);
/// let motion = LinearMotion::chain(&hairpin(-6.0), &hairpin(6.0), &[1.0; 3])?;
/// assert!(motion_self_clears(&motion, 1.5, 1e-3)?.is_clear());
/// assert_eq!(motion_self_clears(&motion, 2.5, 1e-3)?.decision, Decision::Contact);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// - The margin or the resolution is negative or NaN.
/// - The motion has no shape at some time, or one that [`tube_self_clears`] refuses, or its
///   sections change.
/// - A stated speed or turn is not finite, or a turn is more than 2^18 rad.
/// - The resolution is finer than rounding or the samples of a shape allow, or the motion is too
///   fast to be divided that finely.
pub fn motion_self_clears(
    motion: &impl Motion,
    margin: Real,
    resolution: Real,
) -> Result<RobotMotionAnswer, ProximityError> {
    RobotPair::new().motion_self_clears(motion, margin, resolution)
}
