//! The tube in the mesh's frame.

use super::piece::Piece;
use crate::answer::ProximityError;
use crate::distance::Scalar;
use crate::pair::{PlacedLink, rigid_pose};
use crate::robot::{COORDINATE_LIMIT, EndFace, Section, Tube};
use parry3d_f64::math::{Pose, Real, Vector};

/// Lengths below this, 2^-500, are taken for rounding. A square errs by up to 2^-1074 where it
/// falls below the range of numbers, so a length by 2^-536; and no centreline adds up as many as
/// would make 2^-500 of it.
const MIN_LENGTH: Real = Real::from_bits((1023 - 500) << 52);

/// A tube at a pose in the frame of a mesh.
#[derive(Clone, Copy)]
pub(crate) struct PlacedTube<'a> {
    pub(crate) tube: &'a Tube,
    /// Its rotation is of unit length.
    pub(crate) pose: Pose,
    /// What rounding can do to any length that is computed here or measured.
    ///
    /// Every coordinate of the problem is at most `reach` = the tube's reach after the pose and
    /// the mesh's. A measured distance errs by 16 u for each unit of extent, which is at most
    /// 2 reach; a placed point by less than 16 u reach; and no bound here adds up more than a
    /// few such terms. 128 u reach is more than all of them. Beside it stands what
    /// lengths lose whose squares vanish.
    ///
    /// In the place of the mesh's reach, that of a triangle will do that is at most some distance
    /// away from the tube: the tube's, the distance, and the triangle's longest edge. For one
    /// that is farther away in truth can seem nearer by no more than the error that it would
    /// have at that distance.
    pub(crate) slack: Real,
    /// The largest coordinate of the tube after the pose, or more.
    reach: Real,
    /// Whether bodies have to hold what the tube may soon be: flat ends that need not last are
    /// then round.
    is_moving: bool,
    /// How far directions near flat ends may be off from the tube's, if that is known.
    turn: Option<Real>,
}

/// What rounding can do where no coordinate is larger than `reach`.
fn slack_for(reach: Real) -> Real {
    128.0 * Real::UNIT_ROUNDOFF * reach + MIN_LENGTH
}

impl<'a> PlacedTube<'a> {
    /// # Errors
    /// The tube has no section, or the pose is not finite or not rigid, or moves it out of range.
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

    /// Whether rounding may be less where the mesh is near.
    pub(super) fn gains_from_sharpening(&self) -> bool {
        slack_for(2.0 * self.reach) < 0.5 * self.slack
    }

    /// Takes less for rounding where no triangle matters that is farther than `away`, if that is
    /// less.
    pub(super) fn tighten_slack(&mut self, away: Real, longest_edge: impl FnOnce() -> Real) {
        let least = slack_for(2.0 * self.reach + away);
        // What is less by a little is not worth looking at all edges for.
        if least < 0.5 * self.slack {
            self.slack = self.slack.min(slack_for(2.0 * self.reach + away + longest_edge()));
        }
    }

    /// Counts another tube as what it is near to.
    pub(super) fn beside(&mut self, other: &Self) {
        self.slack = slack_for(self.reach + other.reach);
    }

    /// The same shape as a moment of a motion, to which bodies at flat ends have to be prepared.
    pub(crate) fn moving(self) -> Self {
        Self { is_moving: true, ..self }
    }

    /// The same tube as if its turn had not been stated, if that is another tube of which less is
    /// known. All bounds of that one hold for this one.
    pub(crate) fn without_turn(self) -> Option<Self> {
        self.tube.is_turn_all_that_is_known().then_some(Self { turn: None, ..self })
    }

    /// How far directions near flat ends may be off from the tube's, as far as that is known.
    pub(super) fn turn(&self) -> Real {
        self.turn.unwrap_or(0.0)
    }

    /// The flat ends of a section, with what is known of their directions.
    pub(super) fn all_faces(&self, section: &Section) -> [Option<EndFace>; 2] {
        self.tube.faces(section, self.turn)
    }

    /// The flat ends of a section that bodies may end with.
    pub(crate) fn faces(&self, section: &Section) -> [Option<EndFace>; 2] {
        let lasts =
            |face: &EndFace| !self.is_moving || face.persistence.is_safe() && !section.fades;
        let is_sure = |face: &EndFace| lasts(face) && face.tilt < Real::INFINITY;
        self.all_faces(section).map(|face| face.filter(is_sure))
    }

    /// How far apart the bounds of a piece have to be because of what was stated of the direction
    /// of a face nearby, or was not.
    pub(crate) fn direction_uncertainty(&self, piece: &Piece) -> Real {
        let (section, arcs) = (self.section(piece.section), self.arcs(piece));
        if self.tube.is_loose() {
            // A face at the end of the run of links may be what is near.
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

    /// Whether a piece has a flat end that bodies take for round.
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

    /// A point of the centreline in the mesh's frame.
    pub(crate) fn point(&self, section: &Section, tick: u32) -> Vector {
        self.pose * self.tube.point(section, tick)
    }

    pub(crate) fn slack(&self) -> Real {
        self.slack
    }

    /// What the error that the tube states for itself costs a clearance: it counts in both bounds.
    pub(crate) fn position_uncertainty(&self) -> Real {
        2.0 * self.tube.error()
    }

    /// The segment of the input at an arc length of a section.
    pub(crate) fn segment(&self, number: u32, arc: Real) -> u32 {
        self.tube.segment(number, arc)
    }

    /// The radius of a piece.
    pub(crate) fn radius(&self, piece: &Piece) -> Real {
        self.section(piece.section).radius
    }

    /// A point of the centreline, or one between two samples nearby.
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

    /// The largest radius of its sections.
    pub(super) fn widest(&self) -> Real {
        self.sections().iter().fold(0.0, |most: Real, section| most.max(section.radius))
    }

    /// The line between the ends of a section, and their arc lengths.
    pub(crate) fn chord(&self, section: u32) -> (PlacedLink, [Real; 2]) {
        let section = self.section(section);
        let ends = [section.first, section.last].map(|tick| self.point(section, tick));
        (PlacedLink::between(ends[0], ends[1], 0.0, [false; 2]), [section.start, section.end])
    }

    /// A flat end in the mesh's frame.
    pub(crate) fn face(&self, face: &EndFace) -> EndFace {
        EndFace {
            centre: self.pose * face.centre,
            outward: self.pose.rotation * face.outward,
            ..*face
        }
    }
}
