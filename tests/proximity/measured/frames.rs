//! Tubes of frames: their bounds hold wherever the curve bends as the frames show.

use super::{Seen, discs, judge};
use continuum_testing::{Arcs, Random, rounds};
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::proximity::BvhSearch;
use parry_continuum::{RobotError, Tube};
use std::f64::consts::TAU;

/// How the curvature goes along a stretch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    /// Arcs that are at least twice as long as a segment.
    Arcs,
    /// It changes evenly: a clothoid.
    Clothoid,
    /// It is constant, and turns about the curve.
    Helix,
    /// It swings.
    Swing,
}

/// A stretch as very short arcs: of each its length and curvature vector. No segment of the frames
/// is longer than `spacing`.
pub(super) fn stretch(
    random: &mut Random,
    kind: Kind,
    length: f64,
    spacing: f64,
    sharpest: f64,
) -> Vec<(f64, Vector)> {
    let bend =
        |size: f64, angle: f64| Vector::new(angle.cos(), angle.sin(), 0.0) * (sharpest * size);
    let angle = TAU * random.unit();
    if kind == Kind::Arcs {
        let most = ((length / (2.0 * spacing)) as u32).clamp(1, 4);
        let count = 1 + random.below(most);
        return (0..count)
            .map(|_| (length / f64::from(count), bend(random.unit(), TAU * random.unit())))
            .collect();
    }
    const PARTS: u32 = 500;
    let [from, to] = [random.between(-1.0, 1.0), random.between(-1.0, 1.0)];
    // From one segment to the next a helix turns by up to 0.5 rad about the curve, and a swing goes
    // on by as much.
    let turns = random.between(0.0, 0.5) * length / spacing;
    let at = |k: u32| {
        let share = (f64::from(k) + 0.5) / f64::from(PARTS);
        match kind {
            Kind::Clothoid => bend(from + (to - from) * share, angle),
            Kind::Helix => bend(from, angle + turns * share),
            _ => bend(to * (from + turns * share).sin(), angle),
        }
    };
    (0..PARTS).map(|k| (length / f64::from(PARTS), at(k))).collect()
}

/// Frames of a curve, with a radius for each segment. Segments are at most `spacing` long, and at
/// least half as long.
pub(super) fn frames(
    random: &mut Random,
    arcs: &Arcs,
    spacing: f64,
) -> (Vec<Vector>, Vec<Vector>, Vec<f64>) {
    let (start, tangent) = arcs.at(0.0);
    let (mut points, mut tangents, mut radii, mut from) =
        (vec![start], vec![tangent], Vec::new(), 0.0);
    for part in &arcs.stretches {
        let mut lengths = Vec::new();
        while lengths.iter().sum::<f64>() < part.length {
            lengths.push(spacing * random.between(0.6, 1.0));
        }
        let fit = part.length / lengths.iter().sum::<f64>();
        let mut along = 0.0;
        for length in lengths {
            along += length * fit;
            let (point, tangent) = arcs.at(from + along);
            points.push(point);
            // Of any length.
            tangents.push(tangent * random.between(0.5, 2.0));
            radii.push(part.radius);
        }
        from += part.length;
    }
    (points, tangents, radii)
}

#[test]
fn curves_that_bend_as_their_frames_show_are_never_misjudged() {
    let (mut random, mut seen, mut kinds) = (Random::new(71), Seen::default(), [0; 4]);
    for round in 0..rounds(1_000) {
        let mut arcs = Arcs::from_frame(random.pose(5.0));
        let spacing = random.between(0.5, 3.0);
        let kind = [Kind::Arcs, Kind::Clothoid, Kind::Helix, Kind::Swing][round % 4];
        for _ in 0..=random.below(2) {
            let radius = random.between(0.1, 1.0);
            let sharpest = (0.5 / spacing).min(0.8 / radius) * random.unit();
            let length = spacing * random.between(3.0, 20.0);
            let parts = stretch(&mut random, kind, length, spacing, sharpest);
            arcs.push(radius, &parts);
        }
        let (points, tangents, radii) = frames(&mut random, &arcs, spacing);
        let tube = Tube::from_frames(&points, &tangents, &radii).unwrap();
        let curve = |s: f64| arcs.at(s);
        let before = seen.resolved;
        judge(&mut random, &tube, (&discs(&arcs), &curve), [4.0, 0.01], 10, &mut seen);
        kinds[round % 4] += seen.resolved - before;
    }
    assert!(seen.asked == 10 * rounds(1_000), "{seen:?}");
    assert!(seen.touching > rounds(500) && seen.at_faces > rounds(2_000), "{seen:?}");
    assert!(seen.resolved > rounds(9_000), "{seen:?} {kinds:?}");
}

/// A tube of three radii whose middle section is a single segment. In it the bend jumps from the
/// previous section's to the next section's: once or twice, at any place, or not at all.
#[test]
fn sections_of_one_segment_are_known_by_their_own_frames() {
    let (mut random, mut seen, mut straight) = (Random::new(72), Seen::default(), [0; 2]);
    for _ in 0..rounds(1_000) {
        let mut arcs = Arcs::from_frame(random.pose(5.0));
        let spacing = random.between(1.0, 4.0);
        let radii = [1.25, 1.0, 0.5];
        let bend = |random: &mut Random| {
            let angle = TAU * random.unit();
            Vector::new(angle.cos(), angle.sin(), 0.0) * (0.2 * random.unit() / spacing)
        };
        let [from, to] = [bend(&mut random), bend(&mut random)];
        let length = 0.59 * spacing;
        let jumps = random.below(3);
        let parts = match jumps {
            0 => vec![(length, to)],
            // Near an end as often as anywhere.
            1 => {
                let share = random.unit().powi(3);
                let share = if random.unit() < 0.5 { share } else { 1.0 - share };
                vec![(share * length, from), ((1.0 - share) * length, to)]
            }
            // By way of a bend that is up to 40 degrees aside, as seen from both.
            _ => {
                let aside = Vector::Z.cross(to - from) * (0.5 * random.between(-0.8, 0.8));
                let third = length / 3.0;
                vec![(third, from), (third, (from + to) * 0.5 + aside), (third, to)]
            }
        };
        arcs.push(radii[0], &[(3.0 * spacing, from)]);
        arcs.push(radii[1], &parts);
        arcs.push(radii[2], &[(3.0 * spacing, to)]);
        let (points, tangents, radii) = frames(&mut random, &arcs, spacing);
        assert_eq!(radii.iter().filter(|&&radius| radius == 1.0).count(), 1);
        let tube = Tube::from_frames(&points, &tangents, &radii).unwrap();
        let before = seen.resolved;
        judge(
            &mut random,
            &tube,
            (&discs(&arcs), &|s: f64| arcs.at(s)),
            [4.0, 0.01],
            10,
            &mut seen,
        );
        if jumps == 0 {
            straight = [straight[0] + seen.resolved - before, straight[1] + 10];
        }
    }
    assert!(seen.asked == 10 * rounds(1_000), "{seen:?}");
    assert!(seen.touching > rounds(500) && seen.at_faces > rounds(1_500), "{seen:?}");
    // An arc is known although its neighbours bend otherwise.
    assert!(
        straight[0] * 100 >= straight[1] * 99 && straight[1] > rounds(2_500),
        "{straight:?} {seen:?}"
    );
}

/// Two straight arms that meet at a corner, or do not: the frame there is taken twice.
#[test]
fn a_corner_between_two_frames_at_one_place_is_refused() {
    let arms = |turns: &[f64]| {
        let (mut points, mut tangents) =
            (vec![Vector::new(-4.0, 0.0, 0.0), Vector::new(-2.0, 0.0, 0.0)], vec![Vector::X; 2]);
        for &turn in turns {
            points.push(Vector::ZERO);
            tangents.push(Vector::new(turn.cos(), turn.sin(), 0.0) * 3.0);
        }
        let onwards = tangents[tangents.len() - 1] / 3.0;
        points.extend([onwards * 2.0, onwards * 4.0]);
        tangents.extend([onwards; 2]);
        let radii = vec![0.5; points.len() - 1];
        Tube::from_frames(&points, &tangents, &radii)
    };
    // Rounding is no corner, that of single precision neither. Either direction may be the true
    // one.
    let floor = BvhSearch::from_triangles(
        &[
            Vector::new(-90.0, -1.3, -90.0),
            Vector::new(90.0, -1.3, -90.0),
            Vector::new(0.0, -1.3, 90.0),
        ],
        &[[0, 1, 2]],
    );
    let mut floor = floor.unwrap();
    for turns in [
        vec![0.0],
        vec![0.0, 0.0],
        vec![0.0, 1e-15],
        vec![0.0, 1e-10, -1e-10, 0.0],
        vec![0.0, 1e-5],
        vec![-1e-5, 0.0],
    ] {
        let tube = arms(&turns).unwrap();
        assert!((tube.length() - 8.0).abs() < 1e-9, "{turns:?}");
        let found = floor.clearance(&tube, &Pose::IDENTITY, 1e-3).unwrap();
        let onwards = turns[turns.len() - 1];
        for turn in turns {
            // The lowest place of the rim at the tip, whose face stands in one of the two
            // directions; or of the base.
            let tip = 1.3 + 4.0 * onwards.sin() - 0.5 * turn.cos();
            let truth = tip.min(0.8);
            assert!(found.lower <= truth && truth <= found.upper, "{turn} {truth} {found:?}");
        }
    }
    // Those below 0.4 rad were taken for bends of the segment behind, which is straight.
    for corner in [1e-4, 0.01, 0.1, 0.3, 1.0, 2.0, std::f64::consts::PI] {
        let error = arms(&[0.0, corner]).unwrap_err();
        let RobotError::TurnsTooSharply { index, after, turn } = error else {
            panic!("{corner}: {error}")
        };
        assert_eq!((index, after), (3, 2), "{error}");
        assert!((turn - corner).abs() < 1e-7, "{error}");
        // And where it is between them and one that is the first again.
        assert!(arms(&[0.0, corner, 0.0]).is_err(), "{corner}");
    }
}

/// At the tip, where the face would stand as the first of the two says.
#[test]
fn two_directions_of_a_tip_are_refused() {
    let points = [Vector::ZERO, Vector::Z, Vector::Z * 2.0, Vector::Z * 2.0];
    let frames = |turn: f64| {
        let last = Vector::new(0.0, turn.sin(), turn.cos());
        Tube::from_frames(&points, &[Vector::Z, Vector::Z, Vector::Z, last], &[0.5; 3])
    };
    assert!(frames(1e-15).is_ok());
    assert!(matches!(frames(0.1), Err(RobotError::TurnsTooSharply { index: 3, after: 2, .. })));
}
