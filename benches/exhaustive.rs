//! All links against all triangles, on one thread, against a loop of parry's `distance(Cylinder,
//! Triangle)`.

use continuum_demo::levels::levels;
use continuum_demo::subdivide::{in_four, shuffled};
use continuum_demo::{ctr, timing, ventricle};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use parry_continuum::Chain;
use parry_continuum::parry::math::Pose;
use parry_continuum::parry::query;
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{Exhaustive, Proximity, SearchPrecision};
use std::hint::black_box;
use std::time::Duration;

/// Measures parry on every n-th triangle: its time per pair does not depend on their number.
const SAMPLE: usize = 50;

fn exhaustive(criterion: &mut Criterion) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("one thread");
    let (vertices, indices) = shuffled(in_four(ventricle::mesh(ventricle::DEFAULT_TRIANGLES)), 1);
    let mesh = TriMesh::new(vertices, indices).expect("a valid mesh");
    let base = ventricle::entry();
    let line = ctr::three_tubes().centreline(&ventricle::goal(), 30);
    let models = [
        ("capsules", Chain::capsules(&line.points, &line.radii)),
        ("fitted caps", Chain::from_centreline(&line.points, &line.radii)),
        ("cylinders", Chain::cylinders(&line.points, &line.radii)),
    ]
    .map(|(name, robot)| (name, robot.expect("a valid robot")));

    let mut group = criterion.benchmark_group("exhaustive");
    group
        .sample_size(10)
        .measurement_time(Duration::from_secs(1))
        .warm_up_time(Duration::from_millis(300));
    let cylinders = timing::cylinders(&models[2].1);
    let triangles: Vec<_> = mesh.triangles().step_by(SAMPLE).collect();
    group.throughput(Throughput::Elements((cylinders.len() * triangles.len()) as u64));
    group.bench_function("parry", |bencher| {
        bencher.iter(|| {
            for (place, cylinder) in &cylinders {
                for triangle in &triangles {
                    let pose = base * *place;
                    black_box(
                        query::distance(&pose, cylinder, &Pose::IDENTITY, triangle)
                            .expect("a supported pair"),
                    );
                }
            }
        });
    });
    group.throughput(Throughput::Elements((cylinders.len() * mesh.num_triangles()) as u64));
    for culling in [false, true] {
        for (model, robot) in &models {
            let name = format!("{model}, {}", if culling { "culling" } else { "every pair" });
            let mut single: Exhaustive<f32> = engine(&mesh, culling);
            let mut double: Exhaustive<f64> = engine(&mesh, culling);
            let mut bench = |name: String, engine: &mut (dyn Proximity + Send)| {
                let mut out = Vec::new();
                let mut query = || engine.per_link(robot, &base, &mut out).expect("a finite pose");
                group.bench_function(name, |bencher| pool.install(|| bencher.iter(&mut query)));
            };
            bench(format!("{name}, f32"), &mut single);
            bench(format!("{name}, f64"), &mut double);
        }
    }
    // No instruction set may fall back to a narrower one in silence.
    for (name, level) in levels() {
        let mut single: Exhaustive<f32> = engine(&mesh, false);
        single.set_level(level);
        let mut out = Vec::new();
        let mut query = || single.per_link(&models[0].1, &base, &mut out).expect("a finite pose");
        group.bench_function(format!("capsules, every pair, f32, {name}"), |bencher| {
            pool.install(|| bencher.iter(&mut query));
        });
    }
    group.finish();
}

fn engine<T: SearchPrecision>(mesh: &TriMesh, culling: bool) -> Exhaustive<T> {
    let mut engine = Exhaustive::new(mesh).expect("a valid mesh");
    engine.set_culling(culling);
    engine
}

criterion_group!(benches, exhaustive);
criterion_main!(benches);
