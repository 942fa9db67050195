//! `simplify` returns the fewest links that stay within the tolerance.
//!
//! The judge of what stays within it is a dense sampling of both curves, in both directions; the
//! judge of what is fewest tries every subset of the vertices.

use continuum_testing::Random;
use parry_continuum::parry::math::{Real, Vector};
use parry_continuum::{Chain, RobotError, simplify};

const SAMPLES: usize = 64;

fn sample(polyline: &[Vector]) -> Vec<Vector> {
    let on_segment = |ends: &[Vector]| {
        let (a, b) = (ends[0], ends[1]);
        (0..=SAMPLES).map(move |i| a.lerp(b, i as Real / SAMPLES as Real))
    };
    polyline.windows(2).flat_map(on_segment).collect()
}

fn distance_to(polyline: &[Vector], p: Vector) -> Real {
    let to_segment = |ends: &[Vector]| {
        let (w, e) = (p - ends[0], ends[1] - ends[0]);
        let t = (w.dot(e) / e.dot(e)).clamp(0.0, 1.0);
        (w - e * t).length()
    };
    polyline.windows(2).map(to_segment).fold(Real::INFINITY, Real::min)
}

/// The Hausdorff distance, too small by at most half a sampling step.
fn hausdorff(a: &[Vector], b: &[Vector]) -> Real {
    let one_way = |a: &[Vector], b: &[Vector]| {
        sample(a).iter().map(|&p| distance_to(b, p)).fold(0.0, Real::max)
    };
    one_way(a, b).max(one_way(b, a))
}

/// The fewest links over every subset, or None if a chord is too near the tolerance for sampling to
/// tell.
fn brute_force(
    points: &[Vector],
    radii: &[Real],
    tolerance: Real,
    seen: &mut Seen,
) -> Option<usize> {
    let n = points.len();
    let mut admissible = vec![vec![true; n]; n];
    for from in 0..n {
        for to in from + 2..n {
            let (stretch, chord) = (&points[from..=to], [points[from], points[to]]);
            let longest =
                points.windows(2).chain([&chord[..]]).map(|ends| (ends[1] - ends[0]).length());
            let margin = longest.fold(0.0, Real::max) / (2 * SAMPLES) as Real;
            let distance = hausdorff(stretch, &chord);
            if (distance..=distance + margin).contains(&tolerance) {
                return None;
            }
            admissible[from][to] = distance < tolerance;
        }
    }
    let fixed = |k: usize| k == 0 || k == n - 1 || radii[k - 1] != radii[k];
    let mut fewest = n;
    for subset in 0_u32..1 << n {
        let kept: Vec<_> = (0..n).filter(|k| subset >> k & 1 == 1).collect();
        let keeps_all_fixed = (0..n).all(|k| !fixed(k) || kept.contains(&k));
        if keeps_all_fixed && kept.windows(2).all(|ends| admissible[ends[0]][ends[1]]) {
            fewest = fewest.min(kept.len() - 1);
        }
    }
    seen.record(&admissible, (1..n - 1).all(|k| !fixed(k)), fewest);
    Some(fewest)
}

/// What a sample of problems has visited.
#[derive(Default)]
struct Seen {
    problems: usize,
    /// Some links were removed, but not all that the radii allow.
    neither_all_nor_nothing: usize,
    /// The radius changes along the way.
    steps: usize,
    /// A chord is not admissible but a longer one from the same vertex is.
    not_monotone: usize,
    /// The farthest admissible chord from each vertex in turn needs more links than necessary.
    greedy_fails: usize,
}

impl Seen {
    fn record(&mut self, admissible: &[Vec<bool>], one_radius: bool, fewest: usize) {
        let n = admissible.len();
        self.problems += 1;
        self.neither_all_nor_nothing += usize::from(fewest > 1 && fewest < n - 1);
        let fails_then_holds = |row: &Vec<bool>| row.windows(2).any(|pair| !pair[0] && pair[1]);
        self.not_monotone += usize::from(admissible.iter().any(fails_then_holds));
        self.steps += usize::from(!one_radius);
        if one_radius {
            let next = |&from: &usize| (from + 1..n).rev().find(|&to| admissible[from][to]);
            let greedy = std::iter::successors(Some(0), next).count() - 1;
            self.greedy_fails += usize::from(greedy > fewest);
        }
    }
}

/// Small robots that bend, hook, run back on themselves and cross themselves.
fn robot(random: &mut Random) -> (Vec<Vector>, Vec<Real>) {
    let n = [3, 5, 7, 8, 9][random.below(5) as usize];
    let noise = [0.02, 0.1, 0.3][random.below(3) as usize];
    let kind = random.below(3);
    let mut points = vec![random.point()];
    let direction = random.point();
    for _ in 1..n {
        let step = match kind {
            0 => random.point(),
            // Forward, with noise.
            1 => direction * random.between(0.2, 1.0) + random.point() * noise,
            // To and fro along a line, with noise.
            _ => direction * random.between(-0.8, 1.0) + random.point() * noise,
        };
        points.push(points[points.len() - 1] + step);
    }
    let change = if random.below(3) == 0 { 4 } else { u32::MAX };
    let mut radius = 1.0;
    let radii = (1..n).map(|_| {
        radius = if random.below(change) == 0 { random.unit() } else { radius };
        radius
    });
    let radii = radii.collect();
    (points, radii)
}

#[test]
fn as_few_links_as_brute_force_finds() {
    let mut random = Random::new(1);
    let (mut seen, mut unclear) = (Seen::default(), 0);
    while seen.problems < 4000 {
        let (points, radii) = robot(&mut random);
        // From a fraction of the steps to the size of the whole robot.
        let tolerance = Real::powf(10.0, random.between(-1.0, 0.3));
        let Some(fewest) = brute_force(&points, &radii, tolerance, &mut seen) else {
            unclear += 1;
            continue;
        };
        let (kept, kept_radii) = simplify(&points, &radii, tolerance).unwrap();
        assert_eq!(kept_radii.len(), fewest, "{points:?} {radii:?} {tolerance}");
        assert_follows(&points, &radii, &kept, &kept_radii, tolerance);
    }
    assert!(unclear * 5 < seen.problems, "{unclear}");
    assert!(seen.neither_all_nor_nothing * 4 > seen.problems, "{}", seen.neither_all_nor_nothing);
    assert!(seen.steps * 10 > seen.problems, "{}", seen.steps);
    assert!(seen.not_monotone * 40 > seen.problems, "{}", seen.not_monotone);
    assert!(seen.greedy_fails > 5, "{}", seen.greedy_fails);
}

/// The kept points are input points in order with both ends and every change of radius, and each
/// link and the stretch it replaces are within the tolerance by sampling.
fn assert_follows(
    points: &[Vector],
    radii: &[Real],
    kept: &[Vector],
    kept_radii: &[Real],
    tolerance: Real,
) {
    assert_eq!(kept.len(), kept_radii.len() + 1);
    let mut indices = vec![0];
    for &point in &kept[1..] {
        let from = indices[indices.len() - 1];
        indices
            .push((from + 1..points.len()).find(|&k| points[k] == point).expect("an input point"));
    }
    assert_eq!(points[0], kept[0]);
    assert_eq!(indices.last(), Some(&(points.len() - 1)));
    for (ends, &radius) in indices.windows(2).zip(kept_radii) {
        assert!(
            radii[ends[0]..ends[1]].iter().all(|&r| r == radius),
            "the radius changes within a link"
        );
        let chord = [points[ends[0]], points[ends[1]]];
        let distance = hausdorff(&points[ends[0]..=ends[1]], &chord);
        let extent = chord[0].distance(chord[1]) + tolerance;
        assert!(distance <= tolerance + 4.0 * Real::EPSILON * extent, "{distance} > {tolerance}");
    }
}

#[test]
fn long_centrelines() {
    let mut random = Random::new(2);
    let mut spared = 0;
    for tolerance in [1e-4, 1e-3, 1e-2, 0.1] {
        let helix = |i: i32| {
            let t = f64::from(i) * 0.05;
            Vector::new(t.cos(), t.sin(), 0.1 * t) + random.point() * 1e-3
        };
        let points: Vec<_> = (0..200).map(helix).collect();
        let radii: Vec<_> = (0..199).map(|k| if k < 90 { 0.2 } else { 0.1 }).collect();
        let (kept, kept_radii) = simplify(&points, &radii, tolerance).unwrap();
        assert_follows(&points, &radii, &kept, &kept_radii, tolerance);
        assert!(kept.contains(&points[90]));
        spared += 199 - kept_radii.len();
        assert!(Chain::from_centreline(&kept, &kept_radii).is_ok());
    }
    assert!(spared > 300, "{spared}");
}

/// The fewest links by the plain shortest path over all chords, one radius throughout.
fn shortest_path(points: &[Vector], is_near: impl Fn(Vector, [Vector; 2]) -> bool) -> usize {
    let mut fewest = vec![0];
    for to in 1..points.len() {
        let admissible = |&from: &usize| {
            let chord = [points[from], points[to]];
            chord[0] != chord[1] && points[from..to].iter().all(|&p| is_near(p, chord))
        };
        fewest.push(
            (0..to).filter(admissible).map(|from| fewest[from] + 1).min().unwrap_or(usize::MAX / 2),
        );
    }
    fewest[points.len() - 1]
}

/// Long enough that walls and gates rule out most chords.
#[test]
fn as_few_links_as_the_plain_search() {
    let mut random = Random::new(4);
    let (mut decided, mut bent, mut long) = (0, 0, 0);
    for problem in 0..1500 {
        let count = 20 + random.below(100) as usize;
        let noise = [0.0, 0.01, 0.1, 0.5][random.below(4) as usize];
        let (mut points, mut direction) = (vec![random.point()], random.point().normalize());
        let mut bend = random.point();
        for _ in 1..count {
            match random.below(40) {
                0 => bend = random.point() * 1.5,
                // A hook.
                1 => direction = -direction,
                _ => direction = (direction + bend.cross(direction) * 0.1).normalize(),
            }
            let last = points[points.len() - 1];
            let step = if random.below(20) == 0 { 0.0 } else { random.between(0.02, 0.2) };
            points.push(last + direction * step + random.point() * noise * step);
        }
        let (fewest, tolerance) = if problem % 3 > 0 {
            let tolerance = Real::powf(10.0, random.between(-4.0, 0.5));
            let within =
                |limit: Real| shortest_path(&points, |p, ends| distance_to(&ends, p) <= limit);
            let fewest = within(tolerance * (1.0 - 1e-9));
            if fewest != within(tolerance * (1.0 + 1e-9)) {
                continue;
            }
            (fewest, tolerance)
        } else {
            // Whole numbers, whose products are exact, and often on a line.
            let size = [3.0, 10.0, 40.0][random.below(3) as usize];
            points.iter_mut().for_each(|p| *p = (*p * size).round());
            let is_on = |p: Vector, [a, b]: [Vector; 2]| {
                (p - a).cross(b - a) == Vector::ZERO
                    && (p - a).dot(b - a) >= 0.0
                    && (p - b).dot(a - b) >= 0.0
            };
            if points.iter().all(|&p| p == points[0]) {
                continue;
            }
            (shortest_path(&points, is_on), 0.0)
        };
        if points[0] == points[count - 1] && fewest == 0 {
            continue;
        }
        decided += 1;
        bent += usize::from(fewest > 5 && fewest * 3 < count);
        long += usize::from(fewest <= 3);
        assert_eq!(links(&points, tolerance), fewest, "{points:?} {tolerance}");
    }
    assert!(decided > 1400, "{decided}");
    assert!(bent > 200, "{bent}");
    assert!(long > 100, "{long}");
}

/// n evenly spaced points of a circle of radius 1: a chord over m steps is off by 1 - cos(m angle /
/// 2).
#[test]
fn an_arc_as_geometry_says() {
    let angle = 0.01;
    let points: Vec<_> = (0..=240)
        .map(|i| (angle * f64::from(i)).sin_cos())
        .map(|(y, x)| Vector::new(x, y, 0.0))
        .collect();
    for steps in [2_u32, 7, 24, 60] {
        let sagitta = |steps: u32| 1.0 - (angle * f64::from(steps) / 2.0).cos();
        // The deepest vertex is off the middle by half a step if the number of steps is odd.
        let depth = |steps| sagitta(steps) - if steps % 2 == 1 { sagitta(1) } else { 0.0 };
        let tolerance = (depth(steps) + depth(steps + 1)) / 2.0;
        let (kept, _) = simplify(&points, &[0.1; 240], tolerance).unwrap();
        assert_eq!(kept.len() as u32 - 1, 240_u32.div_ceil(steps), "{steps}");
    }
}

fn on_a_line(xs: &[Real]) -> Vec<Vector> {
    xs.iter().map(|&x| Vector::new(x, 2.0 * x, 3.0 * x)).collect()
}

fn links(points: &[Vector], tolerance: Real) -> usize {
    simplify(points, &vec![0.1; points.len() - 1], tolerance).unwrap().1.len()
}

#[test]
fn tolerance_0_drops_only_what_is_collinear() {
    let m = 123_456_789.0;
    let points = on_a_line(&[0.0, m, 2.0 * m, 5.0 * m, 7.0 * m]);
    assert_eq!(links(&points, 0.0), 1);
    for k in 1..4 {
        for axis in 0..3 {
            for nudge in [1.0 + 1e-14, 1.0 - 1e-14] {
                let mut points = points.clone();
                points[k][axis] *= nudge;
                assert_eq!(links(&points, 0.0), [3, 4, 3][k - 1]);
            }
        }
    }
}

#[test]
fn hooks_and_runs_back_on_a_line() {
    // Runs back, but never leaves the chord.
    assert_eq!(links(&on_a_line(&[0.0, 2.0, 1.0, 3.0]), 0.0), 1);
    // Overshoots the end, or starts backwards.
    assert_eq!(links(&on_a_line(&[0.0, 3.0, 2.0]), 0.0), 2);
    assert_eq!(links(&on_a_line(&[0.0, -1.0, 2.0]), 0.0), 2);
    assert_eq!(links(&on_a_line(&[0.0, -1.0, 3.0, 2.0]), 0.0), 3);
    // The hook counts with its length.
    let overshoot = 14.0_f64.sqrt();
    assert_eq!(links(&on_a_line(&[0.0, 3.0, 2.0]), overshoot * 1.000001), 1);
    assert_eq!(links(&on_a_line(&[0.0, 3.0, 2.0]), overshoot * 0.999999), 2);
    // A closed loop keeps one more vertex, for all tolerances.
    let (kept, _) = simplify(&on_a_line(&[0.0, 1.0, 2.0, 0.0]), &[0.1; 3], 1e9).unwrap();
    assert_eq!(kept.len(), 3);
}

/// The vertex (m, 2m) is exactly m from the line through (0, 0) and (4m, 3m), and all squares are
/// exact.
#[test]
fn ties_of_exact_squares_may_go() {
    for i in 0..100_u32 {
        let m = Real::from(2 * i + 1) * 1_234.0;
        for exponent in [-300, 0, 250] {
            let m = m * Real::powi(2.0, exponent);
            let points =
                [(0.0, 0.0), (1.0, 2.0), (4.0, 3.0)].map(|(x, y)| Vector::new(x, y, 0.0) * m);
            assert_eq!(links(&points, m), 1);
            assert_eq!(links(&points, m * (1.0 - 1e-14)), 2);
            let points =
                [(0.0, 0.0), (-3.0, 4.0), (1.0, 0.0)].map(|(x, y)| Vector::new(x, y, 0.0) * m);
            assert_eq!(links(&points, 5.0 * m), 1);
            assert_eq!(links(&points, 5.0 * m * (1.0 - 1e-15)), 2);
        }
    }
}

#[test]
fn the_unit_does_not_matter() {
    let mut random = Random::new(3);
    for _ in 0..200 {
        let (points, radii) = robot(&mut random);
        let tolerance = random.between(0.01, 0.5);
        let (kept, kept_radii) = simplify(&points, &radii, tolerance).unwrap();
        for exponent in [-300, 300] {
            let scale = Real::powi(2.0, exponent);
            let scaled: Vec<_> = points.iter().map(|&point| point * scale).collect();
            let (again, again_radii) = simplify(&scaled, &radii, tolerance * scale).unwrap();
            assert_eq!(again, kept.iter().map(|&point| point * scale).collect::<Vec<_>>());
            assert_eq!(again_radii, kept_radii);
        }
    }
}

#[test]
fn a_tiny_robot_far_out() {
    let points =
        [0.0, 1.0, 2.0].map(|x: Real| Vector::new(x * 1e-300, x * (2.0 - x) * 1e-300, 1e149));
    assert_eq!(links(&points, 1e-300), 1);
    assert_eq!(links(&points, 0.99e-300), 2);
}

#[test]
fn repeated_points() {
    let points = [0.0, 0.0, 1.0, 1.0, 1.0, 2.0, 2.0].map(|x| Vector::X * x);
    // Without a change of radius, nothing stays of the repeated points.
    let (kept, radii) = simplify(&points, &[0.1; 6], 0.0).unwrap();
    assert_eq!((kept, radii), (vec![Vector::ZERO, Vector::X * 2.0], vec![0.1]));
    // A change of radius between or on them keeps the point, once.
    for radii in [
        [0.1, 0.1, 0.1, 0.2, 0.2, 0.2],
        [0.1, 0.1, 0.2, 0.2, 0.2, 0.2],
        [0.3, 0.1, 0.3, 0.3, 0.2, 0.4],
    ] {
        let (kept, kept_radii) = simplify(&points, &radii, 10.0).unwrap();
        assert_eq!(
            (kept, kept_radii),
            (vec![Vector::ZERO, Vector::X, Vector::X * 2.0], vec![0.1, 0.2])
        );
    }
    // A radius of its own on a segment without length is a change of radius too.
    let (kept, kept_radii) = simplify(&points, &[0.1, 0.1, 0.1, 0.5, 0.1, 0.1], 10.0).unwrap();
    assert_eq!((kept.len(), kept_radii), (3, vec![0.1, 0.1]));
}

#[test]
fn bad_input_is_named() {
    let points = [Vector::ZERO, Vector::X, Vector::X * 2.0];
    for tolerance in [-1.0, Real::NAN, Real::INFINITY] {
        let error = simplify(&points, &[0.1; 2], tolerance).unwrap_err();
        assert!(error.to_string().contains(&tolerance.to_string()), "{error}");
    }
    assert_eq!(
        simplify(&points[..1], &[], 0.1),
        Err(RobotError::TooFewPoints { parameter: "points", count: 1 })
    );
    let differ =
        RobotError::LengthsDiffer { parameter: "segment_radii", points: 3, expected: 2, radii: 1 };
    assert_eq!(simplify(&points, &[0.1], 0.1), Err(differ));
    assert_eq!(simplify(&[Vector::X; 3], &[0.1; 2], 0.1), Err(RobotError::AllPointsEqual));
    let nan = simplify(&[Vector::ZERO, Vector::NAN], &[0.1], 0.1).unwrap_err();
    assert!(matches!(nan, RobotError::PointNotFinite { index: 1, .. }));
    let negative = simplify(&points, &[0.1, -2.0], 0.1).unwrap_err();
    assert!(matches!(negative, RobotError::BadRadius { index: 1, value: -2.0, .. }));
}
