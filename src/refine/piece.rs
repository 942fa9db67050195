//! Pieces of the centreline, and how they are halved.

use super::bounding_body::BoundingBody;
use super::placed_tube::PlacedTube;
use super::tube_pair::SectionRange;
use crate::curve::Section;
use parry3d_f64::math::Real;

/// A piece of one section, between two ticks.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Piece {
    pub section: u32,
    pub from: u32,
    pub to: u32,
}

/// A piece end closer to a flat face than `ROOM` times [`Section::room`] must end flat: a round end
/// would stick out of the face. 1/8 more than a ball needs, because a body is wider than the tube.
const ROOM: Real = 1.125;

/// The most pieces that a section starts with. Pieces near the wall are halved later; without the
/// limit thin wires would start with millions.
const MAX_PIECES: u32 = 1024;

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

    /// Returns a piece as a range of its section, which is the same in every shape, with its body.
    pub(super) fn section_range<'o>(
        &self,
        piece: &Piece,
        outer: &'o BoundingBody,
    ) -> SectionRange<'o> {
        SectionRange {
            section: piece.section,
            shares: self.shares(piece),
            outer,
            radius: self.radius(piece),
        }
    }

    /// Which ends of a piece must end flat so that its body does not stick out of a nearby face.
    pub(crate) fn exposed(&self, section: &Section, arcs: [Real; 2]) -> [bool; 2] {
        let faces = self.faces(section);
        [
            faces[0].is_some() && arcs[0] - section.start < ROOM * section.room(0),
            faces[1].is_some() && section.end - arcs[1] < ROOM * section.room(1),
        ]
    }

    /// Fills `pieces` with the initial pieces. A stack takes the last one first.
    ///
    /// 1. The pieces near faces come first, so they are processed last. They cost most, and an
    ///    upper bound from the other pieces prunes most of them.
    /// 2. The other pieces deviate from their chords by about `coarse`, at most [`MAX_PIECES`] per
    ///    section.
    pub(crate) fn begin(&self, coarse: Real, pieces: &mut Vec<Piece>) {
        pieces.clear();
        for number in (0..self.sections().len() as u32).rev() {
            let [from, to] = self.between_faces(number);
            let section = self.section(number);
            let faces = [[section.first, from], [to, section.last]];
            for [from, to] in faces.into_iter().filter(|[from, to]| from < to) {
                pieces.push(Piece { section: number, from, to });
            }
        }
        for number in (0..self.sections().len() as u32).rev() {
            let section = self.section(number);
            let [from, to] = self.between_faces(number);
            if from >= to {
                continue;
            }
            let arcs = [from, to].map(|tick| self.tube.arc(section, tick));
            let length = arcs[1] - arcs[0];
            // The deviation is k l^2 / 8, and no piece turns by more than 1 rad: l <= 1 / k.
            let curvature = section.mean_curvature;
            let longest = (8.0 * coarse / curvature).sqrt().min(1.0 / curvature);
            // The cast saturates, and NaN becomes 0.
            let count = ((length / longest).ceil() as u32).clamp(1, MAX_PIECES).min(to - from);
            let tick = |k: u32| {
                (u64::from(from) + u64::from(to - from) * u64::from(k) / u64::from(count)) as u32
            };
            pieces.extend((0..count).rev().map(|k| Piece {
                section: number,
                from: tick(k),
                to: tick(k + 1),
            }));
        }
    }

    /// Returns the ticks of the range of a section that is clear of its faces. The ticks are equal
    /// if no range is clear.
    pub(crate) fn between_faces(&self, number: u32) -> [u32; 2] {
        let section = self.section(number);
        let [first, last] = self.faces(section).map(|face| face.is_some());
        let room = [0, 1].map(|end| ROOM * section.room(end));
        let needed = room[0] * Real::from(u8::from(first)) + room[1] * Real::from(u8::from(last));
        if needed > 0.0 && section.end - section.start <= needed {
            return if first { [section.last; 2] } else { [section.first; 2] };
        }
        let from =
            if first { self.tube.tick(section, section.start + room[0]) } else { section.first };
        // One tick before the first tick within the room.
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
    /// half.
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
