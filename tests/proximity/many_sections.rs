//! Tubes of many sections, coils from frames, turns that are stated and samples taken twice.

use continuum_testing::{Random, rounds};
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::proximity::{BvhSearch, Decision, RobotPair, SelfQuery};
use parry_continuum::{Chain, Tube};
use std::f64::consts::PI;

/// A helix of straight links, and its tube.
fn helix(count: u32, taper: f64) -> (Chain, Tube) {
    let point = |k: u32| {
        let a = 20.0 * f64::from(k) / f64::from(count);
        Vector::new(10.0 * a.cos(), 10.0 * a.sin(), 3.0 * a)
    };
    let points: Vec<_> = (0..=count).map(point).collect();
    let radii: Vec<_> = (0..count).map(|k| 1.0 - taper * f64::from(k) / f64::from(count)).collect();
    let chain = Chain::from_centreline(&points, &radii).unwrap();
    let tube = Tube::from(&chain);
    (chain, tube)
}

/// The bounds enclose the distance of the chains, near and far apart.
#[test]
fn two_robots_of_many_sections_are_bounded() {
    let mut random = Random::new(91);
    for (count, taper) in [(150, 0.0), (150, 0.3), (600, 0.3)] {
        let (chain, tube) = helix(count, taper);
        for away in [25.0, 60.0, 1000.0] {
            let here = random.pose(0.0);
            let there = Pose::from_parts(random.direction() * away, random.pose(0.0).rotation);
            let mut pair = RobotPair::new();
            let expected = pair.minimum(&chain, &here, &chain, &there).unwrap().distance;
            let cold = RobotPair::new().clearance(&tube, &here, &tube, &there, 1e-6).unwrap();
            assert!(
                cold.lower <= expected + 1e-9
                    && expected <= cold.upper + 1e-9
                    && cold.upper - cold.lower <= 1e-6,
                "{count} {taper} {away}: {expected} {cold:?}"
            );
            // The last answer changes nothing but the time.
            let warm = pair.clearance(&tube, &here, &tube, &there, 1e-6).unwrap();
            let again = pair.clearance(&tube, &here, &tube, &there, 1e-6).unwrap();
            for found in [warm, again] {
                assert_eq!([found.lower, found.upper], [cold.lower, cold.upper]);
            }
            let margin = |margin: f64| {
                RobotPair::new().clears_tubes(&tube, &here, &tube, &there, margin, 1e-6).unwrap()
            };
            if expected > 1e-3 {
                assert_eq!(margin(expected - 1e-3), Decision::Clear);
                assert_eq!(margin(expected + 1e-3), Decision::Contact);
            }
        }
    }
}

/// Far apart nearly all pairs of sections are as near: only those that may be nearest are kept.
#[test]
fn two_robots_of_many_sections_need_memory_for_their_sections() {
    let count = 1500;
    for taper in [0.0, 0.3] {
        let (_, tube) = helix(count, taper);
        let (here, there) = (Pose::IDENTITY, Pose::translation(1000.0, 1.0, 2.0));
        let mut pair = RobotPair::new();
        let memory = allocation_counter::measure(|| {
            pair.clearance(&tube, &here, &tube, &there, 1e-6).unwrap();
        });
        // All pairs of sections are a hundred times as many bytes.
        assert!(memory.bytes_max < 4000 * u64::from(count), "{}", memory.bytes_max);
    }
}

/// A chain of very many sections and itself decides as its links do.
#[test]
fn a_robot_of_many_sections_is_decided_as_its_links() {
    let mut query = SelfQuery::new();
    for (count, taper) in [(200, 0.0), (1500, 0.3)] {
        let (chain, tube) = helix(count, taper);
        let distance = query.minimum(&chain).unwrap().unwrap().distance;
        for (margin, expected) in
            [(distance - 1e-3, Decision::Clear), (distance + 1e-3, Decision::Contact)]
        {
            assert_eq!(query.clears_tube(&tube, margin, 1e-6).unwrap(), expected, "{count}");
        }
    }
}

/// With a margin wider than the robot every pair is near: the first one that counts decides, and
/// pairs that turn too little are left out in groups.
#[test]
fn a_margin_wider_than_a_robot_of_many_sections_needs_memory_for_its_sections() {
    let count = 1500;
    let (chain, tube) = helix(count, 0.3);
    let points: Vec<_> = chain.links().iter().map(|link| link.start()).collect();
    let radii: Vec<_> = chain.links()[1..].iter().map(|link| link.radius()).collect();
    let curve = Tube::from_samples(&points, &radii, None).unwrap();
    // A quarter of a turn.
    let straight = Tube::from_samples(&points[..100], &radii[..99], None).unwrap();
    for (tube, expected) in
        [(tube, Decision::Contact), (curve, Decision::Contact), (straight, Decision::Clear)]
    {
        let mut decision = None;
        let memory = allocation_counter::measure(|| {
            decision = Some(SelfQuery::new().clears_tube(&tube, 1e3, 1e-3).unwrap());
        });
        assert_eq!(decision, Some(expected));
        // All pairs of pieces are a hundred times as many bytes.
        assert!(memory.bytes_max < 4000 * u64::from(count), "{}", memory.bytes_max);
    }
}

/// A coil of radius 1 and pitch 0.5 by a wire of radius 0.4 overlaps itself by 0.3, for every
/// number of frames.
#[test]
fn a_coil_from_frames_meets_itself_with_any_number_of_frames() {
    let mut query = SelfQuery::new();
    let rise = 0.5 / (2.0 * PI);
    for count in (100..=400).step_by(12).chain([272, 290, 310, 338]) {
        let angle = |k: u32| 4.0 * PI * f64::from(k) / f64::from(count);
        let points: Vec<_> = (0..=count)
            .map(|k| Vector::new(angle(k).cos(), angle(k).sin(), rise * angle(k)))
            .collect();
        let tangents: Vec<_> =
            (0..=count).map(|k| Vector::new(-angle(k).sin(), angle(k).cos(), rise)).collect();
        let coil = |radius: f64| {
            Tube::from_frames(&points, &tangents, &vec![radius; count as usize]).unwrap()
        };
        for resolution in [1e-2, 1e-3] {
            let decision = query.clears_tube(&coil(0.4), 0.0, resolution).unwrap();
            assert_eq!(decision, Decision::Contact, "{count} {resolution}");
        }
        let decision = query.clears_tube(&coil(0.2), 0.0, 1e-3).unwrap();
        assert_eq!(decision, Decision::Clear, "{count}");
    }
}

/// A turn of more than pi allows every direction, as a turn of pi does.
#[test]
fn a_stated_turn_of_more_than_pi_is_pi() {
    let points: Vec<_> = (0..=20)
        .map(|k| {
            let a = 0.1 * f64::from(k);
            Vector::new(10.0 * a.cos(), 10.0 * a.sin(), 0.0)
        })
        .collect();
    let corners = [[-50.0, -50.0, 2.0], [50.0, -50.0, 2.0], [50.0, 50.0, 2.0], [-50.0, 50.0, 2.0]];
    let wall = corners.map(Vector::from);
    let clearance = |turn: f64| {
        let tube = Tube::with_constant_radius(&points, 1.0, None).unwrap().with_turn(turn).unwrap();
        let mut search = BvhSearch::from_triangles(&wall, &[[0, 1, 2], [0, 2, 3]]).unwrap();
        search.clearance(&tube, &Pose::IDENTITY, 1e-6).unwrap()
    };
    let expected = clearance(PI);
    assert!(expected.lower <= 1.0 && 1.0 <= expected.upper, "{expected:?}");
    for turn in [4.0, 1e3, 1e6, 1e9, 1e15, 1e300] {
        let found = clearance(turn);
        assert_eq!([found.lower, found.upper], [expected.lower, expected.upper], "{turn}");
    }
    let tube = Tube::with_constant_radius(&points, 1.0, None).unwrap();
    for turn in [f64::INFINITY, f64::NAN, -1.0] {
        assert!(tube.clone().with_turn(turn).is_err());
    }
}

/// Every sample was taken twice, with the same gap: rounding of the gaps decides nothing.
#[test]
fn samples_taken_twice_with_equal_gaps_are_accepted() {
    let mut random = Random::new(92);
    for round in 0..120 {
        let pose = Pose::from_translation(random.point() * 1e4) * random.pose(5.0);
        let (gap, bend) = ([1e-5, 1e-4, 1e-6][round % 3], [0.05, 0.002][round / 3 % 2]);
        let count = [30, 300][round / 6 % 2];
        let circle: Vec<_> = (0..count)
            .map(|k| {
                let a = bend * f64::from(k);
                pose * (Vector::new(a.cos(), a.sin(), 0.0) / bend)
            })
            .collect();
        let reach = circle.iter().fold(0.0, |most: f64, at| most.max(at.abs().max_element()));
        let mut points = Vec::new();
        for (k, at) in circle.into_iter().enumerate() {
            let a = bend * k as f64;
            // Across the curve, or in any direction.
            let aside = match round % 4 {
                0 | 1 => Vector::new(a.cos(), a.sin(), 0.0),
                2 => Vector::Z,
                _ => random.direction(),
            };
            // Gaps that grow along the robot, by the rounding of its coordinates in all.
            let gap = gap + 20.0 * f64::EPSILON / 2.0 * reach * k as f64 / f64::from(count);
            points.extend([at, at + pose.rotation * aside * gap]);
        }
        let tube = Tube::with_constant_radius(&points, 1.0, None);
        let tube = tube.unwrap_or_else(|error| panic!("{round} {gap}: {error}"));
        assert!((tube.length() - f64::from(count - 1)).abs() < 1.0);
    }
}

/// Samples taken twice, a little apart in any direction: the curve through both, which is possible
/// up to a turn of 1 rad, never makes the tube refused.
#[test]
fn a_sample_taken_twice_is_never_refused() {
    let tube = |points: &[Vector], gap: f64| {
        let tube = Tube::with_constant_radius(points, 0.1, None);
        assert!(tube.is_ok(), "{gap}: {tube:?}, {points:?}");
    };
    let points = [
        [0.0, 0.0, 0.0],
        [0.002499979166736832, 0.0, 0.4999916667083332],
        [0.00020805083454900324, -0.003027543328457393, 0.5068006198289623],
        [0.009999666671112184, 0.0, 0.999933334666654],
        [0.022498312550622845, 0.0, 1.499775010124783],
    ];
    tube(&points.map(Vector::from_array), 7.8e-3);
    for seed in 0..rounds(4000) {
        let random = &mut Random::new(seed);
        let pose = random.pose(5.0);
        let gap = 0.03 * random.between(0.1, 1.0);
        let bend = [1e-6, 0.02, 0.1][seed as usize % 3];
        let mut points = Vec::new();
        for k in 0..8 {
            let a = bend * f64::from(k);
            let at = Vector::new((1.0 - a.cos()) / bend, 0.0, a.sin() / bend);
            points.push(pose * at);
            if random.between(0.0, 1.0) < 0.6 && k > 0 && k < 7 {
                points.push(pose * (at + random.direction() * gap));
            }
        }
        tube(&points, gap);
    }
}
