//! Queries about two robots.
//!
//! [`RobotPair`] checks the arguments, places the robots and holds the warm starts. [`TwoRobots`],
//! [`place_tubes`] and [`MotionPair`] answer the queries.

use crate::answer::{
    Decision, ProximityError, RobotClearance, RobotMotionAnswer, RobotMotionClearance,
    RobotProximity,
};
use crate::curve::Tube;
use crate::motion::Motion;
use crate::query::motion::{MAX_PAIRS_FOR_BOUNDS, MarginQuery, MotionPair, MotionsMemory, Sought};
use crate::query::robots::{
    PairMemory, TubesMemory, TwoRobots, clearance_between, clears_tubes, place_tubes,
};
use crate::query::{check_decision, check_margin, check_not_negative};
use crate::robot::Chain;
use crate::threads::with_clones;
use parry3d_f64::math::{Pose, Real};

/// Queries about two robots, as chains, as tubes and during motions: the closest places, bounds on
/// the clearance, and whether they keep a margin.
///
/// The last answers warm-start the next query. Any robots and poses may follow; small motions are
/// answered fastest. A clone copies the memory. Each thread should have its own pair. For one robot
/// and itself see [`SelfQuery`](super::SelfQuery).
///
/// Each pose places its robot in a common frame; answers are in this frame. Distances are unsigned,
/// 0 if the robots touch or overlap. Distances of chains are as exact as distances to a mesh.
///
/// ```
/// use parry_continuum::{Chain, proximity::RobotPair};
/// use parry_continuum::parry::math::{Pose, Vector};
///
/// let catheter = Chain::from_centreline(&[Vector::ZERO, Vector::Z * 40.0], &[1.0])?;
/// let endoscope = Chain::from_centreline(
///     &[Vector::ZERO, Vector::Z * 30.0, Vector::new(5.0, 0.0, 40.0)],
///     &[2.0, 2.0],
/// )?;
/// let mut pair = RobotPair::new();
/// for step in 0..10 {
///     let beside = Pose::translation(6.0 + f64::from(step), 0.0, 0.0);
///     let closest = pair.minimum(&catheter, &Pose::IDENTITY, &endoscope, &beside)?;
///     println!("links {:?} are {} mm apart", closest.links, closest.distance);
/// #   assert!((closest.distance - 3.0 - f64::from(step)).abs() < 1e-12);
/// }
/// assert!(pair.clears(
///     &catheter,
///     &Pose::IDENTITY,
///     &endoscope,
///     &Pose::translation(6.0, 0.0, 0.0),
///     2.5
/// )?);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct RobotPair {
    memory: PairMemory,
    tubes: TubesMemory,
    motions: MotionsMemory,
}

/// The names of the parameters in errors.
const POSES: [&str; 2] = ["pose_a", "pose_b"];
const MOTIONS: [&str; 2] = ["a", "b"];

impl RobotPair {
    /// Makes a pair with an empty memory.
    pub fn new() -> Self {
        Self::default()
    }

    /// Forgets the last answers: the next query starts without a warm start. Queries about motions
    /// always do.
    pub fn forget(&mut self) {
        self.memory.forget();
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
    /// let arc: Vec<_> = (0..=60)
    ///     .map(|k| f64::from(k) / 60.0)
    ///     .map(|a| Vector::new(a.cos(), 0.0, a.sin()) * 30.0)
    ///     .collect();
    /// let tube = Tube::from_samples(
    ///     &arc,
    ///     &[1.0; 60],
    ///     Some([Vector::Z, Vector::new(-1.0_f64.sin(), 0.0, 1.0_f64.cos())]),
    /// )?;
    /// // The same tube, turned around its base. Its tip bends to the other side.
    /// let turned = Pose::new(Vector::X * 65.0, Vector::Z * std::f64::consts::PI);
    /// let found = RobotPair::new().clearance(&tube, &Pose::IDENTITY, &tube, &turned, 0.01)?;
    /// assert!(
    ///     found.resolved
    ///         && found.lower <= 3.0
    ///         && 3.0 <= found.upper
    ///         && found.upper - found.lower <= 0.01
    /// );
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
    ///   ends after 65,536 shapes of each robot, or after 16 million pairs of pieces in total. The
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
    /// assert!(pair.clears_motions(&first, &second, 0.9, 1e-3)?.is_clear());
    /// let found = pair.clears_motions(&first, &second, 1.5, 1e-3)?;
    /// assert_eq!(found.decision, Decision::Contact);
    /// let contact = found.contact.ok_or("they pass too near")?;
    /// assert!(contact.t > 0.2 && contact.t < 0.8 && contact.upper <= 1.5);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// - The margin or the resolution is negative or NaN.
    /// - A motion has no shape at some time, its sections change, or a stated speed is not finite.
    /// - A robot is out of range.
    /// - The resolution is finer than rounding or the samples of a shape allow, or a motion is too
    ///   fast to be divided that finely.
    pub fn clears_motions(
        &mut self,
        a: &impl Motion,
        b: &impl Motion,
        margin: Real,
        resolution: Real,
    ) -> Result<RobotMotionAnswer, ProximityError> {
        check_decision(margin, resolution)?;
        self.ask_motions([a, b], MarginQuery { margin, resolution }, Sought::Any)
    }

    /// Bounds the time at which two robots that move at the same time first come within `margin` of
    /// one another.
    ///
    /// The answer's [`interval`](RobotMotionAnswer::interval) is `[clear_until, t]`. The robots
    /// provably keep the margin until `clear_until`. The shapes at `t`, which the answer names, do
    /// not keep it. Between the two times the touching places approach by at most `resolution`. The
    /// times are farther apart only if the robots come within the resolution of the margin before,
    /// or if the query ends at a limit of [`clears_motions`](Self::clears_motions).
    ///
    /// Decisions and arguments are as for [`clears_motions`](Self::clears_motions).
    ///
    /// ```
    /// use parry_continuum::{LinearMotion, parry::math::Vector, proximity::RobotPair};
    ///
    /// // Two needles of radius 1 whose tips approach by 20.
    /// let needle = |x: [f64; 2]| {
    ///     let ends = x.map(|x| [Vector::new(x, 0.0, -40.0), Vector::new(x, 0.0, 0.0)]);
    ///     LinearMotion::chain(&ends[0], &ends[1], &[1.0])
    /// };
    /// let (first, second) = (needle([0.0, 10.0])?, needle([22.0, 12.0])?);
    /// let found = RobotPair::new().time_of_contact(&first, &second, 5.0, 1e-3)?;
    /// let [clear_until, t] = found.interval;
    /// assert!(clear_until <= 0.75 && 0.75 <= t && t - clear_until <= 1e-3); // 20 - 15 are left
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`clears_motions`](Self::clears_motions).
    pub fn time_of_contact(
        &mut self,
        a: &impl Motion,
        b: &impl Motion,
        margin: Real,
        resolution: Real,
    ) -> Result<RobotMotionAnswer, ProximityError> {
        check_decision(margin, resolution)?;
        self.ask_motions([a, b], MarginQuery { margin, resolution }, Sought::First)
    }

    /// Bounds the least clearance of two robots that move at the same time, over all times from 0
    /// to 1.
    ///
    /// `lower` <= least clearance of the shapes at equal times <= `upper`. `tolerance` is a length:
    /// the bounds differ by at most the tolerance if the motions' shapes allow that. The bounds
    /// hold for every instant, rounding included, given the speeds that the motions state. The
    /// shapes at [`t`](RobotMotionClearance::t) realise `upper`, at the two points of the answer.
    ///
    /// The answer always has bounds; [`resolved`](RobotMotionClearance::resolved) says whether they
    /// meet the tolerance. They may not for the reasons of
    /// [`BvhSearch::clearance_of_motion`](crate::proximity::BvhSearch::clearance_of_motion), or
    /// because the query ends after a million pairs of pieces. A finer tolerance never gives looser
    /// bounds.
    ///
    /// ```
    /// use parry_continuum::{LinearMotion, parry::math::Vector, proximity::RobotPair};
    ///
    /// // Two needles of radius 1 whose tips pass one another at y = 0 and y = 3.
    /// let needle = |y: f64, x: [f64; 2]| {
    ///     let ends = x.map(|x| [Vector::new(0.0, y, -40.0), Vector::new(x, y, 0.0)]);
    ///     LinearMotion::chain(&ends[0], &ends[1], &[1.0])
    /// };
    /// let (first, second) = (needle(0.0, [-10.0, 10.0])?, needle(3.0, [10.0, -10.0])?);
    /// let least = RobotPair::new().clearance_of_motion(&first, &second, 1e-3)?;
    /// assert!(least.resolved && least.lower <= 1.0 && 1.0 <= least.upper + 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// - The tolerance is negative or NaN.
    /// - A motion has no shape at some time, its sections change, or a stated speed is not finite.
    /// - A robot is out of range.
    pub fn clearance_of_motion(
        &mut self,
        a: &impl Motion,
        b: &impl Motion,
        tolerance: Real,
    ) -> Result<RobotMotionClearance, ProximityError> {
        check_not_negative("tolerance", tolerance)?;
        let mut left = MAX_PAIRS_FOR_BOUNDS;
        self.ask_clearance_of_motion([a, b], tolerance, Real::INFINITY, &mut left)
    }

    /// [`minimum`](Self::minimum) for many pairs of robots, on all cores.
    ///
    /// Writes one result per pair to `out`, in order.
    pub fn minimum_batch(
        &self,
        pairs: &[[(&Chain, Pose); 2]],
        out: &mut Vec<Result<RobotProximity, ProximityError>>,
    ) {
        self.batch(pairs, out, |pair, [(a, pose_a), (b, pose_b)]| {
            pair.minimum(a, pose_a, b, pose_b)
        });
    }

    /// [`clears`](Self::clears) for many pairs of robots, on all cores.
    ///
    /// Writes one result per pair to `out`, in order.
    ///
    /// ```
    /// use parry_continuum::{Chain, proximity::RobotPair};
    /// use parry_continuum::parry::math::{Pose, Vector};
    ///
    /// let needle = Chain::from_centreline(&[Vector::ZERO, Vector::Z * 40.0], &[1.0])?;
    /// let beside =
    ///     |x: f64| [(&needle, Pose::IDENTITY), (&needle, Pose::translation(x, 0.0, 0.0))];
    /// let mut answers = Vec::new();
    /// RobotPair::new().clears_batch(&[5.0, 3.0, f64::NAN].map(beside), 2.0, &mut answers)?;
    /// assert_eq!(answers[..2], [Ok(true), Ok(false)]);
    /// assert_eq!(answers[2].map_err(|error| error.kind()), Err("pose_not_finite"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// The margin is negative or NaN; `out` is then empty.
    pub fn clears_batch(
        &self,
        pairs: &[[(&Chain, Pose); 2]],
        margin: Real,
        out: &mut Vec<Result<bool, ProximityError>>,
    ) -> Result<(), ProximityError> {
        out.clear();
        check_margin(margin)?;
        self.batch(pairs, out, |pair, [(a, pose_a), (b, pose_b)]| {
            pair.clears(a, pose_a, b, pose_b, margin)
        });
        Ok(())
    }

    /// [`clears_motions`](Self::clears_motions) for many pairs of motions, on all cores.
    ///
    /// Writes one result per pair to `out`, in order.
    ///
    /// # Errors
    /// The margin or the resolution is negative or NaN; `out` is then empty.
    pub fn clears_motions_batch<A: Motion + Sync, B: Motion + Sync>(
        &self,
        pairs: &[(A, B)],
        margin: Real,
        resolution: Real,
        out: &mut Vec<Result<RobotMotionAnswer, ProximityError>>,
    ) -> Result<(), ProximityError> {
        out.clear();
        check_decision(margin, resolution)?;
        self.batch(pairs, out, |pair, (a, b)| pair.clears_motions(a, b, margin, resolution));
        Ok(())
    }

    /// [`clears_motions`](Self::clears_motions) or [`time_of_contact`](Self::time_of_contact). The
    /// numbers are checked.
    pub(crate) fn ask_motions(
        &mut self,
        motions: [&dyn Motion; 2],
        wanted: MarginQuery,
        sought: Sought,
    ) -> Result<RobotMotionAnswer, ProximityError> {
        self.motions(motions).decide(wanted, sought)
    }

    /// [`clearance_of_motion`](Self::clearance_of_motion); or a lower bound of at least `limit`.
    /// The tolerance is checked. `left`: how many pairs of pieces may be tested.
    pub(crate) fn ask_clearance_of_motion(
        &mut self,
        motions: [&dyn Motion; 2],
        tolerance: Real,
        limit: Real,
        left: &mut u32,
    ) -> Result<RobotMotionClearance, ProximityError> {
        self.motions(motions).clearance(tolerance, limit, left)
    }

    fn motions<'a>(&'a mut self, motions: [&'a dyn Motion; 2]) -> MotionPair<'a> {
        MotionPair { memory: &mut self.motions, motions, names: MOTIONS }
    }

    /// Answers many pairs of robots on all cores.
    fn batch<Q: Sync, T: Send>(
        &self,
        pairs: &[Q],
        out: &mut Vec<Result<T, ProximityError>>,
        ask: impl Fn(&mut Self, &Q) -> Result<T, ProximityError> + Sync + Send,
    ) {
        with_clones(self, pairs, out, || Err(ProximityError::EmptyTube), ask);
    }
}
