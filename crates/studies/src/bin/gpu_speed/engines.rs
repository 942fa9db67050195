//! The engine on the GPU beside those on the CPU, one robot at a time and many.

use crate::meshes::on_gpus;
use crate::timed::{Job, medians, milliseconds};
use crate::{Opened, text};
use continuum_demo::ventricle;
use continuum_studies::models::LINKS;
use parry_continuum::Chain;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{BvhSearch, Exhaustive, Proximity};
use std::time::Duration;

/// Robots of a batch, on a GPU and on one in software.
const BATCH: [u32; 2] = [256, 16];

/// The chapter of the page.
pub fn chapter(
    opened: &[Opened],
    meshes: &[TriMesh],
    robot: &Chain,
    enough: Duration,
) -> Result<String, String> {
    let [mut one, mut many] = [String::new(), String::new()];
    let head: String = opened.iter().map(|opened| format!(" GPU {} |", opened.name)).collect();
    let head_without_pause: String =
        opened.iter().map(|opened| format!(" GPU {}, no pause |", opened.name)).collect();
    let line = "---|".repeat(opened.len());
    let is_software = opened.iter().any(|opened| opened.gpu.adapter().is_software);
    let robots = BATCH[usize::from(is_software)];
    for mesh in meshes {
        one.push_str(&one_robot(opened, mesh, robot, enough)?);
        many.push_str(&batch(opened, mesh, &samples(robot, robots), enough)?);
    }
    Ok(format!(
        "## Beside the engines on the CPU\n\n\
         Milliseconds for the closest points of all {LINKS} links (fitted caps), with transfers. The search is asked for the \
         first time, then again. All engines take turns, so that the GPU rests between two queries; then it is asked \
         without a pause.\n\n\
         | triangles | search, first time | search, again | exhaustive f32, CPU |{head}{head_without_pause}\n\
         |---|---|---|---|{line}{line}\n{one}\n\
         A batch of {robots} robots: milliseconds for each of them.\n\n\
         | triangles | search |{head}\n|---|---|{line}\n{many}"
    ))
}

fn one_robot(
    opened: &[Opened],
    mesh: &TriMesh,
    robot: &Chain,
    enough: Duration,
) -> Result<String, String> {
    let base = ventricle::entry();
    let mut first = BvhSearch::new(mesh).map_err(text)?;
    let mut out = Vec::new();
    let mut first_time = || {
        first.forget();
        first.per_link(robot, &base, &mut out).map_err(text)?;
        Ok(None)
    };
    let mut engines: Vec<Box<dyn Proximity>> = vec![
        Box::new(BvhSearch::new(mesh).map_err(text)?),
        Box::new(Exhaustive::<f32>::new(mesh).map_err(text)?),
    ];
    engines.extend(on_gpus(opened, mesh)?);
    let mut again: Vec<_> = engines
        .iter_mut()
        .map(|engine| {
            let mut out = Vec::new();
            move || {
                engine.per_link(robot, &base, &mut out).map_err(text)?;
                Ok(None)
            }
        })
        .collect();
    let mut jobs: Vec<Job> = vec![&mut first_time];
    jobs.extend(again.iter_mut().map(|job| job as Job));
    let mut row = times(&mut jobs, enough, 1)?;
    for on_gpu in &mut again[2..] {
        row.push_str(&times(&mut [on_gpu], enough, 1)?);
    }
    Ok(format!("| {} |{row}\n", mesh.num_triangles()))
}

fn batch(
    opened: &[Opened],
    mesh: &TriMesh,
    samples: &[(&Chain, Pose)],
    enough: Duration,
) -> Result<String, String> {
    let mut engines: Vec<Box<dyn Proximity>> = vec![Box::new(BvhSearch::new(mesh).map_err(text)?)];
    engines.extend(on_gpus(opened, mesh)?);
    let mut jobs: Vec<_> = engines
        .iter_mut()
        .map(|engine| {
            let mut out = Vec::new();
            move || {
                engine.per_link_batch(samples, &mut out).map_err(text)?;
                Ok(None)
            }
        })
        .collect();
    let mut jobs: Vec<Job> = jobs.iter_mut().map(|job| job as Job).collect();
    Ok(format!("| {} |{}\n", mesh.num_triangles(), times(&mut jobs, enough, samples.len() as u32)?))
}

/// The robot in poses around its own, as a planner would try them.
fn samples(robot: &Chain, count: u32) -> Vec<(&Chain, Pose)> {
    let base = ventricle::entry();
    (0..count)
        .map(|sample| {
            let angle = f64::from(sample) * 0.1;
            let turn =
                Pose::rotation(Vector::new(angle.sin(), angle.cos(), (3.0 * angle).sin()) * 0.02);
            (robot, base * turn)
        })
        .collect()
}

/// What each of the jobs takes for a robot, in turns.
fn times(jobs: &mut [Job], enough: Duration, robots: u32) -> Result<String, String> {
    let times = medians(jobs, enough)?;
    Ok(times
        .iter()
        .map(|timed| format!(" {} |", milliseconds(Some(timed.whole / robots))))
        .collect())
}
