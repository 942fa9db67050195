//! Every kernel's answers, on random problems of the kinds that break distance code, lie within
//! bounds that prove themselves: two points that lie in the shapes, and a plane that separates
//! them.

use continuum_testing::certificate::{Bounds, Exact, Shape, certify, directions, shapes};
use continuum_testing::kernels::{Input, KERNELS};
use continuum_testing::narrow_phase::{segment_disc, triangle_modified_cylinder};
use continuum_testing::precision::{Precision, extent, vector};
use continuum_testing::problems::Family;
use continuum_testing::{Random, rounds};
use parry_continuum::distance::*;
use parry_continuum::parry::math::Vector;

fn exact<T: Precision>(number: T) -> DoubleDouble {
    DoubleDouble::from(number.into())
}

fn exact_point<T: Precision>(point: Vec3<T>) -> Exact {
    Vec3::new(exact(point.x), exact(point.y), exact(point.z))
}

/// How often each kind of answer was seen.
#[derive(Debug, Default)]
struct Seen {
    apart: u32,
    meet: u32,
    /// Nearer than 1e-6 of the extent without touching.
    close: u32,
    on_vertex: u32,
    on_edge: u32,
    on_face: u32,
    beside_barrel: u32,
    at_rim: u32,
    over_flat_cap: u32,
    at_round_cap: u32,
}

impl Seen {
    fn count(
        &mut self,
        [triangle, link]: &[Shape; 2],
        closest: &Closest<DoubleDouble>,
        extent: f64,
    ) {
        let distance = closest.distance.rounded();
        if distance == 0.0 {
            self.meet += 1;
            return;
        }
        self.apart += 1;
        self.close += u32::from(distance < 1e-6 * extent);
        let near = |x: DoubleDouble| x.rounded() < 1e-20 * extent;
        if let Shape::Hull(corners) = triangle {
            let edges = [[0, 1], [1, 2], [2, 0]].map(|pair| pair.map(|i| corners[i]).to_vec());
            if corners.iter().any(|&corner| near((closest.point1 - corner).norm())) {
                self.on_vertex += 1;
            } else if edges
                .into_iter()
                .any(|edge| near(Shape::Hull(edge).distance_to(closest.point1)))
            {
                self.on_edge += 1;
            } else {
                self.on_face += 1;
            }
        }
        if let Shape::Link { ends, axis, radius, flat } = link {
            let heights =
                [(closest.point2 - ends[0]).dot(-*axis), (closest.point2 - ends[1]).dot(*axis)];
            let rho =
                (closest.point2 - ends[0] - *axis * (closest.point2 - ends[0]).dot(*axis)).norm();
            match (0..2).find(|&end| near(-heights[end])) {
                Some(end) if flat[end] && near((rho - *radius).abs()) => self.at_rim += 1,
                Some(end) if flat[end] => self.over_flat_cap += 1,
                Some(_) => self.at_round_cap += 1,
                None => self.beside_barrel += 1,
            }
        }
    }
}

/// Checks all kernels on one input against proven bounds and returns the worst errors in units.
fn check<T: Precision>(input: &Input<T>, worst: &mut [f64; KERNELS.len()], seen: &mut Seen) {
    let precise = input.map(exact);
    let (shapes, proofs) = (shapes(&precise), precise.answers());
    let directions = directions(&precise, &proofs);
    let answers = input.answers();
    let disc_has_normal = vector(input.disc_normal) != Vector::ZERO;
    for (kernel, (points, radius)) in input.parts().iter().enumerate() {
        if !disc_has_normal && KERNELS[kernel].ends_with("disc") {
            continue;
        }
        let extent = extent(points, *radius);
        let far = points.iter().map(|p| p.abs().max_element()).fold(*radius, f64::max);
        let (unit, place) = (T::UNIT * extent, T::UNIT * (extent + far));
        let (shapes, closest) = (&shapes[kernel], &answers[kernel]);
        let fail = |what: &str, error: f64| {
            panic!(
                "{}, {what}: {error}\n{closest:?}\n{:?}\n{input:?}",
                KERNELS[kernel], proofs[kernel]
            )
        };

        // The proof is sharper than the precision under test, down to distances that are 0 to it.
        let Bounds { lower, upper } = certify(shapes, &proofs[kernel], &directions);
        let open = (upper - lower).rounded();
        if open > unit && upper.rounded() > 16.0 * unit {
            fail("open between the bounds", open);
        }
        let got = exact(closest.distance);
        let error = (got - upper).max(lower - got).rounded();
        if error > 16.0 * unit || error.is_nan() {
            fail("outside of the bounds", error / unit);
        }
        if unit > 0.0 {
            worst[kernel] = worst[kernel].max(error / unit);
        }

        // Each witness lies in its shape, and together they realise the distance.
        let witnesses = [closest.point1, closest.point2].map(exact_point);
        for (shape, witness) in shapes.iter().zip(witnesses) {
            let off = shape.distance_to(witness).rounded();
            if off > 8.0 * place || off.is_nan() {
                fail("witness off its shape", off / place);
            }
        }
        let off = ((witnesses[0] - witnesses[1]).norm() - got).abs().rounded();
        if off > 8.0 * place || off.is_nan() {
            fail("witnesses do not realise the distance", off / place);
        }
        if kernel >= KERNELS.len() - 4 {
            seen.count(shapes, &proofs[kernel], extent);
        }
    }
}

fn check_random<T: Precision>(each: u32, finest: f64) {
    let mut random = Random::new(7);
    let mut worst = [0.0; KERNELS.len()];
    let mut seen = Seen::default();
    for family in Family::ALL {
        for _ in 0..each {
            let input = Input::from(&random.problem(family, finest)).map(T::from_f64);
            check(&input, &mut worst, &mut seen);
        }
    }
    for (name, worst) in KERNELS.iter().zip(worst) {
        println!("{name}: {worst:.2} units");
    }
    println!("{seen:?}");
    let all = f64::from(each * Family::ALL.len() as u32 * 4);
    let Seen { apart, meet, close, on_vertex, on_edge, on_face, .. } = seen;
    let shares = [
        (apart, 0.5),
        (meet, 0.1),
        (close, 0.01),
        (on_vertex, 0.1),
        (on_edge, 0.1),
        (on_face, 0.02),
    ];
    let Seen { beside_barrel, at_rim, over_flat_cap, at_round_cap, .. } = seen;
    let more = [(beside_barrel, 0.1), (at_rim, 0.1), (over_flat_cap, 0.01), (at_round_cap, 0.1)];
    for (count, least) in shares.into_iter().chain(more) {
        assert!(f64::from(count) >= least * all, "{count} of {all}: {seen:?}");
    }
}

#[test]
fn answers_lie_within_proven_bounds_in_double_precision() {
    check_random::<f64>(rounds(1500), -17.0);
}

#[test]
fn answers_lie_within_proven_bounds_in_single_precision() {
    check_random::<f32>(rounds(1500), -8.0);
}

/// Small integers make ties, parallels and zeros that random numbers never do.
#[test]
fn answers_on_the_integer_lattice_lie_within_proven_bounds() {
    let mut random = Random::new(11);
    let (mut worst, mut seen) = ([0.0; KERNELS.len()], Seen::default());
    for _ in 0..3_000 {
        let mut input = Input::from(&random.problem(Family::Lattice, -17.0));
        // Discs in planes that do not contain the axis.
        input.disc_normal = Vec3::new(random.whole(-2, 2), random.whole(-2, 2), random.whole(1, 2));
        check(&input, &mut worst, &mut seen);
        check(&input.map(|x| x as f32), &mut worst, &mut seen);
    }
    println!("{worst:?} {seen:?}");
    assert!(seen.meet > 5_000 && seen.apart > 5_000, "{seen:?}");
}

/// A segment parallel to a disc that passes over it just inside its rim: tau and N are 0 or
/// rounding noise.
#[test]
fn a_lattice_segment_that_passes_just_inside_the_rim() {
    let (a, e) = (Vec3::new(-1.0, 1.0, -1.0), Vec3::new(3.0, 1.0, -1.0));
    let (centre, normal) = (Vec3::new(0.0, 0.0, 0.0), Vec3::new(-1.0, 2.0, -1.0));
    let expected = (8.0_f64 / 3.0).sqrt();
    let double = segment_disc([a, a + e], centre, normal, 0.5).distance;
    assert!((double - expected).abs() <= 16.0 * f64::UNIT * 3.0, "{double}");
    let single = |v: Vec3<f64>| Vec3::new(v.x as f32, v.y as f32, v.z as f32);
    let single = segment_disc([a, a + e].map(single), single(centre), single(normal), 0.5).distance;
    assert!((f64::from(single) - expected).abs() <= 16.0 * f32::UNIT * 3.0, "{single}");
}

/// Both ends of a link far shorter than the rounding of its distance are equally near. The answer
/// must be that of the end that faces the triangle: here a flat cap of radius 1 under the plane z =
/// 1 + x / 2, whose nearest point is the rim's (-1, 0, 0), at 0.5 / sqrt(1.25).
#[test]
fn the_flat_cap_of_a_link_shorter_than_rounding_decides() {
    fn check<T: Precision>(length: f64) {
        let point = |x, y, z| T::vec3(Vector::new(x, y, z));
        let triangle = [point(-5.0, -4.0, -1.5), point(4.0, -4.0, 3.0), point(-0.5, 8.0, 0.75)];
        let (low, high) = (point(0.0, 0.0, 0.0), point(0.0, 0.0, length));
        let radius = T::from_f64(1.0);
        let forward = triangle_modified_cylinder(triangle, low, high, radius, [false, true]);
        let backward = triangle_modified_cylinder(triangle, high, low, radius, [true, false]);
        for distance in [forward, backward].map(|closest| closest.distance.into()) {
            let error = (distance - 0.2_f64.sqrt()).abs();
            assert!(error <= 16.0 * T::UNIT * 12.0, "{length}: {distance}");
        }
    }
    [1e-17, 1e-20, 1e-30].into_iter().for_each(check::<f64>);
    [1e-9, 1e-12, 1e-16].into_iter().for_each(check::<f32>);
}
