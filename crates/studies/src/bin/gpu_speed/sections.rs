//! Robots of sections of constant curvature: the search on the GPU, which computes their points,
//! beside the search on the CPU, which builds their chains.

use crate::search::{batches, most_robots_of, vessels};
use crate::timed::{Job, medians};
use crate::{Opened, text};
use continuum_demo::lumen;
use continuum_demo::steer::Random;
use parry_continuum::BendingSection;
use parry_continuum::gpu::GpuSearch;
use parry_continuum::proximity::BvhSearch;
use std::f64::consts::TAU;
use std::fmt::Write;
use std::time::Duration;

/// Links of a section. Each robot has three sections.
const SEGMENTS: usize = 10;
/// The margin, mm.
const MARGIN: f64 = 0.0;

/// The chapter of the page. Adds to `defects` which answers differ.
pub fn chapter(
    opened: &Opened,
    largest: u32,
    most_robots: usize,
    enough: Duration,
    defects: &mut Vec<String>,
) -> Result<String, String> {
    let mut rows = String::new();
    for around in vessels(largest) {
        let mesh = lumen::mesh(around);
        let triangles = mesh.num_triangles();
        let mut cpu = BvhSearch::new(&mesh).map_err(text)?;
        cpu.prepare();
        let mut gpu = GpuSearch::on(&opened.gpu, &mesh).map_err(text)?;
        gpu.set_min_links(Some(0));
        let most = most_robots_of(around, most_robots);
        let (robots, base) = (robots(most), lumen::entry());
        for count in batches(most) {
            let robots = &robots[..count];
            let (mut on_cpu, mut on_gpu) = (Vec::new(), Vec::new());
            let mut ask_cpu = || {
                let asked = cpu.clears_sections_batch(robots, SEGMENTS, &base, MARGIN, &mut on_cpu);
                asked.map_err(text).map(|()| None)
            };
            let mut ask_gpu = || {
                gpu.clears_sections_batch(robots, SEGMENTS, &base, MARGIN, &mut on_gpu)
                    .map_err(text)?;
                Ok(gpu.device_time())
            };
            let mut jobs: [Job; 2] = [&mut ask_cpu, &mut ask_gpu];
            let timed = medians(&mut jobs, enough)?;
            let each = |time: Duration| time.as_secs_f64() * 1e6 / count as f64;
            let [on_host, on_device] = [each(timed[0].whole), each(timed[1].whole)];
            let number = |value: Option<f64>, digits: usize| {
                value.map_or("-".into(), |value: f64| format!("{value:.digits$}"))
            };
            let kernels = timed[1].device.map(each);
            let before = gpu.answered_on_cpu();
            gpu.clears_sections_batch(robots, SEGMENTS, &base, MARGIN, &mut on_gpu)
                .map_err(text)?;
            let left = gpu.answered_on_cpu() - before;
            let clear = on_cpu.iter().filter(|clear| **clear == Ok(true)).count();
            writeln!(
                rows,
                "| {triangles} | {count} | {:.0} % | {on_host:.3} | {on_device:.4} | {} | {:.2} | {} | {left} |",
                100.0 * clear as f64 / count as f64,
                number(kernels, 4),
                on_host / on_device,
                number(kernels.map(|kernels| on_host / kernels), 2)
            )
            .map_err(text)?;
            if on_cpu != on_gpu {
                defects.push(format!("sections of {count} robots, {triangles} triangles"));
            }
        }
    }
    Ok(format!(
        "## Robots of sections in batches\n\n\
         Microseconds for each robot of three sections of constant curvature and {} links (`clears_sections_batch`, a margin of \
         {MARGIN} mm), with transfers. The GPU computes the points; the CPU builds the chains. Device: the kernels alone. \
         Left: the robots that single precision does not resolve, or with too many candidates, which the CPU searches.\n\n\
         | triangles | robots | clear | search, CPU | search, GPU | device | CPU / GPU | CPU / device | left |\n\
         |---|---|---|---|---|---|---|---|---|\n{rows}",
        3 * SEGMENTS
    ))
}

/// Robots in the vessel: sections of 5 to 20 mm that bend about as the vessel does.
fn robots(count: usize) -> Vec<[BendingSection; 3]> {
    let mut random = Random(19);
    let robot = |_| {
        [1.2, 0.9, 0.5].map(|radius| {
            let length = 5.0 + 15.0 * random.share();
            let (more, angle) = (0.02 * random.share(), TAU * random.share());
            let bend = [0.0125 + more * angle.cos(), more * angle.sin()];
            BendingSection { length, radius, bend }
        })
    };
    (0..count).map(robot).collect()
}
