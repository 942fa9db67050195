//! Tubes of samples, some taken twice, slightly apart: the bounds hold, and the pair widens them by
//! its distance.

use super::frames::{Kind, frames, stretch};
use super::{Seen, discs, judge};
use continuum_testing::{Arcs, Random, rounds};
use parry_continuum::Tube;
use parry_continuum::parry::math::{Pose, Vector};

/// Takes a sample once more, so far away; the wrong one comes first or second. Which it was.
fn repeat(
    random: &mut Random,
    points: &mut Vec<Vector>,
    radii: &mut Vec<f64>,
    apart: f64,
) -> usize {
    let last = points.len() as u32 - 1;
    let at = [0, last, random.below(last + 1), random.below(last + 1)][random.below(4) as usize]
        as usize;
    let along = points[(at + 1).min(points.len() - 1)] - points[at.saturating_sub(1)];
    // A pair along the curve shows no more bend than others, and counts as a sample.
    let way = loop {
        let way = random.direction();
        if way.dot(along.normalize()).abs() < 0.97 {
            break way;
        }
    };
    points.insert(at + random.below(2) as usize, points[at] + way * apart);
    radii.insert(at, radii[at.min(radii.len() - 1)]);
    at
}

#[test]
fn samples_taken_twice_never_make_a_bound_wrong() {
    let (mut random, mut seen) = (Random::new(111), Seen::default());
    let (mut wide, mut several, mut at_ends, mut refused) = (0, 0, 0, [0; 2]);
    for round in 0..rounds(1_500) {
        let mut arcs = Arcs::from_frame(random.pose(5.0));
        let spacing = random.between(0.5, 2.0);
        let kind = [Kind::Arcs, Kind::Clothoid, Kind::Helix][round % 3];
        for _ in 0..=random.below(2) {
            let radius = random.between(0.1, 2.0);
            let sharpest = (0.3 / spacing).min(0.5 / radius) * random.unit();
            let length = spacing * random.between(8.0, 20.0);
            // The sharpest arc is seen: it is as long as four segments.
            let parts = stretch(&mut random, kind, length, 2.0 * spacing, sharpest);
            arcs.push(radius, &parts);
        }
        let (mut points, _, mut radii) = frames(&mut random, &arcs, spacing);
        let apart = spacing * [1e-11, 1e-6, 1e-3, 0.01, 0.015][random.below(5) as usize];
        let times = 1 + random.below(2);
        for _ in 0..times {
            let count = points.len();
            let at = repeat(&mut random, &mut points, &mut radii, apart);
            at_ends += usize::from(at == 0 || at + 1 == count);
        }
        let tangents = [None, Some(arcs.end_tangents())][random.below(2) as usize];
        let tube = match Tube::from_samples(&points, &radii, tangents) {
            Ok(tube) => tube,
            // A sample taken three times may be a crowd that is too wide.
            Err(_) => {
                refused[times as usize - 1] += 1;
                continue;
            }
        };
        let curve = |s: f64| arcs.at(s);
        judge(&mut random, &tube, (&discs(&arcs), &curve), [4.0, 0.1 * spacing], 6, &mut seen);
        wide += usize::from(apart > 5e-3 * spacing);
        several += usize::from(times == 2);
    }
    assert!(seen.asked > rounds(8_000), "{seen:?}");
    assert!(seen.touching > rounds(500) && seen.at_faces > rounds(2_000), "{seen:?}");
    assert!(
        wide > rounds(300) && several > rounds(500) && at_ends > rounds(500),
        "{wide} {several} {at_ends}"
    );
    assert!(
        seen.resolved > 9 * seen.asked / 10
            && refused[0] <= rounds(15)
            && refused[1] <= rounds(150),
        "{seen:?} {refused:?}"
    );
}

/// A sample taken twice widens the bounds by the distance of the two, or not at all if the curve
/// goes through both.
#[test]
fn a_pair_counts_in_the_uncertainty() {
    let arc = |k: f64| Vector::new(20.0 - 20.0 * (0.05 * k).cos(), 0.0, 20.0 * (0.05 * k).sin());
    let mut points: Vec<_> = (0..40).map(|k| arc(f64::from(k))).collect();
    let width = |points: &[Vector]| {
        let tube = Tube::with_constant_radius(points, 0.5, None).unwrap();
        let found = super::speck(arc(20.0) + Vector::Y * 3.0)
            .clearance(&tube, &Pose::IDENTITY, 0.1)
            .unwrap();
        assert!(found.resolved && found.lower <= 2.5 && 2.5 <= found.upper, "{found:?}");
        found.uncertainty
    };
    assert_eq!(width(&points), 0.0);
    points.insert(21, points[20] + Vector::Y * 0.01);
    assert!((width(&points) - 0.02).abs() < 1e-12, "{}", width(&points));
    points[21] = arc(20.01);
    assert_eq!(width(&points), 0.0);
}

/// A curve that goes through all samples and bends as they show is covered, also if crowded samples
/// coincide, and if it nearly bends too much.
#[test]
fn a_curve_through_samples_that_crowd_is_covered() {
    // Of a turn by the chord t at the end of a segment of 1 the curve beside it may leave that by k
    // / 8.
    let most = |from: Vector, to: Vector| {
        let along = to - from;
        let turn = (along / along.length() - Vector::Z).length();
        turn / (0.5 * (1.0 + along.length())) / 8.0
    };
    let speck_beside = |points: &[Vector]| {
        let tube = Tube::with_constant_radius(points, 0.2, None).unwrap();
        let at = Vector::new(3.0, 0.0, 4.5);
        super::speck(at).clearance(&tube, &Pose::IDENTITY, 0.01).unwrap().lower
    };
    let at = Vector::Z * 5.0;
    let straight =
        |x: f64, range: std::ops::Range<u32>| range.map(move |k| Vector::new(x, 0.0, k.into()));
    // Once more at one place, and a little off.
    let off = Vector::new(0.004, 0.0, 5.01);
    let twin = Vector::new(1e-14, 0.0, 5.0);
    let points: Vec<_> =
        straight(0.0, 0..6).chain([twin, off]).chain(straight(0.0, 6..12)).collect();
    let (lower, covered) = (speck_beside(&points), 2.8 - most(at, off));
    assert!(lower <= covered, "{lower} {covered}");
    // By half a radian, which is the most there may be.
    let (apart, angle) = (1.0 / 33.0, 2.0 * (0.5 * 0.501_f64).asin());
    let off = at + Vector::new(angle.sin(), 0.0, angle.cos()) * apart;
    let points: Vec<_> = straight(0.0, 0..6).chain([off]).chain(straight(off.x, 6..12)).collect();
    let (lower, covered) = (speck_beside(&points), 2.8 - most(at, off));
    assert!(lower <= covered, "{lower} {covered}");
}
