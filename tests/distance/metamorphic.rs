//! What must not change, or must change in a known way, when a problem is rewritten. No reference
//! is needed.

use continuum_testing::Random;
use continuum_testing::kernels::{Input, KERNELS};
use continuum_testing::narrow_phase::{
    segment_disc, segment_triangle, triangle_disc, triangle_modified_cylinder,
};
use continuum_testing::precision::{extent, vector};
use continuum_testing::problems::{Family, Problem};
use parry_continuum::distance::*;
use parry_continuum::parry::math::Vector;

const UNIT: f64 = f64::EPSILON / 2.0;

type V = Vec3<f64>;

fn vec3(point: Vector) -> V {
    Vec3::from(point.to_array())
}

/// Some problems of every family.
fn problems(seed: u64, each: u32) -> Vec<Problem> {
    let mut random = Random::new(seed);
    let mut all = Vec::new();
    for family in Family::ALL {
        all.extend((0..each).map(|_| random.problem(family, -17.0)));
    }
    all
}

fn whole_extent(problem: &Problem) -> f64 {
    extent(&problem.points(), problem.radius)
}

/// Asserts that two distances agree within this many units of the extent.
#[track_caller]
fn assert_same(what: &str, problem: &Problem, got: f64, expected: f64, unit: f64) {
    assert!(
        (got - expected).abs() <= 16.0 * unit,
        "{what}: {got} for {expected}, unit {unit}\n{problem:?}"
    );
}

fn link(problem: &Problem, flat: [bool; 2]) -> f64 {
    link_of(problem.triangle, problem, flat)
}

fn link_of(triangle: [Vector; 3], problem: &Problem, flat: [bool; 2]) -> f64 {
    let (start, end) = (vec3(problem.start), vec3(problem.end));
    triangle_modified_cylinder(triangle.map(vec3), start, end, problem.radius, flat).distance
}

const CAPS: [[bool; 2]; 4] = [[false, false], [true, false], [false, true], [true, true]];

#[test]
fn swapping_ends_or_arguments_changes_nothing() {
    for problem in problems(1, 300) {
        let unit = UNIT * whole_extent(&problem);
        let Problem { triangle, start, end, radius, .. } = problem;
        let ([a, b, c], s, e) = (triangle.map(vec3), vec3(start), vec3(end));
        let turned = Problem { start: end, end: start, ..problem };
        for flat in CAPS {
            assert_same(
                "link",
                &problem,
                link(&turned, [flat[1], flat[0]]),
                link(&problem, flat),
                unit,
            );
        }
        let expected = segment_segment([s, e], [a, b]).distance;
        for other in [
            segment_segment([e, s], [a, b]),
            segment_segment([s, e], [b, a]),
            segment_segment([a, b], [s, e]),
            segment_segment([b, a], [e, s]),
        ] {
            assert_same("segments", &problem, other.distance, expected, unit);
        }
        let tri = [a, b, c];
        let expected = segment_triangle([s, e], tri).distance;
        assert_same("segment", &problem, segment_triangle([e, s], tri).distance, expected, unit);
        let normal = vec3(end - start);
        let expected = segment_disc([a, b], e, normal, radius).distance;
        assert_same(
            "disc",
            &problem,
            segment_disc([b, a], e, normal, radius).distance,
            expected,
            unit,
        );
        assert_same(
            "disc",
            &problem,
            segment_disc([a, b], e, -normal, radius).distance,
            expected,
            unit,
        );
    }
}

#[test]
fn the_order_of_vertices_changes_nothing() {
    for problem in problems(2, 300) {
        let unit = UNIT * whole_extent(&problem);
        let [a, b, c] = problem.triangle;
        let (s, e) = (vec3(problem.start), vec3(problem.end));
        let normal = vec3(problem.end - problem.start);
        let answers = |triangle: [Vector; 3]| {
            let t = triangle.map(vec3);
            let links = CAPS.map(|flat| link_of(triangle, &problem, flat));
            let others = [
                point_triangle(e, t).distance,
                segment_triangle([s, e], t).distance,
                triangle_disc(t, e, normal, problem.radius).distance,
            ];
            [links.to_vec(), others.to_vec()].concat()
        };
        let expected = answers([a, b, c]);
        for order in [[a, c, b], [b, a, c], [b, c, a], [c, a, b], [c, b, a]] {
            for (got, expected) in answers(order).iter().zip(&expected) {
                assert_same("order", &problem, *got, *expected, unit);
            }
        }
    }
}

/// A rotation turns every number's rounding; so the ends of a short link turn its flat caps by u
/// extent / length.
#[test]
fn a_rigid_motion_changes_no_distance() {
    let mut random = Random::new(3);
    for problem in problems(3, 300) {
        let translation = [0.0, 1.0, 1e3, 1e6][random.below(4) as usize];
        let pose = random.pose(translation);
        let moved = Problem {
            triangle: problem.triangle.map(|p| pose * p),
            start: pose * problem.start,
            end: pose * problem.end,
            ..problem
        };
        let input = Input::from(&problem);
        let turn = |v: V| vec3(pose.rotation * vector(v));
        let moved = Input {
            plane_normal: turn(input.plane_normal),
            disc_normal: turn(input.disc_normal),
            ..Input::from(&moved)
        };
        let far = problem.points().iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
        let length = (problem.end - problem.start).length();
        let turned_caps = if length > 0.0 { 1.0 + problem.radius / length } else { 1.0 };
        let unit = UNIT * (whole_extent(&problem) + far + translation) * turned_caps;
        for (kernel, (got, expected)) in moved.answers().iter().zip(&input.answers()).enumerate() {
            assert_same(KERNELS[kernel], &problem, got.distance, expected.distance, unit);
        }
    }
}

/// Bit for bit: the scaled problem's answers, if they can be represented, are the scaled answers.
fn check_scaling<T: Scalar + PartialEq + std::fmt::Debug>(
    input: &Input<T>,
    factor: T,
    is_exact: impl Fn(T) -> bool,
) -> bool {
    let Input { triangle: [a, b, c], plane_normal, start, end, disc_normal, radius } = *input;
    let numbers = [a, b, c, plane_normal, start, end, disc_normal].map(<[T; 3]>::from);
    if !numbers.iter().flatten().chain([&radius]).all(|&x| is_exact(x)) {
        return false;
    }
    let (answers, scaled) = (input.answers(), input.map(|x| x * factor).answers());
    for (kernel, (got, expected)) in scaled.iter().zip(&answers).enumerate() {
        let compare = |got: T, expected: T| {
            assert!(
                got == expected * factor || !is_exact(expected),
                "{} times {factor:?}: {got:?} for {expected:?}\n{input:?}",
                KERNELS[kernel]
            );
        };
        compare(got.distance, expected.distance);
        let points = [(got.point1, expected.point1), (got.point2, expected.point2)];
        for (got, expected) in points {
            let (got, expected): ([T; 3], [T; 3]) = (got.into(), expected.into());
            got.into_iter().zip(expected).for_each(|(got, expected)| compare(got, expected));
        }
    }
    true
}

#[test]
fn powers_of_two_scale_every_kernel_bit_for_bit_in_double_precision() {
    let mut compared = [0; 16];
    for problem in problems(4, 20) {
        let input = Input::from(&problem);
        let exponents =
            [-960, -700, -300, -150, -40, -13, -2, -1, 1, 2, 13, 40, 150, 300, 700, 960];
        for (i, exponent) in exponents.into_iter().enumerate() {
            let factor = 2.0_f64.powi(exponent);
            let is_exact = |x: f64| x == 0.0 || (x.is_normal() && (x * factor).is_normal());
            compared[i] += u32::from(check_scaling(&input, factor, is_exact));
        }
    }
    println!("{compared:?} problems");
    assert!(compared.iter().all(|&count| count > 200), "{compared:?}");
}

#[test]
fn powers_of_two_scale_every_kernel_bit_for_bit_in_single_precision() {
    let mut compared = [0; 14];
    for problem in problems(5, 20) {
        let input = Input::from(&problem).map(|x| x as f32);
        let exponents = [-100, -60, -40, -20, -13, -7, -1, 1, 7, 13, 20, 40, 60, 100];
        for (i, exponent) in exponents.into_iter().enumerate() {
            let factor = 2.0_f32.powi(exponent);
            let is_exact = |x: f32| x == 0.0 || (x.is_normal() && (x * factor).is_normal());
            compared[i] += u32::from(check_scaling(&input, factor, is_exact));
        }
    }
    println!("{compared:?} problems");
    assert!(compared.iter().all(|&count| count > 150), "{compared:?}");
}

#[test]
fn capsules_bound_modified_cylinders_bound_cylinders() {
    let mut capsule_nearer = [0; 2];
    for problem in problems(6, 600) {
        let slack = 16.0 * UNIT * whole_extent(&problem);
        let [k, start_flat, end_flat, z] = CAPS.map(|flat| link(&problem, flat));
        let (s, e) = (vec3(problem.start), vec3(problem.end));
        let axis = segment_triangle([s, e], problem.triangle.map(vec3)).distance;
        for (end, mixed) in [start_flat, end_flat].into_iter().enumerate() {
            assert!(k <= mixed + slack && mixed <= z + slack, "{k} {mixed} {z}\n{problem:?}");
            capsule_nearer[end] += u32::from(k < mixed);
        }
        assert!(
            z <= axis + slack && axis <= k + problem.radius + slack,
            "{z} {axis} {k}\n{problem:?}"
        );
    }
    println!("{capsule_nearer:?}");
    assert!(capsule_nearer.iter().all(|&count| count > 500), "{capsule_nearer:?}");
}

#[test]
fn the_parts_of_a_triangle_are_as_near_as_the_whole() {
    for problem in problems(7, 300) {
        // Midpoints round, by at most a unit of the coordinates.
        let far = problem.triangle.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
        let unit = UNIT * (whole_extent(&problem) + far);
        let [a, b, c] = problem.triangle;
        let (ab, bc, ca) = ((a + b) * 0.5, (b + c) * 0.5, (c + a) * 0.5);
        let parts = [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]];
        for flat in CAPS {
            let whole = link(&problem, flat);
            let least = parts
                .map(|part| link_of(part, &problem, flat))
                .into_iter()
                .fold(f64::INFINITY, f64::min);
            assert_same("parts", &problem, least, whole, unit);
        }
        let normal = vec3(problem.end - problem.start);
        let disc = |t: [Vector; 3]| {
            triangle_disc(t.map(vec3), vec3(problem.end), normal, problem.radius).distance
        };
        let least = parts.map(disc).into_iter().fold(f64::INFINITY, f64::min);
        assert_same("parts", &problem, least, disc(problem.triangle), unit);
    }
}

#[test]
fn a_shape_within_another_is_never_nearer() {
    let mut random = Random::new(8);
    let mut nearer = 0;
    for problem in problems(8, 300) {
        let axis = problem.end - problem.start;
        let longer = Problem { end: problem.end + axis * random.unit(), ..problem };
        let wider = Problem { radius: problem.radius * (1.0 + random.unit()), ..problem };
        // The old end lies beside the longer axis by rounding, and a short link's caps turn by it.
        let far = problem.points().iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
        let turned_caps =
            if axis == Vector::ZERO { 1.0 } else { 1.0 + problem.radius / axis.length() };
        for flat in CAPS {
            let distance = link(&problem, flat);
            for larger in [longer, wider] {
                let got = link(&larger, flat);
                let slack = 16.0 * UNIT * (whole_extent(&larger) + far) * turned_caps;
                assert!(
                    got <= distance + slack,
                    "{got} for at most {distance}\n{problem:?}\n{larger:?}"
                );
                nearer += u32::from(got < distance);
            }
        }
    }
    assert!(nearer > 6000, "{nearer}");
}

/// Any finite numbers, of magnitudes far apart or alike.
fn wild(random: &mut Random, values: &[f64]) -> Input<f64> {
    let few = [0; 3].map(|_| values[random.below(values.len() as u32) as usize]);
    let mut number = || {
        let value = few[random.below(3) as usize];
        let factor = [1.0, 1.0, -1.0, 0.3][random.below(4) as usize];
        value * factor
    };
    let mut point = || Vec3::new(number(), number(), number());
    Input {
        triangle: [point(), point(), point()],
        plane_normal: point(),
        start: point(),
        end: point(),
        disc_normal: point(),
        radius: number().abs(),
    }
}

/// No answer is NaN; up to `limit` none is infinite (beyond, the distance itself may overflow).
fn check_finite<T: Scalar + Into<f64> + std::fmt::Debug>(input: &Input<T>, limit: f64) {
    let numbers = |c: &Closest<T>| {
        let points: [[T; 3]; 2] = [c.point1.into(), c.point2.into()];
        [vec![c.distance], points.concat()].concat()
    };
    let [a, b, c] = input.triangle;
    let points = [a, b, c, input.start, input.end];
    let largest = points.map(|p| vector(Vec3::new(p.x.abs(), p.y.abs(), p.z.abs())).max_element());
    let largest = largest.into_iter().fold(input.radius.into(), f64::max);
    for (kernel, closest) in input.answers().iter().enumerate() {
        for number in numbers(closest) {
            let number: f64 = number.into();
            assert!(!number.is_nan(), "{}: {closest:?}\n{input:?}", KERNELS[kernel]);
            assert!(
                number.is_finite() || largest > limit,
                "{}: {closest:?}\n{input:?}",
                KERNELS[kernel]
            );
        }
        assert!(closest.distance.into() >= 0.0, "{}: {closest:?}\n{input:?}", KERNELS[kernel]);
    }
}

#[test]
fn finite_numbers_of_any_size_give_no_nan() {
    let mut random = Random::new(9);
    let values = [
        0.0,
        5e-324,
        1e-310,
        3e-308,
        1e-300,
        1e-200,
        1e-154,
        1e-80,
        1e-20,
        1.0,
        3.0,
        1e20,
        1e80,
        1e154,
        1e200,
        1e300,
        3e307,
        1.7e308,
        f64::MAX,
    ];
    for _ in 0..40_000 {
        check_finite(&wild(&mut random, &values), 4e307);
    }
    let values = [
        0.0,
        1e-45,
        1e-40,
        1.2e-38,
        1e-30,
        1e-19,
        1e-9,
        1.0,
        3.0,
        1e9,
        1e19,
        1e30,
        8e37,
        3e38,
        f64::from(f32::MAX),
    ];
    for _ in 0..40_000 {
        check_finite(&wild(&mut random, &values).map(|x| x as f32), 8e37);
    }
}
