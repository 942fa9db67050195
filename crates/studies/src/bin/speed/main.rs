//! How fast: every engine against parry on the same mesh and links, in one run. Writes `docs/SPEED.md`, its plot and the
//! README's table.
//!
//! ```text
//! cargo run --release -p continuum-studies --bin speed
//! ```
//!
//! Needs a few minutes and 8 GB; `--largest 6` goes to meshes of 41 million triangles. `--largest 1 --enough 0`, with an
//! `--out` of its own, is a rehearsal.

mod exhaustive;
mod goals;
mod growth;
mod latency;
mod moving;
mod planner;
mod search;

use clap::Parser;
use continuum_scene::command;
use continuum_studies::{machine, quote};
use goals::Goals;
use std::fs;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;

#[derive(Parser)]
struct Options {
    /// Where to write SPEED.md and speed.svg
    #[arg(long, value_name = "DIRECTORY", default_value = "docs")]
    out: PathBuf,

    /// How often the ventricle of 10,000 triangles is divided in four for the largest mesh; no other is larger
    #[arg(long, value_name = "TIMES", default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..=6))]
    largest: u32,

    /// Seconds for each group of jobs that take turns; groups of a few jobs take less
    #[arg(long, value_name = "SECONDS", default_value_t = 4.0, value_parser = seconds)]
    enough: f64,
}

fn seconds(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(seconds) if (0.0..=60.0).contains(&seconds) => Ok(seconds),
        _ => Err("write a number of seconds from 0 to 60, for example 4".into()),
    }
}

/// How much is measured.
#[derive(Clone, Copy)]
struct Effort {
    /// No mesh is divided in four more often.
    largest: u32,
    enough: Duration,
}

fn main() -> ExitCode {
    command::run(measure)
}

fn measure(options: &Options) -> Result<(), String> {
    let effort = Effort { largest: options.largest, enough: Duration::from_secs_f64(options.enough) };
    let written = format!(
        "Written by `{}` on {}",
        command::line("-p continuum-studies --bin speed"),
        machine::description()
    );
    let mut page = format!(
        "# Speed\n\n\
         {written}. \
         Times are medians; jobs that are compared take turns in one run. [GPU_SPEED.md](GPU_SPEED.md) is about the GPU.\n"
    );
    let memory = exhaustive::memory(effort)?;
    let mut goals = Goals::default();
    let (search, table) = search::chapter(effort, &mut goals)?;
    let planner = planner::chapter(effort, &mut goals)?;
    let exhaustive = exhaustive::chapter(effort, &mut goals)?;
    let growth = growth::chapter(effort, &options.out)?;
    let latency = latency::chapter(effort)?;
    for chapter in
        [search, planner, latency, exhaustive, growth, moving::chapter(effort)?, memory, goals.chapter()]
    {
        page.push('\n');
        page.push_str(&chapter);
    }
    let path = options.out.join("SPEED.md");
    fs::create_dir_all(&options.out)
        .and_then(|()| fs::write(&path, page))
        .map_err(|error| format!("cannot write {} ({error}); choose another --out", path.display()))?;
    println!("{}", path.display());
    let quote = format!(
        "{written}: a robot of 30 links in a cavity of about 100 mm, at the \
         wall (2 mm away) and in the middle (19 mm). Times faster than parry's `distance(Cylinder, TriMesh)` for each \
         link in the same run; `clears` against parry's `closest_points` with the same margin. \
         [docs/SPEED.md](docs/SPEED.md) has the rest.\n\n{table}"
    );
    quote::in_readme(&quote, "speed", &options.out)
}
