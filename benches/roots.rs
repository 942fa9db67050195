//! The root finders on random polynomials, and as routes from a segment to a disc beside the convex
//! one.

use continuum_studies::Number;
use continuum_studies::quartic::{QuarticAsPrinted, RecentredQuartic};
use continuum_testing::Random;
use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, Criterion, Throughput, criterion_group, criterion_main};
use parry_continuum::distance::Vec3;
use parry_continuum::distance::laboratory::{Convex, DiscSolver};
use real_polynomial_roots::*;
use std::hint::black_box;
use std::time::Duration;

const COUNT: usize = 500;

fn group<'a>(criterion: &'a mut Criterion, name: &str) -> BenchmarkGroup<'a, WallTime> {
    let mut group = criterion.benchmark_group(name);
    group
        .sample_size(20)
        .measurement_time(Duration::from_millis(500))
        .warm_up_time(Duration::from_millis(200));
    group.throughput(Throughput::Elements(COUNT as u64));
    group
}

fn finder<F: RootFinder, T: Real, const M: usize>(
    group: &mut BenchmarkGroup<WallTime>,
    name: &str,
) {
    let mut random = Random::new(M as u64);
    let polynomials: Vec<[T; M]> =
        (0..COUNT).map(|_| std::array::from_fn(|_| T::of(random.between(-100.0, 100.0)))).collect();
    let name = format!("{name}, degree {}, f{}", M - 1, 8 * size_of::<T>());
    group.bench_function(name, |bencher| {
        bencher.iter(|| {
            for coefficients in &polynomials {
                let _ = black_box(F::roots(*coefficients));
            }
        });
    });
}

fn finders(criterion: &mut Criterion) {
    let mut group = group(criterion, "roots");
    finder::<ClosedForm, f64, 5>(&mut group, "closed form");
    finder::<Bairstow, f64, 5>(&mut group, "Bairstow");
    finder::<Companion, f64, 5>(&mut group, "companion");
    finder::<JenkinsTraub, f64, 5>(&mut group, "Jenkins-Traub");
    finder::<ClosedForm, f32, 5>(&mut group, "closed form");
    finder::<Bairstow, f64, 11>(&mut group, "Bairstow");
    finder::<Companion, f64, 11>(&mut group, "companion");
    finder::<JenkinsTraub, f64, 11>(&mut group, "Jenkins-Traub");
    group.finish();
}

fn route<S: DiscSolver<T>, T: Number>(group: &mut BenchmarkGroup<WallTime>, name: &str) {
    let mut random = Random::new(1);
    let vec3 = |p: [f64; 3]| Vec3::from(p.map(T::of));
    let problems: Vec<_> = (0..COUNT)
        .map(|_| {
            let ends = [0; 2].map(|_| vec3((random.point() * 3.0).to_array()));
            (ends, vec3(random.direction().to_array()), T::of(random.between(0.05, 2.0)))
        })
        .collect();
    group.bench_function(format!("{name}, f{}", 8 * size_of::<T>()), |bencher| {
        bencher.iter(|| {
            for (ends, normal, radius) in &problems {
                black_box(S::segment_disc(*ends, *normal, *radius));
            }
        });
    });
}

fn discs(criterion: &mut Criterion) {
    let mut group = group(criterion, "segment to disc");
    route::<Convex, f64>(&mut group, "convex");
    route::<RecentredQuartic<ClosedForm, 1>, f64>(&mut group, "recentred, closed form, 1 polish");
    route::<RecentredQuartic<Companion>, f64>(&mut group, "recentred, companion");
    route::<QuarticAsPrinted<ClosedForm>, f64>(&mut group, "as printed, closed form");
    route::<QuarticAsPrinted<Companion>, f64>(&mut group, "as printed, companion");
    route::<Convex, f32>(&mut group, "convex");
    route::<RecentredQuartic<ClosedForm, 1>, f32>(&mut group, "recentred, closed form, 1 polish");
    group.finish();
}

criterion_group!(benches, finders, discs);
criterion_main!(benches);
