//! The engine on the GPU beside those on the CPU, one robot at a time and many.

use crate::meshes::LINKS;
use crate::timed::{Job, medians, milliseconds};
use crate::{Opened, text};
use continuum_scene::ventricle;
use parry_continuum::Chain;
use parry_continuum::gpu::GpuExhaustive;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{BvhSearch, Exhaustive, Proximity};
use std::fmt::Write;
use std::time::Duration;

/// Robots of a batch.
const BATCH: usize = 256;

/// The chapter of the page.
pub fn chapter(
    opened: &[Opened],
    meshes: &[TriMesh],
    robot: &Chain,
    enough: Duration,
) -> Result<String, String> {
    let [mut one, mut many] = [String::new(), String::new()];
    let mut head = String::new();
    for opened in opened {
        write!(head, " GPU {} |", opened.name).map_err(text)?;
    }
    let line = "---|".repeat(opened.len());
    for mesh in meshes {
        one.push_str(&one_robot(opened, mesh, robot, enough)?);
        many.push_str(&batch(opened, mesh, robot, enough)?);
    }
    Ok(format!(
        "## Beside the engines on the CPU\n\n\
         Milliseconds for the closest points of all {LINKS} links (fitted caps), with transfers. The search is asked for the \
         first time, then again.\n\n\
         | triangles | search, first time | search, again | exhaustive f32, CPU |{head}\n|---|---|---|---|{line}\n{one}\n\
         A batch of {BATCH} robots: milliseconds for each of them.\n\n\
         | triangles | search |{head}\n|---|---|{line}\n{many}"
    ))
}

fn one_robot(opened: &[Opened], mesh: &TriMesh, robot: &Chain, enough: Duration) -> Result<String, String> {
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
    for opened in opened {
        engines.push(Box::new(GpuExhaustive::on(&opened.gpu, mesh).map_err(text)?));
    }
    let mut others: Vec<_> = engines
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
    jobs.extend(others.iter_mut().map(|job| job as Job));
    row(mesh, &mut jobs, enough, 1)
}

fn batch(opened: &[Opened], mesh: &TriMesh, robot: &Chain, enough: Duration) -> Result<String, String> {
    let samples = samples(robot);
    let mut engines: Vec<Box<dyn Proximity>> = vec![Box::new(BvhSearch::new(mesh).map_err(text)?)];
    for opened in opened {
        engines.push(Box::new(GpuExhaustive::on(&opened.gpu, mesh).map_err(text)?));
    }
    let mut jobs: Vec<_> = engines
        .iter_mut()
        .map(|engine| {
            let (mut out, samples) = (Vec::new(), &samples);
            move || {
                engine.per_link_batch(samples, &mut out).map_err(text)?;
                Ok(None)
            }
        })
        .collect();
    let mut jobs: Vec<Job> = jobs.iter_mut().map(|job| job as Job).collect();
    row(mesh, &mut jobs, enough, BATCH)
}

/// The robot in poses around its own, as a planner would try them.
fn samples(robot: &Chain) -> Vec<(&Chain, Pose)> {
    let base = ventricle::entry();
    (0..BATCH)
        .map(|sample| {
            let angle = sample as f64 * 0.1;
            let turn = Pose::rotation(Vector::new(angle.sin(), angle.cos(), (3.0 * angle).sin()) * 0.02);
            (robot, base * turn)
        })
        .collect()
}

/// What each of the jobs takes for a robot, in turns.
fn row(mesh: &TriMesh, jobs: &mut [Job], enough: Duration, robots: usize) -> Result<String, String> {
    let mut row = format!("| {} |", mesh.num_triangles());
    for timed in medians(jobs, enough)? {
        write!(row, " {} |", milliseconds(Some(timed.whole / robots as u32))).map_err(text)?;
    }
    Ok(row + "\n")
}
