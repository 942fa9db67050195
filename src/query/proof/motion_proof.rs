//! The proof of a motion: intervals of time, each proven by its middle shape with free space for
//! the motion until the interval ends. A tube is proven by bodies only slightly wider than its
//! pieces ([`tube_shape`]).

use super::plane_search::PlaneSearch;
use super::text::{Kind, PiecePremises, ProvenShape, Shape, size_of};
use crate::answer::ProximityError;
use crate::curve::{CapPersistence, CurveBound, Section, Tube};
use crate::distance::Scalar;
use crate::motion::{CarriedMotion, Motion, MotionDrift, SectionSignature, check_speed};
use crate::query::motion::half_length;
use crate::refine::{self, PlacedTube};
use parry3d_f64::math::Real;

/// The most shapes that are tested for a proof.
const MAX_SHAPES: usize = 1 << 16;

/// Returns shapes in the order of time, each with the steps that separate it from the mesh during
/// its interval. `reach` is the mesh's largest coordinate.
///
/// Returns `None` if a shape is within the margin, or so near that a motion of `resolution`
/// matters, or if the shapes and steps would need more than `most` bytes.
///
/// # Errors
/// The motion has no shape at some time, or its sections change; a shape is out of range; or a
/// stated speed is negative or not finite.
pub(crate) fn motion_proof(
    plane_search: &mut PlaneSearch,
    reach: Real,
    motion: &dyn Motion,
    margin: Real,
    resolution: Real,
    most: usize,
) -> Result<Option<Vec<ProvenShape>>, ProximityError> {
    let (mut tube, mut sections) = (Tube::empty(), SectionSignature::default());
    let (mut proven, mut waiting) = (Vec::new(), vec![[0.0, 1.0]]);
    let (mut shapes, mut bytes) = (0, 0);
    while let Some(times @ [from, to]) = waiting.pop() {
        if shapes == MAX_SHAPES {
            return Ok(None);
        }
        let t = 0.5 * from + 0.5 * to;
        let half = half_length(times);
        tube.forget_error();
        let pose = motion.shape(t, &mut tube)?;
        sections.check(t, &tube)?;
        shapes += 1;
        let carried = CarriedMotion::new(motion, times, half);
        tube.mark_lasting_faces_between(&MotionDrift {
            motion: &carried,
            t,
            turning: carried.turning(),
        });
        let placed = PlacedTube::new(&tube, &pose, reach)?.moving();
        let fastest = (0..placed.sections().len()).map(|section| {
            let speed = carried.speed((&tube, &placed.pose), section, [0.0, 1.0]).point;
            check_speed(section, speed)
        });
        let fastest = fastest.collect::<Result<Vec<_>, _>>()?.into_iter().fold(0.0, Real::max);
        let mut moves = half * fastest;
        // The bodies' excess takes less of the free space than the motion.
        let over = (0.25 * moves).max(0.25 * resolution).max(placed.slack());
        let (mut shape, places) = tube_shape(&placed, over, true);
        shape.times = times;
        for (piece, place) in shape.pieces.iter_mut().zip(&places) {
            let section = place.section as usize;
            let speed = carried.speed((&tube, &placed.pose), section, placed.shares(place));
            // The program takes half of the interval without the rounding of times.
            let rounded = half / (0.5 * (to - from)) * (1.0 + 8.0 * Real::UNIT_ROUNDOFF);
            piece.speed = check_speed(section, speed.point)? * rounded;
            // Balls need no turn. The turn of a link that loses its length is infinite.
            let is_unbounded = piece.flat == [false; 2] && speed.turn == Real::INFINITY;
            let turn = if is_unbounded { Real::MAX } else { speed.turn };
            piece.turn = (check_speed(section, turn)? * rounded).min(Real::MAX);
            if piece.flat != [false; 2] {
                // The rims move with the turn, even if the centreline rests.
                moves = moves.max(half * (piece.speed + piece.radius * piece.turn));
            }
        }
        if let Some(steps) = plane_search.steps(&shape.bodies(margin)) {
            let parted = (shape, steps);
            bytes += size_of(Kind::Motion, &parted);
            if bytes > most {
                return Ok(None);
            }
            proven.push(parted);
            continue;
        }
        let is_fine = moves <= resolution.max(placed.slack()) || !(from < t && t < to);
        if is_fine {
            return Ok(None);
        }
        waiting.extend([[t, to], [from, t]]);
    }
    Ok(Some(proven))
}

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
        let mut waiting: Vec<_> = tube.ranges(number).into_iter().flatten().rev().collect();
        while let Some(place) = waiting.pop() {
            let piece = piece(tube, section, &place, is_moving);
            let mut over = 0.125 * piece.curvature * piece.length * piece.length;
            let is_at_face = piece.flat[0] && place.from == section.first
                || piece.flat[1] && place.to == section.last;
            let (arcs, turn) = (tube.arcs(&place), piece.radius * piece.curvature);
            if piece.stated.is_some() {
                over *= 4.0;
            } else if is_at_face {
                over += 0.5 * turn * piece.length;
            } else {
                // Ahead of an inner flat end lies the tube, up to the face. A disc across the chord
                // reaches ahead of the tube's own disc by `turn * length`, to first order, and that
                // disc is behind the face by `(1 - turn) room`. Half of it is for higher orders.
                let rooms = [arcs[0] - section.start, section.end - arcs[1]];
                for (_, room) in piece.flat.into_iter().zip(rooms).filter(|(flat, _)| *flat) {
                    over = over.max(2.0 * turn * piece.length - (1.0 - turn) * room);
                }
            }
            // A NaN piece is kept: no plane separates it.
            if over > most && place.to - place.from > 1 {
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
    let CurveBound { curvature, off: known } = tube.tube.bound(section, [place.from, place.to]);
    let length = (arcs[1] - arcs[0]) * section.stretch * (1.0 + 8.0 * Real::UNIT_ROUNDOFF);
    // The slack covers the rounding of the points.
    let off = tube.tube.error() + known + tube.slack();
    let ends = [place.from, place.to].map(|tick| tube.point(section, tick));
    let faces = tube
        .faces(section)
        .map(|face| face.filter(|face| !is_moving || face.persistence == CapPersistence::Always));
    // Near a face a round end would stick out of it.
    let exposed = tube.exposed(section, arcs);
    let flat = [0, 1].map(|end| exposed[end] && faces[end].is_some());
    let round = PiecePremises {
        radius: section.radius,
        curvature,
        length,
        off,
        ..PiecePremises::default()
    };
    if flat == [false; 2] {
        return round;
    }
    let (radius, bend, turn) =
        (section.radius, curvature * length, tube.tube.turn().unwrap_or(0.0));
    // The excess of the body across the chord, and of the better one across a stated direction.
    let is_at = [place.from == section.first, place.to == section.last];
    let flat_ends = Real::from(u8::from(flat[0])) + Real::from(u8::from(flat[1]));
    let is_straight = bend <= 1.0 && 4.0 * off < (ends[1] - ends[0]).length();
    let by_chord = 0.125 * bend * length + radius * (0.5 * bend + turn) * flat_ends;
    let by_chord = if is_straight { by_chord } else { Real::INFINITY };
    let stated = [0, 1].into_iter().filter(|&end| is_at[end] && flat[end]).filter_map(|end| {
        let face = faces[end]?;
        // The direction is rounded.
        let tilt = face.tilt * (1.0 + 8.0 * Real::UNIT_ROUNDOFF) + 16.0 * Real::UNIT_ROUNDOFF;
        // A heuristic: a back that is not at a face does not stick out of the tube.
        let is_face = is_at[1 - end] && flat[1 - end];
        let other = if is_face { radius * (bend + tilt) } else { 0.0 };
        let excess = 0.5 * bend * length + tilt * (length + radius) + other;
        let is_possible = excess <= by_chord && bend + tilt <= 1.5 && curvature * radius < 1.0;
        is_possible.then(|| (end, tilt, tube.face(&face).outward))
    });
    match stated.reduce(|one, other| if other.1 < one.1 { other } else { one }) {
        Some((end, tilt, outward)) => {
            PiecePremises { flat, tilt, stated: Some((end, outward)), ..round }
        }
        None if is_straight => PiecePremises { flat, tilt: turn, ..round },
        None => round,
    }
}
