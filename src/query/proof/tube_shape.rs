//! The pieces of a tube for a proof: their bodies are only slightly wider than the pieces.

use super::shape::{PiecePremises, Shape};
use crate::curve::{CapPersistence, Section};
use crate::distance::Scalar;
use crate::refine::{self, PlacedTube};
use parry3d_f64::math::Real;

/// Returns a tube in pieces whose bodies exceed them by about `most`, and the place of each piece
/// in the tube. If `is_moving`, only faces that stay flat are flat.
pub(crate) fn tube_shape(
    tube: &PlacedTube,
    most: Real,
    is_moving: bool,
) -> (Shape, Vec<refine::Piece>) {
    let (mut shape, mut places) = (Shape::default(), Vec::new());
    for number in 0..tube.sections().len() as u32 {
        let section = tube.section(number);
        let [from, to] = tube.between_faces(number);
        let place = |from, to| refine::Piece { section: number, from, to };
        let mut waiting =
            [place(to, section.last), place(from, to), place(section.first, from)].to_vec();
        waiting.retain(|place| place.from < place.to);
        while let Some(place) = waiting.pop() {
            let piece = piece(tube, section, &place, is_moving);
            let mut over = 0.125 * piece.curvature * piece.length * piece.length;
            if piece.flat != [false; 2] {
                over += 0.5 * piece.radius * piece.curvature * piece.length;
            }
            // A NaN piece is kept: no plane separates it.
            if over > most && place.to - place.from > 1 {
                let arcs = tube.arcs(&place);
                let tick = tube.tube.tick(section, 0.5 * (arcs[0] + arcs[1]));
                let tick = tick.max(place.from + 1).min(place.to - 1);
                waiting.extend([
                    refine::Piece { from: tick, ..place },
                    refine::Piece { to: tick, ..place },
                ]);
                continue;
            }
            if shape.points.is_empty() {
                shape.points.push(tube.point(section, place.from));
            }
            shape.points.push(tube.point(section, place.to));
            shape.pieces.push(piece);
            places.push(place);
        }
    }
    (shape, places)
}

fn piece(
    tube: &PlacedTube,
    section: &Section,
    place: &refine::Piece,
    is_moving: bool,
) -> PiecePremises {
    let arcs = tube.arcs(place);
    let known = tube.tube.bound(section, [place.from, place.to]);
    let length = (arcs[1] - arcs[0]) * section.stretch * (1.0 + 8.0 * Real::UNIT_ROUNDOFF);
    // The slack covers the rounding of the points.
    let off = tube.tube.error() + known.off + tube.slack();
    let ends = [place.from, place.to].map(|tick| tube.point(section, tick));
    let is_straight = known.curvature * length <= 1.0 && 4.0 * off < (ends[1] - ends[0]).length();
    let is_face = |end: usize| {
        section.faces[end]
            .is_some_and(|face| !is_moving || face.persistence == CapPersistence::Always)
    };
    // A stated error of place gives no bound on directions.
    let is_certain = tube.tube.error() == 0.0 && tube.tube.turn().unwrap_or(0.0) == 0.0;
    // Near a face a round end would stick out of it.
    let exposed = tube.exposed(section, arcs);
    let flat = [0, 1].map(|end| is_straight && is_certain && exposed[end] && is_face(end));
    PiecePremises {
        radius: section.radius,
        flat,
        curvature: known.curvature,
        length,
        off,
        ..PiecePremises::default()
    }
}
