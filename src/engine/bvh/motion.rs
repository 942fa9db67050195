//! Queries about motions, as [`BvhSearch`] answers them.
//!
//! Each query is a [`MotionSearch`]. It reuses memory; answers do not depend on earlier queries.

use super::search::{BvhSearch, Context, Remembered};
use crate::answer::{MeshError, MotionAnswer, MotionClearance, ProximityError};
use crate::motion::{Motion, ShapePath};
use crate::query::motion::{MarginQuery, MotionSearch, Sought};
use crate::query::{check_decision, check_not_negative};
use crate::robot::Chain;
use parry3d_f64::math::{Real, Vector};

impl BvhSearch {
    /// Decides whether a motion stays farther than `margin` from the mesh at every time from 0 to
    /// 1.
    ///
    /// `margin` and `resolution` are lengths in the mesh's unit.
    ///
    /// - `Clear`: every point of the robot is farther than the margin at every time. The proof uses
    ///   the speeds that the motion states, and includes rounding. A robot that passes through a
    ///   wall is never `Clear`, however far from the wall it is on both sides.
    /// - `Contact`: the answer names a shape that is at most the margin away, and its time.
    /// - `Undecided` with the reason [`Near`](crate::proximity::UndecidedReason::Near): the
    ///   distance of some shape exceeds the margin by at most `resolution`, beside what the motion
    ///   states as uncertain. The query tests 256 more shapes for a contact, then it ends. Two
    ///   other cases have this reason. An end of a link or section lies one radius behind a flat
    ///   face, turns from flat to round, and is the part that comes near. Or the length of a link
    ///   vanishes for an instant, and the ball that the link then is comes near.
    /// - `Undecided` with the reason [`Work`](crate::proximity::UndecidedReason::Work): the query
    ///   ends after 65,536 shapes.
    ///
    /// The work is one tube query for each shape that the proof needs. One shape is enough if the
    /// motion is small compared with its clearance; a narrow passage needs more. Each further shape
    /// searches only the pieces of the robot that are not proven yet.
    ///
    /// The stated speeds are premises. Check them in your tests with
    /// [`verify_motion`](crate::verify_motion).
    ///
    /// The query allocates nothing once its memory has grown. The motion may allocate when it makes
    /// a shape: [`LinearMotion`](crate::LinearMotion) and [`RigidMotion`](crate::RigidMotion) reuse
    /// their memory; [`BendingMotion`](crate::BendingMotion) allocates a few times per shape. Your
    /// own motion reuses memory if it calls [`Tube::set_samples`](crate::Tube::set_samples).
    ///
    /// ```
    /// use parry_continuum::{LinearMotion, parry::{math::Vector, shape::{Ball, TriMesh}}};
    /// use parry_continuum::proximity::{BvhSearch, Decision};
    ///
    /// let (vertices, triangles) = Ball::new(10.0).to_trimesh(64, 32);
    /// let mut search = BvhSearch::new(&TriMesh::new(vertices, triangles)?)?;
    /// let from = [Vector::ZERO, Vector::new(0.0, 0.0, 4.0)];
    /// let to = [Vector::ZERO, Vector::new(4.0, 0.0, 0.0)];
    /// let inside = LinearMotion::chain(&from, &to, &[1.0])?;
    /// assert!(search.clears_motion(&inside, 1.0, 1e-3)?.is_clear());
    /// // From inside to outside. Both end shapes are clear.
    /// let through =
    ///     LinearMotion::chain(&from, &from.map(|point| point + Vector::X * 20.0), &[1.0])?;
    /// let answer = search.clears_motion(&through, 0.0, 1e-3)?;
    /// assert_eq!(answer.decision, Decision::Contact);
    /// assert!(answer.contact.is_some_and(|shape| 0.0 < shape.t && shape.t < 1.0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// - The margin or the resolution is negative or NaN.
    /// - The resolution is finer than rounding or the samples of a shape allow, or the motion is
    ///   too fast to be divided that finely.
    /// - The motion has no shape at some time, its sections change, or a stated speed is not
    ///   finite.
    /// - The robot is out of range.
    pub fn clears_motion(
        &mut self,
        motion: &impl Motion,
        margin: Real,
        resolution: Real,
    ) -> Result<MotionAnswer, ProximityError> {
        check_decision(margin, resolution)?;
        self.context().motion(motion).decide(MarginQuery { margin, resolution }, Sought::Any)
    }

    /// Bounds the time at which a motion first comes within `margin` of the mesh.
    ///
    /// The answer's [`interval`](MotionAnswer::interval) is `[clear_until, t]`. The motion provably
    /// keeps the margin until `clear_until`. The shape at `t`, which the answer names, does not
    /// keep it. Between the two times the touching place moves by at most `resolution`. The times
    /// are farther apart only if the motion comes within the resolution of the margin before, or if
    /// the query ends after 65,536 shapes.
    ///
    /// Decisions mean the same as for [`clears_motion`](Self::clears_motion).
    ///
    /// ```
    /// use parry_continuum::{LinearMotion, parry::{math::Vector, shape::{Ball, TriMesh}}};
    /// use parry_continuum::proximity::BvhSearch;
    ///
    /// let (vertices, triangles) = Ball::new(10.0).to_trimesh(64, 32);
    /// let mut search = BvhSearch::new(&TriMesh::new(vertices, triangles)?)?;
    /// let from = [Vector::ZERO, Vector::Z];
    /// let to = from.map(|point| point + 20.0 * Vector::Z);
    /// let motion = LinearMotion::chain(&from, &to, &[0.01])?;
    /// let found = search.time_of_contact(&motion, 0.0, 1e-3)?;
    /// let [clear_until, t] = found.interval;
    /// // The tip has moved by 9 of 20.
    /// assert!(clear_until <= 0.45 && 0.449 <= t && t - clear_until <= 1e-3);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`clears_motion`](Self::clears_motion).
    pub fn time_of_contact(
        &mut self,
        motion: &impl Motion,
        margin: Real,
        resolution: Real,
    ) -> Result<MotionAnswer, ProximityError> {
        check_decision(margin, resolution)?;
        self.context().motion(motion).decide(MarginQuery { margin, resolution }, Sought::First)
    }

    /// Decides whether the robot stays farther than `margin` along a planner's own shapes, without
    /// stated speeds.
    ///
    /// `shapes` are the robot at the planner's steps, in the mesh's frame. They have the same
    /// number of links and the same radii. `deviation`, `margin` and `resolution` are lengths.
    ///
    /// **Premises.** Between two steps every vertex of the links moves on a straight line at
    /// constant speed. At every time the robot is some tube with a smooth centreline within
    /// `deviation` of the links, place by place. So the deviation must cover three errors:
    ///
    /// 1. of the links against the curve,
    /// 2. of the straight path between two steps against the true path,
    /// 3. of the kinematics or the sensor.
    ///
    /// A place implies no direction. So the side of the tube is known to within the deviation. The
    /// flat faces of its two ends and of steps in radius may have any direction. A face lies within
    /// the ball around its centre and contains the centre. So the caps of the shapes do not matter.
    ///
    /// - `Clear`: every such tube keeps the margin at every time.
    /// - `Contact`: every such tube is at most the margin away at the time of the named shape.
    ///   Times are evenly spaced: the k-th of n shapes, from 0, is at t = k / (n - 1).
    /// - `Undecided`: the decision depends on the tube, or on less than `resolution`.
    ///
    /// ```
    /// use parry_continuum::parry::{math::Vector, shape::Ball};
    /// use parry_continuum::{Chain, proximity::{BvhSearch, Decision}};
    ///
    /// let (vertices, triangles) = Ball::new(10.0).to_trimesh(64, 32);
    /// let mut search = BvhSearch::from_triangles(&vertices, &triangles)?;
    /// // A needle that advances by 5 in steps of 1.
    /// let needle =
    ///     |tip: u32| Chain::capsules(&[Vector::ZERO, Vector::Z * f64::from(tip)], &[0.5]);
    /// let shapes = (1..=6).map(needle).collect::<Result<Vec<_>, _>>()?;
    /// let found = search.clears_path(&shapes, 0.1, 1.0, 1e-3)?;
    /// assert_eq!(found.decision, Decision::Clear);
    /// let found = search.clears_path(&shapes, 0.1, 5.0, 1e-3)?;
    /// assert_eq!(found.decision, Decision::Contact); // at the end the tip is less than 4 away
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// - The margin or the resolution is negative or NaN, or the deviation is negative or not
    ///   finite.
    /// - There are no shapes, or they differ in radii or in which segments have a length.
    /// - The resolution is finer than rounding allows, or the shapes are too far apart to be
    ///   divided that finely.
    /// - The robot is out of range.
    pub fn clears_path(
        &mut self,
        shapes: &[Chain],
        deviation: Real,
        margin: Real,
        resolution: Real,
    ) -> Result<MotionAnswer, ProximityError> {
        check_decision(margin, resolution)?;
        check_not_negative("deviation", deviation)?;
        let path = ShapePath::new(shapes, deviation)?;
        self.context().motion(&path).decide(MarginQuery { margin, resolution }, Sought::Any)
    }

    /// Decides whether a motion stays farther than `margin` from a mesh that moves at the same
    /// time.
    ///
    /// Each vertex moves from its present position to its position in `to`, on a straight line at
    /// constant speed, while t goes from 0 to 1. Examples are an organ that breathes, a corrected
    /// registration, or a step of a tissue simulation.
    ///
    /// `Clear` is proven for every instant, as for [`clears_motion`](Self::clears_motion). A
    /// `Contact` names the time; its points are points of robot and mesh at that time. The engine's
    /// mesh stays where it is: [`set_vertices`](crate::proximity::Proximity::set_vertices) moves it
    /// to `to`.
    ///
    /// A robot at rest is a [`RigidMotion`](crate::RigidMotion) from a pose to the same pose. Each
    /// call visits all triangles once. The speed of the fastest vertex counts as the speed of the
    /// whole mesh. If all vertices share a shift, only the speed of the robot relative to it
    /// counts, and how much the vertices differ from it. If the mesh turns as a whole, move the
    /// robot instead ([`MovingBase`](crate::MovingBase)).
    ///
    /// ```
    /// use parry_continuum::{Chain, RigidMotion, Tube, parry::{math::{Pose, Vector}, shape::Ball}};
    /// use parry_continuum::proximity::{BvhSearch, Decision};
    ///
    /// let (vertices, triangles) = Ball::new(10.0).to_trimesh(64, 32);
    /// let mut search = BvhSearch::from_triangles(&vertices, &triangles)?;
    /// let needle = Tube::from(&Chain::capsules(&[Vector::ZERO, Vector::Z * 6.0], &[0.5])?);
    /// let at_rest = RigidMotion::new(needle, [Pose::IDENTITY; 2])?;
    /// // The ball shrinks to 0.8 and to 0.6 of its size.
    /// let shrunk = |share: f64| vertices.iter().map(|vertex| vertex * share).collect::<Vec<_>>();
    /// assert!(search.clears_motion_while(&shrunk(0.8), &at_rest, 1.0, 1e-3)?.is_clear());
    /// let found = search.clears_motion_while(&shrunk(0.6), &at_rest, 1.0, 1e-3)?;
    /// assert_eq!(found.decision, Decision::Contact);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`clears_motion`](Self::clears_motion); or `to` has another number of vertices than the
    /// mesh, or one that is not finite or out of range.
    pub fn clears_motion_while(
        &mut self,
        to: &[Vector],
        motion: &impl Motion,
        margin: Real,
        resolution: Real,
    ) -> Result<MotionAnswer, ProximityError> {
        check_decision(margin, resolution)?;
        self.check_moved(to)?;
        let mut search = self.context().motion(motion);
        search.move_mesh(to);
        search.decide(MarginQuery { margin, resolution }, Sought::Any)
    }

    /// Bounds the least clearance of a motion over all times from 0 to 1.
    ///
    /// `lower` <= least clearance of all shapes <= `upper`. `tolerance` is a length: the bounds
    /// differ by at most the tolerance if the motion's shapes allow that. The bounds hold for every
    /// instant, rounding included, given the speeds that the motion states. The shape at
    /// [`t`](MotionClearance::t) realises `upper`, at the two points of the answer. If the motion
    /// stays as near for a while, `t` is one such time.
    ///
    /// The answer always has bounds; [`resolved`](MotionClearance::resolved) says whether they meet
    /// the tolerance. They may not, because samples are too coarse, because an end that comes near
    /// turns from flat to round, or because the query ends after 65,536 shapes. A finer tolerance
    /// never gives looser bounds.
    ///
    /// A [`MotionPath`](crate::MotionPath) bounds many motions at once: the query refines a motion
    /// only while the motion may be the nearest.
    ///
    /// ```
    /// use parry_continuum::parry::{math::Vector, shape::Ball};
    /// use parry_continuum::{LinearMotion, proximity::BvhSearch};
    ///
    /// let (vertices, triangles) = Ball::new(10.0).to_trimesh(64, 32);
    /// let mut search = BvhSearch::from_triangles(&vertices, &triangles)?;
    /// // The tip moves from one side to the other.
    /// let motion = LinearMotion::chain(
    ///     &[Vector::Z * 2.0, Vector::new(-4.0, 0.0, 6.0)],
    ///     &[Vector::Z * 2.0, Vector::new(4.0, 0.0, 6.0)],
    ///     &[0.5],
    /// )?;
    /// let least = search.clearance_of_motion(&motion, 0.001)?;
    /// assert!(least.resolved && least.upper - least.lower <= 0.001);
    /// println!("{} mm at t = {}, at {}", least.upper, least.t, least.witness.on_mesh);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// - The tolerance is negative or NaN.
    /// - The motion has no shape at some time, its sections change, or a stated speed is not
    ///   finite.
    /// - The robot is out of range.
    pub fn clearance_of_motion(
        &mut self,
        motion: &impl Motion,
        tolerance: Real,
    ) -> Result<MotionClearance, ProximityError> {
        check_not_negative("tolerance", tolerance)?;
        self.context().motion(motion).clearance(tolerance, Real::INFINITY)
    }

    /// [`clears_motion`](Self::clears_motion) for many motions, on all cores.
    ///
    /// Writes one result per motion to `out`, in order.
    ///
    /// # Errors
    /// The margin or the resolution is negative or NaN; `out` is then empty.
    pub fn clears_motion_batch<M: Motion + Sync>(
        &mut self,
        motions: &[M],
        margin: Real,
        resolution: Real,
        out: &mut Vec<Result<MotionAnswer, ProximityError>>,
    ) -> Result<(), ProximityError> {
        out.clear();
        check_decision(margin, resolution)?;
        self.batch(motions, out, MotionAnswer::clear, |context, motion, out| {
            *out = context.motion(motion).decide(MarginQuery { margin, resolution }, Sought::Any);
        });
        Ok(())
    }

    /// Checks that the vertices can move to these places.
    ///
    /// # Errors
    /// Their number differs, or one is not finite or out of range.
    pub(crate) fn check_moved(&self, vertices: &[Vector]) -> Result<(), MeshError> {
        self.prepared().hierarchy.mesh.check_moved(vertices)
    }
}

impl<'a> Context<'a> {
    /// A search along a motion, with the memory of the last one. No earlier answer enters it.
    pub(super) fn motion(self, motion: &'a dyn Motion) -> MotionSearch<'a> {
        let (search, Remembered { motion: memory, .. }) = self.search();
        MotionSearch { search, memory, motion, last: None, does_mesh_move: false, frame: None }
    }
}
