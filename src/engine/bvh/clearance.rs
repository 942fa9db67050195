//! Queries about tubes, as [`BvhSearch`] answers them.

use super::search::{BvhSearch, Context};
use crate::answer::{Clearance, Decision, ProximityError, TubePiece};
use crate::pieces::{PendingPiece, PlacedTube, TubeInMesh};
use crate::query::clearance::{TubeMemory, clearance, tube_clears};
use crate::query::{check_decision, check_not_negative};
use crate::robot::Tube;
use parry3d_f64::math::{Pose, Real};

impl BvhSearch {
    /// The clearance of a tube, between bounds that are at most `tolerance` apart where the tube
    /// allows that.
    ///
    /// `pose` is the tube's in the mesh's frame. The bounds hold for the tube as it was given, all
    /// rounding included: `lower` <= clearance <= `upper`, and `upper` is realised by the
    /// points of the answer. With a tolerance of 0, which suits straight pieces alone, they
    /// differ by rounding.
    ///
    /// There are always bounds. [`resolved`](Clearance::resolved) says whether they are as close as
    /// was asked for: samples may be too coarse for that, rounding may hide it, and a query
    /// ends after 65,536 pieces. What the tube states as its own error is in both bounds, and
    /// no part of the tolerance: that is the answer's [`uncertainty`](Clearance::uncertainty).
    ///
    /// The answer is the same to the last bit, whatever was asked before. A finer tolerance never
    /// gives looser bounds.
    ///
    /// The work grows with the number of pieces near the wall, about the root of 1 / tolerance.
    ///
    /// # Errors
    /// The tolerance is negative or NaN; the curve of the tube is not finite somewhere; or the pose
    /// is not finite or moves it out of range.
    pub fn clearance(
        &mut self,
        tube: &Tube,
        pose: &Pose,
        tolerance: Real,
    ) -> Result<Clearance, ProximityError> {
        check_not_negative("tolerance", tolerance)?;
        self.context().clearance(tube, pose, tolerance)
    }

    /// [`clearance`](Self::clearance), and the pieces into which the query divided the tube for it,
    /// in the order of their arc lengths: what the tolerance cost.
    ///
    /// Together the pieces are the whole tube, without gap or overlap: few and long far from the
    /// wall, short near it. The least of their `lower` is that of the answer, unless it is the
    /// answer's `upper`. Once a common point with the mesh is found, pieces stay as they are.
    /// The `lower` of pieces that are farther away depends on earlier queries. `out` is cleared
    /// first.
    ///
    /// ```
    /// use parry_continuum::{Tube, parry::{math::{Pose, Vector}, shape::{Ball, TriMesh}}};
    /// use parry_continuum::proximity::BvhSearch;
    ///
    /// let (vertices, triangles) = Ball::new(50.0).to_trimesh(64, 32);
    /// let mut search = BvhSearch::new(&TriMesh::new(vertices, triangles)?)?;
    /// let arc: Vec<_> = (0..=60).map(|k| f64::from(k) / 60.0).map(|a| Vector::new(a.cos(), 0.0, a.sin()) * 30.0).collect();
    /// let tube = Tube::from_samples(&arc, &[1.0; 60], None)?;
    /// let mut pieces = Vec::new();
    /// let found = search.clearance_pieces(&tube, &Pose::IDENTITY, 0.01, &mut pieces)?;
    /// assert!(pieces.iter().all(|piece| piece.lower >= found.lower));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`clearance`](Self::clearance); `out` is then empty.
    pub fn clearance_pieces(
        &mut self,
        tube: &Tube,
        pose: &Pose,
        tolerance: Real,
        out: &mut Vec<TubePiece>,
    ) -> Result<Clearance, ProximityError> {
        out.clear();
        check_not_negative("tolerance", tolerance)?;
        let answer = self.context().clearance_pieces(tube, pose, tolerance, out);
        if answer.is_err() {
            out.clear();
        }
        answer
    }

    /// Whether a tube keeps more than `margin` away from the mesh.
    ///
    /// `Clear` and `Contact` are proven. `Undecided` is the answer only where the clearance is
    /// within `resolution` of the margin, or where 65,536 pieces of the tube do not decide it.
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
    /// assert_eq!(search.tube_clears(&tube, &Pose::IDENTITY, 20.0, 1e-3)?, Decision::Contact);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// The margin or the resolution is negative or NaN, samples do not allow a decision at that
    /// resolution, or as [`clearance`](Self::clearance). A contact that is found is the answer,
    /// whatever samples allow elsewhere.
    pub fn tube_clears(
        &mut self,
        tube: &Tube,
        pose: &Pose,
        margin: Real,
        resolution: Real,
    ) -> Result<Decision, ProximityError> {
        check_decision(margin, resolution)?;
        self.context().tube_clears(tube, pose, margin, resolution)
    }

    /// [`clearance`](Self::clearance) for many tubes, on all cores. `out` gets the answer of each,
    /// or why there is none.
    ///
    /// ```
    /// use parry_continuum::{Tube, parry::{math::{Pose, Vector}, shape::Ball}};
    /// use parry_continuum::proximity::BvhSearch;
    ///
    /// let (vertices, triangles) = Ball::new(50.0).to_trimesh(64, 32);
    /// let mut search = BvhSearch::from_triangles(&vertices, &triangles)?;
    /// let tube = Tube::from_samples(&[Vector::ZERO, Vector::Z * 10.0], &[1.0], None)?;
    /// let poses = [Vector::ZERO, Vector::Z * 30.0, Vector::NAN].map(Pose::from_translation);
    /// let mut answers = Vec::new();
    /// search.clearance_batch(&poses.map(|pose| (&tube, pose)), 0.01, &mut answers)?;
    /// assert!(answers[0].is_ok_and(|found| found.lower > 38.0) && answers[1].is_ok_and(|found| found.upper < 11.0));
    /// assert_eq!(answers[2].map_err(|error| error.kind()), Err("pose_not_finite"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// The tolerance is negative or NaN; `out` is then empty.
    pub fn clearance_batch(
        &mut self,
        tubes: &[(&Tube, Pose)],
        tolerance: Real,
        out: &mut Vec<Result<Clearance, ProximityError>>,
    ) -> Result<(), ProximityError> {
        out.clear();
        check_not_negative("tolerance", tolerance)?;
        self.batch(tubes, out, Clearance::placeholder, |context, (tube, pose), out| {
            *out = context.clearance(tube, pose, tolerance);
        });
        Ok(())
    }

    /// [`tube_clears`](Self::tube_clears) for many tubes, on all cores. `out` gets the answer of
    /// each, or why there is none.
    ///
    /// # Errors
    /// The margin or the resolution is negative or NaN; `out` is then empty.
    pub fn tube_clears_batch(
        &mut self,
        tubes: &[(&Tube, Pose)],
        margin: Real,
        resolution: Real,
        out: &mut Vec<Result<Decision, ProximityError>>,
    ) -> Result<(), ProximityError> {
        out.clear();
        check_decision(margin, resolution)?;
        self.batch(
            tubes,
            out,
            || Decision::Undecided,
            |context, (tube, pose), out| {
                *out = context.tube_clears(tube, pose, margin, resolution);
            },
        );
        Ok(())
    }
}

/// The clearance of a tube of whose flat ends nothing is known but a turn, as if that had not been
/// stated; none of any other tube. Bodies with flat ends are wider beside them than those with
/// round ends, so that either may tell more.
fn clearance_without_turn(
    tube: &mut TubeInMesh,
    memory: &mut TubeMemory,
    tolerance: Real,
) -> Result<Option<Clearance>, ProximityError> {
    let placed = tube.tube;
    let Some(less_known) = placed.without_turn() else { return Ok(None) };
    tube.tube = less_known;
    let answer = clearance(tube, memory, tolerance);
    tube.tube = placed;
    answer.map(Some)
}

impl<'a> Context<'a> {
    fn clearance(
        self,
        tube: &'a Tube,
        pose: &Pose,
        tolerance: Real,
    ) -> Result<Clearance, ProximityError> {
        let (mut tube, memory) = self.tube_in_mesh(tube, pose)?;
        let known = clearance_without_turn(&mut tube, memory, tolerance)?;
        let answer = clearance(&mut tube, memory, tolerance)?;
        Ok(known.map_or(answer, |known| known.and(answer, tolerance)))
    }

    fn clearance_pieces(
        self,
        tube: &'a Tube,
        pose: &Pose,
        tolerance: Real,
        out: &mut Vec<TubePiece>,
    ) -> Result<Clearance, ProximityError> {
        let (mut tube, memory) = self.tube_in_mesh(tube, pose)?;
        let placed = tube.tube;
        let known = clearance_without_turn(&mut tube, memory, tolerance)?;
        let answer = clearance(&mut tube, memory, tolerance)?;
        for PendingPiece { piece, lower, .. } in memory.pieces.all() {
            let outer = placed.outer(piece);
            placed.check_finite(piece, &outer)?;
            out.push(placed.report(piece, &outer, *lower));
        }
        out.sort_unstable_by(|a, b| {
            let [from, to] = [0, 1].map(|end| a.arc_lengths[end].total_cmp(&b.arc_lengths[end]));
            a.section.cmp(&b.section).then(from).then(to)
        });
        Ok(known.map_or(answer, |known| known.and(answer, tolerance)))
    }

    fn tube_clears(
        self,
        tube: &'a Tube,
        pose: &Pose,
        margin: Real,
        resolution: Real,
    ) -> Result<Decision, ProximityError> {
        let (mut tube, memory) = self.tube_in_mesh(tube, pose)?;
        let placed = tube.tube;
        let Some(less_known) = placed.without_turn() else {
            return tube_clears(&mut tube, memory, margin, resolution);
        };
        tube.tube = less_known;
        let decision = tube_clears(&mut tube, memory, margin, resolution);
        tube.tube = placed;
        Decision::better_of(decision, || tube_clears(&mut tube, memory, margin, resolution))
    }

    /// The tube in the mesh, and what the last query about a tube left.
    fn tube_in_mesh(
        self,
        tube: &'a Tube,
        pose: &Pose,
    ) -> Result<(TubeInMesh<'a>, &'a mut TubeMemory), ProximityError> {
        let (search, last) = self.search();
        let tube = PlacedTube::new(tube, pose, search.hierarchy.reach)?;
        Ok((TubeInMesh { search, tube }, &mut last.tube))
    }
}
