//! The reference distances, through the kernels in double and single precision and through parry's
//! traits.

use continuum_testing::narrow_phase::{
    segment_disc, segment_triangle, triangle_capsule, triangle_disc, triangle_modified_cylinder,
};
use continuum_testing::precision::Precision;
use continuum_testing::{Case, distance_cases};
use parry_continuum::distance::*;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::query::{ClosestPoints, QueryDispatcher};
use parry_continuum::parry::shape::{Shape, Triangle};
use parry_continuum::{Cap, ContinuumDispatcher, ModifiedCylinder};

fn answer<T: Precision>(case: &Case) -> Closest<T> {
    let v = |point: [f64; 3]| T::vec3(Vector::from(point));
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

#[test]
fn every_link_through_parrys_dispatcher() {
    let (mut links, mut touching) = (0, 0);
    for case in distance_cases()
        .iter()
        .filter(|case| case.kind.starts_with("triangle_") && case.kind != "triangle_disc")
    {
        let caps = case.flat().map(|flat| if flat { Cap::Flat } else { Cap::Round });
        let (start, end) = (Vector::from(case.p0), Vector::from(case.p1));
        // A wire of length 0 with flat caps is a point, which only two round caps may describe.
        let caps = if start == end { [Cap::Round; 2] } else { caps };
        let link = ModifiedCylinder::new(start, end, case.r, caps).unwrap();
        let [a, b, c] = case.tri.map(Vector::from);
        let triangle = Triangle::new(a, b, c);
        let dispatcher = ContinuumDispatcher::default();
        for (g1, g2) in [(&link as &dyn Shape, &triangle as &dyn Shape), (&triangle, &link)] {
            let found = dispatcher.distance(&Pose::IDENTITY, g1, g2).unwrap().distance;
            let error = (found - case.distance()).abs() / (f64::UNIT * case.scale);
            assert!(error <= 16.0, "{} {} {}: {error} units", case.id, case.kind, case.cat);
            match dispatcher.closest_points(&Pose::IDENTITY, g1, g2, f64::MAX).unwrap() {
                ClosestPoints::WithinMargin(p1, p2) => {
                    let slack = 8.0 * f64::UNIT * (case.mag + case.scale);
                    assert!(
                        ((p1 - p2).length() - found).abs() <= slack,
                        "{}: {p1} {p2} {found}",
                        case.id
                    );
                }
                ClosestPoints::Intersecting => {
                    assert_eq!(found, 0.0, "{}", case.id);
                    touching += 1;
                }
                ClosestPoints::Disjoint => panic!("{} is nowhere", case.id),
            }
        }
        links += 1;
    }
    assert!(links > 1000 && touching > 200, "{links} links, {touching} touching");
}
