//! Every function of the narrow phase on the GPU against its twin on the CPU: the reference cases,
//! and random problems of the kinds that break distance code.

use continuum_studies::gpu::{Discs, GpuPairs, Pair, PairProblem};
use continuum_testing::kernels::Input;
use continuum_testing::problems::{Family, Problem};
use continuum_testing::{Case, Random, distance_cases, gpu};
use parry_continuum::distance::*;
use parry_continuum::gpu::{Gpu, Precision};
use parry_continuum::parry::math::Vector;

fn unit(precision: Precision) -> f64 {
    match precision {
        Precision::F32 => f64::from(f32::EPSILON) / 2.0,
        Precision::F64 => f64::EPSILON / 2.0,
    }
}

/// The CPU's answer.
fn twin(pair: Pair, problem: &PairProblem) -> Closest<f64> {
    let PairProblem { triangle, plane_normal, start, end, disc_normal, radius, flat } = *problem;
    let [a, b, _] = triangle;
    match pair {
        Pair::SegmentSegment => segment_segment([start, end], [a, b]),
        Pair::PointTriangle => point_triangle(end, triangle),
        Pair::SegmentTriangle => segment_triangle([start, end], triangle),
        Pair::PointDisc => point_disc(a, end, disc_normal, radius),
        Pair::SegmentDisc => segment_disc([a, b], end, disc_normal, radius),
        Pair::PlaneDisc => plane_disc(a, plane_normal, end, disc_normal, radius),
        Pair::TriangleDisc => triangle_disc(triangle, end, disc_normal, radius),
        Pair::PointModifiedCylinder => point_modified_cylinder(a, start, end, radius, flat),
        Pair::TriangleCapsule => triangle_capsule(triangle, start, end, radius),
        Pair::TriangleModifiedCylinder => {
            triangle_modified_cylinder(triangle, start, end, radius, flat)
        }
    }
}

/// The size of what the pair takes, for the unit of its error.
fn extent(pair: Pair, problem: &PairProblem) -> f64 {
    let vector = continuum_testing::precision::vector::<f64>;
    let [a, b, c] = problem.triangle.map(vector);
    let (start, end) = (vector(problem.start), vector(problem.end));
    let (points, length): (&[Vector], f64) = match pair {
        Pair::SegmentSegment => (&[start, end, a, b], 0.0),
        Pair::PointTriangle => (&[end, a, b, c], 0.0),
        Pair::SegmentTriangle => (&[start, end, a, b, c], 0.0),
        Pair::PointDisc | Pair::PlaneDisc => (&[end, a], problem.radius),
        Pair::SegmentDisc => (&[end, a, b], problem.radius),
        Pair::TriangleDisc => (&[end, a, b, c], problem.radius),
        Pair::PointModifiedCylinder => (&[start, end, a], problem.radius),
        Pair::TriangleCapsule | Pair::TriangleModifiedCylinder => {
            (&[start, end, a, b, c], problem.radius)
        }
    };
    continuum_testing::precision::extent(points, length)
}

/// The worst error against the twin, in units of the extent, and how many problems touch.
fn worst(gpu: &Gpu, pair: Pair, problems: &[PairProblem]) -> (f64, usize) {
    let mut answers = Vec::new();
    GpuPairs::new(gpu, pair).unwrap().solve(problems, &mut answers).unwrap();
    assert_eq!(answers.len(), problems.len());
    let (mut worst, mut touching) = (0.0_f64, 0);
    for (problem, answer) in problems.iter().zip(&answers) {
        let expected = twin(pair, problem);
        let unit = unit(gpu.precision()) * extent(pair, problem);
        let error = (answer.distance - expected.distance).abs();
        // Written so that NaN fails; all points of a problem may be one.
        assert!(
            error <= 16.0 * unit,
            "{pair:?}: {error}, {answer:?} for {expected:?}, {problem:?}"
        );
        let vector = continuum_testing::precision::vector::<f64>;
        let gap = (vector(answer.point1) - vector(answer.point2)).length();
        let magnitude = vector(answer.point1).length() + vector(answer.point2).length();
        let slack = 16.0 * unit + 8.0 * f64::EPSILON * magnitude;
        assert!(
            (gap - answer.distance).abs() <= slack,
            "{pair:?}: witnesses at {gap}, {answer:?}, {problem:?}"
        );
        worst = worst.max(if error > 0.0 { error / unit } else { 0.0 });
        touching += usize::from(answer.distance == 0.0);
    }
    (worst, touching)
}

#[test]
fn reference_cases() {
    for (name, precision) in gpu::PRECISIONS {
        let Some(gpu) = gpu::open(precision) else { continue };
        let cases: Vec<_> = distance_cases()
            .into_iter()
            .filter(|case| case.f32 || precision == Precision::F64)
            .collect();
        assert!(cases.len() > 1000);
        for pair in Pair::ALL {
            let of_pair = |case: &&Case| pair_of(case) == pair;
            let cases: Vec<_> = cases.iter().filter(of_pair).collect();
            let problems: Vec<_> = cases
                .iter()
                .map(|case| PairProblem::of(&Input::from(*case), case.flat()))
                .collect();
            let mut answers = Vec::new();
            GpuPairs::new(gpu, pair).unwrap().solve(&problems, &mut answers).unwrap();
            let mut worst = 0.0_f64;
            for (case, answer) in cases.iter().zip(&answers) {
                let error =
                    (answer.distance - case.distance()).abs() / (unit(precision) * case.scale);
                assert!(
                    error <= 16.0,
                    "{name} {} {} {}: {error} units",
                    case.id,
                    case.kind,
                    case.cat
                );
                worst = worst.max(error);
            }
            println!("{name} {pair:?}: {} cases, worst {worst:.2}", cases.len());
            assert_eq!(answers.len(), cases.len());
        }
    }
}

fn pair_of(case: &Case) -> Pair {
    match case.kind.as_str() {
        "segment_segment" => Pair::SegmentSegment,
        "point_triangle" => Pair::PointTriangle,
        "segment_triangle" => Pair::SegmentTriangle,
        "point_disc" => Pair::PointDisc,
        "segment_disc" => Pair::SegmentDisc,
        "triangle_disc" => Pair::TriangleDisc,
        "triangle_capsule" => Pair::TriangleCapsule,
        _ => Pair::TriangleModifiedCylinder,
    }
}

/// Random problems in the precision under test, each with one of the four choices of caps.
fn random_problems(random: &mut Random, family: Family, precision: Precision) -> Vec<PairProblem> {
    let finest = if precision == Precision::F32 { -8.0 } else { -17.0 };
    (0..400)
        .map(|number| {
            let problem: Problem = random.problem(family, finest);
            let problem = match precision {
                Precision::F32 => problem.map(|number| f64::from(number as f32)),
                Precision::F64 => problem,
            };
            PairProblem::of(&Input::from(&problem), [number & 1 != 0, number & 2 != 0])
        })
        .collect()
}

#[test]
fn random_and_nasty_problems() {
    for (name, precision) in gpu::PRECISIONS {
        let Some(gpu) = gpu::open(precision) else { continue };
        for pair in Pair::ALL {
            let mut random = Random::new(31);
            let (mut problems, mut all) = (Vec::new(), 0);
            for family in Family::ALL {
                problems.extend(random_problems(&mut random, family, precision));
                all += 400;
            }
            let (worst, touching) = worst(gpu, pair, &problems);
            println!("{name} {pair:?}: worst {worst:.2} of {all}, {touching} touching");
            assert!(touching > 2 && touching < all / 2, "{name} {pair:?}: {touching}");
        }
    }
}

/// A link as short as a power of ten, with flat caps of radius 0.5, and a triangle at a distance of
/// about 1.
fn short_link(random: &mut Random, power: i32, precision: Precision) -> PairProblem {
    let held = |v: Vector| match precision {
        Precision::F32 => Vec3::from(v.as_vec3().as_dvec3()),
        Precision::F64 => Vec3::from(v),
    };
    let centre = random.direction();
    let triangle = [(); 3].map(|()| held(centre + random.point() * 0.3));
    let [start, end] = [Vector::ZERO, random.direction() * 10.0_f64.powi(power)].map(held);
    PairProblem {
        triangle,
        plane_normal: end,
        start,
        end,
        disc_normal: end,
        radius: 0.5,
        flat: [true; 2],
    }
}

/// A link keeps its flat caps however short it is, on devices too that have no numbers below the
/// normal ones.
#[test]
fn short_links() {
    for (name, precision) in gpu::PRECISIONS {
        let Some(gpu) = gpu::open(precision) else { continue };
        let shortest = if precision == Precision::F32 { -18 } else { -150 };
        let mut random = Random::new(43);
        let powers = (shortest..0).flat_map(|power| [power; 20]);
        let problems: Vec<_> =
            powers.map(|power| short_link(&mut random, power, precision)).collect();
        let pair = Pair::TriangleModifiedCylinder;
        let decided_by_cap = |problem: &&PairProblem| {
            let [flat, round] = [true, false]
                .map(|cap| twin(pair, &PairProblem { flat: [cap; 2], ..**problem }).distance);
            flat > round + 0.05
        };
        let caps = problems.iter().filter(decided_by_cap).count();
        assert!(2 * caps > problems.len(), "{name}: {caps} of {}", problems.len());
        for pair in [Pair::PointModifiedCylinder, pair] {
            let (worst, _) = worst(gpu, pair, &problems);
            println!("{name} {pair:?}: worst {worst:.2}");
        }
    }
}

/// The paper's quartic finds the distance of most discs, and never a smaller one: its candidates
/// are points of the segment. (The closed form loses digits on nearly double roots.)
#[test]
fn discs_by_the_quartic() {
    for (name, precision) in gpu::PRECISIONS {
        let Some(gpu) = gpu::open(precision) else { continue };
        let mut random = Random::new(41);
        let mut problems = Vec::new();
        for family in [Family::Generic, Family::Lattice, Family::EdgeTangentToRim, Family::Touching]
        {
            problems.extend(random_problems(&mut random, family, precision));
        }
        for pair in [Pair::SegmentDisc, Pair::TriangleDisc, Pair::TriangleModifiedCylinder] {
            for (discs, share) in [(Discs::ClosedForm, 0.9), (Discs::Companion, 0.99)] {
                let mut answers = Vec::new();
                let mut pairs = GpuPairs::with_discs(gpu, pair, discs).unwrap();
                pairs.solve(&problems, &mut answers).unwrap();
                assert_eq!(answers.len(), problems.len());
                let mut exact = 0;
                for (problem, answer) in problems.iter().zip(&answers) {
                    let expected = twin(pair, problem).distance;
                    let unit = unit(precision) * extent(pair, problem);
                    let beyond = answer.distance - expected;
                    assert!(
                        beyond >= -16.0 * unit,
                        "{name} {pair:?} {discs:?}: {answer:?} for {expected}"
                    );
                    exact += usize::from(beyond <= 16.0 * unit);
                }
                let exact = exact as f64 / problems.len() as f64;
                println!("{name} {pair:?} {discs:?}: {exact:.4} to rounding");
                assert!(exact > share, "{name} {pair:?} {discs:?}: {exact}");
            }
        }
    }
}

/// Problems of any size come back in their own unit, bit for bit.
#[test]
fn scaling_by_a_power_of_two_scales_the_answers_bit_for_bit() {
    for (_, precision) in gpu::PRECISIONS {
        let Some(gpu) = gpu::open(precision) else { continue };
        let mut random = Random::new(37);
        let plain = random_problems(&mut random, Family::Generic, precision);
        for power in [-300, 300] {
            let factor = 2.0_f64.powi(power);
            let scale = |v: Vec3<f64>| Vec3::new(v.x * factor, v.y * factor, v.z * factor);
            let scaled: Vec<_> = plain
                .iter()
                .map(|problem| PairProblem {
                    triangle: problem.triangle.map(scale),
                    start: scale(problem.start),
                    end: scale(problem.end),
                    radius: problem.radius * factor,
                    ..*problem
                })
                .collect();
            let mut pairs = GpuPairs::new(gpu, Pair::TriangleModifiedCylinder).unwrap();
            let (mut small, mut large) = (Vec::new(), Vec::new());
            pairs.solve(&plain, &mut small).unwrap();
            pairs.solve(&scaled, &mut large).unwrap();
            for (small, large) in small.iter().zip(&large) {
                assert_eq!(small.distance * factor, large.distance);
            }
        }
    }
}
