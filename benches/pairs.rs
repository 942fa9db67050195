//! One link against one triangle: this crate's kernels against parry's GJK, over the same random
//! pairs in one run.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use parry_continuum::distance::{Vec3, triangle_modified_cylinder};
use parry_continuum::parry::math::{Pose, Rotation, Vector};
use parry_continuum::parry::query;
use parry_continuum::parry::shape::{Capsule, Cylinder, Triangle};
use std::hint::black_box;

/// A triangle and the axis and radius of a link, all of about the same size.
struct Pair {
    triangle: [Vector; 3],
    start: Vector,
    end: Vector,
    radius: f64,
}

fn pairs(count: usize) -> Vec<Pair> {
    let mut state = 1_u64;
    let mut number = || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 * 2.0_f64.powi(-53)
    };
    let mut point =
        |spread: f64| Vector::new(number() - 0.5, number() - 0.5, number() - 0.5) * spread;
    (0..count)
        .map(|_| {
            let (centre, away) = (point(1.0), point(4.0));
            Pair {
                triangle: [point(2.0) + away, point(2.0) + away, point(2.0) + away],
                start: centre,
                end: centre + point(2.0),
                radius: 0.1 + point(0.1).x.abs(),
            }
        })
        .collect()
}

fn narrow_phase(criterion: &mut Criterion) {
    let pairs = pairs(1000);
    let mut group = criterion.benchmark_group("pairs");
    group.throughput(Throughput::Elements(pairs.len() as u64));
    let mut bench = |name: &str, distance: &dyn Fn(&Pair) -> f64| {
        group.bench_function(name, |bencher| {
            bencher.iter(|| pairs.iter().map(distance).sum::<f64>())
        });
    };
    let triangle =
        |pair: &Pair| Triangle::new(pair.triangle[0], pair.triangle[1], pair.triangle[2]);
    bench("parry cylinder", &|pair| {
        let turn =
            Rotation::from_rotation_arc(Vector::Y, (pair.end - pair.start).normalize_or(Vector::Y));
        let pose = Pose::from_parts((pair.start + pair.end) * 0.5, turn);
        let cylinder = Cylinder::new(0.5 * (pair.end - pair.start).length(), pair.radius);
        query::distance(&pose, &cylinder, &Pose::IDENTITY, &triangle(pair))
            .expect("a supported pair")
            .distance
    });
    bench("parry capsule", &|pair| {
        let capsule = Capsule::new(pair.start, pair.end, pair.radius);
        query::distance(&Pose::IDENTITY, &capsule, &Pose::IDENTITY, &triangle(pair))
            .expect("a supported pair")
            .distance
    });
    let to_f64 = |v: Vector| Vec3::from(v.to_array());
    let to_f32 = |v: Vector| Vec3::from(v.to_array().map(|x| x as f32));
    for (name, flat) in [
        ("capsule", [false, false]),
        ("modified cylinder", [true, false]),
        ("cylinder", [true, true]),
    ] {
        bench(&format!("{name}, f64"), &|pair| {
            let tri = black_box(pair.triangle).map(to_f64);
            triangle_modified_cylinder(tri, to_f64(pair.start), to_f64(pair.end), pair.radius, flat)
                .distance
        });
        bench(&format!("{name}, f32"), &|pair| {
            let tri = black_box(pair.triangle).map(to_f32);
            let link = (to_f32(pair.start), to_f32(pair.end), pair.radius as f32);
            f64::from(triangle_modified_cylinder(tri, link.0, link.1, link.2, flat).distance)
        });
    }
    group.finish();
}

criterion_group!(benches, narrow_phase);
criterion_main!(benches);
