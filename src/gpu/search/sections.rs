//! Decisions about robots of sections of constant curvature: the device computes their points and
//! decides about most of them; the CPU builds the chains of the others.

use super::answer::{Answer, Found, Measure};
use super::bending::BentRobots;
use super::engine::GpuSearch;
use super::kernels::Question;
use super::robots::Packed;
use crate::answer::ProximityError;
#[cfg(doc)]
use crate::engine::BvhSearch;
use crate::pair::{PlacedRobot, rigid_pose};
use crate::query::check_margin;
use crate::robot::BendingSection;
use parry3d_f64::math::{Pose, Real};

/// The least number of links per core of the CPU for which a batch runs on the device. An estimate:
/// it was not measured.
const MIN_LINKS: usize = 240;

impl GpuSearch {
    /// Returns for many robots of sections of constant curvature whether they are farther than
    /// `margin` from the mesh.
    ///
    /// The answers equal the answers of [`BvhSearch::clears_sections_batch`]. The device computes
    /// the points of the robots: only the sections are uploaded, and the CPU builds chains only
    /// where single precision does not decide.
    ///
    /// The CPU searches for robots that have another number of sections than most, or bend by more
    /// than pi in a link or by more than 2 pi in a section; and for robots that single
    /// precision does not resolve, because the mesh is fine beside the rounding of many sections or
    /// of links that are short beside their radius. [`answered_on_cpu`](Self::answered_on_cpu)
    /// counts them. Small batches run on the CPU: see [`set_min_links`](Self::set_min_links).
    ///
    /// ```no_run
    /// use parry_continuum::BendingSection;
    /// use parry_continuum::gpu::GpuSearch;
    /// use parry_continuum::parry::{math::Pose, shape::{Ball, TriMesh}};
    ///
    /// let (vertices, triangles) = Ball::new(50.0).to_trimesh(64, 32);
    /// let mut search = GpuSearch::new(&TriMesh::new(vertices, triangles)?)?;
    /// let section = |bend| BendingSection { length: 30.0, radius: 1.0, bend: [bend, 0.0] };
    /// let bends = || (0..1000).map(|k| section(5e-5 * f64::from(k)));
    /// let robots: Vec<_> = bends().flat_map(|a| bends().map(move |b| [a, b])).collect();
    /// let mut clear = Vec::new();
    /// search.clears_sections_batch(&robots, 15, &Pose::IDENTITY, 0.5, &mut clear)?;
    /// println!("{} of a million", clear.iter().filter(|clear| **clear == Ok(true)).count());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`BvhSearch::clears_sections_batch`]; or the device failed, and `out` is empty.
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
        let bent = BentRobots::new(robots, segments, rigid_pose(pose)?);
        if !self.are_enough(bent, MIN_LINKS) {
            let cpu = self.refitted();
            return cpu.clears_sections_batch(robots, segments, pose, margin, out);
        }
        out.resize(robots.len(), Ok(false));
        self.search(bent, &BentClears { robots: bent, pose, margin }, out)
            .inspect_err(|_| out.clear())?;
        let for_cpu = self.take_for_cpu();
        if for_cpu.is_empty() {
            return Ok(());
        }
        let some: Vec<_> = for_cpu.iter().map(|&robot| robots[robot].as_ref()).collect();
        let mut answers = Vec::new();
        let cpu = self.refitted();
        cpu.clears_sections_batch(&some, segments, pose, margin, &mut answers)?;
        for_cpu.into_iter().zip(answers).for_each(|(robot, answer)| out[robot] = answer);
        Ok(())
    }
}

/// Whether a robot of sections clears a margin. Most robots need no chain for that.
struct BentClears<'a, S> {
    robots: BentRobots<'a, S>,
    /// The pose of the chains, as the user gave it.
    pose: &'a Pose,
    margin: Real,
}

impl<S: AsRef<[BendingSection]> + Sync> Answer for BentClears<'_, S> {
    type Value = bool;

    fn question(&self) -> Question {
        Question::Clears(self.margin)
    }

    fn placeholder(&self) -> bool {
        false
    }

    fn answer(
        &self,
        measure: Measure,
        robot: usize,
        found: Found,
        _: &mut Result<bool, ProximityError>,
    ) -> Option<bool> {
        if let decision @ Some(_) = found.decision() {
            return decision;
        }
        let chain = self.robots.chain(robot).ok()?;
        // Where a segment has lost its length, the links of the chain have other numbers.
        if chain.links().len() != self.robots.links(robot) {
            return None;
        }
        let placed = PlacedRobot::new(&chain, self.pose).ok()?;
        Some(measure.clears(&placed, found, self.margin))
    }
}
