//! A tube at a pose, in the mesh's frame.

use super::piece::Piece;
use crate::answer::ProximityError;
use crate::curve::{EndFace, Section, Tube};
use crate::distance::Scalar;
use crate::pair::{PlacedLink, rigid_pose};
use crate::robot::COORDINATE_LIMIT;
use parry3d_f64::math::{Pose, Real, Vector};

/// Lengths below this value, 2^-500, count as rounding. A square below the range of numbers errs by
/// up to 2^-1074, so a length errs by up to 2^-536. No centreline adds enough such lengths to reach
/// 2^-500.
const MIN_LENGTH: Real = Real::from_bits((1023 - 500) << 52);

/// A tube at a pose in the frame of a mesh.
#[derive(Clone, Copy)]
pub(crate) struct PlacedTube<'a> {
    pub(crate) tube: &'a Tube,
    /// Its rotation has unit length.
    pub(crate) pose: Pose,
    /// A bound on the rounding error of any length that is computed or measured.
    ///
    /// **Claim.** slack = 128 u reach + [`MIN_LENGTH`] suffices, where `reach` is the tube's
    /// largest coordinate after the pose plus that of the mesh.
    ///
    /// **Proof.** A measured distance errs by 16 u extent, and extent <= 2 reach. A placed point
    /// errs by less than 16 u reach. A bound adds only a few such terms. [`MIN_LENGTH`] covers
    /// lengths whose squares vanish.
    ///
    /// **Near triangles only.** If only triangles within a distance matter, the mesh's reach may be
    /// replaced by the tube's reach + the distance + the longest edge. A farther triangle may
    /// appear nearer only by the error that it would have at that distance.
    pub(crate) slack: Real,
    /// An upper bound on the largest coordinate of the tube after the pose.
    reach: Real,
    /// Whether flat ends that may become round count as round in bodies.
    is_moving: bool,
    /// A bound on the angle (rad) between assumed and true directions near flat ends, if known.
    turn: Option<Real>,
}

/// Returns the rounding bound for coordinates up to `reach`.
fn slack_for(reach: Real) -> Real {
    128.0 * Real::UNIT_ROUNDOFF * reach + MIN_LENGTH
}

impl<'a> PlacedTube<'a> {
    /// Places a tube at a pose; `mesh_reach` is the largest coordinate of the mesh.
    ///
    /// # Errors
    /// The tube has no section, or the pose is not finite, not rigid, or moves the tube out of
    /// range.
    pub(crate) fn new(
        tube: &'a Tube,
        pose: &Pose,
        mesh_reach: Real,
    ) -> Result<Self, ProximityError> {
        let pose = rigid_pose(pose)?;
        let radius =
            tube.sections().iter().fold(0.0, |most: Real, section| most.max(section.radius));
        // A rotation keeps lengths, and a length is at most twice the largest coordinate.
        let reach =
            pose.translation.abs().max_element() + 2.0 * tube.reach() + tube.error() + radius;
        if reach > COORDINATE_LIMIT {
            return Err(ProximityError::TubeOutOfRange { limit: COORDINATE_LIMIT });
        }
        if tube.sections().is_empty() {
            return Err(ProximityError::EmptyTube);
        }
        Ok(Self {
            tube,
            pose,
            slack: slack_for(reach + mesh_reach),
            reach,
            is_moving: false,
            turn: tube.turn(),
        })
    }

    /// Whether a near mesh allows a smaller `slack`.
    pub(super) fn gains_from_sharpening(&self) -> bool {
        slack_for(2.0 * self.reach) < 0.5 * self.slack
    }

    /// Reduces `slack`, given that only triangles within `away` matter.
    pub(super) fn tighten_slack(&mut self, away: Real, longest_edge: impl FnOnce() -> Real) {
        let least = slack_for(2.0 * self.reach + away);
        // The gain must be a factor of two: `longest_edge` visits all edges.
        if least < 0.5 * self.slack {
            self.slack = self.slack.min(slack_for(2.0 * self.reach + away + longest_edge()));
        }
    }

    /// Uses another tube as the obstacle, in place of the mesh.
    pub(super) fn beside(&mut self, other: &Self) {
        self.slack = slack_for(self.reach + other.reach);
    }

    /// The same shape as one instant of a motion: flat ends that may become round count as round.
    pub(crate) fn moving(self) -> Self {
        Self { is_moving: true, ..self }
    }

    /// The same tube without its stated turn, if that leaves less known of it. All bounds of that
    /// tube hold for this one.
    pub(crate) fn without_turn(self) -> Option<Self> {
        self.tube.is_turn_all_that_is_known().then_some(Self { turn: None, ..self })
    }

    /// Returns the bound on the direction error near flat ends, 0 if unknown.
    pub(super) fn turn(&self) -> Real {
        self.turn.unwrap_or(0.0)
    }

    /// Returns the flat ends of a section, with bounds on their directions.
    pub(super) fn all_faces(&self, section: &Section) -> [Option<EndFace>; 2] {
        self.tube.faces(section, self.turn)
    }

    /// Returns the flat ends of a section at which bodies may end flat.
    pub(crate) fn faces(&self, section: &Section) -> [Option<EndFace>; 2] {
        let lasts =
            |face: &EndFace| !self.is_moving || face.persistence.is_safe() && !section.fades;
        let is_sure = |face: &EndFace| lasts(face) && face.tilt < Real::INFINITY;
        self.all_faces(section).map(|face| face.filter(is_sure))
    }

    /// Returns the gap between the bounds of a piece that the unknown or uncertain direction of a
    /// nearby face causes.
    pub(crate) fn direction_uncertainty(&self, piece: &Piece) -> Real {
        let (section, arcs) = (self.section(piece.section), self.arcs(piece));
        if self.tube.is_loose() {
            // The nearest place may be a face at the end of the run of links.
            return section.radius;
        }
        let near = 2.0 * (section.radius + self.tube.error());
        let away = [arcs[0] - section.start, section.end - arcs[1]];
        let of = |end: usize| {
            if away[end] <= near {
                self.tube.direction_uncertainty(section, end, self.turn)
            } else {
                0.0
            }
        };
        of(0).max(of(1))
    }

    /// Whether bodies treat a flat end of the piece as round.
    pub(crate) fn may_become_round(&self, piece: &Piece) -> bool {
        let section = self.section(piece.section);
        let count = |faces: [Option<EndFace>; 2]| {
            [piece.from == section.first, piece.to == section.last]
                .into_iter()
                .zip(faces)
                .filter(|(is_there, face)| *is_there && face.is_some())
                .count()
        };
        count(section.faces) > count(self.faces(section))
    }

    pub(crate) fn sections(&self) -> &'a [Section] {
        self.tube.sections()
    }

    pub(crate) fn section(&self, number: u32) -> &'a Section {
        &self.tube.sections()[number as usize]
    }

    /// Returns a point of the centreline in the mesh's frame.
    pub(crate) fn point(&self, section: &Section, tick: u32) -> Vector {
        self.pose * self.tube.point(section, tick)
    }

    pub(crate) fn slack(&self) -> Real {
        self.slack
    }

    /// Returns the gap between the bounds that the tube's stated error causes: it counts in both
    /// bounds.
    pub(crate) fn position_uncertainty(&self) -> Real {
        2.0 * self.tube.error()
    }

    /// Returns the input segment at an arc length of a section.
    pub(crate) fn segment(&self, number: u32, arc: Real) -> u32 {
        self.tube.segment(number, arc)
    }

    /// Returns the radius of a piece.
    pub(crate) fn radius(&self, piece: &Piece) -> Real {
        self.section(piece.section).radius
    }

    /// Returns a point of the centreline, or a point between two neighbouring samples.
    pub(crate) fn place_at(&self, section: u32, arc: Real) -> Vector {
        let section = self.section(section);
        self.point(section, self.tube.tick(section, arc))
    }

    pub(super) fn longest_section(&self) -> u32 {
        let length = |number: &u32| {
            let section = self.section(*number);
            section.end - section.start
        };
        (0..self.sections().len() as u32)
            .max_by(|a, b| length(a).total_cmp(&length(b)))
            .unwrap_or(0)
    }

    /// Returns the largest radius of all sections.
    pub(super) fn widest(&self) -> Real {
        self.sections().iter().fold(0.0, |most: Real, section| most.max(section.radius))
    }

    /// Returns the line between the ends of a section as a link of radius 0, and the arc lengths of
    /// the ends.
    pub(crate) fn chord(&self, section: u32) -> (PlacedLink, [Real; 2]) {
        let section = self.section(section);
        let ends = [section.first, section.last].map(|tick| self.point(section, tick));
        (PlacedLink::between(ends[0], ends[1], 0.0, [false; 2]), [section.start, section.end])
    }

    /// Returns a flat end in the mesh's frame.
    pub(crate) fn face(&self, face: &EndFace) -> EndFace {
        EndFace {
            centre: self.pose * face.centre,
            outward: self.pose.rotation * face.outward,
            ..*face
        }
    }
}
