//! Queries about motions, as [`BvhSearch`] answers them.

use super::search::{BvhSearch, Context, Remembered};
use crate::answer::{MotionAnswer, MotionClearance, ProximityError};
use crate::query::motion::{MarginQuery, MotionSearch};
use crate::query::{check_decision, check_not_negative};
use crate::robot::{Chain, Motion, ShapePath};
use parry3d_f64::math::{Real, Vector};

impl BvhSearch {
    /// Whether a motion keeps more than `margin` away from the mesh at every time from 0 to 1.
    ///
    /// - `Clear`: no point of the robot comes as near as the margin at any time. This is proven
    ///   from the speeds that the motion states, rounding included. A robot that passes through a
    ///   wall is never `Clear`, although it may be far from the wall on both sides.
    /// - `Contact`: the answer names a shape that is at most the margin away, and its time.
    /// - `Undecided`, because of [`Near`](crate::proximity::UndecidedReason::Near): some shape is
    ///   farther away than the margin by no more than `resolution`, which is a length. There are
    ///   two other cases: an end of a link or section that lies one radius behind a flat face turns
    ///   from flat to round, and it is this end that comes near; or a link loses its length for a
    ///   moment, and what comes near is the ball that it is then.
    /// - `Undecided`, because of [`Work`](crate::proximity::UndecidedReason::Work): the question
    ///   ends after 65,536 shapes.
    ///
    /// The work is one tube query for each shape that the proof needs. One shape is enough where
    /// the motion is small beside the room that it has, and more are needed where it passes
    /// close by. Only the pieces of the robot that are not proven yet are looked at again.
    ///
    /// The stated speeds are trusted. Let your tests check them by
    /// [`verify_motion`](crate::verify_motion).
    ///
    /// The query allocates nothing once its memory has grown. Making the shapes may:
    /// [`LinearMotion`](crate::LinearMotion) and [`RigidMotion`](crate::RigidMotion) reuse
    /// their memory, [`BendingMotion`](crate::BendingMotion) allocates a few times
    /// for each shape, and a motion of your own reuses memory if it calls
    /// [`Tube::set_samples`](crate::Tube::set_samples).
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
    /// // From inside to outside, whose ends are both clear.
    /// let through = LinearMotion::chain(&from, &from.map(|point| point + Vector::X * 20.0), &[1.0])?;
    /// let answer = search.clears_motion(&through, 0.0, 1e-3)?;
    /// assert_eq!(answer.decision, Decision::Contact);
    /// assert!(answer.contact.is_some_and(|shape| 0.0 < shape.t && shape.t < 1.0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// - The margin or the resolution is negative or NaN.
    /// - The resolution is finer than rounding, than the samples of a shape allow, or than a motion
    ///   so fast can be divided.
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
        self.context().motion(motion).clears(MarginQuery { margin, resolution })
    }

    /// When a motion first comes as close to the mesh as `margin`: between the two times of the
    /// answer's [`interval`](MotionAnswer::interval).
    ///
    /// Until the first time the margin is kept, which is proven. At the second time a shape does
    /// not keep it, which the answer names. Between the two, the place that touches moves by no
    /// more than the resolution. They are farther apart only if the motion comes within the
    /// resolution of the margin before, or if the question ends after 65,536 shapes.
    ///
    /// Decisions mean what they do for [`clears_motion`](Self::clears_motion).
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
    /// assert!(clear_until <= 0.45 && 0.449 <= t && t - clear_until <= 1e-3); // where the tip has gone 9 of 20
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
        self.context().motion(motion).first_contact(MarginQuery { margin, resolution })
    }

    /// Whether the robot keeps more than `margin` away all the way along a planner's own shapes,
    /// where no speed is stated.
    ///
    /// `shapes` are the robot at the planner's steps, in the mesh's frame, with the same number of
    /// links and the same radii. Between two of them every vertex is taken to move straight and
    /// evenly. At every moment the robot is some tube whose centreline is smooth and lies
    /// within `deviation` of the links, place by place: the deviation counts how far the links
    /// leave the curve, how far the robot's way leaves the straight one between two steps, and
    /// what the kinematics or a sensor errs.
    ///
    /// A place says nothing of a direction. On its side the tube is known to the deviation; at the
    /// flat faces of its two ends and of steps in radius it may stand any way: it lies within
    /// the ball around its centre, and holds that centre. So caps of the shapes do not matter.
    ///
    /// - `Clear`: every such tube keeps the margin at every time.
    /// - `Contact`: every such tube is at most the margin away at the time of the named shape.
    ///   Times are shared out evenly: of n shapes the first is at t = 0, the next at 1 / (n - 1).
    /// - `Undecided`: it depends on the tube, or on less than `resolution`.
    ///
    /// ```
    /// use parry_continuum::{Chain, parry::{math::Vector, shape::Ball}, proximity::{BvhSearch, Decision}};
    ///
    /// let (vertices, triangles) = Ball::new(10.0).to_trimesh(64, 32);
    /// let mut search = BvhSearch::from_triangles(&vertices, &triangles)?;
    /// // A needle that is pushed by 5 in steps of 1.
    /// let needle = |tip: u32| Chain::capsules(&[Vector::ZERO, Vector::Z * f64::from(tip)], &[0.5]);
    /// let shapes = (1..=6).map(needle).collect::<Result<Vec<_>, _>>()?;
    /// let found = search.clears_path(&shapes, 0.1, 1.0, 1e-3)?;
    /// assert_eq!(found.decision, Decision::Clear);
    /// let found = search.clears_path(&shapes, 0.1, 5.0, 1e-3)?;
    /// assert_eq!(found.decision, Decision::Contact); // the tip is less than 4 away in the end
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// - The margin or the resolution is negative or NaN, or the deviation is, or is not finite.
    /// - There are no shapes, or they differ in radii or in which segments have a length.
    /// - The resolution is finer than rounding, or than shapes so far apart can be divided.
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
        self.context().motion(&path).clears(MarginQuery { margin, resolution })
    }

    /// Whether a motion keeps more than `margin` away from a mesh that moves meanwhile: each vertex
    /// goes straight and evenly from where it is to its place in `to`, in the same time from 0
    /// to 1.
    ///
    /// That is an organ that breathes, a registration that is corrected, or a step of a simulation
    /// of tissue. `Clear` is proven for every instant, as for
    /// [`clears_motion`](Self::clears_motion); a `Contact` names the time, and its points are those
    /// of robot and mesh at that time. The engine's mesh stays where it was:
    /// [`set_vertices`](crate::proximity::Proximity::set_vertices) moves it to `to` for good.
    ///
    /// A robot at rest is a [`RigidMotion`](crate::RigidMotion) from a pose to the same pose. Each
    /// call goes once through all triangles. The fastest vertex is taken for the speed of the
    /// whole mesh: what moves everywhere alike had better move the robot instead
    /// ([`MovingBase`](crate::MovingBase)).
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
        self.prepared().hierarchy.mesh.check_moved(to)?;
        let mut search = self.context().motion(motion);
        search.move_mesh(to);
        search.clears(MarginQuery { margin, resolution })
    }

    /// How near a motion comes to the mesh at any time from 0 to 1, between bounds that are at most
    /// `tolerance` apart where the motion's shapes allow that.
    ///
    /// `lower` <= the least clearance of all shapes <= `upper`, for every instant and not only for
    /// some: this is proven from the speeds that the motion states, rounding included. The
    /// shape at [`t`](MotionClearance::t) realises `upper`, at the two points of the answer.
    /// Where the motion stays as near for a while, `t` is one such time.
    ///
    /// There are always bounds; [`resolved`](MotionClearance::resolved) says whether they are as
    /// close as was asked for. Samples may be too coarse for that, an end may turn from flat to
    /// round and be what comes near, or the query ends after 65,536
    /// shapes. A [`MotionPath`](crate::MotionPath) asks about many motions at once: each is looked
    /// at only as closely as it may be the one that comes nearest.
    ///
    /// ```
    /// use parry_continuum::{LinearMotion, parry::{math::Vector, shape::Ball}, proximity::BvhSearch};
    ///
    /// let (vertices, triangles) = Ball::new(10.0).to_trimesh(64, 32);
    /// let mut search = BvhSearch::from_triangles(&vertices, &triangles)?;
    /// // The tip goes from the one side to the other.
    /// let motion = LinearMotion::chain(
    ///     &[Vector::Z * 2.0, Vector::new(-4.0, 0.0, 6.0)],
    ///     &[Vector::Z * 2.0, Vector::new(4.0, 0.0, 6.0)],
    ///     &[0.5],
    /// )?;
    /// let least = search.clearance_of_motion(&motion, 0.001)?;
    /// assert!(least.resolved && least.upper - least.lower <= 0.001);
    /// println!("{} mm at t = {}, at {}", least.upper, least.t, least.on_mesh);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// The tolerance is negative or NaN; the motion has no shape at some time, its sections change,
    /// or a stated speed is not finite; or the robot is out of range.
    pub fn clearance_of_motion(
        &mut self,
        motion: &impl Motion,
        tolerance: Real,
    ) -> Result<MotionClearance, ProximityError> {
        check_not_negative("tolerance", tolerance)?;
        self.context().motion(motion).clearance(tolerance)
    }

    /// [`clears_motion`](Self::clears_motion) for many motions, on all cores. `out` gets the answer
    /// of each, or why there is none.
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
            *out = context.motion(motion).clears(MarginQuery { margin, resolution });
        });
        Ok(())
    }
}

impl<'a> Context<'a> {
    /// A search along a motion.
    fn motion<M: Motion>(self, motion: &'a M) -> MotionSearch<'a, M> {
        let (search, Remembered { motion: memory, .. }) = self.search();
        MotionSearch { search, memory, motion, shapes: 0, last: None, does_mesh_move: false }
    }
}
