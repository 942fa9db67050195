//! A robot of 30 links in the ventricle: Figure 9 and Table IV, latency, batches, moving anatomy.

use crate::timed::{Job, Timed, medians, milliseconds};
use crate::{Opened, text};
use continuum_scene::subdivide::{in_four, shuffled};
use continuum_scene::{ctr, ventricle};
use continuum_studies::gpu::Discs;
use parry_continuum::Chain;
use parry_continuum::gpu::GpuExhaustive;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{BvhSearch, Exhaustive, LinkProximity, Proximity};
use std::fmt::Write;
use std::time::Duration;

const LINKS: usize = 30;
/// Robots of a batch.
const BATCH: usize = 256;

/// As capsules (K), by Algorithm 1 (Z*) and as cylinders (Z).
fn models() -> Result<[(&'static str, Chain); 3], String> {
    let line = ctr::three_tubes().centreline(&ventricle::goal(), LINKS);
    let (points, radii) = (&line.points, &line.radii);
    Ok([
        ("K", Chain::capsules(points, radii).map_err(text)?),
        ("Z*", Chain::from_centreline(points, radii).map_err(text)?),
        ("Z", Chain::cylinders(points, radii).map_err(text)?),
    ])
}

/// The meshes, 1e4 triangles and more, and the largest: the ventricle divided in four until it has enough, shuffled,
/// and of that the first so many.
fn sizes(largest: u32) -> Vec<u32> {
    let mut sizes: Vec<_> =
        [10_000, 100_000, 1_000_000, 10_000_000].into_iter().filter(|&size| size < largest).collect();
    sizes.push(largest);
    sizes
}

fn mesh(triangles: u32) -> Result<TriMesh, String> {
    let mut divided = ventricle::mesh(ventricle::DEFAULT_TRIANGLES);
    while divided.1.len() < triangles as usize {
        divided = in_four(divided);
    }
    let (vertices, mut indices) = shuffled(divided, 1);
    indices.truncate(triangles as usize);
    TriMesh::new(vertices, indices).map_err(text)
}

/// What is measured on one mesh.
#[derive(Default)]
struct Pages {
    culling: String,
    every_pair: String,
    engines: String,
    moving: String,
    notes: String,
}

/// The chapter of the page.
pub fn chapter(
    opened: &[Opened],
    largest: u32,
    most_every_pair: u32,
    enough: Duration,
) -> Result<String, String> {
    let models = models()?;
    let mut pages = Pages::default();
    for size in sizes(largest) {
        let mesh = mesh(size)?;
        let exact = answers(&mut BvhSearch::new(&mesh).map_err(text)?, &models)?;
        for opened in opened {
            let name = format!("{size} | {}", opened.name);
            let mut engine = GpuExhaustive::on(&opened.gpu, &mesh).map_err(text)?;
            let apart = disagreement(&answers(&mut engine, &models)?, &exact);
            let timed = all_models(&mut engine, &models, enough)?;
            pages.culling.push_str(&row(&name, size, opened.tflops, &timed)?);
            writeln!(
                pages.notes,
                "- {size} triangles, {}: the distances differ from the search's by at most {apart:.0e} mm, and {} links \
                 needed the CPU.",
                opened.name,
                engine.answered_on_cpu()
            )
            .map_err(text)?;
            if size <= most_every_pair {
                for (discs, route) in [
                    (Discs::Convex, "convex"),
                    (Discs::ClosedForm, "quartic, closed form"),
                    (Discs::Companion, "quartic, companion"),
                ] {
                    engine.compute_every_pair(&discs.route(opened.gpu.precision())).map_err(text)?;
                    let timed = all_models(&mut engine, &models, enough)?;
                    let name = format!("{name} | {route}");
                    pages.every_pair.push_str(&row(&name, size, opened.tflops, &timed)?);
                }
                engine.set_culling(true).map_err(text)?;
            }
            pages.moving.push_str(&moving(&name, &mut engine, &models[1].1, &mesh, enough)?);
        }
        pages.engines.push_str(&engines(opened, &mesh, &models[1].1, enough)?);
    }
    Ok(page(&pages))
}

fn page(pages: &Pages) -> String {
    let table = |head: &str| {
        format!(
            "| {head} | K device ms | end to end | index | Z* device | end to end | index | Z device | end to end | index | \
             Z* / K | Z / K | pairs/s (K) |\n|{}\n",
            "---|".repeat(head.split('|').count() + 12)
        )
    };
    let Pages { culling, every_pair, engines, moving, notes } = pages;
    format!(
        "## Figure 9 and Table IV: {LINKS} links against a mesh\n\n\
         The ventricle divided in four, its triangles shuffled. Index: 1 / (seconds x TFLOPS) by the device's time, for \
         the peak that the command gives; the paper's for 1e6 triangles is 11.93 (f32) and 10.32 (f64) for K and Z*, 0.69 \
         and 1.16 for Z. Ratios are of device times.\n\n\
         With culling, every triangle visited:\n\n{}{culling}\n\
         Without, every pair in full, as in the paper, by three routes to the disc of a flat cap:\n\n{}{every_pair}\n\
         Checks:\n\n{notes}\n\
         ## Beside the engines on the CPU\n\n\
         Milliseconds for the closest points of all {LINKS} links (Z*), end to end; and for each robot of a batch of \
         {BATCH}. The search is cold, then warm.\n\n\
         | triangles | exhaustive f32, CPU | search, cold | search, warm | GPU f32 | GPU f64 | batch on the GPU f32 | GPU f64 \
         | batch by the search |\n|---|---|---|---|---|---|---|---|---|\n{engines}\n\
         ## Moving anatomy\n\n\
         Every vertex moves, then one query (Z*): milliseconds of the whole frame, and of the query alone.\n\n\
         | triangles | precision | frame | query |\n|---|---|---|---|\n{moving}",
        table("triangles | precision"),
        table("triangles | precision | discs"),
    )
}

fn answers(engine: &mut dyn Proximity, models: &[(&str, Chain); 3]) -> Result<Vec<LinkProximity>, String> {
    let (mut all, mut out) = (Vec::new(), Vec::new());
    for (_, robot) in models {
        engine.per_link(robot, &ventricle::entry(), &mut out).map_err(text)?;
        all.extend(&out);
    }
    Ok(all)
}

fn disagreement(one: &[LinkProximity], other: &[LinkProximity]) -> f64 {
    one.iter().zip(other).map(|(a, b)| (a.distance - b.distance).abs()).fold(0.0, f64::max)
}

/// The three models on one engine, in turns.
fn all_models(
    engine: &mut GpuExhaustive,
    models: &[(&str, Chain); 3],
    enough: Duration,
) -> Result<Vec<Timed>, String> {
    let engine = std::cell::RefCell::new(engine);
    let base = ventricle::entry();
    let query = |robot: &Chain, out: &mut Vec<LinkProximity>| {
        let mut engine = engine.borrow_mut();
        engine.per_link(robot, &base, out).map_err(text)?;
        Ok(engine.device_time())
    };
    let mut out = [Vec::new(), Vec::new(), Vec::new()];
    let [k, z_star, z] = &mut out;
    medians(
        &mut [&mut || query(&models[0].1, k), &mut || query(&models[1].1, z_star), &mut || {
            query(&models[2].1, z)
        }],
        enough,
    )
}

fn row(name: &str, triangles: u32, tflops: Option<f64>, timed: &[Timed]) -> Result<String, String> {
    let mut row = format!("| {name} |");
    for time in timed {
        let index = tflops
            .zip(time.device)
            .map_or("-".into(), |(tflops, device)| format!("{:.1}", 1.0 / (device.as_secs_f64() * tflops)));
        write!(row, " {} | {} | {index} |", milliseconds(time.device), milliseconds(Some(time.whole)))
            .map_err(text)?;
    }
    let seconds: Vec<_> = timed.iter().map(|time| time.device.unwrap_or(time.whole).as_secs_f64()).collect();
    let pairs = f64::from(triangles) * LINKS as f64 / seconds[0];
    writeln!(row, " {:.2} | {:.2} | {pairs:.1e} |", seconds[1] / seconds[0], seconds[2] / seconds[0])
        .map_err(text)?;
    Ok(row)
}

fn moving(
    name: &str,
    engine: &mut GpuExhaustive,
    robot: &Chain,
    mesh: &TriMesh,
    enough: Duration,
) -> Result<String, String> {
    let rest = mesh.vertices();
    let centre = rest.iter().sum::<Vector>() / rest.len() as f64;
    let beats =
        [1.0, 1.01].map(|beat| rest.iter().map(|&v| centre + (v - centre) * beat).collect::<Vec<_>>());
    let engine = std::cell::RefCell::new(engine);
    let base = ventricle::entry();
    let query = |out: &mut Vec<LinkProximity>| {
        let mut engine = engine.borrow_mut();
        engine.per_link(robot, &base, out).map_err(text)?;
        Ok(engine.device_time())
    };
    let (mut frame, mut one, mut other) = (0, Vec::new(), Vec::new());
    let timed = medians(
        &mut [
            &mut || {
                frame += 1;
                engine.borrow_mut().set_vertices(&beats[frame % 2]).map_err(text)?;
                query(&mut one)
            },
            &mut || query(&mut other),
        ],
        enough,
    )?;
    let [frame, query] = [0, 1].map(|job| milliseconds(Some(timed[job].whole)));
    Ok(format!("| {name} | {frame} | {query} |\n"))
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

type Boxed<'a> = Box<dyn FnMut() -> Result<Option<Duration>, String> + 'a>;

/// All engines on one mesh, in turns.
fn engines(opened: &[Opened], mesh: &TriMesh, robot: &Chain, enough: Duration) -> Result<String, String> {
    let base = ventricle::entry();
    let samples = samples(robot);
    let mut exhaustive = Exhaustive::<f32>::new(mesh).map_err(text)?;
    let mut search = BvhSearch::new(mesh).map_err(text)?;
    let mut warm = BvhSearch::new(mesh).map_err(text)?;
    let mut many = BvhSearch::new(mesh).map_err(text)?;
    let mut gpus = Vec::new();
    for opened in opened {
        gpus.push(std::cell::RefCell::new(GpuExhaustive::on(&opened.gpu, mesh).map_err(text)?));
    }
    let per_link = |engine: &mut dyn Proximity, out: &mut Vec<LinkProximity>| {
        engine.per_link(robot, &base, out).map_err(text).map(|()| None)
    };
    let batch = |engine: &mut dyn Proximity, out: &mut Vec<Vec<LinkProximity>>| {
        engine.per_link_batch(&samples, out).map_err(text).map(|()| None)
    };
    let mut out = vec![Vec::new(); 3 + gpus.len()];
    let mut outs = vec![Vec::new(); 1 + gpus.len()];
    let [out1, out2, out3, out_gpu @ ..] = &mut out[..] else { return Err("an answer is missing".into()) };
    let [outs1, outs_gpu @ ..] = &mut outs[..] else { return Err("an answer is missing".into()) };
    let mut jobs: Vec<Boxed> = vec![
        Box::new(|| per_link(&mut exhaustive, out1)),
        Box::new(|| {
            search.forget();
            per_link(&mut search, out2)
        }),
        Box::new(|| per_link(&mut warm, out3)),
        Box::new(|| batch(&mut many, outs1)),
    ];
    for (gpu, (out, outs)) in gpus.iter().zip(out_gpu.iter_mut().zip(outs_gpu)) {
        jobs.push(Box::new(|| per_link(&mut *gpu.borrow_mut(), out)));
        jobs.push(Box::new(|| batch(&mut *gpu.borrow_mut(), outs)));
    }
    let mut jobs: Vec<Job> = jobs.iter_mut().map(|job| &mut **job as Job).collect();
    let timed = medians(&mut jobs, enough)?;
    let whole = |job: usize| timed.get(job).map(|timed| timed.whole);
    let each = |job: usize| whole(job).map(|time| time / BATCH as u32);
    let cells = [whole(0), whole(1), whole(2), whole(4), whole(6), each(5), each(7), each(3)];
    let cells: Vec<_> = cells.into_iter().map(milliseconds).collect();
    Ok(format!("| {} | {} |\n", mesh.num_triangles(), cells.join(" | ")))
}
