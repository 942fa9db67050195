//! The search on the GPU beside the search on the CPU and the exhaustive engine on the GPU: batches
//! of random robots in a vessel, and the work of the kernels.

use crate::timed::{Job, medians};
use crate::{Opened, text};
use continuum_demo::lumen;
use continuum_demo::steer::Random;
use continuum_studies::models::LINKS;
use parry_continuum::gpu::{GpuExhaustive, GpuSearch};
use parry_continuum::parry::math::{Pose, Rot3, Vector};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{BvhSearch, LinkProximity, Proximity, ProximityError};
use parry_continuum::{Chain, RobotError};
use std::f64::consts::TAU;
use std::fmt::Write;
use std::time::Duration;

/// Triangles around the vessels: meshes of 5, 82 and 328 thousand, 1 and 10 million triangles.
const AROUND: [u32; 5] = [32, 128, 256, 447, 1414];
/// The vessel of the largest batch.
const MAIN: u32 = 128;
/// Robots of the largest batch on the other vessels.
const MOST_ELSEWHERE: usize = 100_000;
/// Robots of the largest batch of the exhaustive engine, on a GPU and on one in software.
const MOST_EXHAUSTIVE: [usize; 2] = [1000, 20];
/// Robots whose work is counted.
const COUNTED: usize = 1000;
/// Shapes of robots. A larger batch repeats them in other poses.
const SHAPES: usize = 4096;
/// The margin of `clears_batch`.
const MARGIN: f64 = 0.0;

/// The nodes that a prototype visits for a link of such robots (capsules), by the triangles around
/// the vessel and the question: the same tree, 32 threads in step, and a bound that no rounding
/// widens.
const PROTOTYPE: [(u32, [&str; 3]); 4] = [
    (32, ["2.8", "28.3", "77.4"]),
    (128, ["2.9", "50.8", "268.6"]),
    (256, ["3.0", "76.6", "570.6"]),
    (447, ["3.0", "122.0", "1135.8"]),
];

const QUESTIONS: [&str; 3] = ["`clears_batch`", "`minimum_batch`", "`per_link_batch`"];

/// Builds a robot of a model.
type Build = fn(&[Vector], &[f64]) -> Result<Chain, RobotError>;

/// The chapter of the page. Adds to `defects` which answers differ.
pub fn chapter(
    opened: &Opened,
    largest: u32,
    most_robots: usize,
    enough: Duration,
    defects: &mut Vec<String>,
) -> Result<String, String> {
    let (mut times, mut work) = (String::new(), String::new());
    for around in vessels(largest) {
        let mesh = lumen::mesh(around);
        let triangles = mesh.num_triangles();
        let mut engines = Engines::new(opened, &mesh)?;
        let largest_batch = most_robots_of(around, most_robots);
        let (shapes, poses) = (shapes(&mesh, Chain::from_centreline)?, poses(&mesh, most_robots));
        let robots = robots(&shapes, &poses);
        for count in batches(largest_batch) {
            for (question, name) in QUESTIONS.iter().enumerate() {
                let (row, is_same) = engines.row(&robots[..count], question, enough)?;
                writeln!(times, "| {triangles} | {name} | {count} |{row}").map_err(text)?;
                if !is_same {
                    defects.push(format!("{name} of {count} robots, {triangles} triangles"));
                }
            }
        }
        engines.gpu.count_work().map_err(text)?;
        let capsules = self::shapes(&mesh, Chain::capsules)?;
        for (model, shapes) in [("capsules", &capsules), ("fitted caps", &shapes)] {
            let robots = self::robots(shapes, &poses[..poses.len().min(COUNTED)]);
            for (question, name) in QUESTIONS.iter().enumerate() {
                let [nodes, leaves, left] = engines.work(&robots, question)?;
                let row = PROTOTYPE.iter().find(|row| row.0 == around && model == "capsules");
                let prototype = row.map_or("-", |row| row.1[question]);
                writeln!(
                    work,
                    "| {triangles} | {model} | {name} | {nodes:.1} | {leaves:.1} | {prototype} | {left} |"
                )
                .map_err(text)?;
            }
        }
    }
    Ok(format!(
        "## Search in batches\n\n\
         Microseconds for each robot of {LINKS} links (fitted caps) of random shape and place in a vessel, with transfers and \
         measuring: the search on the CPU, the search on the GPU, and the exhaustive engine on the GPU. Device: the kernels of \
         the search alone. `clears_batch` is about a margin of {MARGIN} mm.\n\n\
         | triangles | question | robots | search, CPU | search, GPU | device | exhaustive, GPU | CPU / GPU | CPU / device |\n\
         |---|---|---|---|---|---|---|---|---|\n{times}\n\
         Nodes and leaves that the device visits for a link, beside the nodes of a prototype; and the robots that were left to \
         the CPU, of {}.\n\n\
         | triangles | model | question | nodes | leaves | prototype | left |\n|---|---|---|---|---|---|---|\n{work}",
        most_robots.min(COUNTED)
    ))
}

/// Robots of the largest batch on a vessel.
pub fn most_robots_of(around: u32, most_robots: usize) -> usize {
    if around == MAIN { most_robots } else { most_robots.min(MOST_ELSEWHERE) }
}

/// The vessels of at most `largest` triangles, at least one.
pub fn vessels(largest: u32) -> Vec<u32> {
    let fit: Vec<_> = AROUND.into_iter().filter(|around| 5 * around * around <= largest).collect();
    if fit.is_empty() { vec![(largest / 5).isqrt()] } else { fit }
}

pub fn batches(most: usize) -> impl Iterator<Item = usize> {
    let smaller = [100, 1000, 10_000, 100_000].into_iter().filter(move |&count| count < most);
    smaller.chain([most])
}

/// Robots that bend in a plane, with radii and lengths in proportion to the mesh. The base is at
/// the origin and points along z.
fn shapes(mesh: &TriMesh, build: Build) -> Result<Vec<Chain>, String> {
    let reach = mesh.local_aabb().half_extents().max_element();
    let radii: Vec<_> = (0..LINKS).map(|link| reach * [0.012, 0.009, 0.005][link / 10]).collect();
    let mut random = Random(11);
    let shape = |_| {
        let bend = Rot3::from_scaled_axis(Vector::X * (0.1 * random.share()));
        let step = reach * (0.1 + 0.4 * random.share()) / LINKS as f64;
        let (mut points, mut heading) = (vec![Vector::ZERO], Vector::Z);
        for link in 0..LINKS {
            heading = bend * heading;
            points.push(points[link] + heading * step);
        }
        build(&points, &radii).map_err(text)
    };
    (0..SHAPES).map(shape).collect()
}

/// Poses of any direction, with places in the middle of the mesh's box.
fn poses(mesh: &TriMesh, count: usize) -> Vec<Pose> {
    let bounds = mesh.local_aabb();
    let (centre, half) = (bounds.center(), bounds.half_extents());
    let mut random = Random(13);
    let mut between = || 2.0 * random.share() - 1.0;
    (0..count)
        .map(|_| {
            let place = centre + half * Vector::new(between(), between(), between()) * 0.5;
            let (z, angle) = (between(), between() * 0.5 * TAU);
            let across = (1.0 - z * z).sqrt();
            let direction = Vector::new(across * angle.cos(), across * angle.sin(), z);
            let turn = Rot3::from_scaled_axis(Vector::Z * (between() * 0.5 * TAU));
            Pose::from_parts(place, Rot3::from_rotation_arc(Vector::Z, direction) * turn)
        })
        .collect()
}

fn robots<'a>(shapes: &'a [Chain], poses: &[Pose]) -> Vec<(&'a Chain, Pose)> {
    shapes.iter().cycle().zip(poses).map(|(shape, pose)| (shape, *pose)).collect()
}

type Batch<T> = Vec<Result<T, ProximityError>>;

#[derive(Default, PartialEq)]
struct Answers {
    clear: Batch<bool>,
    minima: Batch<LinkProximity>,
    links: Batch<Vec<LinkProximity>>,
}

impl Answers {
    fn ask(
        &mut self,
        engine: &mut dyn Proximity,
        robots: &[(&Chain, Pose)],
        question: usize,
    ) -> Result<(), String> {
        match question {
            0 => engine.clears_batch(robots, MARGIN, &mut self.clear),
            1 => engine.minimum_batch(robots, &mut self.minima),
            _ => engine.per_link_batch(robots, &mut self.links),
        }
        .map_err(text)
    }
}

struct Engines {
    cpu: BvhSearch,
    gpu: GpuSearch,
    exhaustive: GpuExhaustive,
    most_exhaustive: usize,
}

impl Engines {
    fn new(opened: &Opened, mesh: &TriMesh) -> Result<Self, String> {
        let cpu = BvhSearch::new(mesh).map_err(text)?;
        cpu.prepare();
        let mut gpu = GpuSearch::on(&opened.gpu, mesh).map_err(text)?;
        gpu.set_min_links(Some(0));
        let exhaustive = GpuExhaustive::on(&opened.gpu, mesh).map_err(text)?;
        let [real, in_software] = MOST_EXHAUSTIVE;
        let most_exhaustive = if gpu.adapter().is_software { in_software } else { real };
        Ok(Self { cpu, gpu, exhaustive, most_exhaustive })
    }

    /// The times of a batch, and whether both searches have the same answers.
    fn row(
        &mut self,
        robots: &[(&Chain, Pose)],
        question: usize,
        enough: Duration,
    ) -> Result<(String, bool), String> {
        let Self { cpu, gpu, exhaustive, most_exhaustive } = self;
        let [mut on_cpu, mut on_gpu, mut of_all] = [(); 3].map(|()| Answers::default());
        let mut ask_cpu = || on_cpu.ask(cpu, robots, question).map(|()| None);
        let mut ask_gpu = || {
            on_gpu.ask(gpu, robots, question)?;
            Ok(gpu.device_time())
        };
        let mut ask_exhaustive = || of_all.ask(exhaustive, robots, question).map(|()| None);
        let mut jobs: Vec<Job> = vec![&mut ask_cpu, &mut ask_gpu];
        if robots.len() <= *most_exhaustive {
            jobs.push(&mut ask_exhaustive);
        }
        let timed = medians(&mut jobs, enough)?;
        let each = |time: Duration| time.as_secs_f64() * 1e6 / robots.len() as f64;
        let [cpu, gpu] = [each(timed[0].whole), each(timed[1].whole)];
        let device = timed[1].device.map(each);
        let number = |value: Option<f64>, digits| {
            value.map_or("-".into(), |value: f64| format!("{value:.digits$}"))
        };
        let exhaustive = number(timed.get(2).map(|timed| each(timed.whole)), 3);
        let [device, ratio] = [number(device, 4), number(device.map(|device| cpu / device), 2)];
        let row = format!(
            " {cpu:.3} | {gpu:.3} | {device} | {exhaustive} | {:.2} | {ratio} |",
            cpu / gpu
        );
        Ok((row, on_cpu == on_gpu))
    }

    /// Nodes and leaves that the device visits for a link, and the robots left to the CPU.
    fn work(&mut self, robots: &[(&Chain, Pose)], question: usize) -> Result<[f64; 3], String> {
        let gpu = &mut self.gpu;
        let before = gpu.answered_on_cpu();
        Answers::default().ask(gpu, robots, question)?;
        let [nodes, leaves, links] = gpu.work().map(|count| count as f64);
        let left = (gpu.answered_on_cpu() - before) as f64;
        Ok([nodes / links.max(1.0), leaves / links.max(1.0), left])
    }
}
