//! The reference distances, through the kernels, in double and single precision.

mod common;

use common::{Case, distance_cases};
use parry_continuum::distance::*;

/// Unit roundoff and conversion for a precision under test.
trait Precision: Scalar<Mask = bool> + Into<f64> + std::fmt::Debug {
    const UNIT: f64;
    fn from_f64(value: f64) -> Self;
}
impl Precision for f64 {
    const UNIT: f64 = f64::EPSILON / 2.0;
    fn from_f64(value: f64) -> Self {
        value
    }
}
impl Precision for f32 {
    const UNIT: f64 = f32::EPSILON as f64 / 2.0;
    fn from_f64(value: f64) -> Self {
        value as f32
    }
}

fn vector<T: Precision>(v: [f64; 3]) -> Vec3<T> {
    Vec3::from(v.map(T::from_f64))
}

fn answer<T: Precision>(case: &Case) -> Closest<T> {
    let v = |x| vector::<T>(x);
    let tri = case.tri.map(v);
    let r = T::from_f64(case.r);
    match case.kind.as_str() {
        "segment_segment" => segment_segment([v(case.s0), v(case.s1)], [v(case.u0), v(case.u1)]),
        "point_triangle" => point_triangle(v(case.p), tri),
        "segment_triangle" => segment_triangle([v(case.s0), v(case.s1)], tri),
        "point_disc" => point_disc(v(case.p), v(case.c), v(case.n), r),
        "segment_disc" => segment_disc([v(case.s0), v(case.s1)], v(case.c), v(case.n), r),
        "triangle_disc" => triangle_disc(tri, v(case.c), v(case.n), r),
        "triangle_capsule" => triangle_capsule(tri, v(case.p0), v(case.p1), r),
        _ => triangle_modified_cylinder(tri, v(case.p0), v(case.p1), r, case.flat()),
    }
}

fn worst<T: Precision>(cases: &[Case]) -> f64 {
    let mut worst = 0.0_f64;
    for case in cases {
        let closest = answer::<T>(case);
        let unit = T::UNIT * case.scale;
        let error = (closest.distance.into() - case.distance()).abs() / unit;
        assert!(
            error <= 16.0,
            "{} {} {}: {error} units, {closest:?} for {}",
            case.id,
            case.kind,
            case.cat,
            case.d
        );
        // The witnesses realise the distance.
        let gap: [T; 3] = (closest.point1 - closest.point2).into();
        let gap = gap.map(Into::<f64>::into);
        let realised = (gap[0] * gap[0] + gap[1] * gap[1] + gap[2] * gap[2]).sqrt();
        let slack = 8.0 * T::UNIT * (case.mag + case.scale);
        assert!(
            (realised - closest.distance.into()).abs() <= slack,
            "{} {} {}: witnesses at {realised}, distance {:?}",
            case.id,
            case.kind,
            case.cat,
            closest.distance
        );
        worst = worst.max(error);
    }
    worst
}

#[test]
fn every_case_in_double_precision() {
    let cases = distance_cases();
    assert_eq!(cases.len(), 2050);
    println!("f64: {:.2} units of the extent", worst::<f64>(&cases));
}

#[test]
fn every_single_precision_case_in_single_precision() {
    let cases: Vec<_> = distance_cases().into_iter().filter(|case| case.f32).collect();
    assert!(cases.len() > 1000);
    println!("f32: {:.2} units of the extent", worst::<f32>(&cases));
}
