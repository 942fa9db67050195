//! Queries about motions, as [`BvhSearch`] answers them.

use super::search::{BvhSearch, Context, Memory};
use crate::answer::{MotionAnswer, ProximityError};
use crate::query::motion::MotionSearch;
use crate::query::{check_margin, check_not_negative};
use crate::robot::Motion;
use crate::search::hierarchy::MeshSearch;
use parry3d_f64::math::Real;

impl BvhSearch {
    /// Whether a motion keeps more than `margin` away from the mesh at every time from 0 to 1.
    ///
    /// The decision `Clear` is proven for all times, given the speeds that the motion states, all rounding included. It is so although
    /// distances are unsigned and a robot may be clear on both sides of a wall: what is proven is that no point gets
    /// there. `Contact` names a shape that is at most the margin away. `Undecided` is the answer only where some shape's
    /// clearance is above the margin by no more than `resolution`, which is a length; and at the moment at which an end of
    /// a link or section, one radius behind a flat face, becomes flat or round, if that is what comes near.
    ///
    /// The work is a query for each shape that the proof takes: one if the motion is small beside the room that it has,
    /// and more where it passes close by. Only the pieces that are not proven yet are looked at again.
    ///
    /// The stated speeds are trusted. [`verify_motion`](crate::verify_motion) tries them: call it in your tests.
    ///
    /// The query allocates nothing once its memory has grown; making the shapes may. [`LinearMotion`](crate::LinearMotion)
    /// and [`RigidMotion`](crate::RigidMotion) make theirs in memory that is used again, and so can a motion of one's own
    /// through [`Tube::set_samples`](crate::Tube::set_samples). [`BendingMotion`](crate::BendingMotion) allocates a few times
    /// for each shape.
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
    /// The margin or the resolution is negative or NaN, or the resolution so fine that rounding hides it; the motion has no
    /// shape at some time, its sections change, or a stated speed is not finite; the robot is out of range; the samples of
    /// a shape do not allow an answer as fine as the resolution; or the motion is too fast for it.
    pub fn clears_motion(
        &mut self,
        motion: &impl Motion,
        margin: Real,
        resolution: Real,
    ) -> Result<MotionAnswer, ProximityError> {
        check_margin(margin)?;
        check_not_negative("resolution", resolution)?;
        self.context().motion(motion, margin, resolution).clears()
    }

    /// When a motion first comes as close to the mesh as `margin`, between two times.
    ///
    /// The answer and its errors are as those of [`clears_motion`](Self::clears_motion). Between the two times, the place
    /// that touches moves by no more than the resolution; they are farther apart only if the motion comes within the
    /// resolution of the margin before.
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
        check_margin(margin)?;
        check_not_negative("resolution", resolution)?;
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
        check_margin(margin)?;
        check_not_negative("resolution", resolution)?;
        self.batch(motions, out, MotionAnswer::clear, |context, motion, out| {
            *out = context.motion(motion, margin, resolution).clears();
        });
        Ok(())
    }
}

impl<'a> Context<'a> {
    /// A search along a motion. Margin and resolution were checked.
    fn motion<M: Motion>(self, motion: &'a M, margin: Real, resolution: Real) -> MotionSearch<'a, M> {
        let Self { level, mesh, memory } = self;
        let Memory { scratch, motion: memory, .. } = memory;
        let search = MeshSearch { level, hierarchy: &mesh.hierarchy, scratch };
        MotionSearch { search, memory, motion, margin, resolution, shapes: 0, last: None }
    }
}
