//! The search on the GPU beside the search on the CPU: batches of robots of 30 links with fitted
//! caps, and the work of the kernels.

use crate::timed::{Job, medians};
use crate::{Opened, text};
use continuum_demo::steer::Random;
use continuum_demo::{ctr, ventricle};
use continuum_studies::models::LINKS;
use parry_continuum::Chain;
use parry_continuum::gpu::GpuSearch;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{BvhSearch, LinkProximity, Proximity, ProximityError};
use std::fmt::Write;
use std::time::Duration;

/// Shapes of robots. A larger batch repeats them in other poses.
const SHAPES: usize = 4096;

/// The margin of `clears_batch`.
const MARGIN: f64 = 0.5;

/// The nodes a link that a prototype visited: a binary tree of boxes, 82,000 triangles, capsules.
const PROTOTYPE: [&str; 3] = ["7", "40", "153"];

const QUESTIONS: [&str; 3] = ["`clears_batch`", "`minimum_batch`", "`per_link_batch`"];

/// The chapter of the page.
pub fn chapter(
    opened: &Opened,
    meshes: &[TriMesh],
    most_robots: usize,
    enough: Duration,
) -> Result<String, String> {
    let (tubes, mut random) = (ctr::three_tubes(), Random(11));
    let shapes = (0..SHAPES.min(most_robots))
        .map(|_| {
            let line = tubes.centreline(&tubes.any_joints(&mut random), LINKS);
            Chain::from_centreline(&line.points, &line.radii).map_err(text)
        })
        .collect::<Result<Vec<_>, _>>()?;
    let robots: Vec<_> = (0..most_robots)
        .map(|robot| {
            let angle = robot as f64 * 0.1;
            let turn =
                Pose::rotation(Vector::new(angle.sin(), angle.cos(), (3.0 * angle).sin()) * 0.02);
            (&shapes[robot % shapes.len()], ventricle::entry() * turn)
        })
        .collect();
    let (mut times, mut work) = (String::new(), String::new());
    for mesh in meshes {
        let triangles = mesh.num_triangles();
        let mut cpu = BvhSearch::new(mesh).map_err(text)?;
        cpu.prepare();
        let mut gpu = GpuSearch::on(&opened.gpu, mesh).map_err(text)?;
        gpu.set_min_links(Some(0));
        for count in batches(most_robots) {
            for (question, name) in QUESTIONS.iter().enumerate() {
                let row = row(&mut cpu, &mut gpu, &robots[..count], question, enough)?;
                writeln!(times, "| {triangles} | {name} | {count} |{row}").map_err(text)?;
            }
        }
        let left = gpu.answered_on_cpu();
        gpu.count_work().map_err(text)?;
        let some = &robots[..robots.len().min(1000)];
        for (question, name) in QUESTIONS.iter().enumerate() {
            ask(&mut gpu, some, question, &mut Answers::default())?;
            let [nodes, leaves, links] = gpu.work().map(|count| count as f64);
            writeln!(
                work,
                "| {triangles} | {name} | {:.1} | {:.1} | {} | {left} |",
                nodes / links.max(1.0),
                leaves / links.max(1.0),
                PROTOTYPE[question],
            )
            .map_err(text)?;
        }
    }
    Ok(format!(
        "## Search in batches\n\n\
         Microseconds a robot of {LINKS} links (fitted caps), for the search on the CPU and the search on the GPU, with \
         transfers and measuring. Device: the kernels alone. `clears_batch` is about a margin of {MARGIN} mm.\n\n\
         | triangles | question | robots | search, CPU | search, GPU | device | ratio |\n|---|---|---|---|---|---|---|\n{times}\n\
         Nodes and leaves that the device visits for a link, beside the nodes of a prototype on capsules and 82,000 \
         triangles; and the robots of all batches above that were left to the CPU.\n\n\
         | triangles | question | nodes | leaves | prototype | left |\n|---|---|---|---|---|---|\n{work}"
    ))
}

fn batches(most: usize) -> impl Iterator<Item = usize> {
    let smaller = [100, 1000, 10_000, 100_000].into_iter().filter(move |&count| count < most);
    smaller.chain([most])
}

type Batch<T> = Vec<Result<T, ProximityError>>;

#[derive(Default)]
struct Answers {
    clear: Batch<bool>,
    minima: Batch<LinkProximity>,
    links: Batch<Vec<LinkProximity>>,
}

fn ask(
    engine: &mut dyn Proximity,
    robots: &[(&Chain, Pose)],
    question: usize,
    answers: &mut Answers,
) -> Result<(), String> {
    match question {
        0 => engine.clears_batch(robots, MARGIN, &mut answers.clear),
        1 => engine.minimum_batch(robots, &mut answers.minima),
        _ => engine.per_link_batch(robots, &mut answers.links),
    }
    .map_err(text)
}

fn row(
    cpu: &mut BvhSearch,
    gpu: &mut GpuSearch,
    robots: &[(&Chain, Pose)],
    question: usize,
    enough: Duration,
) -> Result<String, String> {
    let [mut on_cpu, mut on_gpu] = [Answers::default(), Answers::default()];
    let mut jobs: [Job; 2] =
        [&mut || ask(cpu, robots, question, &mut on_cpu).map(|()| None), &mut || {
            ask(gpu, robots, question, &mut on_gpu)?;
            Ok(gpu.device_time())
        }];
    let timed = medians(&mut jobs, enough)?;
    if on_cpu.clear != on_gpu.clear
        || on_cpu.minima != on_gpu.minima
        || on_cpu.links != on_gpu.links
    {
        return Err(format!("{} differs on the GPU", QUESTIONS[question]));
    }
    let each = |time: Duration| time.as_secs_f64() * 1e6 / robots.len() as f64;
    let device = timed[1].device.map_or("-".into(), |time| format!("{:.4}", each(time)));
    let [cpu, gpu] = [each(timed[0].whole), each(timed[1].whole)];
    Ok(format!(" {cpu:.3} | {gpu:.3} | {device} | {:.2} |", cpu / gpu))
}
