//! Certificates of pairs of links: bounds that hold on the reference cases, that are tight on
//! random and on degenerate pairs, and that refuse an answer about others.

use super::certify::Tally;
use super::robots::{beside, robot};
use continuum_testing::precision::extent;
use continuum_testing::{Random, link_cases};
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::proximity::{Certificate, ProximityError, RobotPair, SelfQuery};
use parry_continuum::{Cap, ContinuumDispatcher, ModifiedCylinder};

const UNIT: Real = Real::EPSILON / 2.0;

fn link(ends: [Vector; 2], radius: Real, flat: [bool; 2]) -> ModifiedCylinder {
    let cap = |flat: bool| if flat && ends[0] != ends[1] { Cap::Flat } else { Cap::Round };
    ModifiedCylinder::new(ends[0], ends[1], radius, flat.map(cap)).unwrap()
}

fn certified([first, second]: &[ModifiedCylinder; 2]) -> Certificate {
    Certificate::between_links(first, &Pose::IDENTITY, second, &Pose::IDENTITY).unwrap()
}

/// The reference, to 30 digits, lies between the bounds, and they lie within 16 units of each
/// other.
#[test]
fn the_reference_cases_lie_within_tight_bounds() {
    let mut tally = Tally::default();
    for case in link_cases() {
        let links =
            [0, 1].map(|k| link(case.links[k].map(Vector::from), case.radii[k], case.flat[k]));
        for links in [links, [links[1], links[0]]] {
            let name = format!("{} {}", case.id, case.cat);
            tally.hold(&name, case.distance(), case.scale, certified(&links));
        }
        tally.count(case.distance() / case.scale);
    }
    println!("{tally:?}");
    assert!(tally.apart > 500 && tally.nearly_touching > 20 && tally.touching > 300, "{tally:?}");
}

/// How two links lie to one another.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Random,
    Lattice,
    Parallel,
    NearlyParallel,
    Coaxial,
    Coplanar,
    Tangent,
    CrossingDiscs,
    FacingDiscs,
    Wires,
    Balls,
    Short,
}

const KINDS: [Kind; 12] = [
    Kind::Random,
    Kind::Lattice,
    Kind::Parallel,
    Kind::NearlyParallel,
    Kind::Coaxial,
    Kind::Coplanar,
    Kind::Tangent,
    Kind::CrossingDiscs,
    Kind::FacingDiscs,
    Kind::Wires,
    Kind::Balls,
    Kind::Short,
];

fn drawn(random: &mut Random, kind: Kind) -> [ModifiedCylinder; 2] {
    let lattice = kind == Kind::Lattice || (kind != Kind::Random && random.below(2) == 0);
    let point = |random: &mut Random| {
        let point = random.point() * 2.0;
        if lattice { (point * 2.0).round() / 2.0 } else { point }
    };
    let radius = |random: &mut Random| {
        [0.0, 0.5, 1.0, random.magnitude(-2.0, 0.3)][random.below(4) as usize]
    };
    let mut axes = [[point(random), point(random)], [point(random), point(random)]];
    let mut radii = [radius(random), radius(random)];
    let bits = random.below(16);
    let mut flat = [[bits & 1 != 0, bits & 2 != 0], [bits & 4 != 0, bits & 8 != 0]];
    let along = axes[0][1] - axes[0][0];
    let share = [1.0, -0.5, 2.0, random.between(-2.0, 2.0)][random.below(4) as usize];
    match kind {
        Kind::Random | Kind::Lattice => {}
        Kind::Parallel => axes[1][1] = axes[1][0] + along * share,
        Kind::NearlyParallel => {
            let tilt = random.direction() * random.tiny(-16.0, -1.0);
            axes[1][1] = axes[1][0] + along * share + tilt;
        }
        Kind::Coaxial => {
            axes[1] =
                [share, share + random.between(-1.5, 1.5)].map(|place| axes[0][0] + along * place);
        }
        Kind::Coplanar => {
            (axes[1][0].z, axes[1][1].z, axes[0][0].z, axes[0][1].z) = (0.0, 0.0, 0.0, 0.0)
        }
        // At exactly the sum of the radii, beside or end to end, up to rounding and a tiny bit.
        Kind::Tangent => {
            radii = radii.map(|radius| radius + 0.25);
            let (across, other) = along.try_normalize().unwrap_or(Vector::X).any_orthonormal_pair();
            let by = (radii[0] + radii[1]) * (1.0 + random.tiny(-17.0, -1.0));
            let at = axes[0][0] + along * random.unit() + across * by;
            let way = if random.below(2) == 0 { other } else { other * share + along };
            axes[1] = [at - way, at + way];
        }
        Kind::CrossingDiscs => {
            flat = [[true; 2]; 2];
            radii = radii.map(|radius| radius + 0.5);
            axes[1][0] = axes[0][1] + random.direction() * random.magnitude(-3.0, 1.0);
        }
        // Two faces, parallel up to a tiny tilt, at any height over one another.
        Kind::FacingDiscs => {
            flat = [[true; 2]; 2];
            radii = radii.map(|radius| radius + 0.25);
            let way = along.try_normalize().unwrap_or(Vector::X);
            let aside = way.any_orthonormal_vector() * random.between(0.0, 1.5);
            axes[1][0] = axes[0][1] + aside + way * random.magnitude(-16.0, 0.0);
            axes[1][1] = axes[1][0] + way + random.direction() * random.magnitude(-17.0, -1.0);
        }
        Kind::Wires => {
            radii[random.below(2) as usize] = 0.0;
            if random.below(2) == 0 {
                let at = axes[0][0] + along * random.unit();
                axes[1] = [at, at + (axes[1][1] - axes[1][0])];
            }
        }
        Kind::Balls => {
            axes[1][1] = axes[1][0];
            if random.below(2) == 0 {
                axes[0][1] = axes[0][0];
            }
        }
        Kind::Short => axes[1][1] = axes[1][0] + random.direction() * random.magnitude(-17.0, -1.0),
    }
    [0, 1].map(|k| link(axes[k], radii[k], flat[k]))
}

/// A point of a link, more often than not of its boundary.
fn some_point(random: &mut Random, link: &ModifiedCylinder) -> Vector {
    let along = link.end() - link.start();
    let share = [0.0, 1.0, random.unit()][random.below(3) as usize];
    let way = random.direction();
    let axis = along.try_normalize().unwrap_or(Vector::ZERO);
    let across = (way - axis * way.dot(axis)).normalize_or_zero();
    link.start() + along * share + across * (link.radius() * random.unit().sqrt())
}

/// Returns how many units of the extent the widest bounds are apart.
fn many(count: u32, seed: u64) -> f64 {
    let mut random = Random::new(seed);
    let (mut apart, mut near, mut meeting) = ([0; KINDS.len()], 0, [0; KINDS.len()]);
    let mut widest = (0.0_f64, Kind::Random);
    let dispatcher = ContinuumDispatcher::default();
    for round in 0..count {
        let number = round as usize % KINDS.len();
        let links = drawn(&mut random, KINDS[number]);
        let [first, second] = &links;
        let Certificate { lower, upper, .. } = certified(&links);
        let fail = |what: &str| {
            panic!("{what} [{lower:e}, {upper:e}] in round {round}, {:?}: {links:?}", KINDS[number])
        };
        let points = [first.start(), first.end(), second.start(), second.end()];
        let unit = UNIT * extent(&points, first.radius().max(second.radius()));
        if !(0.0 <= lower && lower <= upper) {
            fail("not bounds:");
        }
        let width = (upper - lower) / unit;
        if width > 16.0 {
            fail(&format!("{width} units wide:"));
        }
        if width > widest.0 {
            widest = (width, KINDS[number]);
        }
        let found = parry_continuum::parry::query::QueryDispatcher::distance(
            &dispatcher,
            &Pose::IDENTITY,
            first,
            second,
        );
        let found = found.unwrap().distance;
        if found < lower - 16.0 * unit || found > upper + 16.0 * unit {
            fail(&format!("{found:e} is not within"));
        }
        // No two points are nearer.
        for _ in 0..4 {
            let between = some_point(&mut random, first).distance(some_point(&mut random, second));
            if between < lower - 16.0 * unit {
                fail(&format!("two points are {between:e} apart, not within"));
            }
        }
        if lower > 0.0 {
            apart[number] += 1
        } else {
            meeting[number] += 1
        }
        near += u32::from(lower > 0.0 && upper < 1e-6);
    }
    println!(
        "{count} pairs, widest {:.2} units, of {:?}; {near} nearly touching",
        widest.0, widest.1
    );
    let few = count / KINDS.len() as u32 / 50;
    assert!(apart.iter().all(|&seen| seen > few), "{apart:?}");
    assert!(
        meeting
            .iter()
            .enumerate()
            .all(|(number, &seen)| seen > few || KINDS[number] == Kind::Wires),
        "{meeting:?}"
    );
    assert!(near > count / 200, "{near}");
    widest.0
}

#[test]
fn random_and_degenerate_pairs_have_tight_bounds() {
    many(22_000, 1);
}

/// `cargo test --test proximity a_million_pairs -- --ignored --nocapture`
#[test]
#[ignore = "a minute or more"]
fn a_million_pairs_have_tight_bounds() {
    // By the difference of the two points alone some faces that nearly touch are 8 units wide.
    assert!(many(1_000_000, 2) <= 7.0);
}

#[test]
fn bounds_scale_with_the_pair() {
    let mut random = Random::new(3);
    for round in 0..220 {
        let links = drawn(&mut random, KINDS[round % KINDS.len()]);
        let plain = certified(&links);
        for power in [-300, -40, 40, 300] {
            let factor = 2.0_f64.powi(power);
            let scaled = links.map(|it| {
                ModifiedCylinder::new(
                    it.start() * factor,
                    it.end() * factor,
                    it.radius() * factor,
                    it.caps(),
                )
                .unwrap()
            });
            let bounds = certified(&scaled);
            assert_eq!(
                (bounds.lower, bounds.upper),
                (plain.lower * factor, plain.upper * factor),
                "{links:?}"
            );
        }
    }
}

/// What queries answer is certified, for whole robots; what is about others is refused.
#[test]
fn answers_fit_their_robots_and_no_others() {
    let mut random = Random::new(4);
    let (mut pair, mut found, mut refused, mut own) = (RobotPair::new(), 0, 0, 0);
    for round in 0..400 {
        let (a, b) = (robot(&mut random, 12), robot(&mut random, 12));
        let pose_a = random.pose(1.0);
        let pose_b = beside(&mut random, &a, &pose_a, &b, [0.0, 1.0, 6.0][round % 3]);
        let mut each = Vec::new();
        pair.per_link(&a, &pose_a, &b, &pose_b, &mut each).unwrap();
        for answer in &each {
            let Certificate { lower, upper, .. } =
                answer.certify(&a, &pose_a, &b, &pose_b).unwrap();
            let slack = 16.0 * UNIT * 32.0;
            assert!(
                lower - slack <= answer.distance && answer.distance <= upper + slack,
                "{answer:?}"
            );
            assert!(upper - lower <= slack);
            found += 1;
            // A robot that has moved, or another one.
            let moved = Pose::translation(1e-3, 1e-3, 1e-3) * pose_b;
            match answer.certify(&a, &pose_a, &b, &moved) {
                Err(ProximityError::LinksDoNotFit { links, off, limit, .. }) => {
                    assert!(links == answer.links && off > limit);
                    refused += 1;
                }
                Ok(_) => assert!(answer.distance <= slack),
                Err(other) => panic!("{other}"),
            }
        }
        if let Ok(Some(answer)) = SelfQuery::new().minimum(&a) {
            match answer.certify(&a, &Pose::IDENTITY, &a, &Pose::IDENTITY) {
                Ok(bounds) => {
                    assert!((bounds.upper - answer.distance).abs() <= 16.0 * UNIT * 32.0);
                    own += 1;
                }
                // A face, to which its link is nearer.
                Err(error) => assert_eq!(error.kind(), "links_do_not_fit"),
            }
        }
    }
    assert!(found > 1000 && refused > 1000 && own > 20, "{found} {refused} {own}");
}

#[test]
fn what_does_not_exist_or_is_spoilt_is_an_error() {
    let mut random = Random::new(5);
    let (a, b) = (robot(&mut random, 6), robot(&mut random, 6));
    let (here, there) = (Pose::IDENTITY, Pose::translation(9.0, 0.0, 0.0));
    let answer = RobotPair::new().minimum(&a, &here, &b, &there).unwrap();
    let lost = Pose::from_translation(Vector::NAN);
    assert_eq!(answer.certify(&a, &lost, &b, &there).unwrap_err().kind(), "pose_not_finite");
    let error = answer.certify(&a, &here, &b, &lost).unwrap_err();
    assert!(error.to_string().contains("pose_b"), "{error}");
    let far = Pose::from_translation(Vector::X * 1e200);
    assert_eq!(answer.certify(&a, &here, &b, &far).unwrap_err().kind(), "out_of_range");
    let mut other = answer;
    other.links[1] = 99;
    assert_eq!(other.certify(&a, &here, &b, &there).unwrap_err().kind(), "no_such_link");
    for spoil in [1e-9, 1.0, 1e300, f64::INFINITY, f64::NAN] {
        let spoilt: [fn(&mut _, f64); 3] = [
            |answer: &mut parry_continuum::proximity::RobotProximity, by| answer.distance += by,
            |answer, by| answer.witness.on_first.y += by,
            |answer, by| answer.witness.on_second.z -= by,
        ];
        for spoilt in spoilt {
            let mut other = answer;
            spoilt(&mut other, spoil);
            let error = other.certify(&a, &here, &b, &there).unwrap_err();
            assert!(matches!(error, ProximityError::LinksDoNotFit { .. }), "{spoil}: {error}");
        }
    }
}
