//! Queries about tubes, as [`BvhSearch`] answers them.

use super::BvhSearch;
use super::engine::Memory;
use super::hierarchy::MeshSearch;
use super::tube_queries::{TubeMemory, TubeSearch};
use crate::Tube;
use crate::proximity::checks::{check_margin, check_tolerance};
use crate::proximity::parallel::in_shares;
use crate::proximity::tube::PlacedTube;
use crate::proximity::{Clearance, Decision, ProximityError};
use parry3d_f64::math::{Pose, Real};

impl BvhSearch {
    /// The clearance of a tube, between bounds that are at most `tolerance` apart.
    ///
    /// `pose` is the tube's in the mesh's frame. The bounds hold for the tube as it was given, all rounding included:
    /// `lower` <= clearance <= `upper`, and `upper` is realised by the points of the answer. With a tolerance of 0, which
    /// suits straight pieces alone, they differ by rounding.
    ///
    /// The work grows with the number of pieces near the wall, about the root of 1 / tolerance.
    ///
    /// # Errors
    /// The tolerance is negative or NaN; the tube is empty, or its curve not finite somewhere; the pose is not finite or
    /// moves it out of range; or the samples allow no answer as fine as that.
    pub fn clearance(
        &mut self,
        tube: &Tube,
        pose: &Pose,
        tolerance: Real,
    ) -> Result<Clearance, ProximityError> {
        check_tolerance(tolerance)?;
        let Self { level, hierarchy, memory, .. } = self;
        clearance(
            MeshSearch { level: *level, hierarchy, scratch: &mut memory.scratch },
            &mut memory.tube,
            tube,
            pose,
            tolerance,
        )
    }

    /// Whether a tube keeps more than `margin` away from the mesh.
    ///
    /// `Clear` and `Touches` are proven. `Undecided` is the answer only where the clearance is within `resolution` of
    /// the margin.
    ///
    /// ```
    /// use parry_continuum::{Tube, parry::{math::{Pose, Vector}, shape::{Ball, TriMesh}}};
    /// use parry_continuum::proximity::{BvhSearch, Decision};
    ///
    /// let (vertices, triangles) = Ball::new(50.0).to_trimesh(64, 32);
    /// let mut search = BvhSearch::new(&TriMesh::new(vertices, triangles)?)?;
    /// let arc: Vec<_> = (0..=60).map(|k| f64::from(k) / 60.0).map(|a| Vector::new(a.cos(), 0.0, a.sin()) * 30.0).collect();
    /// let tube = Tube::from_samples(&arc, &[1.0; 60], None)?;
    /// assert_eq!(search.tube_clears(&tube, &Pose::IDENTITY, 15.0, 1e-3)?, Decision::Clear);
    /// assert_eq!(search.tube_clears(&tube, &Pose::IDENTITY, 20.0, 1e-3)?, Decision::Touches);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// The margin or the resolution is negative or NaN, or as [`clearance`](Self::clearance).
    pub fn tube_clears(
        &mut self,
        tube: &Tube,
        pose: &Pose,
        margin: Real,
        resolution: Real,
    ) -> Result<Decision, ProximityError> {
        check_margin(margin)?;
        check_tolerance(resolution)?;
        let Self { level, hierarchy, memory, .. } = self;
        let search = MeshSearch { level: *level, hierarchy, scratch: &mut memory.scratch };
        clears(search, &mut memory.tube, tube, pose, margin, resolution)
    }

    /// [`clearance`](Self::clearance) for many tubes, on all cores. `out` gets one entry per tube.
    ///
    /// # Errors
    /// Those of the first tube that has one; `out` is then empty.
    pub fn clearance_batch(
        &mut self,
        tubes: &[(&Tube, Pose)],
        tolerance: Real,
        out: &mut Vec<Clearance>,
    ) -> Result<(), ProximityError> {
        out.clear();
        check_tolerance(tolerance)?;
        self.tube_batch(tubes, out, Clearance::unanswered, |search, memory, tube, pose| {
            clearance(search, memory, tube, pose, tolerance)
        })
    }

    /// [`tube_clears`](Self::tube_clears) for many tubes, on all cores. `out` gets one entry per tube.
    ///
    /// # Errors
    /// Those of the first tube that has one; `out` is then empty.
    pub fn tube_clears_batch(
        &mut self,
        tubes: &[(&Tube, Pose)],
        margin: Real,
        resolution: Real,
        out: &mut Vec<Decision>,
    ) -> Result<(), ProximityError> {
        out.clear();
        check_margin(margin)?;
        check_tolerance(resolution)?;
        self.tube_batch(
            tubes,
            out,
            || Decision::Undecided,
            |search, memory, tube, pose| clears(search, memory, tube, pose, margin, resolution),
        )
    }

    fn tube_batch<T: Send>(
        &mut self,
        tubes: &[(&Tube, Pose)],
        out: &mut Vec<T>,
        unanswered: impl Fn() -> T,
        answer: impl Fn(MeshSearch, &mut TubeMemory, &Tube, &Pose) -> Result<T, ProximityError> + Sync,
    ) -> Result<(), ProximityError> {
        out.resize_with(tubes.len(), unanswered);
        let (level, hierarchy) = (self.level, &*self.hierarchy);
        let result = in_shares(tubes, out, &mut self.batch, |memory: &mut Memory, tubes, out| {
            memory.forget();
            for ((tube, pose), out) in tubes.iter().zip(out) {
                let search = MeshSearch { level, hierarchy, scratch: &mut memory.scratch };
                *out = answer(search, &mut memory.tube, tube, pose)?;
            }
            Ok(())
        });
        if result.is_err() {
            out.clear();
        }
        result
    }
}

fn clearance(
    search: MeshSearch,
    memory: &mut TubeMemory,
    tube: &Tube,
    pose: &Pose,
    tolerance: Real,
) -> Result<Clearance, ProximityError> {
    let tube = PlacedTube::new(tube, pose, search.hierarchy.reach)?;
    let (answer, place) =
        TubeSearch { search, tube, pieces: &mut memory.pieces }.clearance(tolerance, memory.last)?;
    memory.last = Some(place);
    Ok(answer)
}

fn clears(
    search: MeshSearch,
    memory: &mut TubeMemory,
    tube: &Tube,
    pose: &Pose,
    margin: Real,
    resolution: Real,
) -> Result<Decision, ProximityError> {
    let tube = PlacedTube::new(tube, pose, search.hierarchy.reach)?;
    let (decision, place) =
        TubeSearch { search, tube, pieces: &mut memory.pieces }.clears(margin, resolution, memory.last)?;
    memory.last = place.or(memory.last);
    Ok(decision)
}
