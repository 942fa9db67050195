//! Queries about motions, as [`BvhSearch`] answers them.

use super::search::{BvhSearch, Context, Remembered};
use crate::answer::{MotionAnswer, ProximityError};
use crate::query::check_decision;
use crate::query::motion::MotionSearch;
use crate::robot::Motion;
use parry3d_f64::math::Real;

impl BvhSearch {
    /// Whether a motion keeps more than `margin` away from the mesh at every time from 0 to 1.
    ///
    /// - `Clear`: no point of the robot comes as near as the margin at any time. This is proven from the speeds that the motion
    ///   states, rounding included. A robot that passes through a wall is never `Clear`, although it may be far from the wall
    ///   on both sides.
    /// - `Contact`: the answer names a shape that is at most the margin away, and its time.
    /// - `Undecided`: some shape is farther away than the margin by no more than `resolution`, which is a length. There is one
    ///   other case: an end of a link or section that lies one radius behind a flat face turns from flat to round, and it is
    ///   this end that comes near.
    ///
    /// The work is one tube query for each shape that the proof needs. One shape is enough where the motion is small beside
    /// the room that it has, and more are needed where it passes close by. Only the pieces of the robot that are not proven
    /// yet are looked at again.
    ///
    /// The stated speeds are trusted. Let your tests check them by [`verify_motion`](crate::verify_motion).
    ///
    /// The query allocates nothing once its memory has grown. Making the shapes may: [`LinearMotion`](crate::LinearMotion) and
    /// [`RigidMotion`](crate::RigidMotion) reuse their memory, [`BendingMotion`](crate::BendingMotion) allocates a few times
    /// for each shape, and a motion of your own reuses memory if it calls [`Tube::set_samples`](crate::Tube::set_samples).
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
    /// - The resolution is finer than rounding, than the samples of a shape allow, or than a motion so fast can be divided.
    /// - The motion has no shape at some time, its sections change, or a stated speed is not finite.
    /// - The robot is out of range.
    pub fn clears_motion(
        &mut self,
        motion: &impl Motion,
        margin: Real,
        resolution: Real,
    ) -> Result<MotionAnswer, ProximityError> {
        check_decision(margin, resolution)?;
        self.context().motion(motion, margin, resolution).clears()
    }

    /// When a motion first comes as close to the mesh as `margin`: between the two times of the answer's
    /// [`interval`](MotionAnswer::interval).
    ///
    /// Until the first time the margin is kept, which is proven. At the second time a shape does not keep it, which the answer
    /// names. Between the two, the place that touches moves by no more than the resolution. They are farther apart only if the
    /// motion comes within the resolution of the margin before.
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
        self.context().motion(motion, margin, resolution).first_contact()
    }

    /// [`clears_motion`](Self::clears_motion) for many motions, on all cores. `out` gets the answer of each, or why there is
    /// none.
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
            *out = context.motion(motion, margin, resolution).clears();
        });
        Ok(())
    }
}

impl<'a> Context<'a> {
    /// A search along a motion. Margin and resolution were checked.
    fn motion<M: Motion>(self, motion: &'a M, margin: Real, resolution: Real) -> MotionSearch<'a, M> {
        let (search, Remembered { motion: memory, .. }) = self.search();
        MotionSearch { search, memory, motion, margin, resolution, shapes: 0, last: None }
    }
}
