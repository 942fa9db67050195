//! Tubes of arbitrarily uneven samples: each segment bends as the samples around it show.

use super::frames::{Kind, stretch};
use super::{Seen, discs, judge};
use continuum_testing::{Arcs, Random, rounds};
use parry_continuum::Tube;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::proximity::Decision;

/// How many random curves are tried.
const ROUNDS: usize = 600;

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

/// Whether the tube is known between two samples too, so that pieces begin there: seen from beside
/// its longest segment.
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
    let is_sample =
        |arc: f64| arcs.iter().any(|sample| (sample - arc).abs() < 1e-9 * tube.length());
    pieces.iter().any(|piece| !piece.arc_lengths.into_iter().all(is_sample))
}

#[test]
fn uneven_samples_never_make_a_bound_wrong() {
    let (mut random, mut seen, [mut sharper, mut arched]) =
        (Random::new(121), Seen::default(), [0; 2]);
    for round in 0..rounds(1_500) {
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
        sharper += usize::from(
            kind == Kind::Arcs && arcs.stretches.iter().any(|part| part.curvature > 0.1),
        );
    }
    assert!(seen.asked == 8 * rounds(1_500), "{seen:?}");
    assert!(seen.touching > rounds(500) && seen.at_faces > rounds(2_000), "{seen:?}");
    assert!(seen.resolved > 9 * seen.asked / 10 && sharper > rounds(100), "{seen:?} {sharper}");
    assert!(arched > rounds(400), "{arched}");
}

/// A sharp bend counts where it is: a wall beside the straight part is as well known as beside a
/// straight tube.
#[test]
fn a_sharp_bend_costs_nothing_elsewhere() {
    let mut arcs = Arcs::from_frame(Pose::IDENTITY);
    arcs.push(0.5, &[(40.0, Vector::ZERO), (10.0, Vector::X * 0.2)]);
    // Far apart on the straight part, and near enough in the bend.
    let places =
        (0..10).map(|k| 4.0 * f64::from(k)).chain((0..=20).map(|k| 40.0 + 0.5 * f64::from(k)));
    let points: Vec<_> = places.map(|s| arcs.at(s).0).collect();
    let tube = Tube::with_constant_radius(&points, 0.5, None).unwrap();
    let found =
        super::speck(Vector::new(3.0, 0.0, 18.0)).clearance(&tube, &Pose::IDENTITY, 1e-6).unwrap();
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
        // An arc, or one that bends back from some place on, which shows least a quarter of a
        // segment from its ends.
        let change = if round % 2 == 0 { bend } else { -bend };
        let place = (2.0 + [0.25, 0.75, random.unit()][round % 3]) * spacing;
        arcs.push(0.5, &[(place, bend), (5.0 * spacing - place, change)]);
        let places =
            (0..=5).flat_map(|k| [-0.01, 0.0, 0.01].map(|off| spacing * (f64::from(k) + off)));
        let points: Vec<_> =
            places.filter(|s| (0.0..=5.0 * spacing).contains(s)).map(|s| arcs.at(s).0).collect();
        let tube = Tube::with_constant_radius(&points, 0.5, None).unwrap();
        let before = seen.resolved;
        // The chord leaves the arc by k l^2 / 8, and the bounds are up to twice that apart. Where
        // bends change, they are to be as close as they can.
        let does_change = round % 2 == 1;
        let half = 0.5 * bend.length() * spacing * spacing / 8.0;
        let tolerance = if does_change { 0.0 } else { half };
        judge(
            &mut random,
            &tube,
            (&discs(&arcs), &|s: f64| arcs.at(s)),
            [4.0, tolerance],
            10,
            &mut seen,
        );
        if does_change {
            seen.resolved = before;
        }
    }
    assert!(seen.asked == 3_000 && seen.touching > 100, "{seen:?}");
    assert!(seen.resolved > 1_350, "{seen:?}");
}

/// How samples lie along a curve.
#[derive(Clone, Copy, Debug)]
enum Spacing {
    /// Two close together, then a long segment.
    Pairs,
    /// Three close together, then a long segment.
    Triples,
    /// Ever closer towards a place, and ever farther apart behind it.
    Geometric,
    /// Anything.
    Mixed,
    /// A long and a short segment.
    Three,
}

/// Arc lengths of samples: the long segments are 1 long or less, the short ones `close`.
fn places(random: &mut Random, spacing: Spacing, close: f64) -> Vec<f64> {
    let steps: Vec<f64> = match spacing {
        Spacing::Pairs => (0..9).map(|k| [1.0, close][k % 2]).collect(),
        Spacing::Triples => (0..10).map(|k| [close, close, 1.0][k % 3]).collect(),
        Spacing::Geometric => {
            let ratio = random.between(0.1, 0.6);
            let count = ((close.ln() / ratio.ln()) as i32).clamp(2, 12);
            (-count..=count).map(|k| ratio.powi(count - k.abs())).collect()
        }
        Spacing::Mixed => (0..10).map(|_| close.powf(random.unit())).collect(),
        Spacing::Three => vec![1.0, close],
    };
    let steps = if random.below(2) == 0 { steps } else { steps.into_iter().rev().collect() };
    let mut places = vec![0.0];
    places.extend(steps.iter().scan(0.0, |at, step| {
        *at += step;
        Some(*at)
    }));
    places
}

/// Whether samples show the bends of a curve that jumps at some places: each segment bends no more
/// than one of the two samples before it and the two behind it shows, between whose neighbours the
/// bend is the same.
fn is_shown(places: &[f64], jumps: &[f64], bends: &[Vector], has_tangents: bool) -> bool {
    let last = places.len() - 1;
    let pieces = |from: f64, to: f64| {
        let first = jumps.partition_point(|&jump| jump <= from);
        first..=jumps.partition_point(|&jump| jump < to).max(first)
    };
    let shown = |sample: usize| {
        if (sample == 0 || sample == last) && !has_tangents {
            return 0.0;
        }
        let around = pieces(places[sample.saturating_sub(1)], places[(sample + 1).min(last)]);
        if around.start() == around.end() { bends[*around.start()].length() } else { 0.0 }
    };
    (0..last).all(|from| {
        let most =
            pieces(places[from], places[from + 1]).map(|k| bends[k].length()).fold(0.0, f64::max);
        let four = from.saturating_sub(1)..=(from + 2).min(last);
        four.map(shown).fold(0.0, f64::max) >= most
    })
}

/// An S-curve, or one of arcs in any directions, through samples that show its bends; none if none
/// was found.
fn jumping(random: &mut Random, places: &[f64], has_tangents: bool, radius: f64) -> Option<Arcs> {
    let (last, longest) =
        (places.len() - 1, places.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max));
    let sharpest = (0.6 / longest).min(0.7 / radius) * random.unit();
    let is_flat = random.below(2) == 0;
    for _ in 0..100 {
        let mut jumps: Vec<f64> = (0..=random.below(3))
            .map(|_| {
                let at = random.below(last as u32) as usize;
                let share = [random.unit(), random.unit().powi(3), 1.0 - random.unit().powi(3)];
                places[at] + (places[at + 1] - places[at]) * share[random.below(3) as usize]
            })
            .collect();
        jumps.sort_by(f64::total_cmp);
        let mut side = 1.0;
        let bends: Vec<_> = (0..=jumps.len())
            .map(|_| {
                side = -side;
                let angle = if is_flat { 0.0 } else { random.between(0.0, 6.3) };
                let size = if is_flat { side } else { random.unit() };
                Vector::new(angle.cos(), angle.sin(), 0.0) * (size * sharpest)
            })
            .collect();
        if !is_shown(places, &jumps, &bends, has_tangents) {
            continue;
        }
        let mut arcs = Arcs::from_frame(random.pose(5.0));
        let ends = [&[0.0], &jumps[..], &[places[last]]].concat();
        let parts: Vec<_> =
            ends.windows(2).zip(&bends).map(|(ends, &bend)| (ends[1] - ends[0], bend)).collect();
        arcs.push(radius, &parts);
        return Some(arcs);
    }
    None
}

/// A bend that a sample shows counts for the two segments on either side, however close the next
/// sample lies. The curves bend nowhere more than that.
#[test]
fn bends_count_however_close_the_samples_lie() {
    const KINDS: [Spacing; 5] =
        [Spacing::Pairs, Spacing::Triples, Spacing::Geometric, Spacing::Mixed, Spacing::Three];
    let (mut random, mut wrong) = (Random::new(123), Vec::new());
    let (mut asked, mut refused, mut known, mut close_by) = ([0; 5], [0; 5], [0; 5], [0; 5]);
    for round in 0..ROUNDS {
        let kind = round % KINDS.len();
        let close = 10.0_f64.powf(-random.between(0.7, 5.0));
        let places = places(&mut random, KINDS[kind], close);
        let has_tangents = kind == 4 || random.below(2) == 0;
        let radius = random.between(0.05, 2.0);
        let Some(arcs) = jumping(&mut random, &places, has_tangents, radius) else { continue };
        let unit = [1.0, 1e-3, 1e-6, 1e3][random.below(4) as usize];
        let points: Vec<_> = places.iter().map(|&s| arcs.at(s).0 * unit).collect();
        let tangents = has_tangents.then(|| arcs.end_tangents());
        let tube = match Tube::with_constant_radius(&points, radius * unit, tangents) {
            Ok(tube) => tube,
            Err(_) => {
                refused[kind] += 1;
                continue;
            }
        };
        let curve = |s: f64| arcs.at(s);
        for _ in 0..4 {
            // Where the curve is farthest from a chord, to either side; and anywhere.
            let at = random.below(places.len() as u32 - 1) as usize;
            let [start, end] = [at, at + 1].map(|k| arcs.at(places[k]).0);
            let along = (end - start).normalize();
            let beside = |share: f64| {
                let place = arcs.at(places[at] + (places[at + 1] - places[at]) * share);
                let off = place.0 - start;
                (place, off - along * off.dot(along))
            };
            let farthest = (1..20)
                .map(|k| beside(f64::from(k) / 20.0))
                .max_by(|one, other| one.1.length().total_cmp(&other.1.length()))
                .unwrap();
            let ((centre, tangent), away) = if random.below(3) == 0 {
                (beside(random.unit()).0, random.direction())
            } else {
                farthest
            };
            let side = [-1.0, 1.0, 1.0][random.below(3) as usize];
            let across = tangent.cross(away).cross(tangent).normalize() * side;
            if !across.is_finite() {
                continue;
            }
            let point = centre + across * (radius + 10.0_f64.powf(-random.between(0.0, 4.0)));
            let truth = super::distance(&discs(&arcs), &curve, point);
            let mut wall = super::speck(point * unit);
            let found = wall.clearance(&tube, &Pose::IDENTITY, 1e-6 * unit).unwrap();
            let size = 1e-9 * (1.0 + point.length());
            let [lower, upper] = [found.lower, found.upper].map(|bound| bound / unit);
            let margin = (truth + size + random.unit() * 1e-3) * unit;
            let decision = wall.clears_tube(&tube, &Pose::IDENTITY, margin, 1e-4 * unit);
            let is_right = lower <= truth + size && truth <= upper + size;
            if !is_right || matches!(decision, Ok(Decision::Clear)) {
                wrong.push((round, close, truth, lower, upper, decision));
            }
            asked[kind] += 1;
            known[kind] += usize::from(upper - lower < 0.25);
            close_by[kind] += usize::from(truth < 0.01);
        }
    }
    let wrong_rounds = wrong.iter().map(|one| one.0).collect::<std::collections::BTreeSet<_>>();
    assert!(
        wrong.is_empty(),
        "{} of {asked:?} in {} tubes: {:?}",
        wrong.len(),
        wrong_rounds.len(),
        &wrong[..wrong.len().min(5)]
    );
    // All kinds are visited, few are refused, most are known closely, and many walls are near.
    let each = ROUNDS * 4 / KINDS.len();
    for kind in 0..KINDS.len() {
        let counts = [asked[kind], refused[kind], known[kind], close_by[kind]];
        assert!(asked[kind] > each / 2 && 5 * refused[kind] < each, "{kind} {counts:?}");
        assert!(
            5 * known[kind] > 4 * asked[kind] && 5 * close_by[kind] > asked[kind],
            "{kind} {counts:?}"
        );
    }
}

/// Three samples of an S-curve that leaves the origin along z, a long and a short segment: two
/// points, the direction at the tip, the radius and the true distance, and the wall.
#[test]
fn a_short_segment_at_the_tip_shows_how_the_long_one_bends() {
    let cases = [
        (
            [
                [0.0029904384581193166, 0.0, 0.9999599990040907],
                [0.0025029736691547454, 0.0, 1.0312463020831122],
            ],
            [-0.016305050279763672, 0.0, 0.9998670638316748],
            [0.8463216559682865, 0.05497648949635725],
            [0.9064670236163008, 0.0, 0.5857788043138724],
        ),
        (
            [
                [0.02335030562478964, 0.0, 0.9996673566181065],
                [0.023451224971835105, 0.0, 1.0058112380806774],
            ],
            [0.016225769060715566, 0.0, 0.9998683535437994],
            [1.082832838746682, 0.0016374913625238907],
            [-1.0732501925496014, 0.0, 0.6102091477625886],
        ),
        (
            [
                [0.022733798844672904, 0.0, 0.9996836702607902],
                [0.022789184839837478, 0.0, 1.0040491938769485],
            ],
            [0.012538316128468157, 0.0, 0.9999213922247401],
            [1.9477850187091583, 0.0394337221661758],
            [-1.9825934970620505, 0.0, 0.3936701605985672],
        ),
    ];
    for ([middle, tip], tangent, [radius, truth], wall) in cases {
        let points = [Vector::ZERO, Vector::from(middle), Vector::from(tip)];
        let tangents = Some([Vector::Z, Vector::from(tangent)]);
        let tube = Tube::with_constant_radius(&points, radius, tangents).unwrap();
        let mut wall = super::speck(Vector::from(wall));
        let found = wall.clearance(&tube, &Pose::IDENTITY, 1e-6).unwrap();
        assert!(found.lower <= truth && truth <= found.upper, "{truth} {found:?}");
        let decision = wall.clears_tube(&tube, &Pose::IDENTITY, truth * (1.0 + 1e-9), 1e-6);
        assert_ne!(decision, Ok(Decision::Clear), "{truth}");
    }
}
