//! Moving anatomy: a ventricle whose every vertex moves in each frame, on the GPU and on the CPU.

use crate::meshes::on_gpus;
use crate::timed::{Job, medians, milliseconds};
use crate::{Opened, text};
use continuum_demo::ventricle;
use continuum_studies::models::LINKS;
use parry_continuum::Chain;
use parry_continuum::gpu::GpuSearch;
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{BvhSearch, Exhaustive, LinkProximity, Proximity};
use std::fmt::Write;
use std::time::Duration;

/// The chapter of the page.
pub fn chapter(
    opened: &[Opened],
    meshes: &[TriMesh],
    robot: &Chain,
    enough: Duration,
) -> Result<String, String> {
    let mut page = format!(
        "## Moving anatomy\n\n\
         Every vertex moves, then comes one query for the closest points of all {LINKS} links (fitted caps): milliseconds of \
         the frame. Both searches refit their hierarchies.\n\n\
         | triangles | search | exhaustive f32, CPU |"
    );
    for opened in opened {
        write!(page, " GPU {} |", opened.name).map_err(text)?;
    }
    writeln!(page, " search, GPU |\n|---|---|---|{}", "---|".repeat(opened.len() + 1))
        .map_err(text)?;
    for mesh in meshes {
        page.push_str(&row(opened, mesh, robot, enough)?);
    }
    Ok(page)
}

/// An engine whose mesh moves.
struct Moving<'a> {
    engine: Box<dyn Proximity + 'a>,
    frames: usize,
    out: Vec<LinkProximity>,
}

fn row(
    opened: &[Opened],
    mesh: &TriMesh,
    robot: &Chain,
    enough: Duration,
) -> Result<String, String> {
    let beats = ventricle::beat(mesh.vertices());
    let base = ventricle::entry();
    let mut engines: Vec<Box<dyn Proximity>> = vec![
        Box::new(BvhSearch::new(mesh).map_err(text)?),
        Box::new(Exhaustive::<f32>::new(mesh).map_err(text)?),
    ];
    engines.extend(on_gpus(opened, mesh)?);
    let mut search = GpuSearch::on(&opened[0].gpu, mesh).map_err(text)?;
    search.set_min_links(Some(0));
    engines.push(Box::new(search));
    let frame = |moving: &mut Moving| {
        moving.frames += 1;
        moving.engine.set_vertices(&beats[moving.frames % 2]).map_err(text)?;
        moving.engine.per_link(robot, &base, &mut moving.out).map_err(text)?;
        Ok(None)
    };
    let mut moving: Vec<_> =
        engines.into_iter().map(|engine| Moving { engine, frames: 0, out: Vec::new() }).collect();
    let mut jobs: Vec<_> = moving.iter_mut().map(|moving| || frame(moving)).collect();
    let mut jobs: Vec<Job> = jobs.iter_mut().map(|job| job as Job).collect();
    let mut row = format!("| {} |", mesh.num_triangles());
    for timed in medians(&mut jobs, enough)? {
        write!(row, " {} |", milliseconds(Some(timed.whole))).map_err(text)?;
    }
    Ok(row + "\n")
}
