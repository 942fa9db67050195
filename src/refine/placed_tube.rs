//! A tube at a pose, in the mesh's frame; its pieces, and how they are halved.

use crate::answer::{PlacementFault, ProximityError};
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
    /// replaced by the tube's reach + the distance + the longest edge. Errors grow more
    /// slowly than distances, so the computed distance of a farther triangle is at least that
    /// distance less the slack.
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
            return Err(PlacementFault::TubeOutOfRange { limit: COORDINATE_LIMIT }.into());
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
    pub(super) fn gains_from_tightening(&self) -> bool {
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
    #[cfg(feature = "robots")]
    pub(super) fn beside(&mut self, other: &Self) {
        self.slack = slack_for(self.reach + other.reach);
    }

    /// The same shape as one instant of a motion: flat ends that may become round count as round.
    pub(crate) fn moving(self) -> Self {
        Self { is_moving: true, ..self }
    }

    /// The same tube without its stated turn, if that leaves less known of it. All bounds of the
    /// result hold for `self`.
    pub(crate) fn without_turn(self) -> Option<Self> {
        self.tube.is_turn_all_that_is_known().then_some(Self { turn: None, ..self })
    }

    /// The same tube, if its pose is the product of its pose in a scene and the inverse of the
    /// mesh's pose there. `size`: the largest coordinate of the mesh and of its pose. `products`:
    /// how many such products are rounded, one for a mesh at rest.
    ///
    /// **Rounding.** Let M be the largest coordinate of tube and mesh in the scene. A rotation
    /// keeps lengths, so `M <= 2 reach + size`. Two poses whose product is rounded place a point
    /// less than 400 u M from its place (`scene::distance_cache`, step 3). That is less than the
    /// slack of 8 (reach + size). The errors of several products add up.
    pub(crate) fn posed(self, size: Real, products: Real) -> Self {
        let more = 8.0 * products * (self.reach + size);
        Self { slack: self.slack + slack_for(more), reach: self.reach + more, ..self }
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

/// A piece of one section, between two ticks.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Piece {
    pub section: u32,
    pub from: u32,
    pub to: u32,
}

/// A piece end closer to a flat face than `ROOM` times [`Section::room`] must end flat: a round end
/// would stick out of the face. 1/8 more than a ball needs, because a body is wider than the tube.
const ROOM: Real = 1.125;

/// Which ends of a piece are near one of the faces of its section.
fn near_faces(faces: [Option<EndFace>; 2], section: &Section, arcs: [Real; 2]) -> [bool; 2] {
    [
        faces[0].is_some() && arcs[0] - section.start < ROOM * section.room(0),
        faces[1].is_some() && section.end - arcs[1] < ROOM * section.room(1),
    ]
}

/// The most pieces that a section starts with. Pieces near the wall are halved later; without the
/// limit thin wires would start with millions.
const MAX_INITIAL_PIECES: u32 = 1024;

impl PlacedTube<'_> {
    /// Returns the arc lengths of a piece's ends.
    pub(crate) fn arcs(&self, piece: &Piece) -> [Real; 2] {
        let section = self.section(piece.section);
        [piece.from, piece.to].map(|tick| self.tube.arc(section, tick))
    }

    /// Returns the smallest piece that contains the range between two shares of a section.
    pub(crate) fn between(&self, section: u32, shares: [Real; 2]) -> Piece {
        let [from, to] = self.tube.ticks_around(self.section(section), shares);
        Piece { section, from, to }
    }

    /// Returns the range of shares of its section that a piece covers.
    pub(crate) fn shares(&self, piece: &Piece) -> [Real; 2] {
        let section = self.section(piece.section);
        [piece.from, piece.to].map(|tick| self.tube.share(section, tick))
    }

    /// Which ends of a piece must end flat so that its body does not stick out of a nearby face.
    pub(crate) fn exposed(&self, section: &Section, arcs: [Real; 2]) -> [bool; 2] {
        near_faces(self.faces(section), section, arcs)
    }

    /// Whether a place of a piece may be a disc that is no ball, in this shape or another one of
    /// its motion.
    #[cfg(feature = "robots")]
    pub(super) fn may_have_discs(&self, section: &Section, arcs: [Real; 2]) -> bool {
        near_faces(section.faces, section, arcs) != [false; 2]
    }

    /// Fills `pieces` with the initial pieces. A stack takes the last one first.
    ///
    /// The pieces near faces come first, so they are processed last. They cost most, and an upper
    /// bound from the other pieces prunes most of them.
    pub(crate) fn begin(&self, coarse: Real, pieces: &mut Vec<Piece>) {
        let sections = (0..self.sections().len() as u32).rev();
        pieces.clear();
        for number in sections.clone() {
            let [first, _, last] = self.ranges(number);
            [first, last].into_iter().flatten().for_each(|piece| pieces.push(piece));
        }
        for number in sections {
            if let [_, Some(middle), _] = self.ranges(number) {
                pieces.extend(self.divided(middle, coarse).rev());
            }
        }
    }

    /// Appends the initial pieces in their order along the tube.
    #[cfg(feature = "robots")]
    pub(super) fn begin_along(&self, coarse: Real, mut push: impl FnMut(Piece)) {
        for number in 0..self.sections().len() as u32 {
            let [first, middle, last] = self.ranges(number);
            first.into_iter().for_each(&mut push);
            middle.into_iter().flat_map(|middle| self.divided(middle, coarse)).for_each(&mut push);
            last.into_iter().for_each(&mut push);
        }
    }

    /// Returns the range of a section that is clear of its faces, between the ranges at its faces.
    pub(crate) fn ranges(&self, number: u32) -> [Option<Piece>; 3] {
        let section = self.section(number);
        let [from, to] = self.between_faces(number);
        [[section.first, from], [from, to], [to, section.last]]
            .map(|[from, to]| (from < to).then_some(Piece { section: number, from, to }))
    }

    /// Returns the parts of a piece that deviate from their chords by about `coarse`, at most
    /// [`MAX_INITIAL_PIECES`].
    fn divided(
        &self,
        piece: Piece,
        coarse: Real,
    ) -> impl DoubleEndedIterator<Item = Piece> + use<> {
        let Piece { section, from, to } = piece;
        let count = if to - from == 1 {
            1
        } else {
            let [start, end] = self.arcs(&piece);
            // On average the deviation is k l^2 / 8, and the turn k l <= 1 rad.
            let curvature = self.section(section).mean_curvature;
            let longest = (8.0 * coarse / curvature).sqrt().min(1.0 / curvature);
            // The cast saturates, and NaN becomes 0.
            let count = ((end - start) / longest).ceil() as u32;
            count.clamp(1, MAX_INITIAL_PIECES).min(to - from)
        };
        let tick = move |k: u32| {
            (u64::from(from) + u64::from(to - from) * u64::from(k) / u64::from(count)) as u32
        };
        (0..count).map(move |k| Piece { section, from: tick(k), to: tick(k + 1) })
    }

    /// Returns the ticks of the range of a section that is clear of its faces. The ticks are equal
    /// if no range is clear.
    fn between_faces(&self, number: u32) -> [u32; 2] {
        let section = self.section(number);
        if section.faces.iter().all(Option::is_none) {
            return [section.first, section.last];
        }
        let [first, last] = self.faces(section).map(|face| face.is_some());
        let room = [0, 1].map(|end| ROOM * section.room(end));
        let needed = room[0] * Real::from(u8::from(first)) + room[1] * Real::from(u8::from(last));
        if needed > 0.0 && section.end - section.start <= needed {
            return if first { [section.last; 2] } else { [section.first; 2] };
        }
        let from =
            if first { self.tube.tick(section, section.start + room[0]) } else { section.first };
        // The last tick before the room.
        let to = if last {
            self.tube.tick(section, section.end - room[1]).saturating_sub(1).max(section.first)
        } else {
            section.last
        };
        if from < to { [from, to] } else { [to.max(section.first); 2] }
    }

    /// Returns the two halves of a piece; `None` for a piece of one tick.
    ///
    /// At a face the part at the face has the length l with `k l^2 = aim`, if that is shorter than
    /// half: its body in case 3 exceeds the tube by `aim / 2` then.
    pub(crate) fn halves(&self, piece: &Piece, aim: Real) -> Option<[Piece; 2]> {
        if piece.to - piece.from < 2 {
            return None;
        }
        let section = self.section(piece.section);
        let arcs = self.arcs(piece);
        let middle = 0.5 * (arcs[0] + arcs[1]);
        let near = (aim / self.tube.bound(section, [piece.from, piece.to]).curvature).sqrt();
        let faces = self.faces(section);
        let at = [
            piece.from == section.first && faces[0].is_some(),
            piece.to == section.last && faces[1].is_some(),
        ];
        let arc = match at {
            [true, false] => middle.min(arcs[0] + near),
            [false, true] => middle.max(arcs[1] - near),
            _ => middle,
        };
        let tick = self.tube.tick(section, arc).max(piece.from + 1).min(piece.to - 1);
        Some([Piece { to: tick, ..*piece }, Piece { from: tick, ..*piece }])
    }
}
