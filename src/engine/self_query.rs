//! Queries about one robot and itself.
//!
//! [`SelfQuery`] checks the arguments and holds the warm starts. [`RobotWithItself`],
//! [`self_clears_tube`] and [`self_decides_motion`] answer; the module of [`RobotWithItself`]
//! derives which pairs of parts count.

use crate::answer::{Decision, ProximityError, RobotClearance, RobotMotionAnswer, RobotProximity};
use crate::curve::Tube;
use crate::motion::Motion;
use crate::query::motion::{MarginQuery, SelfMotionMemory, Sought, self_decides_motion};
use crate::query::robots::{
    BeyondMemory, RobotWithItself, SelfMemory, SelfTubeMemory, chain_clears, chain_minimum,
    self_clears_tube, tube_clearance, tube_clears,
};
use crate::query::{check_decision, check_margin, check_not_negative};
use crate::robot::Chain;
use parry3d_f64::math::Real;

/// Exact queries about one robot and itself.
///
/// The last answers warm-start the next query. Any robots may follow; small motions are answered
/// fastest. A clone copies the memory. Each thread should have its own query. For two robots see
/// [`RobotPair`](super::RobotPair).
///
/// Answers are in the robot's own frame, those about motions in the frame of the motion. The first
/// of two parts is the one nearer to the base.
#[doc(alias = "self_minimum")]
#[doc(alias = "self_clears")]
#[derive(Clone, Debug, Default)]
pub struct SelfQuery {
    chain: SelfMemory,
    tube: SelfTubeMemory,
    motion: SelfMotionMemory,
    beyond: BeyondMemory,
}

impl SelfQuery {
    /// Makes a query with an empty memory.
    pub fn new() -> Self {
        Self::default()
    }

    /// Forgets the last answers: the next query starts without a warm start.
    pub fn forget(&mut self) {
        *self = Self::new();
    }

    /// Returns the place where a robot comes closest to itself, or `None` if no two of its parts
    /// can.
    ///
    /// `None` occurs for a robot that is straight or bends too little. Parts that are close only
    /// because they are neighbours do not count. The query considers these pairs of parts:
    ///
    /// 1. Two links with a turn of at least pi between them. The turn is the sum of the angles of
    ///    the joints. The pair counts if the robot leads nowhere nearer from the closest places of
    ///    the two axes. Axes that open by at most 2^-24 rad count as parallel, in every frame, also
    ///    if they are skew by up to 35 degrees about the bend between them.
    /// 2. A face and a link, with a turn of at least pi / 2. A face is the base or the tip, if
    ///    flat, or the wider side of a step, also if round.
    /// 3. Two faces that look at one another, at any turn: the end of a link and the start of a
    ///    later one.
    ///
    /// A face counts if three conditions hold at the nearest place:
    ///
    /// - The way to the other part leaves the face outwards.
    /// - The robot leads nowhere nearer from there.
    /// - The adjoining link does not contain the nearest point of the face.
    ///
    /// So the shoulders of a taper never meet. Radii that differ by less than a share of 2^-32 are
    /// no step.
    ///
    /// No other two places can be a local minimum of the distance, however the robot bends. A
    /// closed curve turns by at least 2 pi (Fenchel's theorem), and the two corners of arc and
    /// chord take at most pi of it. So a bend never collides with its own neighbourhood, and no
    /// number of neighbours has to be chosen.
    ///
    /// # Errors
    /// A joint is so sharp that its links overlap over more than half of the shorter one:
    /// r tan(angle / 2) > length / 2. The rule above holds for tubes that are thinner than their
    /// bends. At a step a thin link leaves from the centre of the wide one's face, so
    /// r tan(angle) > length / 2 is required of its own radius too.
    ///
    /// ```
    /// use parry_continuum::{Chain, proximity::SelfQuery};
    /// use parry_continuum::parry::math::Vector;
    ///
    /// // A hairpin: two straight legs, and half a circle of radius 10 between them.
    /// let angles = (0..=20).map(|k| std::f64::consts::PI * f64::from(k) / 20.0);
    /// let arc = angles.map(|a| Vector::new(10.0 * (1.0 - a.cos()), 0.0, 30.0 + 10.0 * a.sin()));
    /// let points: Vec<_> =
    ///     [Vector::ZERO].into_iter().chain(arc).chain([Vector::new(20.0, 0.0, 0.0)]).collect();
    /// let robot = Chain::from_centreline(&points, &[1.5; 22])?;
    /// let closest = SelfQuery::new().minimum(&robot)?.ok_or("too straight")?;
    /// assert!((closest.distance - 17.0).abs() < 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn minimum(&mut self, robot: &Chain) -> Result<Option<RobotProximity>, ProximityError> {
        Ok(RobotWithItself::new(robot, &mut self.chain)?.minimum(&mut self.chain))
    }

    /// Returns whether a robot keeps a margin to itself.
    ///
    /// True exactly if [`minimum`](Self::minimum) returns `None` or a distance of more than
    /// `margin`.
    ///
    /// # Errors
    /// As [`minimum`](Self::minimum), or the margin is negative or NaN.
    ///
    /// ```
    /// use parry_continuum::{Chain, proximity::SelfQuery};
    /// use parry_continuum::parry::math::Vector;
    ///
    /// let straight =
    ///     Chain::from_centreline(&[Vector::ZERO, Vector::Z, 2.0 * Vector::Z], &[3.0, 3.0])?;
    /// assert!(SelfQuery::new().clears(&straight, 100.0)?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn clears(&mut self, robot: &Chain, margin: Real) -> Result<bool, ProximityError> {
        check_margin(margin)?;
        Ok(RobotWithItself::new(robot, &mut self.chain)?.clears(margin, &mut self.chain))
    }

    /// Bounds the distance of a robot from itself between places at least `arc` apart along its
    /// centreline. Returns `None` if the robot is shorter than `arc`.
    ///
    /// The distance is the least distance of two cross-sections whose arc lengths differ by at
    /// least `arc`, a length. The cross-section of a place is the disc across the centreline. At a
    /// joint the discs of both links count, at a step both radii. A round end of the robot, half a
    /// ball, has the arc length of the end.
    ///
    /// - The distance is never more than `arc`, and exactly `arc` for a straight robot. So a margin
    ///   of `arc` or more never clears.
    /// - It does not depend on how straight links are cut. It changes continuously with the shape
    ///   and `arc`, unless two joints are exactly `arc` apart: their discs turn from link to link.
    /// - The wedge between the discs of a round joint, on its outside, does not count. It is within
    ///   r sin(angle / 2) of the discs.
    /// - No turn is required, and no joint is too sharp: [`minimum`](Self::minimum) has the local
    ///   minima in place of a length.
    ///
    /// The bounds differ by rounding, except if a round end of the robot is exactly `arc` from the
    /// nearest place: see [`resolved`](RobotClearance::resolved). `arc` is taken up to rounding.
    /// The sections of the answer are links.
    ///
    /// # Errors
    /// `arc` is negative or NaN.
    ///
    /// ```
    /// use parry_continuum::{Chain, proximity::SelfQuery};
    /// use parry_continuum::parry::math::Vector;
    ///
    /// let points = [0.0, 30.0, 60.0].map(|z| Vector::Z * z);
    /// let straight = Chain::from_centreline(&points, &[1.5; 2])?;
    /// let found = SelfQuery::new().minimum_beyond(&straight, 20.0)?.ok_or("too short")?;
    /// assert!((found.lower - 20.0).abs() < 1e-9 && found.resolved);
    /// assert_eq!(SelfQuery::new().minimum_beyond(&straight, 61.0)?, None);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn minimum_beyond(
        &mut self,
        robot: &Chain,
        arc: Real,
    ) -> Result<Option<RobotClearance>, ProximityError> {
        check_not_negative("arc", arc)?;
        chain_minimum(robot, &mut self.beyond, arc)
    }

    /// Returns whether a robot provably keeps a margin to itself, between places at least `arc`
    /// apart along its centreline.
    ///
    /// True if the lower bound of [`minimum_beyond`](Self::minimum_beyond) is more than `margin`,
    /// or the robot is shorter than `arc`.
    ///
    /// # Errors
    /// `arc` or the margin is negative or NaN.
    ///
    /// ```
    /// use parry_continuum::{Chain, proximity::SelfQuery};
    /// use parry_continuum::parry::math::Vector;
    ///
    /// // A hairpin whose legs are 8 apart, from surface to surface.
    /// let points = [[0.0, 0.0, 0.0], [0.0, 0.0, 40.0], [10.0, 0.0, 40.0], [10.0, 0.0, 0.0]];
    /// let robot = Chain::from_centreline(&points.map(Vector::from_array), &[1.0; 3])?;
    /// assert!(SelfQuery::new().clears_beyond(&robot, 20.0, 7.9)?);
    /// assert!(!SelfQuery::new().clears_beyond(&robot, 20.0, 8.1)?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn clears_beyond(
        &mut self,
        robot: &Chain,
        arc: Real,
        margin: Real,
    ) -> Result<bool, ProximityError> {
        check_not_negative("arc", arc)?;
        check_margin(margin)?;
        Ok(chain_clears(robot, &mut self.beyond, [arc, margin])? == Decision::Clear)
    }

    /// Bounds the distance of a tube from itself between places at least `arc` apart along its
    /// centreline. Returns `None` if the tube is shorter than `arc`.
    ///
    /// The distance is that of [`minimum_beyond`](Self::minimum_beyond), for the discs of the
    /// curve: `lower` <= distance <= `upper`. `arc` and `tolerance` are lengths. The bounds differ
    /// by at most the tolerance ([`resolved`](RobotClearance::resolved)), unless the samples do not
    /// allow that or 65,536 pairs of pieces do not suffice.
    ///
    /// # Errors
    /// - `arc` or the tolerance is negative or NaN.
    /// - The tube has no section or is out of range, or its curve is not finite somewhere.
    ///
    /// ```
    /// use parry_continuum::{Tube, parry::math::Vector, proximity::SelfQuery};
    ///
    /// // Half a circle of radius 20. Inner edges half a radian apart are 38 sin(0.25) apart.
    /// let angles = (0..=400).map(|k| std::f64::consts::PI * f64::from(k) / 400.0);
    /// let points: Vec<_> =
    ///     angles.map(|a| Vector::new(a.cos(), 0.0, a.sin()) * 20.0).collect();
    /// let tube = Tube::with_constant_radius(&points, 1.0, Some([Vector::Z, -Vector::Z]))?;
    /// let found = SelfQuery::new().clearance_beyond(&tube, 10.0, 0.05)?.ok_or("too short")?;
    /// let expected = 38.0 * 0.25_f64.sin();
    /// assert!(found.lower <= expected && found.upper >= expected - 1e-3 && found.resolved);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn clearance_beyond(
        &mut self,
        tube: &Tube,
        arc: Real,
        tolerance: Real,
    ) -> Result<Option<RobotClearance>, ProximityError> {
        check_not_negative("arc", arc)?;
        check_not_negative("tolerance", tolerance)?;
        tube_clearance(tube, &mut self.beyond, arc, tolerance)
    }

    /// Decides whether a tube is farther than `margin` from itself, between places at least `arc`
    /// apart along its centreline.
    ///
    /// The distance is that of [`clearance_beyond`](Self::clearance_beyond); a tube shorter than
    /// `arc` is `Clear`. `Clear` and `Contact` are proven. `Undecided` occurs if the distance is
    /// within `resolution` of the margin, if the samples are too few or state errors, or if 65,536
    /// pairs of pieces do not decide.
    ///
    /// # Errors
    /// As [`clearance_beyond`](Self::clearance_beyond), or the margin or the resolution is negative
    /// or NaN.
    ///
    /// ```
    /// use parry_continuum::{Chain, Tube, parry::math::Vector};
    /// use parry_continuum::proximity::{Decision, SelfQuery};
    ///
    /// let straight = Chain::from_centreline(&[Vector::ZERO, Vector::Z * 50.0], &[1.0])?;
    /// let tube = Tube::from(&straight);
    /// let mut itself = SelfQuery::new();
    /// assert_eq!(itself.clears_tube_beyond(&tube, 10.0, 9.9, 1e-3)?, Decision::Clear);
    /// assert_eq!(itself.clears_tube_beyond(&tube, 10.0, 10.1, 1e-3)?, Decision::Contact);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn clears_tube_beyond(
        &mut self,
        tube: &Tube,
        arc: Real,
        margin: Real,
        resolution: Real,
    ) -> Result<Decision, ProximityError> {
        check_not_negative("arc", arc)?;
        check_decision(margin, resolution)?;
        tube_clears(tube, &mut self.beyond, [arc, margin], resolution)
    }

    /// Decides whether a tube is farther than `margin` from itself.
    ///
    /// The query considers the same parts as [`minimum`](Self::minimum), on the curve itself:
    ///
    /// 1. Two places with a turn of at least pi between them. (For a tube made from a chain: two
    ///    links that count for [`minimum`](Self::minimum).)
    /// 2. A flat face and a place in front of it, with a turn of at least pi / 2.
    /// 3. Two faces that look at one another.
    ///
    /// It leaves out a piece if the robot leads nearer to the face from every place of the piece.
    /// So a bend never collides with its own neighbourhood.
    ///
    /// `margin` and `resolution` are lengths. `Clear` and `Contact` are proven. All distances allow
    /// for the errors that the tube states of itself; the parts are selected on the curve as it was
    /// given. `Undecided` occurs only if
    ///
    /// - the distance of such parts is within `resolution` of the margin, or within the stated
    ///   errors;
    /// - the margin is as wide as the tightest bend: at least 1 / curvature - r beside a step, and
    ///   at least 2 / curvature - r1 - r2 elsewhere. The known curve may then leave open which
    ///   parts count;
    /// - the samples are too few to show how far the curve turns; or
    /// - 65,536 pairs of pieces do not decide.
    ///
    /// # Errors
    /// - The margin or the resolution is negative or NaN.
    /// - The tube bends, or may bend, within its radius somewhere.
    /// - The tube is made from a chain with a joint that is too sharp for
    ///   [`minimum`](Self::minimum).
    /// - Samples do not allow a decision at that resolution, or the curve of the tube is not finite
    ///   somewhere.
    ///
    /// ```
    /// use parry_continuum::{Tube, proximity::{Decision, SelfQuery}};
    /// use parry_continuum::parry::math::Vector;
    ///
    /// // Two turns of a coil of radius 10 and pitch 4; the wire has radius 1.
    /// let angles = (0..=240).map(|k| std::f64::consts::PI * f64::from(k) / 60.0);
    /// let rise = 4.0 / (2.0 * std::f64::consts::PI);
    /// let coil: Vec<_> =
    ///     angles.map(|a| Vector::new(10.0 * a.cos(), 10.0 * a.sin(), rise * a)).collect();
    /// let along = Vector::new(0.0, 10.0, rise); // at both ends, after whole turns
    /// let tube = Tube::with_constant_radius(&coil, 1.0, Some([along; 2]))?;
    /// assert_eq!(SelfQuery::new().clears_tube(&tube, 1.9, 0.01)?, Decision::Clear);
    /// assert_eq!(SelfQuery::new().clears_tube(&tube, 2.1, 0.01)?, Decision::Contact);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn clears_tube(
        &mut self,
        tube: &Tube,
        margin: Real,
        resolution: Real,
    ) -> Result<Decision, ProximityError> {
        check_decision(margin, resolution)?;
        self_clears_tube(tube, &mut self.tube, margin, resolution)
    }

    /// Decides whether a moving robot stays farther than `margin` from itself, at every time from 0
    /// to 1.
    ///
    /// - `Clear` is proven from the speeds and turns that the motion states. At no instant are two
    ///   places closest to one another and at most the margin apart, unless they are neighbours.
    /// - `Contact` names a time at which the shape violates the margin in the sense of
    ///   [`clears_tube`](Self::clears_tube), and two points of that shape in the mesh's frame.
    /// - `Undecided`: the robot comes within `resolution` of the margin, beyond the errors that it
    ///   states of itself. Or margin or samples are among the cases that
    ///   [`clears_tube`](Self::clears_tube) leaves undecided. Or an end that comes near turns from
    ///   flat to round. The [reason](RobotMotionAnswer::reason) of all these is `Near`. It is
    ///   `Work` if the query ends after 65,536 shapes, or after 262,144 pairs of pieces in total.
    ///
    /// The work is one query about a tube and itself for each time that the proof needs. It needs
    /// four to eight times per rad that a part of the robot turns, and more near a contact.
    ///
    /// **Premises.** The stated speeds and turns hold: see [`verify_motion`](crate::verify_motion).
    /// At all times [`clears_tube`](Self::clears_tube) accepts the robot: it bends by less than
    /// 1 / radius. The query checks the latter only for the shapes that it visits.
    ///
    /// ```
    /// use parry_continuum::{LinearMotion, parry::math::Vector, proximity::{Decision, SelfQuery}};
    ///
    /// // A hairpin of straight links. Its tip swings past its base.
    /// let hairpin = |y: f64| {
    ///     [[0.0, 0.0, 0.0], [0.0, 0.0, 40.0], [8.0, 0.0, 40.0], [4.0, y, 2.0]]
    ///         .map(Vector::from_array)
    /// };
    /// let motion = LinearMotion::chain(&hairpin(-6.0), &hairpin(6.0), &[1.0; 3])?;
    /// assert!(SelfQuery::new().clears_motion(&motion, 1.5, 1e-3)?.is_clear());
    /// assert_eq!(SelfQuery::new().clears_motion(&motion, 2.5, 1e-3)?.decision, Decision::Contact);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// - The margin or the resolution is negative or NaN.
    /// - The motion has no shape at some time, or one that [`clears_tube`](Self::clears_tube)
    ///   refuses, or its sections change.
    /// - A stated speed or turn is not finite, or a turn is more than 2^18 rad.
    /// - The resolution is finer than rounding or the samples of a shape allow, or the motion is
    ///   too fast to be divided that finely.
    pub fn clears_motion(
        &mut self,
        motion: &impl Motion,
        margin: Real,
        resolution: Real,
    ) -> Result<RobotMotionAnswer, ProximityError> {
        check_decision(margin, resolution)?;
        self.ask_motion(motion, MarginQuery { margin, resolution }, Sought::Any)
    }

    /// [`clears_motion`](Self::clears_motion), or the first contact in time. The numbers are
    /// checked.
    pub(crate) fn ask_motion(
        &mut self,
        motion: &dyn Motion,
        wanted: MarginQuery,
        sought: Sought,
    ) -> Result<RobotMotionAnswer, ProximityError> {
        self_decides_motion(motion, &mut self.motion, wanted, sought)
    }
}
