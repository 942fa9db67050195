//! Tests of the error bounds against solid angles of twice the digits.

use super::SolidAngle;
use super::solid_angle::{FarField, solid_angle};
use crate::distance::{DoubleDouble, Scalar, Vec3};
use continuum_testing::Random;
use parry3d_f64::math::Vector;
use std::f64::consts::TAU;

/// The solid angle of a triangle to nearly all digits of double precision, however small it is.
fn reference(corners: [Vector; 3], point: Vector) -> f64 {
    let twice = |v: Vector| Vec3::new(v.x.into(), v.y.into(), v.z.into());
    let [a, b, c] = corners.map(|corner| (twice(corner) - twice(point)).normalised());
    let one = DoubleDouble::from(1.0);
    let (across, along) = (a.dot(b.cross(c)), one + a.dot(b) + b.dot(c) + c.dot(a));
    2.0 * across.rounded().atan2(along.rounded())
}

/// Any size, place and shape, slivers included.
fn triangle(random: &mut Random) -> [Vector; 3] {
    let size = 10.0_f64.powf(random.between(-6.0, 6.0));
    let centre = random.point() * size * [0.0, 1.0, 1e3][random.below(3) as usize];
    let [a, b] = [0, 1].map(|_| centre + random.point() * size);
    let thin = 10.0_f64.powf(random.between(-12.0, 0.0));
    let c = match random.below(3) {
        0 => a.lerp(b, random.unit()) + random.point() * size * thin,
        1 => a + random.point() * size * thin,
        _ => centre + random.point() * size,
    };
    [a, b, c]
}

#[test]
fn a_triangles_solid_angle_is_within_its_bound() {
    let mut random = Random::new(41);
    let (mut worst, mut unknown, mut across_the_face, mut at_edges) = (0.0_f64, 0, 0, 0);
    for _ in 0..100_000 {
        let corners @ [a, b, c] = triangle(&mut random);
        let size = (b - a).length().max((c - a).length());
        let (s, t) = (random.unit(), random.unit());
        let on = match random.below(3) {
            0 => a,
            1 => a.lerp(b, s),
            _ => a.lerp(b, s).lerp(c, t),
        };
        let point = on + random.direction() * size * 10.0_f64.powf(random.between(-16.0, 4.0));
        let (found, truth) = (solid_angle(corners, point), reference(corners, point));
        // The error of the reference: an arc tangent of two rounded numbers.
        let error = (found.value - truth).abs() - 16.0 * f64::UNIT_ROUNDOFF;
        assert!(error <= found.error, "{found:?} for {truth}: {corners:?} from {point}");
        if found.error == TAU {
            unknown += 1;
            continue;
        }
        worst = worst.max(error / found.error);
        across_the_face += usize::from(found.value.abs() > 0.999 * TAU);
        at_edges += usize::from(found.error > 1e-6);
    }
    assert!(worst > 0.02, "{worst} of a bound");
    assert!(
        unknown > 100 && across_the_face > 1000 && at_edges > 1000,
        "{unknown} {across_the_face} {at_edges}"
    );
}

#[test]
fn points_of_a_triangle_are_not_told() {
    let [a, b, c] = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]].map(Vector::from);
    for point in [a, b, c, a.midpoint(b), b.midpoint(c), Vector::new(1.0, 1.0, 0.0)] {
        assert_eq!(solid_angle([a, b, c], point).error, TAU, "{point}");
        assert_eq!(
            solid_angle([a, a, b], point).error == TAU,
            point.y == 0.0 && point.x <= 4.0,
            "{point}"
        );
    }
    // In the plane and on the lines of the edges, but beside the triangle, the solid angle is 0.
    for point in
        [[-1.0, 0.0, 0.0], [5.0, 0.0, 0.0], [3.0, 3.0, 0.0], [-1e-9, 1.0, 0.0]].map(Vector::from)
    {
        let SolidAngle { value, error } = solid_angle([a, b, c], point);
        assert!(value == 0.0 && error < 1e-4, "{value} {error} from {point}");
    }
}

/// Patches: flat, curved, crumpled, and of slivers.
fn patch(random: &mut Random, size: f64, offset: Vector) -> Vec<[Vector; 3]> {
    let kind = random.below(4);
    let count = [1, 2, 16, 200][random.below(4) as usize];
    let frame = random.pose(0.0);
    let mut all = Vec::new();
    for _ in 0..count {
        let mut corner = || {
            let place = random.point();
            let place = match kind {
                0 => Vector::new(place.x, place.y, 0.0),
                1 => Vector::new(place.x, place.y, 0.5 * (place.x * place.x - place.y * place.y)),
                _ => place,
            };
            offset + frame * place * size
        };
        let (a, b, c) = (corner(), corner(), corner());
        all.push(if kind == 3 { [a, b, a.midpoint(b) + (c - a) * 1e-9] } else { [a, b, c] });
    }
    if kind < 2 {
        // All face the same way.
        let up = frame * Vector::Z;
        let facing = |t: &[Vector; 3]| (t[1] - t[0]).cross(t[2] - t[0]).dot(up) > 0.0;
        all.iter_mut().filter(|t| !facing(t)).for_each(|t| t.swap(1, 2));
    }
    all
}

#[test]
fn many_triangles_are_within_their_bound_from_afar() {
    let mut random = Random::new(43);
    let (mut worst, mut worst_far, mut near, mut far) = (0.0_f64, 0.0_f64, 0, 0);
    for _ in 0..3000 {
        let size = 10.0_f64.powf(random.between(-6.0, 6.0));
        let offset = random.point() * size * [0.0, 10.0, 1e6][random.below(3) as usize];
        let triangles = patch(&mut random, size, offset);
        let scale = (size * 8.0).power_of_two_to_unity();
        let corners = || triangles.iter().flatten().copied();
        let (low, high) = (corners().reduce(Vector::min), corners().reduce(Vector::max));
        let centre = low.zip(high).map_or(offset, |(low, high)| low.midpoint(high));
        let radius = corners().map(|corner| corner.distance(centre)).fold(0.0, f64::max);
        let field = FarField::new(scale, triangles.iter().copied());
        for _ in 0..4 {
            let away = [1.0 + random.unit(), 10.0_f64.powf(random.between(0.1, 9.0))]
                [random.below(2) as usize];
            let point = centre + random.direction() * radius * away;
            let SolidAngle { value, error } = field.solid_angle(scale, point);
            let each = triangles.iter().map(|&corners| reference(corners, point));
            let (truth, all) =
                each.fold((0.0, 0.0), |(sum, all), angle: f64| (sum + angle, all + angle.abs()));
            let rounding = (triangles.len() + 8) as f64 * f64::UNIT_ROUNDOFF * all;
            assert!(
                (value - truth).abs() <= error + rounding,
                "{value} +- {error} for {truth}, {away} radii away"
            );
            if error.is_finite() {
                let filled = ((value - truth).abs() - rounding) / error;
                if away < 1e3 {
                    worst = worst.max(filled)
                } else {
                    worst_far = worst_far.max(filled)
                }
            }
            near += usize::from(away < 1.5 && error.is_finite());
            far += usize::from(away > 1e6);
        }
    }
    // The bounds are nearly attained, both for truncation and for rounding.
    assert!(worst > 0.5 && worst_far > 1e-3, "{worst} {worst_far}");
    assert!(near > 1000 && far > 1000, "{near} {far}");
}
