//! The paper's experiment: a robot of 30 links, as capsules, with caps that fit, and as cylinders,
//! against every triangle.

use crate::timed::{Timed, medians, milliseconds};
use crate::{Opened, text};
use continuum_demo::ventricle;
use continuum_studies::gpu::Discs;
use continuum_studies::long_table;
use continuum_studies::models::LINKS;
use parry_continuum::Chain;
use parry_continuum::gpu::GpuExhaustive;
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{BvhSearch, LinkProximity, Proximity};
use std::fmt::Write;
use std::path::Path;
use std::time::Duration;

/// The chapter of the page, and a table beside it in `out`.
pub fn chapter(
    opened: &[Opened],
    meshes: &[TriMesh],
    most_every_pair: u32,
    models: &[(&str, Chain); 3],
    enough: Duration,
    out: &Path,
) -> Result<String, String> {
    let [mut culling, mut every_pair, mut checks] = [String::new(), String::new(), String::new()];
    for mesh in meshes {
        let size = mesh.num_triangles();
        let exact = answers(&mut BvhSearch::new(mesh).map_err(text)?, models)?;
        for opened in opened {
            let name = format!("{size} | {}", opened.name);
            let mut engine = GpuExhaustive::on(&opened.gpu, mesh).map_err(text)?;
            let apart = disagreement(&answers(&mut engine, models)?, &exact);
            let timed = all_models(&mut engine, models, enough)?;
            culling.push_str(&row(&name, size, opened.tflops, &timed)?);
            let distances = match apart {
                0.0 => "the distances are the search's".into(),
                _ => format!("the distances differ from the search's by at most {apart:.0e} mm"),
            };
            let on_cpu = match engine.answered_on_cpu() {
                0 => "no link".into(),
                count => format!("{count} links"),
            };
            writeln!(
                checks,
                "- {size} triangles, {}: {distances}, and {on_cpu} needed the CPU.",
                opened.name
            )
            .map_err(text)?;
            if size > most_every_pair as usize {
                continue;
            }
            for (discs, route) in [
                (Discs::Convex, "convex"),
                (Discs::ClosedForm, "quartic, closed form"),
                (Discs::Companion, "quartic, companion"),
            ] {
                engine.compute_every_pair(&discs.route(opened.gpu.precision())).map_err(text)?;
                let timed = all_models(&mut engine, models, enough)?;
                every_pair.push_str(&row(
                    &format!("{name} | {route}"),
                    size,
                    opened.tflops,
                    &timed,
                )?);
            }
        }
    }
    page(&culling, &every_pair, &checks, out)
}

fn page(culling: &str, every_pair: &str, checks: &str, out: &Path) -> Result<String, String> {
    let table = |head: &str| {
        format!(
            "| {head} | capsules, device | end to end | index | fitted caps, device | end to end | index | cylinders, device \
             | end to end | index | fitted caps / capsules | cylinders / capsules | capsules, pairs/s |\n|{}\n",
            "---|".repeat(head.split('|').count() + 12)
        )
    };
    let every_pair = table("triangles | precision | discs") + every_pair;
    let largest =
        every_pair.lines().last().and_then(|row| row.split('|').nth(1)).unwrap_or_default();
    let shown = long_table::write(&every_pair, &out.join("gpu_every_pair.csv"), |cells| {
        cells[0] == largest.trim()
    })?;
    Ok(format!(
        "## Figure 9 and Table IV: {LINKS} links against a mesh\n\n\
         Milliseconds. Index: 1 / (seconds x TFLOPS) by the device's time, for the peak that the command gives. The paper's \
         for 1e6 triangles is 11.93 (f32) and 10.32 (f64) for capsules and fitted caps, 0.69 and 1.16 for cylinders. Ratios \
         are of device times.\n\n\
         With culling, every triangle visited:\n\n{}{culling}\n\
         Without, every pair in full, as in the paper, by three routes to the disc of a flat cap \
         ([gpu_every_pair.csv](gpu_every_pair.csv) has all sizes):\n\n{shown}\n\
         Checks:\n\n{checks}",
        table("triangles | precision"),
    ))
}

fn answers(
    engine: &mut dyn Proximity,
    models: &[(&str, Chain); 3],
) -> Result<Vec<LinkProximity>, String> {
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
    let [(_, capsules), (_, fitted), (_, cylinders)] = models;
    let mut out = [Vec::new(), Vec::new(), Vec::new()];
    let [out1, out2, out3] = &mut out;
    medians(
        &mut [&mut || query(capsules, out1), &mut || query(fitted, out2), &mut || {
            query(cylinders, out3)
        }],
        enough,
    )
}

fn row(
    name: &str,
    triangles: usize,
    tflops: Option<f64>,
    timed: &[Timed],
) -> Result<String, String> {
    let mut row = format!("| {name} |");
    for time in timed {
        let index = tflops.zip(time.device).map_or("-".into(), |(tflops, device)| {
            format!("{:.1}", 1.0 / (device.as_secs_f64() * tflops))
        });
        write!(
            row,
            " {} | {} | {index} |",
            milliseconds(time.device),
            milliseconds(Some(time.whole))
        )
        .map_err(text)?;
    }
    let seconds: Vec<_> =
        timed.iter().map(|time| time.device.unwrap_or(time.whole).as_secs_f64()).collect();
    let pairs = triangles as f64 * LINKS as f64 / seconds[0];
    writeln!(
        row,
        " {:.2} | {:.2} | {pairs:.1e} |",
        seconds[1] / seconds[0],
        seconds[2] / seconds[0]
    )
    .map_err(text)?;
    Ok(row)
}
