//! Two robots, and one and itself: this crate's search beside every exact pair in turn, and parry's
//! own shapes.

use criterion::{Criterion, criterion_group, criterion_main};
use parry_continuum::distance::{Vec3, modified_cylinder_modified_cylinder};
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::query;
use parry_continuum::parry::shape::{Capsule, Compound, SharedShape};
use parry_continuum::proximity::{RobotPair, SelfQuery};
use parry_continuum::{Cap, Chain, ModifiedCylinder};
use std::f64::consts::{PI, TAU};
use std::hint::black_box;

/// A robot of 30 links that bends to one side.
fn bent(side: f64) -> Chain {
    let point = |k: i32| {
        let s = f64::from(k) * 2.0;
        let turn = s / 45.0;
        Vector::new(side * 45.0 * (1.0 - turn.cos()), 0.3 * s * (s / 20.0).sin(), 45.0 * turn.sin())
    };
    Chain::from_centreline(&(0..=30).map(point).collect::<Vec<_>>(), &[1.0; 30]).expect("a robot")
}

/// A coil of three turns.
fn coil(links: i32) -> Chain {
    let point = |k: i32| {
        let turn = f64::from(k) * 3.0 * TAU / f64::from(links);
        Vector::new(10.0 * turn.cos(), 10.0 * turn.sin(), 4.0 * turn / PI)
    };
    let points: Vec<_> = (0..=links).map(point).collect();
    Chain::from_centreline(&points, &vec![0.8; links as usize]).expect("a robot")
}

fn apart(one: &ModifiedCylinder, two: &ModifiedCylinder) -> f64 {
    let axis =
        |link: &ModifiedCylinder| [link.start(), link.end()].map(|p| Vec3::from(p.to_array()));
    let flat = |link: &ModifiedCylinder| link.caps().map(|cap| cap == Cap::Flat);
    modified_cylinder_modified_cylinder(
        axis(one),
        one.radius(),
        flat(one),
        axis(two),
        two.radius(),
        flat(two),
    )
    .distance
}

fn capsules(robot: &Chain) -> Compound {
    let part = |link: &ModifiedCylinder| {
        (Pose::IDENTITY, SharedShape::new(Capsule::new(link.start(), link.end(), link.radius())))
    };
    Compound::new(robot.links().iter().map(part).collect())
}

fn two_robots(criterion: &mut Criterion) {
    let (a, b) = (bent(1.0), bent(-1.0));
    let poses: Vec<_> =
        (0..60).map(|k| Pose::translation(30.0 + 0.2 * f64::from(k), 1.0, 0.0)).collect();
    let mut group = criterion.benchmark_group("two robots of 30 links");
    let mut step = 0;
    let mut next = move |poses: &[Pose]| {
        step = (step + 1) % poses.len();
        poses[step]
    };
    let mut bench = |name: &str, ask: &mut dyn FnMut(&Pose) -> f64| {
        group.bench_function(name, |bencher| bencher.iter(|| ask(black_box(&next(&poses)))));
    };
    let here = Pose::IDENTITY;
    bench("minimum without memory", &mut |pose| {
        RobotPair::new().minimum(&a, &here, &b, pose).expect("an answer").distance
    });
    let mut pair = RobotPair::new();
    bench("minimum", &mut |pose| pair.minimum(&a, &here, &b, pose).expect("an answer").distance);
    bench("clears without memory", &mut |pose| {
        f64::from(u8::from(RobotPair::new().clears(&a, &here, &b, pose, 1.0).expect("an answer")))
    });
    bench("every exact pair", &mut |pose| {
        let placed: Vec<_> = b.links().iter().map(|link| link.transformed(pose)).collect();
        let all = a.links().iter().flat_map(|one| placed.iter().map(move |two| apart(one, two)));
        all.fold(f64::INFINITY, f64::min)
    });
    let (one, two) = (capsules(&a), capsules(&b));
    bench("parry's compounds of capsules", &mut |pose| {
        query::distance(&here, &one, pose, &two).expect("a supported pair").distance
    });
    group.finish();
}

fn one_robot(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("one robot and itself");
    for links in [60, 100] {
        let robot = coil(links);
        let mut query = SelfQuery::new();
        group.bench_function(format!("minimum without memory, {links} links"), |bencher| {
            bencher.iter(|| SelfQuery::new().minimum(black_box(&robot)).expect("an answer"));
        });
        group.bench_function(format!("clears without memory, {links} links"), |bencher| {
            bencher.iter(|| SelfQuery::new().clears(black_box(&robot), 1.0).expect("an answer"));
        });
        group.bench_function(format!("clears, {links} links"), |bencher| {
            bencher.iter(|| query.clears(black_box(&robot), 1.0).expect("an answer"));
        });
        group.bench_function(format!("every exact pair, {links} links"), |bencher| {
            bencher.iter(|| {
                let links = black_box(&robot).links();
                let pairs =
                    (0..links.len()).flat_map(|i| (i + 2..links.len()).map(move |j| (i, j)));
                pairs.map(|(i, j)| apart(&links[i], &links[j])).fold(f64::INFINITY, f64::min)
            });
        });
    }
    group.finish();
}

criterion_group!(benches, two_robots, one_robot);
criterion_main!(benches);
