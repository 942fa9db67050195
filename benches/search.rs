//! Per-link closest pairs by search, against parry on the same mesh and links, in one run.

#[path = "../examples/scene/cavity.rs"]
mod cavity;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use parry_continuum::parry::math::{Pose, Rotation, Vector};
use parry_continuum::parry::query;
use parry_continuum::parry::shape::{Cylinder, TriMesh};
use parry_continuum::proximity::{BvhSearch, Proximity};
use parry_continuum::{Chain, ModifiedCylinder};
use std::hint::black_box;
use std::time::Duration;

/// parry's cylinder for a link, which it wants along y around the origin.
fn parry_cylinder(link: &ModifiedCylinder) -> (Pose, Cylinder) {
    let rotation = Rotation::from_rotation_arc(Vector::Y, link.axis());
    let pose = Pose::from_parts((link.start() + link.end()) * 0.5, rotation);
    (pose, Cylinder::new(link.length() * 0.5, link.radius()))
}

fn parry_per_link(mesh: &TriMesh, cylinders: &[(Pose, Cylinder)], pose: &Pose) -> f64 {
    let distance = |(place, cylinder): &(Pose, Cylinder)| {
        query::distance(&(*pose * *place), cylinder, &Pose::IDENTITY, mesh)
            .expect("a supported pair")
            .distance
    };
    cylinders.iter().map(distance).sum()
}

fn parry_clears(mesh: &TriMesh, cylinders: &[(Pose, Cylinder)], pose: &Pose, margin: f64) -> bool {
    cylinders.iter().all(|(place, cylinder)| {
        let found = query::closest_points(&(*pose * *place), cylinder, &Pose::IDENTITY, mesh, margin);
        found.expect("a supported pair") == query::ClosestPoints::Disjoint
    })
}

fn search(criterion: &mut Criterion) {
    for level in [4, 6, 8] {
        let mesh = cavity::mesh(level);
        for (scene, clearance) in [("wall", 2.0), ("mid", 20.0)] {
            let robot: Chain = cavity::chain(clearance);
            let cylinders: Vec<_> = robot.links().iter().map(parry_cylinder).collect();
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
                black_box(parry_per_link(&mesh, &cylinders, pose));
            });
            bench("parry clears", &mut |pose| {
                black_box(parry_clears(&mesh, &cylinders, pose, margin));
            });
            let mut engine = BvhSearch::new(&mesh).expect("the scene's mesh is valid");
            let mut out = Vec::new();
            bench("per link, cold", &mut |pose| {
                engine.forget();
                engine.per_link(&robot, pose, &mut out).expect("a finite pose");
                black_box(&out);
            });
            bench("per link, warm", &mut |pose| {
                engine.per_link(&robot, pose, &mut out).expect("a finite pose");
                black_box(&out);
            });
            bench("minimum, cold", &mut |pose| {
                engine.forget();
                black_box(engine.minimum(&robot, pose).expect("a finite pose"));
            });
            bench("clears, cold", &mut |pose| {
                engine.forget();
                black_box(engine.clears(&robot, pose, margin).expect("a finite pose"));
            });
            group.finish();
        }
    }
}

criterion_group!(benches, search);
criterion_main!(benches);
