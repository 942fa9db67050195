//! Tubes of samples that lie as unevenly as one likes: each segment bends as the samples around it show.

use super::frames::{Kind, stretch};
use super::{Seen, discs, judge};
use continuum_testing::{Arcs, Random};
use parry_continuum::Tube;
use parry_continuum::parry::math::{Pose, Vector};

/// Samples of a curve that are up to `spacing` apart, and often far less.
fn samples(random: &mut Random, arcs: &Arcs, spacing: f64) -> (Vec<Vector>, Vec<f64>) {
    let (mut points, mut radii, mut from) = (vec![arcs.at(0.0).0], Vec::new(), 0.0);
    for part in &arcs.stretches {
        let mut places = Vec::new();
        let mut along = 0.0;
        while along < part.length {
            let share: f64 = random.between(0.05, 1.0);
            along += spacing * share * share;
            places.push(along.min(part.length));
        }
        points.extend(places.iter().map(|s| arcs.at(from + s).0));
        radii.extend(std::iter::repeat_n(part.radius, places.len()));
        from += part.length;
    }
    (points, radii)
}

/// Whether the tube is known between two samples too, so that pieces begin there: seen from beside its longest segment.
fn is_divided_between_samples(tube: &Tube, points: &[Vector]) -> bool {
    let longest = points.windows(2).max_by(|one, other| {
        let [one, other] = [one, other].map(|ends| (ends[1] - ends[0]).length());
        one.total_cmp(&other)
    });
    let middle = longest.map_or(Vector::ZERO, |ends| (ends[0] + ends[1]) * 0.5);
    let mut pieces = Vec::new();
    let speck = &mut super::speck(middle + Vector::new(3.0, 4.0, 5.0));
    speck.clearance_pieces(tube, &Pose::IDENTITY, 0.0, &mut pieces).unwrap();
    let mut arcs = vec![0.0];
    arcs.extend(points.windows(2).scan(0.0, |arc, ends| {
        *arc += (ends[1] - ends[0]).length();
        Some(*arc)
    }));
    let is_sample = |arc: f64| arcs.iter().any(|sample| (sample - arc).abs() < 1e-9 * tube.length());
    pieces.iter().any(|piece| !piece.arc_lengths.into_iter().all(is_sample))
}

#[test]
fn uneven_samples_never_make_a_bound_wrong() {
    let (mut random, mut seen, [mut sharper, mut arched]) = (Random::new(121), Seen::default(), [0; 2]);
    for round in 0..1_500 {
        let mut arcs = Arcs::from_frame(random.pose(5.0));
        let spacing = random.between(0.5, 2.0);
        let kind = [Kind::Arcs, Kind::Clothoid, Kind::Helix][round % 3];
        for _ in 0..=random.below(2) {
            let radius = random.between(0.1, 2.0);
            let sharpest = (0.4 / spacing).min(0.6 / radius) * random.unit();
            let length = spacing * random.between(8.0, 20.0);
            let parts = stretch(&mut random, kind, length, 2.0 * spacing, sharpest);
            arcs.push(radius, &parts);
        }
        let (points, radii) = samples(&mut random, &arcs, spacing);
        let tangents = [None, Some(arcs.end_tangents())][random.below(2) as usize];
        let tube = Tube::from_samples(&points, &radii, tangents).unwrap();
        arched += usize::from(is_divided_between_samples(&tube, &points));
        let curve = |s: f64| arcs.at(s);
        judge(&mut random, &tube, (&discs(&arcs), &curve), [4.0, 0.1 * spacing], 8, &mut seen);
        sharper += usize::from(kind == Kind::Arcs && arcs.stretches.iter().any(|part| part.curvature > 0.1));
    }
    assert!(seen.asked == 12_000 && seen.touching > 500 && seen.at_faces > 2_000, "{seen:?}");
    assert!(seen.resolved > 9 * seen.asked / 10 && sharper > 100, "{seen:?} {sharper}");
    assert!(arched > 400, "{arched}");
}

/// A sharp bend counts where it is: a wall beside the straight part is as well known as beside a straight tube.
#[test]
fn a_sharp_bend_costs_nothing_elsewhere() {
    let mut arcs = Arcs::from_frame(Pose::IDENTITY);
    arcs.push(0.5, &[(40.0, Vector::ZERO), (10.0, Vector::X * 0.2)]);
    // Far apart on the straight part, and near enough in the bend.
    let places = (0..10).map(|k| 4.0 * f64::from(k)).chain((0..=20).map(|k| 40.0 + 0.5 * f64::from(k)));
    let points: Vec<_> = places.map(|s| arcs.at(s).0).collect();
    let tube = Tube::with_constant_radius(&points, 0.5, None).unwrap();
    let found = super::speck(Vector::new(3.0, 0.0, 18.0)).clearance(&tube, &Pose::IDENTITY, 1e-6).unwrap();
    assert!(found.resolved && found.lower <= 2.5 && 2.5 <= found.upper, "{found:?}");
}

/// Between samples that lie in pairs, the directions of the pairs tell where the curve is.
#[test]
fn a_long_segment_between_short_ones_is_known_better_than_by_its_chord() {
    let (mut random, mut seen) = (Random::new(122), Seen::default());
    for round in 0..300 {
        let mut arcs = Arcs::from_frame(random.pose(5.0));
        let (spacing, bend) = (random.between(4.0, 8.0), random.between(0.01, 0.03));
        let angle = std::f64::consts::TAU * random.unit();
        let bend = Vector::new(angle.cos(), angle.sin(), 0.0) * bend;
        // An arc, or one that bends back from some place on, which shows least a quarter of a segment from its ends.
        let change = if round % 2 == 0 { bend } else { -bend };
        let place = (2.0 + [0.25, 0.75, random.unit()][round % 3]) * spacing;
        arcs.push(0.5, &[(place, bend), (5.0 * spacing - place, change)]);
        let places = (0..=5).flat_map(|k| [-0.01, 0.0, 0.01].map(|off| spacing * (f64::from(k) + off)));
        let points: Vec<_> =
            places.filter(|s| (0.0..=5.0 * spacing).contains(s)).map(|s| arcs.at(s).0).collect();
        let tube = Tube::with_constant_radius(&points, 0.5, None).unwrap();
        let before = seen.resolved;
        // The chord leaves the arc by k l^2 / 8, and the bounds are up to twice that apart. Where bends change, they are to be as
        // close as they can.
        let does_change = round % 2 == 1;
        let half = 0.5 * bend.length() * spacing * spacing / 8.0;
        let tolerance = if does_change { 0.0 } else { half };
        judge(&mut random, &tube, (&discs(&arcs), &|s: f64| arcs.at(s)), [4.0, tolerance], 10, &mut seen);
        if does_change {
            seen.resolved = before;
        }
    }
    assert!(seen.asked == 3_000 && seen.touching > 100, "{seen:?}");
    assert!(seen.resolved > 1_350, "{seen:?}");
}
