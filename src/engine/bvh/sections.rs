//! Decisions about robots of sections of constant curvature: [`BvhSearch`] builds a chain of each.

use super::search::BvhSearch;
use crate::answer::ProximityError;
use crate::pair::{PlacedRobot, rigid_pose};
use crate::query::check_margin;
use crate::robot::{BendingSection, ConstantCurvature};
#[cfg(doc)]
use crate::{engine::Proximity, robot::Chain};
use parry3d_f64::math::{Pose, Real};

impl BvhSearch {
    /// Returns for many robots of sections of constant curvature whether they are farther than
    /// `margin` from the mesh, on all cores.
    ///
    /// Each robot is its sections, base to tip. `segments` is the number of links of each section;
    /// 0 counts as 1. `pose` maps the frame of the robots to the mesh's frame. Writes one result
    /// per robot to `out`, in order.
    ///
    /// [`ConstantCurvature::points`] and [`Chain::from_centreline`] build a chain of each robot.
    /// The answers equal the answers of [`clears`](Proximity::clears) for these chains.
    ///
    /// ```
    /// use parry_continuum::BendingSection;
    /// use parry_continuum::parry::{math::Pose, shape::Ball};
    /// use parry_continuum::proximity::BvhSearch;
    ///
    /// let (vertices, triangles) = Ball::new(50.0).to_trimesh(64, 32);
    /// let mut search = BvhSearch::from_triangles(&vertices, &triangles)?;
    /// // Two sections of 30 mm that bend towards x by up to 0.05 / mm.
    /// let section = |bend| BendingSection { length: 30.0, radius: 1.0, bend: [bend, 0.0] };
    /// let bends = [0.0, 0.025, 0.05].map(section);
    /// let robots: Vec<_> = bends.iter().flat_map(|&a| bends.map(|b| [a, b])).collect();
    /// let mut clear = Vec::new();
    /// search.clears_sections_batch(&robots, 15, &Pose::IDENTITY, 0.5, &mut clear)?;
    /// // A straight robot reaches the wall.
    /// assert_eq!((clear.len(), clear[0], clear[8]), (9, Ok(false), Ok(true)));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// - The margin is negative or NaN, or the pose is not finite or not rigid; `out` is then
    ///   empty.
    /// - In `out`: a section is invalid, as for [`ConstantCurvature::new`], or `clears` refuses the
    ///   chain.
    pub fn clears_sections_batch<S: AsRef<[BendingSection]> + Sync>(
        &mut self,
        robots: &[S],
        segments: usize,
        pose: &Pose,
        margin: Real,
        out: &mut Vec<Result<bool, ProximityError>>,
    ) -> Result<(), ProximityError> {
        out.clear();
        check_margin(margin)?;
        rigid_pose(pose)?;
        self.batch(
            robots,
            out,
            || false,
            |context, sections, out| {
                *out = ConstantCurvature::new(sections.as_ref())
                    .and_then(|robot| robot.chain(segments))
                    .map_err(Into::into)
                    .and_then(|chain| Ok(context.clears(PlacedRobot::new(&chain, pose)?, margin)));
            },
        );
        Ok(())
    }
}
