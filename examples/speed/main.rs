//! How fast: every engine against parry on the same mesh and links, in one run. Writes `docs/SPEED.md` and its plot.
//!
//! ```text
//! cargo run --release --example speed
//! ```
//!
//! Needs a few minutes and 8 GB; `--largest 7` goes to meshes of 25 million triangles.

#[path = "../scene/mod.rs"]
mod scene;

mod exhaustive;
mod growth;
mod machine;
mod moving;
mod search;

use clap::Parser;
use scene::command;
use std::fmt::Write;
use std::fs;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Parser)]
struct Options {
    /// Where to write SPEED.md and speed.svg
    #[arg(long, value_name = "DIRECTORY", default_value = "docs")]
    out: PathBuf,

    /// How often the ventricle of 6,000 triangles is divided in four for the largest mesh
    #[arg(long, value_name = "TIMES", default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..=7))]
    largest: u32,
}

fn main() -> ExitCode {
    command::run(measure)
}

fn measure(options: &Options) -> Result<(), String> {
    let mut page = String::new();
    let head = format!(
        "# Speed\n\n\
         Written by `cargo run --release --example speed` on {}. \
         Times are medians; jobs that are compared take turns in one run. \
         A goal is a ratio that this project set itself.\n",
        machine::description()
    );
    page.push_str(&head);
    for chapter in [
        search::chapter()?,
        exhaustive::chapter()?,
        growth::chapter(options.largest, &options.out)?,
        moving::chapter()?,
    ] {
        write!(page, "\n{chapter}").map_err(|error| error.to_string())?;
    }
    let path = options.out.join("SPEED.md");
    fs::create_dir_all(&options.out)
        .and_then(|()| fs::write(&path, page))
        .map_err(|error| format!("cannot write {} ({error}); choose another --out", path.display()))?;
    println!("{}", path.display());
    Ok(())
}
