//! A robot and itself by arc length: the bounds beside dense samples of its cross-sections, and
//! what follows from the definition.

use continuum_testing::{Random, rounds};
use parry_continuum::distance::{Vec3, disc_disc};
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::proximity::{Decision, RobotClearance, Scene, SceneError, SelfQuery};
use parry_continuum::{Cap, Chain, LinearMotion, RobotError, Tube};
use std::f64::consts::PI;

/// A cross-section: its place, centre, direction and radius.
#[derive(Clone, Copy)]
struct Disc {
    arc: f64,
    centre: Vector,
    direction: Vector,
    radius: f64,
}

fn apart(one: &Disc, two: &Disc) -> f64 {
    let v = |vector: Vector| Vec3::from(vector.to_array());
    disc_disc(
        v(one.centre),
        v(one.direction),
        one.radius,
        v(two.centre),
        v(two.direction),
        two.radius,
    )
    .distance
}

/// Discs of a chain by the definition: `count` per link, and points of the robot's round ends, at
/// most `angle` apart.
fn discs(robot: &Chain, count: u32, angle: f64) -> Vec<Disc> {
    let (mut discs, mut before) = (Vec::new(), 0.0);
    let links = robot.links();
    for (number, link) in links.iter().enumerate() {
        let (axis, length, radius) = (link.axis(), link.length(), link.radius());
        for k in 0..=count {
            let along = length * f64::from(k) / f64::from(count);
            let centre = link.start() + axis * along;
            discs.push(Disc { arc: before + along, centre, direction: axis, radius });
        }
        for end in [0, 1] {
            let (arc, centre) = [(before, link.start()), (before + length, link.end())][end];
            let neighbour = if end == 0 { number.checked_sub(1) } else { Some(number + 1) };
            if link.caps()[end] == Cap::Flat {
                continue;
            }
            if neighbour.is_none_or(|neighbour| neighbour == links.len()) {
                // Points of the half ball.
                let outward = if end == 0 { -axis } else { axis };
                let across = outward.any_orthonormal_vector();
                for k in 0..=8 {
                    let (sin, cos) = (angle * f64::from(k)).min(0.5 * PI).sin_cos();
                    for l in 0..16 {
                        let (s, c) = (PI * f64::from(l) / 8.0).sin_cos();
                        let side = across * c + outward.cross(across) * s;
                        let centre = centre + (outward * cos + side * sin) * radius;
                        discs.push(Disc { arc, centre, direction: axis, radius: 0.0 });
                    }
                }
            }
        }
        before += length;
    }
    discs
}

/// The least distance of two discs at least `arc` apart.
fn sampled(discs: &[Disc], arc: f64) -> f64 {
    let mut least = f64::INFINITY;
    for (k, one) in discs.iter().enumerate() {
        for two in &discs[k..] {
            let centres = (two.centre - one.centre).length();
            let within = centres - one.radius - two.radius < least;
            if (two.arc - one.arc).abs() >= arc && within {
                least = apart(one, two).min(least);
            }
        }
    }
    least
}

/// Robots of a few links: free, straight, level, folded, with steps and repeated points.
fn robot(random: &mut Random) -> Result<Chain, RobotError> {
    let count = 1 + random.below(7);
    let kind = random.below(6);
    let mut points = vec![random.point()];
    let mut way = random.direction();
    for k in 0..count {
        way = match kind {
            0 => way,
            1 if k % 2 == 1 => -way,
            1 => way.any_orthonormal_vector(),
            2 => (way + random.point() * 0.5).normalize(),
            3 => Vector::new(way.x, way.y + 0.7, 0.0).normalize_or(Vector::X),
            _ => (way + random.point() * 2.0).normalize(),
        };
        let length = if kind == 5 { 1.0 } else { random.between(0.2, 2.0) };
        points.push(points[points.len() - 1] + way * length);
        if random.below(5) == 0 {
            points.push(points[points.len() - 1]);
        }
    }
    let wide = random.between(0.02, 0.6);
    let steps = random.below(3) == 0;
    let radii: Vec<_> = (1..points.len())
        .map(|_| if steps && random.below(2) == 0 { 0.5 * wide } else { wide })
        .collect();
    match random.below(3) {
        0 => Chain::capsules(&points, &radii),
        1 => Chain::cylinders(&points, &radii),
        _ => Chain::from_centreline(&points, &radii),
    }
}

fn length(robot: &Chain) -> f64 {
    robot.links().iter().map(|link| link.length()).sum()
}

fn minimum(robot: &Chain, arc: f64) -> Option<RobotClearance> {
    SelfQuery::new().minimum_beyond(robot, arc).unwrap()
}

/// The sampled distance is at least `lower`, and at most `upper` plus the steps of the samples.
#[test]
fn the_bounds_enclose_samples_of_all_discs() {
    let mut random = Random::new(1);
    let (mut unresolved, mut touching) = (0, 0);
    let all = rounds(10_000);
    for round in 0..all {
        let robot = robot(&mut random).unwrap();
        let length = length(&robot);
        let arc = [0.0, length, random.between(0.0, 1.0) * length, 0.3][random.below(4) as usize];
        let (count, angle) = (12, 0.2);
        let discs = discs(&robot, count, angle);
        let expected = sampled(&discs, arc * (1.0 - 1e-12));
        let Some(found) = minimum(&robot, arc) else {
            assert!(expected == f64::INFINITY || arc >= length * (1.0 - 1e-12), "{round}");
            continue;
        };
        assert!(found.lower <= expected + 1e-12, "{round}: {found:?}, {expected}");
        let longest = robot.links().iter().map(|link| link.length()).fold(0.0, f64::max);
        let widest = robot.links().iter().map(|link| link.radius()).fold(0.0, f64::max);
        let error = 2.0 * longest / f64::from(count) + 2.0 * widest * angle;
        assert!(found.upper >= expected - error, "{round}: {found:?}, {expected}");
        assert!(found.lower <= found.upper && found.upper <= arc + 1e-12, "{round}: {found:?}");
        let witness = found.witness;
        let apart = (witness.on_first - witness.on_second).length();
        assert!((apart - found.upper).abs() <= 1e-12, "{round}: {found:?}");
        let [from, to] = witness.arc_lengths;
        assert!(to - from >= arc - 1e-12 && from >= 0.0 && to <= length + 1e-12);
        for (place, point) in [(from, witness.on_first), (to, witness.on_second)] {
            assert!(is_in_disc(&robot, place, point), "{round}: {found:?}");
        }
        unresolved += u32::from(!found.resolved);
        touching += u32::from(found.upper == 0.0);
        // The margin query agrees with the bounds.
        let mut itself = SelfQuery::new();
        let gap = 1e-10;
        assert!(!itself.clears_beyond(&robot, arc, found.lower + gap).unwrap() || !found.resolved);
        if found.lower > gap {
            assert!(itself.clears_beyond(&robot, arc, found.lower - gap).unwrap(), "{round}");
        }
    }
    println!("{unresolved} unresolved and {touching} touching of {all}");
    assert!(2 * unresolved <= all + 100, "{unresolved} of {all}");
}

/// Whether a point belongs to a cross-section at a place, within rounding.
fn is_in_disc(robot: &Chain, place: f64, point: Vector) -> bool {
    let (links, mut before, error) = (robot.links(), 0.0, 1e-11);
    links.iter().enumerate().any(|(number, link)| {
        let (along, length) = (place - before, link.length());
        before += length;
        if along < -error || along > length + error {
            return false;
        }
        let from_centre = point - (link.start() + link.axis() * along);
        let height = from_centre.dot(link.axis());
        // At a round end of the robot: half a ball.
        let is_cap = |end: usize, at: f64, is_end: bool, sign: f64| {
            let is_round = is_end && link.caps()[end] == Cap::Round;
            is_round && (along - at).abs() <= error && height * sign >= -error
        };
        let is_round =
            is_cap(0, 0.0, number == 0, -1.0) || is_cap(1, length, number + 1 == links.len(), 1.0);
        from_centre.length() <= link.radius() + error && (height.abs() <= error || is_round)
    })
}

#[test]
fn a_straight_robot_is_as_far_from_itself_as_the_arc_length() {
    let mut random = Random::new(2);
    for count in [1, 2, 17, 300] {
        let way = random.direction();
        let points: Vec<_> = (0..=count).map(|k| way * (f64::from(k) * 0.7)).collect();
        let radii = vec![0.4; count as usize];
        for robot in [
            Chain::from_centreline(&points, &radii).unwrap(),
            Chain::capsules(&points, &radii).unwrap(),
            Chain::cylinders(&points, &radii).unwrap(),
        ] {
            let length = 0.7 * f64::from(count);
            for arc in [0.0, 1e-9, 0.1 * length, 0.63 * length, length * (1.0 - 1e-15)] {
                let found = minimum(&robot, arc).unwrap();
                // Sums of arc lengths are rounded.
                let error = 1e-12 * (1.0 + length);
                assert!((found.lower - arc).abs() <= error, "{count} {arc}: {found:?}");
                assert!((found.upper - arc).abs() <= error, "{count} {arc}: {found:?}");
                assert!(found.resolved, "{count} {arc}: {found:?}");
                assert!(!SelfQuery::new().clears_beyond(&robot, arc, arc).unwrap());
            }
            assert_eq!(minimum(&robot, length * (1.0 + 1e-9)), None);
            assert_eq!(minimum(&robot, f64::INFINITY), None);
            assert!(SelfQuery::new().clears_beyond(&robot, 2.0 * length, 1e300).unwrap());
        }
    }
}

/// Inner edges of an arc of radius R by discs of radius r: 2 (R - r) sin(arc / 2 R) apart.
#[test]
fn a_circle_is_as_near_as_its_inner_edge() {
    let (radius, thick, links) = (20.0, 1.5, 2000_u32);
    let angle = |k: u32| PI * f64::from(k) / f64::from(links);
    let points: Vec<_> =
        (0..=links).map(|k| Vector::new(angle(k).cos(), 0.0, angle(k).sin()) * radius).collect();
    let robot = Chain::with_constant_radius(&points, thick).unwrap();
    let tube = Tube::with_constant_radius(&points, thick, Some([Vector::Z, -Vector::Z])).unwrap();
    for arc in [1.0, 10.0, 40.0, 60.0] {
        let expected = 2.0 * (radius - thick) * (0.5 * arc / radius).sin();
        let found = minimum(&robot, arc).unwrap();
        assert!((found.lower - expected).abs() < 2e-3 * expected.max(1.0), "{found:?} {expected}");
        assert!(found.resolved, "{found:?}");
        let found = SelfQuery::new().clearance_beyond(&tube, arc, 0.1).unwrap().unwrap();
        assert!(found.lower <= expected + 1e-4 && expected <= found.upper + 1e-4, "{found:?}");
        assert!(found.resolved, "{arc}: {found:?}");
    }
}

/// Both bounds of the same robot enclose one value, so they overlap however its links are cut.
#[test]
fn where_links_are_cut_changes_nothing() {
    let mut random = Random::new(3);
    for round in 0..rounds(4000) {
        let whole = robot(&mut random).unwrap();
        let (mut points, mut radii) = (vec![whole.links()[0].start()], Vec::new());
        for link in whole.links() {
            for _ in 0..random.below(4) {
                let last = points[points.len() - 1];
                points.push(last + (link.end() - last) * random.between(0.05, 0.9));
                radii.push(link.radius());
            }
            points.push(link.end());
            radii.push(link.radius());
        }
        // Uniform caps: with Algorithm 1 a cut near a face may change which joints are round.
        let ends: Vec<_> = std::iter::once(whole.links()[0].start())
            .chain(whole.links().iter().map(|link| link.end()))
            .collect();
        let own: Vec<_> = whole.links().iter().map(|link| link.radius()).collect();
        type Build = fn(&[Vector], &[f64]) -> Result<Chain, RobotError>;
        let builds: [Build; 2] = [|p, r| Chain::capsules(p, r), |p, r| Chain::cylinders(p, r)];
        let build = builds[random.below(2) as usize];
        let (whole, cut) = (build(&ends, &own).unwrap(), build(&points, &radii).unwrap());
        let arc = random.between(0.0, 1.0) * length(&whole);
        let (one, two) = (minimum(&whole, arc).unwrap(), minimum(&cut, arc).unwrap());
        let slack = 1e-12;
        assert!(one.lower <= two.upper + slack && two.lower <= one.upper + slack, "{round}");
        if one.resolved && two.resolved {
            assert!((one.lower - two.lower).abs() < slack, "{round}: {one:?} {two:?}");
        }
    }
}

/// The distance grows with the arc length by no more than it, as long as no end of a link is met.
#[test]
fn it_changes_continuously_with_arc_length_and_shape() {
    let mut random = Random::new(4);
    for round in 0..rounds(2000) {
        let robot = robot(&mut random).unwrap();
        let capsules = robot.links().iter().map(|link| link.end());
        let points: Vec<_> = std::iter::once(robot.links()[0].start()).chain(capsules).collect();
        let radius = 0.2;
        let robot = Chain::capsules(&points, &vec![radius; points.len() - 1]).unwrap();
        let length = length(&robot);
        let arc = random.between(0.0, 0.99) * length;
        let step = 1e-7 * length;
        let (one, two) = (minimum(&robot, arc).unwrap(), minimum(&robot, arc + step).unwrap());
        assert!(one.lower <= two.upper + 1e-12, "{round}: it grows with the arc length");
        if one.resolved && two.resolved {
            assert!(two.lower - one.lower <= step + 1e-6, "{round}: {one:?} {two:?}");
        }
        let moved: Vec<_> = points.iter().map(|&p| p + random.point() * 1e-9).collect();
        let moved = Chain::capsules(&moved, &vec![radius; points.len() - 1]).unwrap();
        let three = minimum(&moved, arc).unwrap();
        let turns = 1e-9 / robot.links().iter().map(|l| l.length()).fold(1.0, f64::min);
        let most = 100.0 * turns * f64::from(points.len() as u32);
        assert!(one.lower <= three.upper + most && three.lower <= one.upper + most, "{round}");
    }
}

/// Frames change rounding alone, powers of two nothing.
#[test]
fn frames_and_units_change_nothing() {
    let mut random = Random::new(5);
    for round in 0..rounds(2000) {
        let robot = robot(&mut random).unwrap();
        let arc = random.between(0.0, 1.0) * length(&robot);
        let found = minimum(&robot, arc).unwrap();
        let power = [-300, -40, 7, 300][random.below(4) as usize];
        let unit = 2.0_f64.powi(power);
        let points: Vec<_> = std::iter::once(robot.links()[0].start())
            .chain(robot.links().iter().map(|link| link.end()))
            .collect();
        let radii: Vec<_> = robot.links().iter().map(|link| link.radius()).collect();
        let build = |unit: f64, pose: &Pose| {
            let points: Vec<_> = points.iter().map(|&point| (*pose * point) * unit).collect();
            let radii: Vec<_> = radii.iter().map(|radius| radius * unit).collect();
            Chain::capsules(&points, &radii).unwrap()
        };
        let here = minimum(&build(1.0, &Pose::IDENTITY), arc).unwrap();
        let scaled = minimum(&build(unit, &Pose::IDENTITY), arc * unit).unwrap();
        assert_eq!(scaled.lower.to_bits(), (here.lower * unit).to_bits(), "{round}");
        assert_eq!(scaled.upper.to_bits(), (here.upper * unit).to_bits(), "{round}");
        let turned = minimum(&build(1.0, &random.pose(3.0)), arc).unwrap();
        assert!(here.lower <= turned.upper + 1e-11 && turned.lower <= here.upper + 1e-11);
        if here.resolved && turned.resolved {
            assert!((here.lower - turned.lower).abs() < 1e-11, "{round}: {here:?} {turned:?}");
        }
        assert!(found.lower <= found.upper);
    }
}

/// A chain as a tube has the same distance; a curve from samples encloses the samples of its discs.
#[test]
fn bounds_of_tubes_enclose_samples_of_their_discs() {
    let mut random = Random::new(6);
    for round in 0..rounds(1000) {
        let robot = robot(&mut random).unwrap();
        let arc = random.between(0.0, 1.0) * length(&robot);
        let chain = minimum(&robot, arc).unwrap();
        let mut itself = SelfQuery::new();
        let tube = itself.clearance_beyond(&Tube::from(&robot), arc, 0.0).unwrap().unwrap();
        assert!(tube.lower <= chain.upper + 1e-12, "{round}: {tube:?} {chain:?}");
        assert!(chain.lower <= tube.upper + 1e-12, "{round}: {tube:?} {chain:?}");
    }
    for round in 0..rounds(200) {
        let [turns, pitch] = [random.between(0.1, 2.0), random.between(0.0, 3.0)];
        let (radius, thick) = (random.between(2.0, 4.0), random.between(0.1, 1.0));
        let angle = |k: u32| 2.0 * PI * turns * f64::from(k) / 400.0;
        let place = |a: f64| Vector::new(radius * a.cos(), radius * a.sin(), pitch * a);
        let along = |a: f64| Vector::new(-radius * a.sin(), radius * a.cos(), pitch);
        let points: Vec<_> = (0..=400).map(|k| place(angle(k))).collect();
        let ends = Some([along(0.0), along(angle(400))]);
        let tube = Tube::with_constant_radius(&points, thick, ends).unwrap();
        let speed = radius.hypot(pitch);
        let disc = |k: u32| Disc {
            arc: speed * angle(k),
            centre: place(angle(k)),
            direction: along(angle(k)),
            radius: thick,
        };
        let discs: Vec<_> = (0..=400).map(disc).collect();
        let arc = random.between(0.0, 0.99) * speed * angle(400);
        let (tolerance, step) = (0.1, speed * angle(1));
        let expected = sampled(&discs, arc);
        let mut itself = SelfQuery::new();
        let found = itself.clearance_beyond(&tube, arc, tolerance).unwrap().unwrap();
        assert!(found.lower <= expected + 0.01 * step, "{round}: {found:?} {expected}");
        assert!(found.upper >= expected - 2.0 * step, "{round}: {found:?} {expected}");
        let decision = itself.clears_tube_beyond(&tube, arc, found.upper, tolerance).unwrap();
        assert_ne!(decision, Decision::Clear, "{round}");
    }
}

#[test]
fn numbers_that_are_no_lengths_are_refused() {
    let robot = Chain::capsules(&[Vector::ZERO, Vector::X], &[0.1]).unwrap();
    let tube = Tube::from(&robot);
    let mut itself = SelfQuery::new();
    for wrong in [-1.0, f64::NAN] {
        assert!(itself.minimum_beyond(&robot, wrong).unwrap_err().to_string().contains("arc"));
        assert!(itself.clears_beyond(&robot, wrong, 1.0).is_err());
        assert!(itself.clears_beyond(&robot, 1.0, wrong).is_err());
        assert!(itself.clearance_beyond(&tube, wrong, 1.0).is_err());
        assert!(itself.clearance_beyond(&tube, 1.0, wrong).is_err());
        assert!(itself.clears_tube_beyond(&tube, 0.5, 1.0, wrong).is_err());
    }
}

/// Of an arc of radius R by discs of radius r: the inner edges are 2 (R - r) sin(arc / 2 R) apart.
#[test]
fn a_scene_keeps_a_margin_by_arc_length() {
    let angles = (0..=150).map(|k| f64::from(k).to_radians());
    let points: Vec<_> = angles.map(|a| Vector::new(a.cos(), 0.0, a.sin()) * 10.0).collect();
    let bent = Chain::from_centreline(&points, &[2.0; 150]).unwrap();
    let straight = Chain::from_centreline(&[Vector::ZERO, Vector::X * 9.0], &[0.5]).unwrap();
    let away = Pose::translation(0.0, 50.0, 0.0);
    let robots = [(&straight, Pose::IDENTITY), (&bent, away)];
    let tubes = [Tube::from(&straight), Tube::from(&bent)];
    let tubes = [(&tubes[0], Pose::IDENTITY), (&tubes[1], away)];
    let mut scene = Scene::new();
    for arc in [10.0, 14.0, 25.0] {
        // A straight robot that is shorter than `arc` keeps every margin.
        let expected = 16.0 * (0.05_f64 * arc).sin();
        for (margin, decision) in
            [(0.99 * expected, Decision::Clear), (1.01 * expected, Decision::Contact)]
        {
            scene.set_self_margin(Some(margin)).unwrap();
            scene.set_self_arc(Some(arc)).unwrap();
            assert_eq!(scene.clears(&robots), Ok(decision == Decision::Clear), "{arc}");
            assert_eq!(scene.clears_tube(&tubes, 1e-3), Ok(decision), "{arc}");
            // Without the arc length: the bend has no local minimum.
            scene.set_self_arc(None).unwrap();
            assert_eq!(scene.clears(&robots), Ok(true));
        }
    }
    let motion = LinearMotion::capsules(&points, &points, &[2.0; 150]).unwrap();
    scene.set_self_arc(Some(20.0)).unwrap();
    let refused = Err(SceneError::SelfArcOfMotion);
    assert_eq!(scene.clears_motion(&[&motion], 0.1), refused);
    assert_eq!(scene.time_of_contact(&[&motion], 0.1), refused);
    assert_eq!(scene.clearance_of_motion(&[&motion], 0.1), Ok(None));
    scene.set_self_margin(None).unwrap();
    scene.set_robot_margin(Some(1.0)).unwrap();
    assert!(scene.clears_motion(&[&motion], 0.1).unwrap().is_clear());
    for wrong in [-1.0, f64::NAN] {
        let error = scene.set_self_arc(Some(wrong)).unwrap_err();
        assert!(error.to_string().contains("arc"), "{error}");
    }
}

/// The bounds of a fit hold for every curve within its deviation, whatever its direction.
#[test]
fn bounds_of_fits_enclose_curves_within_their_deviation() {
    for (unit, radius) in [(1e-6, 2.0), (1.0, 2.0), (1e3, 0.5)] {
        let points: Vec<_> = (0..=200).map(|k| Vector::Z * (0.2 * f64::from(k) * unit)).collect();
        let deviation = 0.1 * unit;
        let fit = Tube::fit(&points, &[radius * unit; 200], deviation).unwrap();
        // A sine of the amplitude 0.1. At z = 10 and 30 its discs lean towards one another.
        let arc = 20.0 * unit;
        let (turn, mut own) = (2.0 * PI * 4.5 / 20.0, SelfQuery::new());
        let disc = |z: f64| Disc {
            arc: z * unit,
            centre: Vector::new(0.1 * (turn * (z - 10.0)).sin(), 0.0, z) * unit,
            direction: Vector::new(0.1 * turn * (turn * (z - 10.0)).cos(), 0.0, 1.0).normalize(),
            radius: radius * unit,
        };
        let member = apart(&disc(10.0), &disc(30.0));
        assert!(member < 19.9 * unit, "the discs lean: {member}");
        let found = own.clearance_beyond(&fit, arc, 0.01 * unit).unwrap().unwrap();
        assert!(found.lower <= member && found.resolved, "{found:?}");
        let straight = 20.0 * unit;
        assert!(found.upper >= straight * (1.0 - 1e-12), "{found:?}");
        let decided = own.clears_tube_beyond(&fit, arc, member, 1e-3 * unit).unwrap();
        assert_eq!(decided, Decision::Undecided);
    }
}

/// A stated turn counts within two radii of a flat face alone.
#[test]
fn a_stated_turn_counts_near_flat_faces() {
    let points: Vec<_> = (0..=60).map(|k| Vector::Z * f64::from(k)).collect();
    let exact = Tube::from_samples(&points, &[2.0; 60], None).unwrap();
    let turned = exact.clone().with_turn(0.1).unwrap();
    let mut own = SelfQuery::new();
    let [plain, found] =
        [&exact, &turned].map(|tube| own.clearance_beyond(tube, 20.0, 0.01).unwrap().unwrap());
    assert!(plain.resolved && plain.lower > 19.9, "{plain:?}");
    // Two discs that lean by the turn, or one at a face and one that is exact.
    assert!(found.resolved && found.lower <= 20.0 - 2.0 * 0.0998, "{found:?}");
    assert!(found.lower > 19.0 && found.uncertainty >= 0.2, "{found:?}");
}

/// A margin may be infinite: a robot that has no two such places keeps it.
#[test]
fn an_infinite_margin_is_kept_by_a_robot_that_is_shorter_than_the_arc() {
    let mut own = SelfQuery::new();
    for unit in [1e-9, 1.0] {
        let points = [Vector::ZERO, Vector::Z * unit];
        let chain = Chain::capsules(&points, &[0.1 * unit]).unwrap();
        let tube = Tube::from(&chain);
        for (arc, is_kept) in [(2.0 * unit, true), (0.5 * unit, false)] {
            for margin in [1e300, f64::INFINITY] {
                assert_eq!(own.clears_beyond(&chain, arc, margin), Ok(is_kept));
                let decided = own.clears_tube_beyond(&tube, arc, margin, 1e-3 * unit).unwrap();
                assert_eq!(decided == Decision::Clear, is_kept, "{margin}");
                assert_eq!(decided == Decision::Contact, !is_kept, "{margin}");
            }
        }
    }
}

/// Many links that are bent unevenly: the union of parts is as far from its chord as both of them
/// and their joint together.
#[test]
fn parts_of_uneven_bends_are_within_their_bounds() {
    let points = [
        (0.0, 0.0),
        (0.0, 10.0),
        (10.0, 10.0),
        (20.0, 10.0),
        (30.0, 10.0),
        (22.25, 10.25),
        (14.5, 10.5),
        (6.75, 10.75),
        (-1.0, 11.0),
    ];
    let points = points.map(|(x, z)| Vector::new(x, 0.0, z));
    let robot = Chain::capsules(&points, &[0.001; 8]).unwrap();
    let nearest = sampled(&discs(&robot, 200, 0.1), 59.0);
    let found = minimum(&robot, 59.0).unwrap();
    assert!(found.lower <= nearest && nearest < 1.0 && nearest < found.upper + 0.1, "{found:?}");
}
