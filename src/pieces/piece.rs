//! Pieces of the centreline, and how a query divides them.

use super::bounding_body::BoundingBody;
use super::placed_tube::PlacedTube;
use super::tube_pair::SectionRange;
use crate::robot::Section;
use parry3d_f64::math::Real;

/// A piece of one section, between two ticks.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Piece {
    pub section: u32,
    pub from: u32,
    pub to: u32,
}

/// Which ends of a piece are so near to a flat face that a round end would stick out of it. An
/// eighth more than the room that a ball needs, because the body around a piece is wider than the
/// tube.
const ROOM: Real = 1.125;

/// More pieces of a section are never begun with: what is near the wall is halved, and thin wires
/// would begin with millions.
const MAX_PIECES: u32 = 1024;

impl PlacedTube<'_> {
    /// The arc lengths of a piece's ends.
    pub(crate) fn arcs(&self, piece: &Piece) -> [Real; 2] {
        let section = self.section(piece.section);
        [piece.from, piece.to].map(|tick| self.tube.arc(section, tick))
    }

    /// The least piece that holds all between two shares of a section.
    pub(crate) fn between(&self, section: u32, shares: [Real; 2]) -> Piece {
        let [from, to] = self.tube.ticks_around(self.section(section), shares);
        Piece { section, from, to }
    }

    /// The shares of a section between which a piece lies.
    pub(crate) fn shares(&self, piece: &Piece) -> [Real; 2] {
        let section = self.section(piece.section);
        [piece.from, piece.to].map(|tick| self.tube.share(section, tick))
    }

    /// A piece whatever the shape of the tube, and the body that holds it in this one.
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

    /// Which ends of a piece must be flat if its body is not to stick out of a face nearby.
    pub(crate) fn exposed(&self, section: &Section, arcs: [Real; 2]) -> [bool; 2] {
        let faces = self.faces(section);
        [
            faces[0].is_some() && arcs[0] - section.start < ROOM * section.room(0),
            faces[1].is_some() && section.end - arcs[1] < ROOM * section.room(1),
        ]
    }

    /// The pieces to begin with, those near faces first, so that they come last from a stack: they
    /// cost most, and a bound from the others spares most of them. The others leave their chord
    /// by about `coarse`, unless that would make too many.
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
            // By k l^2 / 8, and never turning by more than 1 rad.
            let curvature = section.mean_curvature;
            let longest = (8.0 * coarse / curvature).sqrt().min(1.0 / curvature);
            // A number out of range becomes the nearest that is in it, and NaN becomes 0.
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

    /// The ticks between which a section is free of its faces. The first is the second where it is
    /// not.
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
        // One before the first tick within the room.
        let to = if last {
            self.tube.tick(section, section.end - room[1]).saturating_sub(1).max(section.first)
        } else {
            section.last
        };
        if from < to { [from, to] } else { [to.max(section.first); 2] }
    }

    /// The two halves of a piece; none of one tick. At a face the part at the face is as short as a
    /// body within `aim` of the tube needs: `k l^2`.
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
