//! Robots thrown onto walls in rapier, beside parry's compounds. Writes the table of
//! `docs/RAPIER.md`.
//!
//! ```text
//! cargo run --release -p continuum-studies --features rapier --bin throws
//! ```

use clap::Parser;
use continuum_demo::command;
use continuum_studies::quote;
use continuum_testing::throws::{Outcome, ThrownBody, Throws, Wall};
use std::fmt::Write as _;
use std::path::PathBuf;
use std::process::ExitCode;

/// Throw robots and compounds onto walls in rapier.
#[derive(Parser)]
struct Options {
    /// How many throws of each body onto each wall, in each unit, with and without continuous
    /// collision detection
    #[arg(long, value_name = "COUNT", default_value_t = 50)]
    throws: u64,
    /// How many steps of a throw
    #[arg(long, value_name = "COUNT", default_value_t = 960)]
    steps: usize,
    /// Where RAPIER.md is
    #[arg(long, value_name = "DIRECTORY", default_value = "docs")]
    out: PathBuf,
}

/// The units of length.
const UNITS: [f64; 3] = [1e-3, 1.0, 1e3];

/// All throws of a body onto a wall.
fn thrown(my: &Options, body: ThrownBody, wall: Wall) -> Outcome {
    let mut all = Outcome::default();
    for unit in UNITS {
        for ccd in [false, true] {
            all.add(
                &Throws { wall, unit, ccd, steps: my.steps, rate: 240.0 }.of(body, 0..my.throws),
            );
        }
    }
    all
}

/// Returns the table, and the rows that pass or are worse than their compounds.
fn table(my: &Options) -> (String, Vec<String>) {
    let mut page = format!(
        "{} throws of each body onto each wall, in three units, half of them with `ccd_enabled`, \
         {} steps at 240 Hz (`{}`). Bodies are 3 units u long and 0.16 u thick. *Held*: steps in \
         which the body moves by less than 1 % of what its velocity after the step says, of all \
         steps in which it moves. *Rise*: the largest rise of the energy after its minimum, in \
         m g u. *Deepest*: the deepest overlap, in radii. *Asleep*: bodies that fall asleep \
         on the wall, and the median of their steps.\n\n\
         | wall | body | held | longest run | rise | deepest | passed | asleep |\n\
         |---|---|---|---|---|---|---|---|\n",
        my.throws * 2 * UNITS.len() as u64,
        my.steps,
        command::line("-p continuum-studies --features rapier --bin throws")
    );
    let mut worse = Vec::new();
    for wall in Wall::ALL {
        let outcomes = ThrownBody::ALL.map(|body| (body, thrown(my, body, wall)));
        for (body, mut outcome) in outcomes.clone() {
            let compounds = body.compounds();
            let of_compounds = outcomes.iter().filter(|(body, _)| compounds.contains(body));
            let parrys: Vec<_> = of_compounds.map(|(_, outcome)| outcome.clone()).collect();
            if !parrys.is_empty() && (outcome.passed > 0 || !outcome.is_no_worse_than(&parrys)) {
                worse.push(format!("{} on a {}", body.name(), wall.name()));
            }
            outcome.asleep.sort_unstable();
            let asleep = match outcome.asleep.len() {
                0 => "0".to_owned(),
                count => format!("{count}, {}", outcome.asleep[count / 2]),
            };
            let Outcome { held, moving, longest, rise, depth, passed, .. } = outcome;
            let _ = writeln!(
                page,
                "| {} | {} | {held} of {moving} | {longest} | {rise:.4} | {depth:.2} | {passed} | {asleep} |",
                wall.name(),
                body.name(),
            );
        }
    }
    (page, worse)
}

fn main() -> ExitCode {
    command::run(|my: &Options| {
        let (table, worse) = table(my);
        print!("{table}");
        quote::in_page(&table, "throws", &my.out.join("RAPIER.md"))?;
        match worse.is_empty() {
            true => Ok(()),
            false => Err(format!("worse than their compounds: {}", worse.join(", "))),
        }
    })
}
