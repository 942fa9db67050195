//! A tube in a mesh: bounding bodies of its pieces, their nearest triangles, and upper bounds.

use super::bounding_body::{BoundingBody, MOST_CORES};
use super::placed_tube::{Piece, PlacedTube};
use super::refinable::{Refinable, UpperBound};
use super::tube_point::TubePoint;
use crate::answer::{ProximityError, Witness};
use crate::pair::{Best, Nearest, PlacedLink};
use crate::search::hierarchy::PlacedMeshSearch;
use parry3d_f64::math::{Real, Vector};

/// A tube and the mesh around it.
pub(crate) struct TubeInMesh<'a> {
    pub search: PlacedMeshSearch<'a>,
    pub tube: PlacedTube<'a>,
}

/// An upper bound on the clearance, and the witness that realises it.
#[derive(Clone, Copy)]
pub(crate) struct MeshUpperBound {
    pub upper: Real,
    pub section: u32,
    pub witness: Witness,
}

impl MeshUpperBound {
    /// Returns the smaller bound; ties return `self`.
    fn nearer(self, other: Self) -> Self {
        if other.upper < self.upper { other } else { self }
    }
}

impl UpperBound for MeshUpperBound {
    fn upper(&self) -> Real {
        self.upper
    }

    fn triangle(&self) -> Option<u32> {
        Some(self.witness.triangle)
    }

    fn tie(&self) -> [u32; 2] {
        [self.witness.triangle, self.section]
    }
}

impl Refinable for TubeInMesh<'_> {
    type Piece = Piece;
    type Body = BoundingBody;
    type Nearest = Nearest;
    type Upper = MeshUpperBound;

    fn body(&self, piece: &Piece) -> BoundingBody {
        self.tube.outer(piece)
    }

    fn place(&self, piece: &Piece) -> [u32; 4] {
        [piece.section, piece.from, 0, 0]
    }

    fn check_finite(&self, piece: &Piece, outer: &BoundingBody) -> Result<(), ProximityError> {
        self.tube.check_finite(piece, outer)
    }

    fn halves(&self, piece: &Piece, outer: &BoundingBody, aim: Real) -> Option<[Piece; 2]> {
        if outer.narrows > 0.5 * self.tube.slack() { self.tube.halves(piece, aim) } else { None }
    }

    fn may_meet(&mut self, outer: &BoundingBody, bound: Real) -> bool {
        self.search.may_meet(&outer.body, bound)
    }

    fn nearest(
        &mut self,
        outer: &BoundingBody,
        bound: Real,
        start: Option<u32>,
    ) -> Option<Nearest> {
        self.search.nearest(&outer.body, Best::within(bound), start).nearest()
    }

    fn distance(nearest: &Nearest) -> Real {
        nearest.distance
    }

    /// Returns the upper bound that the triangle nearest to a piece's body yields.
    fn found(&self, piece: &Piece, outer: &BoundingBody, nearest: &Nearest) -> MeshUpperBound {
        let arcs = self.tube.arcs(piece);
        let arc = outer.body.share_of(nearest.on_mesh) * (arcs[1] - arcs[0]) + arcs[0];
        let found = self.found_at(piece.section, arc, nearest);
        if nearest.distance > 0.0 || found.upper <= 0.0 {
            return found;
        }
        // A triangle that crosses the body may touch it at a boundary point that is outside the
        // tube. The triangle's point nearest to a place 1/8 of the way to the body's middle shows
        // whether it also crosses the tube.
        let middle = outer.body.start() + outer.body.along() * 0.5;
        let deeper = nearest.on_mesh + (middle - nearest.on_mesh) * 0.125;
        let deeper = self.found_at(piece.section, arc, &self.nearest_to(deeper, nearest.triangle));
        let mut found = found.nearer(deeper);
        // At a flat end the triangle's point may lie in the plane of the face, where rounding
        // decides on which side. The body without an outer layer gives points farther inside.
        let (mut depth, corners) = (1.0, self.search.corners(nearest.triangle));
        for _ in 0..MOST_CORES {
            if found.upper <= 0.0 {
                break;
            }
            let Some(core) = self.tube.core(piece, outer, depth) else { break };
            let nearest = core.measure(nearest.triangle, corners);
            if nearest.distance > 0.0 {
                break;
            }
            found = found.nearer(self.found_at(piece.section, arc, &nearest));
            depth *= 8.0;
        }
        found
    }

    fn is_in_first_half(&self, found: &MeshUpperBound, halves: &[Piece; 2]) -> bool {
        found.witness.arc_length < self.tube.arcs(&halves[0])[1]
    }

    fn radius(&self, piece: &Piece) -> Real {
        self.tube.radius(piece)
    }

    fn direction_uncertainty(&self, piece: &Piece) -> Real {
        self.tube.direction_uncertainty(piece)
    }

    fn may_become_round(&self, piece: &Piece) -> bool {
        self.tube.may_become_round(piece)
    }

    fn position_uncertainty(&self) -> Real {
        self.tube.position_uncertainty()
    }

    fn slack(&self) -> Real {
        self.tube.slack()
    }
}

impl TubeInMesh<'_> {
    /// Fills `pieces` with initial pieces. They deviate from their chords by about max(`scale`,
    /// widest radius / 4).
    pub(crate) fn begin(&self, scale: Real, pieces: &mut Vec<Piece>) {
        self.tube.begin(scale.max(0.25 * self.tube.widest()), pieces);
    }

    /// Fills `pieces` with initial pieces that turn by about 1 rad on average, or less.
    pub(crate) fn begin_coarse(&self, pieces: &mut Vec<Piece>) {
        self.tube.begin(Real::INFINITY, pieces);
    }

    /// Whether a near mesh allows a smaller `slack`.
    pub(crate) fn gains_from_tightening(&self) -> bool {
        self.tube.gains_from_tightening()
    }

    /// Reduces `slack`, given that only triangles within `away` matter.
    pub(crate) fn tighten_slack(&mut self, away: Real) {
        self.tube.tighten_slack(away, || self.search.longest_at_rest());
    }

    /// Returns a first upper bound: from the triangle nearest to the chord of the longest section.
    pub(crate) fn first_bound(&mut self) -> MeshUpperBound {
        let longest = self.tube.longest_section();
        let (chord, arcs) = self.tube.chord(longest);
        let nearest = self.search.nearest(&chord, Best::within(Real::INFINITY), None).nearest();
        let nearest = nearest.unwrap_or_else(|| self.search.any(&chord));
        let arc = chord.share_of(nearest.on_mesh) * (arcs[1] - arcs[0]) + arcs[0];
        self.found_at(longest, arc, &nearest)
    }

    /// Returns the upper bound that a triangle yields at a place of the tube.
    pub(crate) fn bound_at(&self, section: u32, arc: Real, triangle: u32) -> MeshUpperBound {
        let place = self.tube.place_at(section, arc);
        self.found_at(section, arc, &self.nearest_to(place, triangle))
    }

    /// Returns the point of a triangle nearest to a point.
    fn nearest_to(&self, point: Vector, triangle: u32) -> Nearest {
        let corners = self.search.corners(triangle);
        PlacedLink::between(point, point, 0.0, [false; 2]).measure(triangle, corners)
    }

    fn found_at(&self, section: u32, arc: Real, nearest: &Nearest) -> MeshUpperBound {
        let Nearest { triangle, on_mesh, .. } = *nearest;
        let TubePoint { upper, arc, point } = self.tube.near(section, arc, on_mesh);
        let segment = self.tube.segment(section, arc);
        let witness = Witness { on_robot: point, on_mesh, triangle, arc_length: arc, segment };
        MeshUpperBound { upper, section, witness }
    }
}
