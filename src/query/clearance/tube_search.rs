//! The queries of a tube: its clearance between bounds, or only whether it keeps a margin.
//!
//! The centreline is taken in pieces, each in a convex body that is searched like a link. A body that keeps away settles
//! its piece; one that does not gives a triangle, whose nearest point bounds the clearance from above, and the piece is
//! halved where the two bounds are too far apart. So far from the wall one capsule stands for a whole section, and near
//! it the curve is resolved as finely as the answer needs. A chain is a tube whose pieces are straight: their bodies
//! are the links themselves.

use crate::answer::{Clearance, Decision, ProximityError, Witness};
use crate::pair::{Best, Nearest, PlacedLink};
use crate::pieces::{OnTube, Outer, Piece, PlacedTube};
use crate::search::hierarchy::MeshSearch;
use parry3d_f64::math::{Real, Vector};

/// After so many pieces none is halved any more, and the bounds are what they are: a limit on the time that a query takes,
/// far above what any tolerance needs that the samples allow.
const MOST_PIECES: u32 = 1 << 16;

/// A tube on its way through a mesh.
pub(crate) struct TubeSearch<'a> {
    pub search: MeshSearch<'a>,
    pub tube: PlacedTube<'a>,
    /// Pieces that wait for their turn, the next one last.
    pub pieces: &'a mut Vec<Piece>,
}

/// Where a query ended, for the next to begin.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Start {
    pub triangle: u32,
    pub section: u32,
    arc: Real,
}

/// What a query about a tube leaves for the next.
#[derive(Clone, Default)]
pub(crate) struct TubeMemory {
    pub pieces: Vec<Piece>,
    pub last: Option<Start>,
}

impl TubeMemory {
    pub(crate) fn forget(&mut self) {
        self.last = None;
    }
}

/// The least upper bound so far.
#[derive(Clone, Copy)]
pub(crate) struct Found {
    pub upper: Real,
    pub section: u32,
    pub witness: Witness,
}

impl Found {
    /// Where the next query begins.
    fn start(&self) -> Start {
        let Witness { triangle, arc_length, .. } = self.witness;
        Start { triangle, section: self.section, arc: arc_length }
    }
}

impl TubeSearch<'_> {
    /// The clearance, with bounds no farther apart than the tolerance where the tube allows that; and where it was found.
    ///
    /// Each piece that is settled is handed over, with its body and how far away that is at least. Those that were not
    /// needed, because the tube touches the mesh, are left in `pieces`.
    pub(crate) fn clearance(
        &mut self,
        tolerance: Real,
        last: Option<Start>,
        mut settled: impl FnMut(&Piece, &Outer, Real),
    ) -> Result<(Clearance, Start), ProximityError> {
        let uncertainty = self.tube.uncertainty();
        // So that the bounds of the answer are no farther apart than asked for after they are rounded.
        let aim = (tolerance + uncertainty - 4.0 * self.tube.slack()).max(0.0);
        let mut left = MOST_PIECES;
        let mut best = self.first_bound(last);
        self.begin(best.upper.max(tolerance));
        let mut lower = Real::INFINITY;
        let mut settle = |piece: &Piece, outer: &Outer, apart: Real| {
            lower = lower.min(apart);
            settled(piece, outer, apart);
        };
        while let Some(piece) = self.pieces.pop() {
            let bound = best.upper - aim;
            // Nothing below 0 is left to be found.
            if bound < 0.0 || best.upper <= 0.0 {
                self.pieces.push(piece);
                break;
            }
            let outer = self.outer(&piece)?;
            left -= u32::from(left > 0);
            let is_wide =
                left > 0 && outer.over > 2.0 * aim && (outer.is_flat() || outer.over > 0.25 * best.upper);
            if is_wide && let Some(halves) = self.halves(&piece, &outer, aim) {
                if self.search.may_meet(&outer.body, bound) {
                    self.pieces.extend(halves);
                } else {
                    settle(&piece, &outer, bound);
                }
                continue;
            }
            let start = [Some(best.witness.triangle), None];
            let Some(nearest) = self.search.nearest(&outer.body, Best::within(bound), start).nearest() else {
                settle(&piece, &outer, bound);
                continue;
            };
            let found = self.witness(&piece, &outer, &nearest);
            if found.upper < best.upper {
                best = found;
            }
            if nearest.distance >= best.upper - aim || left == 0 {
                settle(&piece, &outer, nearest.distance);
            } else if let Some(halves) = self.halves(&piece, &outer, aim) {
                self.extend_nearest_last(halves, found.witness.arc_length);
            } else {
                settle(&piece, &outer, nearest.distance);
            }
        }
        let Found { upper, section, witness } = best;
        let lower = if self.pieces.is_empty() { lower.min(upper) } else { 0.0 };
        let resolved = upper - lower <= tolerance + uncertainty;
        Ok((Clearance { lower, upper, resolved, uncertainty, section, witness }, best.start()))
    }

    /// Whether the tube keeps more than the margin away; and where it does not.
    pub(crate) fn clears(
        &mut self,
        margin: Real,
        resolution: Real,
        last: Option<Start>,
    ) -> Result<(Decision, Option<Start>), ProximityError> {
        let mut decision = Decision::Clear;
        self.begin(margin.max(resolution));
        while let Some(piece) = self.pieces.pop() {
            let outer = self.outer(&piece)?;
            let is_wide =
                outer.over > 2.0 * resolution && outer.over > 0.5 * self.tube.radius(&piece).max(margin);
            if is_wide && let Some(halves) = self.halves(&piece, &outer, resolution) {
                if self.search.may_meet(&outer.body, margin) {
                    self.pieces.extend(halves);
                }
                continue;
            }
            let start = [last.map(|last| last.triangle), None];
            let Some(nearest) = self.search.nearest(&outer.body, Best::within(margin), start).nearest()
            else {
                continue;
            };
            let found = self.witness(&piece, &outer, &nearest);
            let upper = found.upper;
            if upper <= margin {
                return Ok((Decision::Contact, Some(found.start())));
            }
            if upper - nearest.distance <= resolution {
                decision = Decision::Undecided;
            } else if let Some(halves) = self.halves(&piece, &outer, 0.25 * outer.over) {
                self.extend_nearest_last(halves, found.witness.arc_length);
            } else {
                self.check_resolved(upper - nearest.distance, ("resolution", resolution))?;
                decision = Decision::Undecided;
            }
        }
        Ok((decision, None))
    }

    /// A first upper bound: from the triangle of the last answer, or from the one nearest to the longest section's chord.
    fn first_bound(&mut self, last: Option<Start>) -> Found {
        let sections = self.tube.sections();
        if let Some(last) = last.filter(|last| (last.section as usize) < sections.len()) {
            let place = self.tube.place_at(last.section, last.arc);
            return self.witness_at(last.section, last.arc, &self.nearest_to(place, last.triangle));
        }
        let length = |number: &u32| {
            let section = &sections[*number as usize];
            section.end - section.start
        };
        let longest = (0..sections.len() as u32).max_by(|a, b| length(a).total_cmp(&length(b))).unwrap_or(0);
        let (chord, arcs) = self.tube.chord(longest);
        let nearest = self.search.nearest(&chord, Best::within(Real::INFINITY), [None; 2]).nearest();
        let nearest = nearest.unwrap_or_else(|| self.search.any(&chord));
        let arc = chord.share_of(nearest.on_mesh) * (arcs[1] - arcs[0]) + arcs[0];
        self.witness_at(longest, arc, &nearest)
    }

    /// The pieces to begin with: those that leave their chord by no more than what is to be decided, or than a part of
    /// the radius where that is less.
    pub(crate) fn begin(&mut self, scale: Real) {
        let radius =
            self.tube.sections().iter().fold(0.0, |radius: Real, section| radius.max(section.radius));
        self.tube.begin(scale.max(0.25 * radius), self.pieces);
    }

    /// # Errors
    /// The curve is not finite there.
    pub(crate) fn outer(&self, piece: &Piece) -> Result<Outer, ProximityError> {
        let outer = self.tube.outer(piece);
        if outer.body.is_finite() {
            Ok(outer)
        } else {
            Err(ProximityError::CurveNotFinite { arc_length: self.tube.arcs(piece)[0] })
        }
    }

    /// The halves of a piece whose body can become narrower.
    pub(crate) fn halves(&self, piece: &Piece, outer: &Outer, aim: Real) -> Option<[Piece; 2]> {
        if outer.over > self.tube.slack() { self.tube.halves(piece, aim) } else { None }
    }

    fn extend_nearest_last(&mut self, halves: [Piece; 2], arc: Real) {
        let [first, second] = halves;
        let is_in_first = arc < self.tube.arcs(&first)[1];
        self.pieces.extend(if is_in_first { [second, first] } else { [first, second] });
    }

    pub(crate) fn witness(&self, piece: &Piece, outer: &Outer, nearest: &Nearest) -> Found {
        let arcs = self.tube.arcs(piece);
        let arc = outer.body.share_of(nearest.on_mesh) * (arcs[1] - arcs[0]) + arcs[0];
        let found = self.witness_at(piece.section, arc, nearest);
        if nearest.distance > 0.0 || found.upper <= 0.0 {
            return found;
        }
        // The body's common point with a triangle that crosses it may lie on its boundary, from where nobody sees that
        // the tube is crossed too: one nearer to its middle shows it.
        let middle = outer.body.start() + outer.body.along() * 0.5;
        let deeper = nearest.on_mesh + (middle - nearest.on_mesh) * 0.125;
        let deeper = self.witness_at(piece.section, arc, &self.nearest_to(deeper, nearest.triangle));
        if deeper.upper < found.upper { deeper } else { found }
    }

    /// The point of a triangle nearest to a point.
    fn nearest_to(&self, point: Vector, triangle: u32) -> Nearest {
        let corners = self.search.hierarchy.mesh.corners(triangle);
        PlacedLink::between(point, point, 0.0, [false; 2]).measure(triangle, corners)
    }

    fn witness_at(&self, section: u32, arc: Real, nearest: &Nearest) -> Found {
        let Nearest { triangle, on_mesh, .. } = *nearest;
        let OnTube { upper, arc, point } = self.tube.near(section, arc, on_mesh);
        let segment = self.tube.segment(section, arc);
        let witness = Witness { on_robot: point, on_mesh, triangle, arc_length: arc, segment };
        Found { upper, section, witness }
    }

    /// # Errors
    /// The bounds are farther apart than was asked for, but for rounding: the samples allow no more.
    pub(crate) fn check_resolved(
        &self,
        possible: Real,
        (parameter, tolerance): (&'static str, Real),
    ) -> Result<(), ProximityError> {
        // Written so that NaN is an error.
        if possible <= tolerance + 16.0 * self.tube.slack() {
            Ok(())
        } else {
            Err(ProximityError::ToleranceTooFine { parameter, tolerance, possible })
        }
    }
}
