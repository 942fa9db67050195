//! How fast: every engine against parry on the same mesh and links, in one run. Writes
//! `docs/SPEED.md`, its plot and the README's table.
//!
//! ```text
//! cargo run --release -p continuum-studies --bin speed
//! ```
//!
//! Needs a few minutes and 8 GB; `--largest 6` goes to meshes of 41 million triangles. `--largest 1
//! --enough 0`, with an `--out` of its own, is a rehearsal. `--only rare`, `--only robots` and
//! `--only scenes` measure that chapter again and leave the others as they are.

mod exhaustive;
mod goals;
mod growth;
mod latency;
mod moving;
mod planner;
mod rare;
mod robots;
mod scenes;
mod search;

use clap::Parser;
use continuum_demo::command::{self, Stages};
use continuum_studies::{machine, quote};
use goals::Goals;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

/// Measure how fast every engine answers, beside parry.
#[derive(Parser)]
struct Options {
    /// Where to write SPEED.md and speed.svg
    #[arg(long, value_name = "DIRECTORY", default_value = "docs")]
    out: PathBuf,

    /// How often the ventricle of 10,000 triangles is divided in four; other meshes stay smaller
    #[arg(long, value_name = "TIMES", default_value_t = 5, value_parser = command::whole(1..=6))]
    largest: u32,

    /// Seconds for each group of jobs that are compared; small groups take less
    #[arg(long, value_name = "SECONDS", default_value_t = 4.0, value_parser = seconds)]
    enough: f64,

    /// Measure this chapter alone, and leave the rest of the page and the goals as they are
    #[arg(long, value_enum)]
    only: Option<Chapter>,
}

/// A chapter that can be written alone.
#[derive(Clone, Copy, PartialEq, clap::ValueEnum)]
enum Chapter {
    /// The worst of many new shapes.
    Rare,
    /// Robots beside robots.
    Robots,
    /// Several structures.
    Scenes,
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
    command::directory(&options.out)?;
    let effort =
        Effort { largest: options.largest, enough: Duration::from_secs_f64(options.enough) };
    let written = format!(
        "Written by `{}` on {}",
        command::line("-p continuum-studies --bin speed"),
        machine::description()
    );
    let file = options.out.join("SPEED.md");
    if let Some(only) = options.only {
        let mark = match only {
            Chapter::Rare => rare::MARK,
            Chapter::Robots => robots::MARK,
            Chapter::Scenes => scenes::MARK,
        };
        quote::check_chapter(mark, &file)?;
        let chapter = match only {
            Chapter::Rare => rare::chapter(effort, &written, &mut Goals::default())?,
            Chapter::Robots => robots::chapter(effort, &written)?,
            Chapter::Scenes => scenes::chapter(effort, &written)?,
        };
        quote::in_page(&chapter, mark, &file)?;
        println!("{}", file.display());
        return Ok(());
    }
    let mut page = format!(
        "# Speed\n\n\
         {written}. \
         Times are medians; jobs that are compared take turns in one run. [GPU_SPEED.md](GPU_SPEED.md) is about the GPU.\n"
    );
    let stages = Stages::begin();
    stages.next("memory");
    let memory = exhaustive::memory(effort)?;
    let mut goals = Goals::default();
    stages.next("search");
    let (search, rows) = search::chapter(effort, &mut goals)?;
    stages.next("planner");
    let (planner, shapes) = planner::chapter(effort, &mut goals)?;
    stages.next("every triangle");
    let exhaustive = exhaustive::chapter(effort, &mut goals)?;
    stages.next("growth with the mesh");
    let growth = growth::chapter(effort, &options.out)?;
    stages.next("after other work");
    let latency = latency::chapter(effort)?;
    stages.next("the worst of many");
    let rare = rare::chapter(effort, &written, &mut goals)?;
    let rare = marked(rare::MARK, &rare);
    stages.next("robots beside robots");
    let robots = marked(robots::MARK, &robots::chapter(effort, &written)?);
    stages.next("several structures");
    let scenes = marked(scenes::MARK, &scenes::chapter(effort, &written)?);
    stages.next("moving meshes");
    for chapter in [
        search,
        planner,
        latency,
        rare,
        robots,
        scenes,
        exhaustive,
        growth,
        moving::chapter(effort)?,
        memory,
    ] {
        page.push('\n');
        page.push_str(&chapter);
    }
    write(&file, &page)?;
    let internals = options.out.join("internals");
    write(&internals.join("speed_goals.md"), &goals.page(&written))?;
    println!("{}", file.display());
    let is_quoted = |row: &&String| row.starts_with("| near |") && !row.contains("| 327680 |");
    let table: String = rows.iter().filter(is_quoted).map(String::as_str).collect();
    let quote = format!(
        "{written}: a robot of 30 links in a cavity of about 100 mm, 2 mm from the wall. Microseconds per query, and in brackets \
         how many times faster than parry with the same bounds. *First time*: without a warm start. *Again*: with the answers of \
         the previous query, as in a control loop.\n\n{}{table}\n\
         {shapes} [docs/SPEED.md](docs/SPEED.md) has the other scenes, and the times after other work in the caches.\n",
        search::HEAD,
    );
    quote::in_readme(&quote, "speed", &options.out)
}

/// A chapter that can be written alone.
fn marked(mark: &str, chapter: &str) -> String {
    format!("<!-- {mark} -->\n{chapter}<!-- /{mark} -->\n")
}

fn write(path: &Path, page: &str) -> Result<(), String> {
    let directory = path.parent().unwrap_or(Path::new("."));
    fs::create_dir_all(directory)
        .and_then(|()| fs::write(path, page))
        .map_err(|error| format!("cannot write {} ({error}); choose another --out", path.display()))
}
