//! `simplify` follows a centreline and its faces within the tolerance, evenly and with few links.
//!
//! The judge of the distance is dense sampling of both curves, in both directions; of the number of
//! links, a shortest path over all chords.

use continuum_testing::Random;
use parry_continuum::parry::math::{Real, Vector};
use parry_continuum::{RobotError, simplify};

/// Curves that bend more and less, with noise, hooks, loops and repeated points, and one to three
/// radii.
fn robot(random: &mut Random) -> (Vec<Vector>, Vec<Real>) {
    let count = 2 + (random.unit() * 100.0) as usize;
    let noise = [0.0, 1e-4, 0.01, 0.3][(random.unit() * 4.0) as usize];
    let (mut points, mut direction) = (vec![random.point()], random.point().normalize());
    let mut curvature = random.point();
    for _ in 1..count {
        if random.unit() < 0.05 {
            curvature = random.point() * 2.0;
        }
        if random.unit() < 0.01 {
            direction = -direction;
        }
        direction = (direction + curvature.cross(direction) * 0.1).normalize();
        let step = if random.unit() < 0.03 { 0.0 } else { random.between(0.05, 0.15) };
        points.push(points[points.len() - 1] + direction * step + random.point() * noise * step);
    }
    let mut radius = 0.3;
    let radii = (1..count).map(|_| {
        if random.unit() < 0.03 {
            radius = [0.0, 0.1, 0.2, 0.5][(random.unit() * 4.0) as usize];
        }
        radius
    });
    let radii = radii.collect();
    (points, radii)
}

/// The input without segments that have no length.
fn distinct(points: &[Vector], radii: &[Real]) -> (Vec<Vector>, Vec<Real>) {
    let (mut kept, mut kept_radii) = (vec![points[0]], vec![]);
    for (ends, &radius) in points.windows(2).zip(radii) {
        if ends[0] != ends[1] {
            kept.push(ends[1]);
            kept_radii.push(radius);
        }
    }
    (kept, kept_radii)
}

fn distance(a: Vector, b: Vector, p: Vector) -> Real {
    let t = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
    (a + (b - a) * t - p).length()
}

/// Where the kept points stand in the input.
fn places(points: &[Vector], kept: &[Vector]) -> Vec<usize> {
    let mut rest = 0;
    let place = |kept: &Vector| {
        rest +=
            points[rest..].iter().position(|point| point == kept).expect("a point of the input");
        rest
    };
    kept.iter().map(place).collect()
}

/// By how much the rim of each face of the input moves: at both ends and on the wider side of each
/// step.
fn rims(points: &[Vector], radii: &[Real], kept: &[Vector], kept_radii: &[Real]) -> Vec<Real> {
    let places = places(points, kept);
    let direction = |points: &[Vector], k: usize| (points[k + 1] - points[k]).normalize();
    let last = kept_radii.len() - 1;
    let mut rims = vec![];
    for k in 0..=last {
        let radius = kept_radii[k];
        if k == 0 || kept_radii[k - 1] < radius {
            rims.push(radius * (direction(kept, k) - direction(points, places[k])).length());
        }
        if k == last || kept_radii[k + 1] < radius {
            rims.push(
                radius * (direction(kept, k) - direction(points, places[k + 1] - 1)).length(),
            );
        }
    }
    assert!(radii.len() >= kept_radii.len());
    rims
}

#[test]
fn centreline_and_faces_are_followed_within_the_tolerance() {
    let mut random = Random::new(1);
    let (mut spared, mut bound_by_faces, mut coarse) = (0, 0, 0);
    for _ in 0..3000 {
        let (points, radii) = robot(&mut random);
        let (points, radii) =
            if random.unit() < 0.5 { distinct(&points, &radii) } else { (points, radii) };
        let tolerance = Real::powf(10.0, random.between(-4.0, 0.0));
        let Ok((kept, kept_radii)) = simplify(&points, &radii, tolerance) else {
            assert!(points.iter().all(|point| *point == points[0]));
            continue;
        };
        let (points, radii) = distinct(&points, &radii);
        assert_eq!((kept[0], kept[kept.len() - 1]), (points[0], points[points.len() - 1]));
        for ((ends, link), &radius) in
            places(&points, &kept).windows(2).zip(kept.windows(2)).zip(&kept_radii)
        {
            assert!(
                radii[ends[0]..ends[1]].iter().all(|&one| one == radius),
                "the radius changes within a link"
            );
            let stretch = &points[ends[0]..=ends[1]];
            for samples in stretch.windows(2) {
                for k in 0..=4 {
                    let off = distance(
                        link[0],
                        link[1],
                        samples[0].lerp(samples[1], Real::from(k) / 4.0),
                    );
                    assert!(off <= tolerance + 1e-12, "{off} {tolerance}");
                }
            }
            for k in 0..=20 {
                let p = link[0].lerp(link[1], Real::from(k) / 20.0);
                let off = stretch.windows(2).map(|ends| distance(ends[0], ends[1], p));
                assert!(off.fold(Real::INFINITY, Real::min) <= tolerance + 1e-12);
            }
        }
        // The faces of a thin robot need no short links.
        let times = |radii: &[Real], factor: Real| -> Vec<_> {
            radii.iter().map(|radius| radius * factor).collect()
        };
        let thin = simplify(&points, &times(&radii, 1e-9), tolerance).unwrap();
        let few = (thin.0, times(&thin.1, 1e9));
        let worst = |kept: &(Vec<Vector>, Vec<Real>)| {
            rims(&points, &radii, &kept.0, &kept.1).into_iter().fold(0.0, Real::max)
        };
        let kept = (kept, kept_radii);
        assert!(worst(&kept) <= tolerance + 1e-12, "{} {tolerance}", worst(&kept));
        bound_by_faces += usize::from(worst(&few) > tolerance);
        spared += radii.len() - kept.1.len();
        coarse += usize::from(kept.1.len() > 5 && kept.1.len() * 4 < radii.len());
    }
    assert!(spared > 40_000, "{spared}");
    assert!(bound_by_faces > 500, "{bound_by_faces}");
    assert!(coarse > 300, "{coarse}");
}

/// The fewest links by the plain shortest path over all chords that hold.
fn fewest(points: &[Vector], tolerance: Real) -> usize {
    let mut fewest = vec![0];
    for to in 1..points.len() {
        let holds = |&from: &usize| {
            let (start, end) = (points[from], points[to]);
            // From the middle on, where most chords fail.
            let middle = (from + to) / 2;
            let between = (middle..to).chain(from + 1..middle);
            start != end
                && between.into_iter().all(|k| distance(start, end, points[k]) <= tolerance)
        };
        let links = (0..to).filter(holds).map(|from| fewest[from] + 1).min();
        fewest.push(links.expect("a segment replaces itself"));
    }
    fewest[points.len() - 1]
}

/// A wire whose bends change along the way: nearly as few links as are possible, and every one
/// bends as much.
#[test]
fn few_and_evenly_spread() {
    let mut random = Random::new(2);
    for count in [150, 300, 1000, 3000] {
        let (turns, wave) = (random.between(1.0, 3.0), random.between(0.5, 2.0));
        let curve = |k: usize| {
            let t = turns * k as Real / count as Real;
            Vector::new(t, (2.0 * t).sin(), wave * (t * t).cos())
        };
        let points: Vec<_> = (0..=count).map(curve).collect();
        for tolerance in [1e-3, 1e-4] {
            let (kept, radii) = simplify(&points, &vec![0.0; count], tolerance).unwrap();
            let fewest = fewest(&points, tolerance);
            assert!(
                radii.len() as Real <= 1.15 * fewest as Real,
                "{count} {}, {fewest}",
                radii.len()
            );
            let deviations = places(&points, &kept)
                .windows(2)
                .map(|ends| {
                    let (a, b) = (points[ends[0]], points[ends[1]]);
                    points[ends[0]..ends[1]].iter().map(|&p| distance(a, b, p)).fold(0.0, Real::max)
                })
                .collect::<Vec<_>>();
            let even = deviations.iter().filter(|&&deviation| deviation > 0.5 * tolerance).count();
            // Samples as coarse as the chords leave no choice, and where a curve turns over it is
            // straight.
            if count / radii.len() > 20 {
                assert!(even * 10 > deviations.len() * 8, "{count} {tolerance} {deviations:?}");
            }
        }
    }
}

/// An arc for which three chords are too few gets four equal ones, not three long ones and a short
/// one.
#[test]
fn an_arc_in_equal_parts() {
    let arc = |k: u32| (f64::from(k) * 0.01).sin_cos();
    let points: Vec<_> = (0..=240).map(arc).map(|(y, x)| Vector::new(x, y, 0.0)).collect();
    // A chord over 72 steps.
    let tolerance = 1.0 - Real::cos(0.36);
    let (kept, _) = simplify(&points, &[0.0; 240], tolerance).unwrap();
    let places = places(&points, &kept);
    assert_eq!(places.len(), 5);
    assert!(places.windows(2).all(|ends| (59..=61).contains(&(ends[1] - ends[0]))), "{places:?}");
    // Faces add at most two chords each: the second where the next one's rim would stick out.
    let (kept, _) = simplify(&points, &[0.8; 240], tolerance).unwrap();
    assert!(
        rims(&points, &[0.8; 240], &kept, &vec![0.8; kept.len() - 1])
            .iter()
            .all(|&rim| rim <= tolerance)
    );
    assert!(kept.len() <= 9, "{}", kept.len());
}

#[test]
fn tolerance_0_repeats_and_loops() {
    let line: Vec<_> = [0.0, 1.0, 2.0, 2.0, 3.0].map(|x| Vector::X * x).to_vec();
    assert_eq!(
        simplify(&line, &[0.1; 4], 0.0).unwrap(),
        (vec![Vector::ZERO, Vector::X * 3.0], vec![0.1])
    );
    let closed = [Vector::ZERO, Vector::X, Vector::Y, Vector::ZERO];
    assert!(simplify(&closed, &[0.1; 3], 1e9).unwrap().1.len() >= 2);
    let stepped = simplify(&line, &[0.1, 0.1, 0.5, 0.1], 1.0).unwrap();
    assert_eq!(stepped, simplify(&line, &[0.1, 0.1, 0.5, 0.1], 1.0).unwrap());
}

fn on_a_line(xs: &[Real]) -> Vec<Vector> {
    xs.iter().map(|&x| Vector::new(x, 2.0 * x, 3.0 * x)).collect()
}

/// The number of links of a wire.
fn links(points: &[Vector], tolerance: Real) -> usize {
    simplify(points, &vec![0.0; points.len() - 1], tolerance).unwrap().1.len()
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
    // A segment without length makes no change, with any radius.
    let (kept, kept_radii) = simplify(&points, &[0.1, 0.1, 0.1, 0.5, 0.1, 0.1], 10.0).unwrap();
    assert_eq!((kept.len(), kept_radii), (2, vec![0.1]));
}

#[test]
fn the_unit_does_not_matter() {
    let mut random = Random::new(3);
    for _ in 0..300 {
        let (points, radii) = robot(&mut random);
        let tolerance = random.between(0.001, 0.1);
        let Ok((kept, kept_radii)) = simplify(&points, &radii, tolerance) else { continue };
        for exponent in [-300, 300] {
            let scale = Real::powi(2.0, exponent);
            let scaled: Vec<_> = points.iter().map(|&point| point * scale).collect();
            let scaled_radii: Vec<_> = radii.iter().map(|radius| radius * scale).collect();
            let (again, again_radii) = simplify(&scaled, &scaled_radii, tolerance * scale).unwrap();
            assert_eq!(again, kept.iter().map(|&point| point * scale).collect::<Vec<_>>());
            assert_eq!(
                again_radii,
                kept_radii.iter().map(|radius| radius * scale).collect::<Vec<_>>()
            );
        }
    }
}

#[test]
fn bad_input_is_named() {
    let points = [Vector::ZERO, Vector::X, Vector::X * 2.0];
    for tolerance in [-1.0, Real::NAN, Real::INFINITY] {
        let error = simplify(&points, &[0.1; 2], tolerance).unwrap_err();
        assert!(matches!(error, RobotError::Negative { parameter: "tolerance", .. }));
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

/// Radii that differ by rounding are one: as many links as of one radius, with the largest of them.
#[test]
fn rounding_of_the_radius_is_no_step() {
    let mut random = Random::new(9);
    let arc = |k: u32| {
        let (sin, cos) = (f64::from(k) / 300.0).sin_cos();
        Vector::new(30.0 * cos, 30.0 * sin, 0.0)
    };
    let points: Vec<_> = (0..=300).map(arc).collect();
    let (expected, _) = simplify(&points, &[1.0; 300], 0.01).unwrap();
    for noise in [1e-16, 3e-16, 1e-12, 1e-10] {
        for kind in 0..3 {
            let radius = |k: usize| match kind {
                0 => 1.0 + noise * f64::from(u8::from(k >= 150)),
                1 => 1.0 + noise * f64::from(u8::from(k.is_multiple_of(2))),
                _ => 1.0 + noise * random.unit(),
            };
            let radii: Vec<_> = (0..300).map(radius).collect();
            let (kept, kept_radii) = simplify(&points, &radii, 0.01).unwrap();
            assert_eq!(kept, expected, "{noise} {kind}");
            let widest = radii.iter().copied().fold(0.0, Real::max);
            assert!(kept_radii.iter().all(|&radius| radius == widest), "{noise} {kind}");
        }
    }
    // A real step stays.
    let radii: Vec<_> = (0..300).map(|k| if k < 150 { 1.0 } else { 1.0 + 1e-9 }).collect();
    let (kept, _) = simplify(&points, &radii, 0.01).unwrap();
    assert!(kept.contains(&points[150]));
}
