//! Margin 0 is a margin like any other: flat faces that overlap by more than the resolution are a
//! contact.

use continuum_testing::{Random, rounds};
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::shape::Cone;
use parry_continuum::proximity::{
    BvhSearch, Decision, Proximity, RobotPair, Scene, SceneMotionContact, SelfQuery,
};
use parry_continuum::{
    BendingMotion, BendingSection, Chain, LinearMotion, Motion, RigidMotion, Tube,
};

/// Two disks of radius 5 on a thin backbone of length 4 that bends by `theta`, as a chain.
fn disks(theta: f64, chords: u32, thickness: f64) -> Chain {
    let radius = 4.0 / theta;
    let on_arc =
        |angle: f64| Vector::new(radius * (1.0 - f64::cos(angle)), 0.0, radius * f64::sin(angle));
    let mut points = vec![Vector::Z * -thickness];
    points.extend((0..=chords).map(|k| on_arc(theta * f64::from(k) / f64::from(chords))));
    points.push(on_arc(theta) + Vector::new(f64::sin(theta), 0.0, f64::cos(theta)) * thickness);
    let mut radii = vec![0.5; points.len() - 1];
    (radii[0], radii[chords as usize + 1]) = (5.0, 5.0);
    Chain::from_centreline(&points, &radii).unwrap()
}

/// The inner points of the rims are `2 (4 / theta - 5) sin(theta / 2)` apart: the disks cross from
/// `theta = 0.8` on.
#[test]
fn overlapping_disks_touch_at_margin_0() {
    let mut query = SelfQuery::new();
    for theta in [0.5, 0.7, 0.79, 0.81, 0.85, 0.9, 1.0, 1.2] {
        for (chords, thickness) in [(1, 1.0), (2, 0.5), (4, 1.0), (8, 0.5)] {
            let chain = disks(theta, chords, thickness);
            let gap = f64::max(0.0, 2.0 * (4.0 / theta - 5.0) * f64::sin(0.5 * theta));
            let found = query.minimum(&chain).unwrap().unwrap().distance;
            assert!((found - gap).abs() < 1e-12, "{theta} {chords}: {found} {gap}");
            let expected = if theta < 0.8 { Decision::Clear } else { Decision::Contact };
            let mut random = Random::new(81);
            for round in 0..4 {
                let pose = if round == 0 { Pose::IDENTITY } else { random.pose(3.0) };
                let points: Vec<_> = std::iter::once(chain.links()[0].start())
                    .chain(chain.links().iter().map(|link| link.end()))
                    .map(|point| pose * point)
                    .collect();
                let radii: Vec<_> = chain.links().iter().map(|link| link.radius()).collect();
                let tube = Tube::from(&Chain::from_centreline(&points, &radii).unwrap());
                let decision = query.clears_tube(&tube, 0.0, 1e-6).unwrap();
                assert_eq!(decision, expected, "{theta} {chords} {round}");
            }
        }
    }
}

/// The same on a curve, and while it bends: margin 0 is first violated at `t = 0.8`.
#[test]
fn bending_disks_touch_when_their_rims_meet() {
    let rows = |curvature: f64| {
        let row = |length, radius, bend| BendingSection { length, radius, bend: [bend, 0.0] };
        [row(2.0, 5.0, 0.0), row(4.0, 0.5, curvature), row(2.0, 5.0, 0.0)]
    };
    let motion =
        |to: f64| BendingMotion::new(&rows(0.0), &rows(0.25 * to), Pose::IDENTITY).unwrap();
    let (mut query, mut tube) = (SelfQuery::new(), Tube::from(&disks(0.5, 1, 1.0)));
    for (t, expected) in
        [(0.7, Decision::Clear), (0.81, Decision::Contact), (1.0, Decision::Contact)]
    {
        motion(1.0).shape(t, &mut tube).unwrap();
        assert_eq!(query.clears_tube(&tube, 0.0, 1e-4).unwrap(), expected, "{t}");
    }
    assert!(query.clears_motion(&motion(0.79), 0.0, 1e-3).unwrap().is_clear());
    let found = query.clears_motion(&motion(1.0), 0.0, 1e-3).unwrap();
    let t = found.contact.unwrap_or_else(|| panic!("{found:?}")).t;
    assert!(0.8 <= t, "{found:?}");

    let mut scene = Scene::new();
    scene.set_self_margin(Some(0.0)).unwrap();
    let found = scene.time_of_contact(&[&motion(1.0)], 1e-3).unwrap();
    let [from, to] = found.interval;
    assert!(from <= 0.8 && 0.8 <= to && to - from < 2e-3, "{found:?}");
    assert!(matches!(found.contact, Some(SceneMotionContact::Itself { .. })), "{found:?}");
}

/// A rod with a flat tip that moves into a wall: the first contact is known to the resolution.
#[test]
fn a_flat_tip_meets_a_wall_at_margin_0() {
    let mut random = Random::new(82);
    let resolution = 1e-3;
    let (mut level, mut tilted) = (0, 0);
    for round in 0..rounds(400) {
        let placed = if random.below(3) == 0 { Pose::IDENTITY } else { random.pose(10.0) };
        let corners =
            [[-30.0, -30.0, 0.0], [30.0, -30.0, 0.0], [30.0, 30.0, 0.0], [-30.0, 30.0, 0.0]];
        let wall = corners.map(|corner| placed * Vector::from(corner));
        let mut search = BvhSearch::from_triangles(&wall, &[[0, 1, 2], [0, 2, 3]]).unwrap();
        let tilt = [0.0, 1e-9, 1e-4, 0.05, 0.7][random.below(5) as usize];
        let angle = random.between(0.0, 6.0);
        let axis =
            Vector::new(angle.cos() * f64::sin(tilt), angle.sin() * f64::sin(tilt), tilt.cos());
        let radius = random.between(0.2, 2.0);
        let length = random.between(2.0, 20.0);
        let tip = Vector::new(random.between(-5.0, 5.0), random.between(-5.0, 5.0), 3.0);
        let way = Vector::new(
            random.between(-1.0, 1.0),
            random.between(-1.0, 1.0),
            -random.between(4.0, 8.0),
        );
        let rod = |tip: Vector| [placed * tip, placed * (tip + axis * length)];
        let cylinder = LinearMotion::chain(&rod(tip), &rod(tip + way), &[radius]).unwrap();
        let found = search.time_of_contact(&cylinder, 0.0, resolution).unwrap();
        // The lowest point of the rim reaches the plane.
        let first = (tip.z - radius * f64::sin(tilt)) / -way.z;
        let [from, to] = found.interval;
        assert_eq!(found.decision, Decision::Contact, "{round} {tilt}: {found:?} {first}");
        assert!(from <= first && first <= to + 1e-12, "{round} {tilt}: {found:?} {first}");
        assert!(
            (to - from) * way.length() <= 2.0 * resolution,
            "{round} {tilt}: {found:?} {first}"
        );
        level += usize::from(tilt < 1e-6);
        tilted += usize::from(tilt >= 1e-6);
    }
    assert!(level >= rounds(150) && tilted >= rounds(150), "{level} {tilted}");
}

/// A cylinder that moves to a cone's base in every way in which rims and faces stay level within
/// rounding. Between the times of an answer the two are within the resolution.
#[test]
fn level_rims_meet_at_margin_0() {
    let (mut random, mut narrow, mut sliding) = (Random::new(83), 0, 0);
    for round in 0..rounds(1200) {
        let resolution = [1e-3, 1e-5][random.below(2) as usize];
        let placed = if random.below(3) == 0 { Pose::IDENTITY } else { random.pose(10.0) };
        let tilt = [0.0, 1e-15, 1e-12, 1e-6, 1e-3][random.below(5) as usize];
        let radius = random.between(0.3, 2.0);
        let [base, high] = [random.between(0.3, 2.0), random.between(1.0, 4.0)];
        let steps = 1 + random.below(12);
        let share = |k: u32| f64::from(k) / f64::from(steps);
        let points: Vec<_> = (0..=steps).map(|k| Vector::Z * (high * share(k))).collect();
        let radii: Vec<_> = (0..steps).map(|k| base * (1.0 - share(k))).collect();
        let cone = Chain::cylinders(&points, &radii).unwrap();
        let angle = random.between(0.0, 6.0);
        let out = Vector::new(angle.cos(), angle.sin(), 0.0);
        let up = Vector::Z + out.any_orthonormal_vector() * tilt;
        let (way, axis) = match random.below(4) {
            // Beside the cone, both on one plane; sliding below it; obliquely, rim to rim.
            0 => (-out * 2.0, up),
            1 => (-out * 2.0, -up),
            2 => (-out * 2.0 - Vector::Z, up),
            _ => (Vector::Z * 2.0, -up),
        };
        let beside = if way.x == 0.0 && way.y == 0.0 {
            out * (random.between(0.0, 0.9) * (radius + base))
        } else {
            out * (radius + base)
        };
        let at = beside - way * 0.5;
        let ends = |t: f64| [at + way * t, at + way * t + axis * 3.0].map(|point| placed * point);
        let motion = LinearMotion::chain(&ends(0.0), &ends(1.0), &[radius]).unwrap();
        let shape = |t: f64| Chain::cylinders(&ends(t), &[radius]).unwrap();
        let [found, within] = if random.below(2) == 0 {
            let rest = RigidMotion::new(Tube::from(&cone), [placed; 2]).unwrap();
            let found = RobotPair::new().time_of_contact(&motion, &rest, 0.0, resolution).unwrap();
            let distance = |t: f64| {
                let pair = RobotPair::new().minimum(&shape(t), &Pose::IDENTITY, &cone, &placed);
                pair.unwrap().distance
            };
            let [from, to] = found.interval;
            let inner = [0.1, 0.5, 0.9].map(|share| distance(from + share * (to - from)));
            [found.interval, inner.into_iter().fold([0.0; 2], |[a, b], d| [a.max(d), b])]
        } else {
            let (corners, triangles) = Cone::new(0.5 * high, base).to_trimesh(24);
            let upright = placed * Pose::rotation(Vector::X * std::f64::consts::FRAC_PI_2);
            let lift = Vector::Y * (0.5 * high);
            let corners: Vec<_> = corners.iter().map(|v| upright * (*v + lift)).collect();
            let mut search = BvhSearch::from_triangles(&corners, &triangles).unwrap();
            let found = search.time_of_contact(&motion, 0.0, resolution).unwrap();
            let [from, to] = found.interval;
            let mut distance =
                |t: f64| search.minimum(&shape(t), &Pose::IDENTITY).unwrap().distance;
            let inner = [0.1, 0.5, 0.9].map(|share| distance(from + share * (to - from)));
            [found.interval, inner.into_iter().fold([0.0; 2], |[a, b], d| [a.max(d), b])]
        };
        let width = (found[1] - found[0]) * way.length();
        if width <= 2.0 * resolution {
            narrow += 1;
            continue;
        }
        // Faces that slide on one another: no earlier place is farther than the resolution.
        sliding += 1;
        assert!(within[0] <= resolution, "{round} {tilt}: {found:?} {within:?}");
    }
    assert!(narrow >= rounds(800) && sliding >= rounds(10), "{narrow} {sliding}");
}
