//! The paper's studies on your own processor: branching (Tables II and III), root finders (Tables I
//! and V) and the exhaustive engines with the paper's solvers (Figure 9, Table IV). Writes
//! `docs/internals/studies.md`.
//!
//! ```text
//! cargo run --release -p continuum-studies --bin studies
//! ```
//!
//! Needs a few minutes and 3 GB. `--only` measures one chapter again and leaves the others as they
//! are.

mod branching;
mod discs;
mod engines;
mod pairs;
mod peak;
mod polynomials;
mod schur;
mod turns;

use clap::{Parser, ValueEnum};

use continuum_demo::command::{self, Stages};
use continuum_studies::machine;
use std::fs;
use std::path::PathBuf;
use std::process::ExitCode;

/// Repeat the paper's studies on this processor: branching, root finders and exhaustive engines.
#[derive(Parser)]
struct Options {
    /// Where to write studies.md, and its long tables as studies_*.csv
    #[arg(long, value_name = "DIRECTORY", default_value = "docs/internals")]
    out: PathBuf,

    /// Measure this chapter alone
    #[arg(long)]
    only: Option<Chapter>,

    /// Segments and discs for Table I
    #[arg(long, value_name = "COUNT", default_value_t = 1_000_000, value_parser = at_least_20)]
    problems: usize,

    /// Queries for Tables II and III, which have 10,000 too
    #[arg(long, value_name = "COUNT", default_value_t = 100_000_000, value_parser = at_least_20)]
    queries: usize,

    /// Triangles for Table IV
    #[arg(long, value_name = "COUNT", default_value_t = 1_000_000, value_parser = at_least_20)]
    triangles: usize,

    /// Polynomials of each degree for Table V; the companion matrix gets a tenth of them
    #[arg(long, value_name = "COUNT", default_value_t = 1_000_000, value_parser = at_least_20)]
    polynomials: usize,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Chapter {
    Discs,
    Branching,
    Engines,
    Polynomials,
    Schur,
}

impl Chapter {
    const ALL: [Self; 5] =
        [Self::Discs, Self::Branching, Self::Engines, Self::Polynomials, Self::Schur];

    /// The line that ends the chapter.
    fn mark(self) -> String {
        format!("<!-- {self:?} -->\n").to_lowercase()
    }
}

/// A count that fills every kind of problem and every part of a table.
fn at_least_20(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(count) if count >= 20 => Ok(count),
        _ => Err("must be a whole number, at least 20".into()),
    }
}

fn main() -> ExitCode {
    command::run(measure)
}

fn measure(options: &Options) -> Result<(), String> {
    command::directory(&options.out)?;
    let path = options.out.join("studies.md");
    let before = fs::read_to_string(&path).unwrap_or_default();
    let mut page = format!(
        "# The paper's studies\n\n\
         Written by `cargo run --release -p continuum-studies --bin studies` on {}. Times are for comparison within a table: what is compared \
         takes turns in one run. The paper's CPU was an Intel i7-3770 (Tables II, III) and two Xeon E5-2637v3 (the others), \
         its GPU an AMD FirePro W9100.\n\n",
        machine::description()
    );
    let mut rest = before.split_once("\n## ").map_or("", |(_, chapters)| chapters);
    let stages = Stages::begin();
    for chapter in Chapter::ALL {
        let old = rest.split_once(&chapter.mark());
        rest = old.map_or(rest, |(_, after)| after.trim_start_matches("\n## "));
        if options.only.is_none_or(|only| only == chapter) {
            stages.next(&format!("{chapter:?}").to_lowercase());
            page.push_str(&match chapter {
                Chapter::Discs => discs::chapter(options.problems, &options.out)?,
                Chapter::Branching => pairs::chapters(options.queries)?.join("\n"),
                Chapter::Engines => engines::chapter(options.triangles, &options.out)?,
                Chapter::Polynomials => polynomials::chapter(options.polynomials, &options.out)?,
                Chapter::Schur => schur::chapter(options.polynomials.div_ceil(10))?,
            });
        } else if let Some((text, _)) = old {
            page.push_str("## ");
            page.push_str(text);
        }
        page.push_str(&chapter.mark());
        page.push('\n');
    }
    fs::create_dir_all(&options.out)
        .and_then(|()| fs::write(&path, page.trim_end().to_owned() + "\n"))
        .map_err(|error| {
            format!("cannot write {} ({error}); choose another --out", path.display())
        })?;
    println!("{}", path.display());
    Ok(())
}
