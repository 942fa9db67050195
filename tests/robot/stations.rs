//! `stations` follows a centreline and its faces within the tolerance, evenly and with few links.
//!
//! The judge of the distance is dense sampling of both curves, in both directions; of the number of
//! links, `simplify`.

use continuum_testing::Random;
use parry_continuum::parry::math::{Real, Vector};
use parry_continuum::{RobotError, simplify, stations};

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
        let (kept, kept_radii) = match stations(&points, &radii, tolerance) {
            Ok(kept) => kept,
            Err(error) => {
                assert_eq!(error, simplify(&points, &radii, tolerance).unwrap_err());
                continue;
            }
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
        let few = simplify(&points, &radii, tolerance).unwrap();
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
            let (kept, radii) = stations(&points, &vec![0.0; count], tolerance).unwrap();
            let fewest = simplify(&points, &vec![0.0; count], tolerance).unwrap().1.len();
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
    let (kept, _) = stations(&points, &[0.0; 240], tolerance).unwrap();
    let places = places(&points, &kept);
    assert_eq!(places.len(), 5);
    assert!(places.windows(2).all(|ends| (59..=61).contains(&(ends[1] - ends[0]))), "{places:?}");
    // Faces add at most two chords each: the second where the next one's rim would stick out.
    let (kept, _) = stations(&points, &[0.8; 240], tolerance).unwrap();
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
        stations(&line, &[0.1; 4], 0.0).unwrap(),
        (vec![Vector::ZERO, Vector::X * 3.0], vec![0.1])
    );
    let closed = [Vector::ZERO, Vector::X, Vector::Y, Vector::ZERO];
    assert!(stations(&closed, &[0.1; 3], 1e9).unwrap().1.len() >= 2);
    let stepped = stations(&line, &[0.1, 0.1, 0.5, 0.1], 1.0).unwrap();
    assert_eq!(stepped, simplify(&line, &[0.1, 0.1, 0.5, 0.1], 1.0).unwrap());
}

#[test]
fn the_unit_does_not_matter() {
    let mut random = Random::new(3);
    for _ in 0..300 {
        let (points, radii) = robot(&mut random);
        let tolerance = random.between(0.001, 0.1);
        let Ok((kept, kept_radii)) = stations(&points, &radii, tolerance) else { continue };
        for exponent in [-300, 300] {
            let scale = Real::powi(2.0, exponent);
            let scaled: Vec<_> = points.iter().map(|&point| point * scale).collect();
            let scaled_radii: Vec<_> = radii.iter().map(|radius| radius * scale).collect();
            let (again, again_radii) = stations(&scaled, &scaled_radii, tolerance * scale).unwrap();
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
        assert!(matches!(
            stations(&points, &[0.1; 2], tolerance),
            Err(RobotError::Negative { parameter: "tolerance", .. })
        ));
    }
    assert_eq!(
        stations(&points[..1], &[], 0.1),
        Err(RobotError::TooFewPoints { parameter: "points", count: 1 })
    );
    let differ =
        RobotError::LengthsDiffer { parameter: "segment_radii", points: 3, expected: 2, radii: 1 };
    assert_eq!(stations(&points, &[0.1], 0.1), Err(differ));
    assert_eq!(stations(&[Vector::X; 3], &[0.1; 2], 0.1), Err(RobotError::AllPointsEqual));
    let nan = stations(&[Vector::ZERO, Vector::NAN], &[0.1], 0.1).unwrap_err();
    assert!(matches!(nan, RobotError::PointNotFinite { index: 1, .. }));
    let negative = stations(&points, &[0.1, -2.0], 0.1).unwrap_err();
    assert!(matches!(negative, RobotError::BadRadius { index: 1, value: -2.0, .. }));
}
