//! Queries about tubes, as [`BvhSearch`] answers them.
//!
//! # Algorithm
//! For some tubes a stated turn is all that is known of their flat ends
//! (`is_turn_all_that_is_known`). For such a tube:
//!
//! 1. Answer the query as if the turn had not been stated ([`clearance_without_turn`]).
//! 2. Answer the query with the turn.
//! 3. Combine both: the tighter bounds, or the better decision.
//!
//! **Claim.** A stated turn never makes an answer worse.
//! **Proof.** Both answers are valid for the tube, and step 3 keeps the better. Step 2 alone would
//! not do, because a body with flat ends is wider beside them than a body with round ends. So
//! either body may give the tighter bound.

use super::search::{BvhSearch, Context, Remembered};
use crate::answer::{Clearance, Decision, ProximityError, TubePiece};
use crate::curve::Tube;
use crate::query::clearance::{LastPlace, MeshPieces, TubeMemory, clearance, clears_tube};
use crate::query::motion::MarginQuery;
use crate::query::{check_decision, check_not_negative};
use crate::refine::{PendingPiece, PlacedTube, TubeInMesh};
use crate::search::hierarchy::PlacedMeshSearch;
use parry3d_f64::math::{Pose, Real};

impl BvhSearch {
    /// Bounds the clearance of a tube from both sides.
    ///
    /// `pose` is the tube's pose in the mesh's frame. `tolerance` is a length: the bounds differ by
    /// at most the tolerance if the tube allows that. A tolerance of 0 suits straight pieces alone;
    /// the bounds then differ by rounding.
    ///
    /// The bounds hold for the tube as it was given, all rounding included: `lower` <= clearance <=
    /// `upper`. The points of the answer realise `upper`.
    ///
    /// The answer always has bounds, and [`resolved`](Clearance::resolved) says whether they meet
    /// the tolerance. They may not, because samples are too coarse, because rounding hides more, or
    /// because the query ends after 32,768 divisions. Both bounds allow for the error that the tube
    /// states of itself. This error is no part of the tolerance; the answer's
    /// [`uncertainty`](Clearance::uncertainty) reports it.
    ///
    /// The answer does not depend on earlier queries, bit for bit. A finer tolerance never gives
    /// looser bounds.
    ///
    /// The work grows with the number of pieces near the wall, about as 1 / sqrt(tolerance).
    ///
    /// # Errors
    /// - The tolerance is negative or NaN.
    /// - The curve of the tube is not finite somewhere.
    /// - The pose is not finite, or moves the tube out of range.
    pub fn clearance(
        &mut self,
        tube: &Tube,
        pose: &Pose,
        tolerance: Real,
    ) -> Result<Clearance, ProximityError> {
        check_not_negative("tolerance", tolerance)?;
        self.context().clearance(tube, pose, tolerance, None)
    }

    /// [`clearance`](Self::clearance), and the pieces into which the query divided the tube.
    ///
    /// The pieces show where the tolerance costs work. They are sorted by arc length and cover the
    /// tube without gap or overlap: few and long far from the wall, short near it. The answer's
    /// `lower` is the least `lower` of the pieces, or else the answer's `upper`. For a tube that
    /// states a turn the answer combines two queries: the pieces come from the query with the
    /// larger `lower`. Once the query finds a common point with the mesh, it divides no further.
    /// The `lower` of a piece farther than `upper` depends on earlier queries. `out` is cleared
    /// first.
    ///
    /// ```
    /// use parry_continuum::{Tube, parry::{math::{Pose, Vector}, shape::{Ball, TriMesh}}};
    /// use parry_continuum::proximity::BvhSearch;
    ///
    /// let (vertices, triangles) = Ball::new(50.0).to_trimesh(64, 32);
    /// let mut search = BvhSearch::new(&TriMesh::new(vertices, triangles)?)?;
    /// let arc: Vec<_> = (0..=60)
    ///     .map(|k| f64::from(k) / 60.0)
    ///     .map(|a| Vector::new(a.cos(), 0.0, a.sin()) * 30.0)
    ///     .collect();
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

    /// Decides whether a tube is farther than `margin` from the mesh.
    ///
    /// `margin` and `resolution` are lengths. `Clear` and `Contact` are proven. `Undecided` occurs
    /// only if the clearance is within `resolution` of the margin, or if 65,536 pieces of the tube
    /// do not decide.
    ///
    /// ```
    /// use parry_continuum::{Tube, parry::{math::{Pose, Vector}, shape::{Ball, TriMesh}}};
    /// use parry_continuum::proximity::{BvhSearch, Decision};
    ///
    /// let (vertices, triangles) = Ball::new(50.0).to_trimesh(64, 32);
    /// let mut search = BvhSearch::new(&TriMesh::new(vertices, triangles)?)?;
    /// let arc: Vec<_> = (0..=60)
    ///     .map(|k| f64::from(k) / 60.0)
    ///     .map(|a| Vector::new(a.cos(), 0.0, a.sin()) * 30.0)
    ///     .collect();
    /// let tube = Tube::from_samples(&arc, &[1.0; 60], None)?;
    /// assert_eq!(search.clears_tube(&tube, &Pose::IDENTITY, 15.0, 1e-3)?, Decision::Clear);
    /// assert_eq!(search.clears_tube(&tube, &Pose::IDENTITY, 20.0, 1e-3)?, Decision::Contact);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`clearance`](Self::clearance); or the margin or the resolution is negative or NaN; or
    /// samples do not allow a decision at that resolution. A contact that is found is reported
    /// before any error about samples.
    pub fn clears_tube(
        &mut self,
        tube: &Tube,
        pose: &Pose,
        margin: Real,
        resolution: Real,
    ) -> Result<Decision, ProximityError> {
        check_decision(margin, resolution)?;
        self.context().clears_tube(tube, pose, MarginQuery { margin, resolution }, None)
    }

    /// [`clearance`](Self::clearance) for many tubes, on all cores.
    ///
    /// Writes one result per tube to `out`, in order.
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
    /// assert!(
    ///     answers[0].is_ok_and(|found| found.lower > 38.0)
    ///         && answers[1].is_ok_and(|found| found.upper < 11.0)
    /// );
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
            *out = context.clearance(tube, pose, tolerance, None);
        });
        Ok(())
    }

    /// [`clears_tube`](Self::clears_tube) for many tubes, on all cores.
    ///
    /// Writes one result per tube to `out`, in order.
    ///
    /// # Errors
    /// The margin or the resolution is negative or NaN; `out` is then empty.
    pub fn clears_tube_batch(
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
                *out = context.clears_tube(tube, pose, MarginQuery { margin, resolution }, None);
            },
        );
        Ok(())
    }
}

/// A placed tube, memory, and the warm start.
type TubeQuery<'a> = (TubeInMesh<'a>, &'a mut TubeMemory, &'a mut Option<LastPlace>);

/// Step 1: the clearance of a tube as if no turn had been stated, and its pieces. `None` if none
/// was stated.
fn clearance_without_turn<'m>(
    tube: &mut TubeInMesh,
    memory: &'m mut TubeMemory,
    last: &mut Option<LastPlace>,
    tolerance: Real,
) -> Result<Option<(Clearance, &'m MeshPieces)>, ProximityError> {
    let placed = tube.tube;
    let Some(less_known) = placed.without_turn() else { return Ok(None) };
    tube.tube = less_known;
    let answer = clearance(tube, memory, last, tolerance);
    tube.tube = placed;
    answer.map(Some)
}

/// Replaces `out` by the pieces of a placed tube, sorted by arc length.
///
/// # Errors
/// The curve of a piece is not finite.
fn report_pieces(
    placed: &PlacedTube,
    pieces: &MeshPieces,
    out: &mut Vec<TubePiece>,
) -> Result<(), ProximityError> {
    out.clear();
    for PendingPiece { piece, lower, .. } in pieces.all() {
        let outer = placed.outer(piece);
        placed.check_finite(piece, &outer)?;
        out.push(placed.report(piece, &outer, *lower));
    }
    out.sort_unstable_by(|a, b| {
        let [from, to] = [0, 1].map(|end| a.arc_lengths[end].total_cmp(&b.arc_lengths[end]));
        a.section.cmp(&b.section).then(from).then(to)
    });
    Ok(())
}

impl<'a> Context<'a> {
    pub(super) fn clearance(
        self,
        tube: &'a Tube,
        pose: &Pose,
        tolerance: Real,
        frame: Option<Real>,
    ) -> Result<Clearance, ProximityError> {
        let (mut tube, memory, last) = self.tube_in_mesh(tube, pose, frame)?;
        let known =
            clearance_without_turn(&mut tube, memory, last, tolerance)?.map(|(known, _)| known);
        let (answer, _) = clearance(&mut tube, memory, last, tolerance)?;
        Ok(known.map_or(answer, |known| known.and(answer, tolerance)))
    }

    fn clearance_pieces(
        self,
        tube: &'a Tube,
        pose: &Pose,
        tolerance: Real,
        out: &mut Vec<TubePiece>,
    ) -> Result<Clearance, ProximityError> {
        let (mut tube, memory, last) = self.tube_in_mesh(tube, pose, None)?;
        let placed = tube.tube;
        let mut known = None;
        let without_turn = clearance_without_turn(&mut tube, memory, last, tolerance)?;
        if let (Some(less_known), Some((answer, pieces))) = (placed.without_turn(), without_turn) {
            report_pieces(&less_known, pieces, out)?;
            known = Some(answer);
        }
        let (answer, pieces) = clearance(&mut tube, memory, last, tolerance)?;
        if known.is_none_or(|known| answer.lower >= known.lower) {
            report_pieces(&placed, pieces, out)?;
        }
        Ok(known.map_or(answer, |known| known.and(answer, tolerance)))
    }

    pub(super) fn clears_tube(
        self,
        tube: &'a Tube,
        pose: &Pose,
        MarginQuery { margin, resolution }: MarginQuery,
        frame: Option<Real>,
    ) -> Result<Decision, ProximityError> {
        let (mut tube, memory, last) = self.tube_in_mesh(tube, pose, frame)?;
        let placed = tube.tube;
        let Some(less_known) = placed.without_turn() else {
            return clears_tube(&mut tube, memory, last, margin, resolution);
        };
        tube.tube = less_known;
        let decision = clears_tube(&mut tube, memory, last, margin, resolution);
        tube.tube = placed;
        Decision::better_of(decision, || clears_tube(&mut tube, memory, last, margin, resolution))
    }

    /// Places the tube in the mesh's frame and returns it with the warm start of tube queries.
    fn tube_in_mesh(
        self,
        tube: &'a Tube,
        pose: &Pose,
        frame: Option<Real>,
    ) -> Result<TubeQuery<'a>, ProximityError> {
        let (search, Remembered { tube: memory, places, .. }) = self.search();
        let tube = PlacedTube::new(tube, pose, search.hierarchy.mesh_reach)?;
        let tube = frame.map_or(tube, |size| tube.posed(size, 1.0));
        let tube = TubeInMesh { search: PlacedMeshSearch::at_rest(search), tube };
        Ok((tube, memory, &mut places.tube))
    }
}
