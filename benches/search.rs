//! Per-link closest pairs by search, against parry on the same mesh and links, in one run; and the
//! side of a point.

use continuum_demo::{cavity, steer, timing};
use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::query;
use parry_continuum::parry::shape::{Cylinder, TriMesh};
use parry_continuum::proximity::{BvhSearch, Proximity, Side};
use std::hint::black_box;
use std::time::Duration;

fn parry_clears(mesh: &TriMesh, cylinders: &[(Pose, Cylinder)], pose: &Pose, margin: f64) -> bool {
    cylinders.iter().all(|(place, cylinder)| {
        let found =
            query::closest_points(&(*pose * *place), cylinder, &Pose::IDENTITY, mesh, margin);
        found.expect("a supported pair") == query::ClosestPoints::Disjoint
    })
}

fn search(criterion: &mut Criterion) {
    for level in [4, 6, 8] {
        let mesh = cavity::mesh(level);
        for (scene, clearance) in [("wall", 2.0), ("mid", 20.0)] {
            let robot = cavity::chain(clearance);
            let cylinders = timing::cylinders(&robot);
            let frames = cavity::frames(60);
            let margin = clearance * 0.5;
            let mut group = criterion.benchmark_group(format!("search/{scene}"));
            group
                .sample_size(10)
                .measurement_time(Duration::from_secs(1))
                .warm_up_time(Duration::from_millis(300));
            let mut bench = |name: &str, query: &mut dyn FnMut(&Pose)| {
                let mut frame = frames.iter().cycle();
                group.bench_function(BenchmarkId::new(name, mesh.indices().len()), |bencher| {
                    bencher.iter(|| query(frame.next().unwrap_or(&Pose::IDENTITY)));
                });
            };
            bench("parry 30 cylinders", &mut |pose| {
                black_box(timing::parry(&mesh, &cylinders, pose).expect("a supported pair"));
            });
            bench("parry clears", &mut |pose| {
                black_box(parry_clears(&mesh, &cylinders, pose, margin));
            });
            let mut engine = BvhSearch::new(&mesh).expect("the scene's mesh is valid");
            let mut out = Vec::new();
            bench("per link, first time", &mut |pose| {
                engine.forget();
                engine.per_link(&robot, pose, &mut out).expect("a finite pose");
                black_box(&out);
            });
            bench("per link, again", &mut |pose| {
                engine.per_link(&robot, pose, &mut out).expect("a finite pose");
                black_box(&out);
            });
            bench("minimum, first time", &mut |pose| {
                engine.forget();
                black_box(engine.minimum(&robot, pose).expect("a finite pose"));
            });
            bench("clears, first time", &mut |pose| {
                engine.forget();
                black_box(engine.clears(&robot, pose, margin).expect("a finite pose"));
            });
            group.finish();
        }
    }
}

/// Inside or outside, on the wall's both sides, against the sum over all triangles.
fn side(criterion: &mut Criterion) {
    for level in [4, 6, 8] {
        let mesh = cavity::mesh(level);
        let engine = BvhSearch::new(&mesh).expect("the scene's mesh is valid");
        let (line, _) = cavity::robot(2.0);
        let points: Vec<_> =
            line.iter().flat_map(|&point| [0.5, 0.9, 1.1, 2.0].map(|far| point * far)).collect();
        let mut group = criterion.benchmark_group("side");
        group
            .sample_size(10)
            .measurement_time(Duration::from_secs(1))
            .warm_up_time(Duration::from_millis(300));
        let mut bench = |name: &str, ask: &dyn Fn(Vector) -> bool| {
            let mut point = points.iter().cycle();
            group.bench_function(BenchmarkId::new(name, mesh.indices().len()), |bencher| {
                bencher.iter(|| black_box(ask(*point.next().unwrap_or(&Vector::ZERO))));
            });
        };
        bench("search", &|point| engine.side(point) == Side::Inside);
        bench("every triangle", &|point| steer::is_inside(&mesh, point));
        group.finish();
    }
}

criterion_group!(benches, search, side);
criterion_main!(benches);
