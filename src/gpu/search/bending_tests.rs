use super::bending::{BASE_SIZE, BentRobots, coefficients};
use super::bounds::SearchCap;
use super::kernels::BENDING_THREADS;
use super::robots::Packed;
use crate::gpu::tests::gpu;
use crate::mesh::{Mesh, SearchFrame};
use crate::robot::{BendingSection, ConstantCurvature};
use continuum_testing::Random;
use gpu_batch::Record;
use gpu_batch::wgpu::{BufferUsages, WriteOnly};
use parry3d_f64::math::{Pose, Real, Vector};

type Bent<'a> = BentRobots<'a, Vec<BendingSection>>;

use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Two large triangles around a place, in metres, millimetres or micrometres.
fn mesh(random: &mut Random) -> Mesh {
    let unit = [1.0, 1e-3, 1e3][random.below(3) as usize];
    let centre = random.point() * [0.0, 1.0, 10.0][random.below(3) as usize];
    let corner = |x: Real, y: Real, z: Real| (Vector::new(x, y, z) + centre) * unit;
    let corners = [
        corner(-1.0, -1.0, -1.0),
        corner(1.0, -1.0, 0.0),
        corner(0.0, 1.0, -1.0),
        corner(-1.0, -1.0, 1.0),
        corner(1.0, -1.0, 1.0),
        corner(0.0, 1.0, 1.0),
    ];
    Mesh::of(corners.to_vec(), vec![[0, 1, 2], [3, 4, 5]])
}

/// Sections with angles that break formulas: none, tiny, a quarter turn, a half, a whole.
fn sections(
    random: &mut Random,
    count: usize,
    segments: usize,
    unit: Real,
    radius: Real,
) -> Vec<BendingSection> {
    let most = TAU.min(PI * segments as Real) * (1.0 - 1e-12);
    (0..count)
        .map(|_| {
            let length =
                unit * [1.0, 0.3, 0.1][random.below(3) as usize] * random.between(0.1, 1.0);
            let angle = match random.below(8) {
                0 => 0.0,
                1 => 1e-9,
                2 => FRAC_PI_2,
                3 => most,
                _ => random.between(0.0, most),
            };
            let (sin, cos) = match random.below(4) {
                0 => (0.0, 1.0),
                1 => (-1.0, 0.0),
                _ => random.between(-PI, PI).sin_cos(),
            };
            let curvature = angle / length;
            BendingSection { length, radius, bend: [curvature * cos, curvature * sin] }
        })
        .collect()
}

/// The numbers that the device gets, base first, and the errors of the robots; `None` if one of
/// them is left to the CPU.
fn packed(robots: Bent, frame: &SearchFrame) -> Option<(Vec<f32>, Vec<Real>)> {
    let (mut bytes, mut errors) = (Vec::new(), Vec::new());
    robots.write_base(frame, &mut bytes);
    for robot in 0..robots.len() {
        let first = bytes.len();
        bytes.resize(first + robots.shape_size(1), 0);
        let shape = WriteOnly::from_mut(&mut bytes[first..]);
        errors.push(robots.write_shape(robot, frame, shape).unwrap()?.into());
    }
    let words = bytes.as_chunks::<4>().0.iter();
    Some((words.map(|word| f32::from_ne_bytes(*word)).collect(), errors))
}

/// The points of a robot in double precision.
fn exact(robots: Bent, robot: usize, frame: &SearchFrame) -> Vec<Vector> {
    let sections = ConstantCurvature::new(robots.sections(robot)).unwrap();
    let (points, _) = sections.points(robots.segments);
    points.iter().map(|point| (robots.pose * *point - frame.centre) * frame.scale).collect()
}

/// A product and a sum, as devices may compute them.
fn plus<const FUSED: bool>(a: f32, b: f32, c: f32) -> f32 {
    if FUSED { a.mul_add(b, c) } else { a * b + c }
}

fn cross<const FUSED: bool>(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [(1, 2), (2, 0), (0, 1)].map(|(k, l)| plus::<FUSED>(a[k], b[l], -(a[l] * b[k])))
}

/// bending.wgsl for one point.
fn twin<const FUSED: bool>(numbers: &[f32], robots: Bent, robot: usize, point: usize) -> Vector {
    let [cosines, sincs] = coefficients();
    let horner = |terms: &[f32], t: f32| {
        terms.iter().rev().copied().reduce(|sum, term| plus::<FUSED>(t, sum, term)).unwrap_or(0.0)
    };
    let mut at = [numbers[0], numbers[1], numbers[2]];
    let mut axis = [numbers[3], numbers[4], numbers[5]];
    let (mut w, mut remaining) = (numbers[6], point);
    for section in 0.. {
        if remaining == 0 {
            break;
        }
        let steps = remaining.min(robots.segments);
        remaining -= steps;
        let share = steps as f32 / robots.segments as f32;
        let place = BASE_SIZE as usize + 3 * (robot * robots.each + section);
        let [length, x, y] = [0, 1, 2].map(|k| numbers[place + k] * share);
        let squared = 0.25 * plus::<FUSED>(x, x, y * y);
        let (cosine, sinc) = (horner(&cosines, squared), horner(&sincs, squared));
        let across = 0.5 * length * sinc * sinc;
        let step = [across * x, across * y, length * cosine * sinc];
        let turn = [0.5 * sinc * -y, 0.5 * sinc * x, 0.0];
        let twice = cross::<FUSED>(axis, step).map(|k| 2.0 * k);
        let more = cross::<FUSED>(axis, twice);
        at = [0, 1, 2].map(|k| at[k] + (plus::<FUSED>(w, twice[k], step[k]) + more[k]));
        let over = cross::<FUSED>(axis, turn);
        let next = [0, 1, 2].map(|k| plus::<FUSED>(w, turn[k], cosine * axis[k]) + over[k]);
        let dot =
            plus::<FUSED>(axis[0], turn[0], plus::<FUSED>(axis[1], turn[1], axis[2] * turn[2]));
        w = plus::<FUSED>(w, cosine, -dot);
        axis = next;
    }
    Vector::new(at[0].into(), at[1].into(), at[2].into())
}

/// Calls `check` with random robots of radius 0, whose error is that of their points.
fn for_robots(seed: u64, rounds: u32, mut check: impl FnMut(Bent, &SearchFrame, &[f32], &[Real])) {
    let mut random = Random::new(seed);
    let mut computed = 0;
    for _ in 0..rounds {
        let frame = SearchFrame::new(&mesh(&mut random));
        let (each, segments) =
            (1 + random.below(6) as usize, [1, 2, 7, 30][random.below(4) as usize]);
        let unit = [0.1, 1.0, 3.0][random.below(3) as usize] / frame.scale;
        let mut pose = random.pose(1.0);
        pose.translation = frame.centre + random.point() * unit;
        if random.below(4) == 0 {
            pose.rotation = Pose::IDENTITY.rotation;
        }
        let robots: Vec<_> =
            (0..5).map(|_| sections(&mut random, each, segments, unit, 0.0)).collect();
        let robots = BentRobots::new(&robots, segments, pose);
        if let Some((numbers, errors)) = packed(robots, &frame) {
            computed += 1;
            check(robots, &frame, &numbers, &errors);
        }
    }
    assert!(computed > rounds / 2, "{computed} of {rounds}");
}

#[test]
fn points_err_by_less_than_the_bound() {
    let mut worst = 0.0_f64;
    for_robots(71, 3000, |robots, frame, numbers, errors| {
        for (robot, &error) in errors.iter().enumerate() {
            for (point, exact) in exact(robots, robot, frame).into_iter().enumerate() {
                let found = [
                    twin::<false>(numbers, robots, robot, point),
                    twin::<true>(numbers, robots, robot, point),
                ];
                for found in found {
                    let off = (found - exact).length();
                    assert!(off <= error, "{off} {error}: {:?}", robots.sections(robot));
                    worst = worst.max(off / error);
                }
            }
        }
    });
    println!("at most {worst} of the bound");
    // A bound that is far too large would be right and useless.
    assert!(worst > 0.03, "{worst}");
}

#[test]
fn points_of_the_device_err_by_less_than_the_bound() {
    let Some(gpu) = gpu() else { return };
    let (device, kernels) = (&gpu.0.device, gpu.0.search().unwrap());
    let mut points = 0;
    for_robots(73, 100, |robots, frame, numbers, errors| {
        let of_robot = robots.each * robots.segments + 1;
        let query = robots.bending(robots.len()).unwrap();
        let mut record = Vec::new();
        query.write(device.precision(), &mut record);
        let bytes: Vec<_> = numbers.iter().flat_map(|number| number.to_ne_bytes()).collect();
        let size = (12 * of_robot * robots.len()) as u64;
        let uniform = BufferUsages::UNIFORM | BufferUsages::COPY_DST;
        let up = BufferUsages::STORAGE | BufferUsages::COPY_DST;
        let query_buffer = device.buffer(record.len() as u64, uniform);
        let shapes = device.buffer(bytes.len() as u64, up);
        let found = device.buffer(size, up | BufferUsages::COPY_SRC);
        let readback = device.buffer(size, BufferUsages::MAP_READ | BufferUsages::COPY_DST);
        device.queue().write_buffer(&query_buffer, 0, &record);
        device.queue().write_buffer(&shapes, 0, &bytes);
        let group = device.group(
            &kernels.bending_layout,
            &[
                device.uniform_binding::<super::robots::BendingQuery>(&query_buffer),
                shapes.as_entire_binding(),
                found.as_entire_binding(),
            ],
        );
        let mut encoder = device.raw().create_command_encoder(&Default::default());
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&kernels.bend);
        pass.set_bind_group(0, &group, &[0]);
        device.dispatch(&mut pass, ((of_robot * robots.len()) as u32).div_ceil(BENDING_THREADS));
        drop(pass);
        encoder.copy_buffer_to_buffer(&found, 0, &readback, 0, Some(size));
        let mut numbers = Vec::new();
        let read = |bytes: &[u8]| {
            let words = bytes.as_chunks::<4>().0.iter();
            numbers.extend(words.map(|word| Real::from(f32::from_ne_bytes(*word))));
            Ok(())
        };
        device.run_and_read(&mut device.watch(), encoder.finish(), &readback, size, read).unwrap();
        for (robot, &error) in errors.iter().enumerate() {
            let first = 3 * robot * of_robot;
            for (point, exact) in exact(robots, robot, frame).into_iter().enumerate() {
                let found = &numbers[first + 3 * point..][..3];
                let off = (Vector::new(found[0], found[1], found[2]) - exact).length();
                assert!(off <= error, "{off} {error}: {:?}", robots.sections(robot));
                points += 1;
            }
        }
    });
    assert!(points > 5000, "{points}");
}

/// Caps that are stated as flat are flat in the chain that Algorithm 1 builds.
#[test]
fn caps_that_are_certain_are_those_of_the_chain() {
    let mut random = Random::new(79);
    let (mut flat, mut either_flat, mut either_round) = (0, 0, 0);
    for _ in 0..3000 {
        let (each, segments) = (1 + random.below(5) as usize, 1 + random.below(6) as usize);
        let mut all = sections(&mut random, each, segments, 1.0, 0.0);
        let radii = [0.1, 0.1 * (1.0 + 1e-12), 0.1 * (1.0 + 1e-5), 0.05, 0.3];
        for section in &mut all {
            section.radius = radii[random.below(5) as usize];
        }
        let robots = BentRobots::new(std::slice::from_ref(&all), segments, Pose::IDENTITY);
        let chain = robots.chain(0).unwrap();
        assert_eq!(chain.links().len(), each * segments);
        for (number, link) in chain.links().iter().enumerate() {
            for (cap, is_flat) in robots.caps(&all, number).into_iter().zip(link.flat()) {
                match cap {
                    SearchCap::Round => panic!("{number}"),
                    SearchCap::Flat => {
                        assert!(is_flat, "{number}: {all:?}");
                        flat += 1;
                    }
                    SearchCap::Either if is_flat => either_flat += 1,
                    SearchCap::Either => either_round += 1,
                }
            }
        }
    }
    assert!(
        flat > 6000 && either_flat > 100 && either_round > 1000,
        "{flat} {either_flat} {either_round}"
    );
}
