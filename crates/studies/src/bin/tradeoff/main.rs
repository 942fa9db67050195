//! What accuracy costs: every model, tolerance and engine on seeded shapes of a concentric tube
//! robot in a ventricle. Writes `docs/TRADEOFF.md`, its plot and the guide in docs/book/trade.md.
//!
//! ```text
//! cargo run --release -p continuum-studies --bin tradeoff
//! ```
//!
//! Needs a few minutes. With `--features gpu` the engines on the GPU take part. `--mesh` takes
//! other anatomy; then the page goes to `target/tradeoff`, as it does with other numbers of shapes.

mod clock;
mod from_samples;
mod front;
#[cfg(feature = "gpu")]
mod gpu;
mod guide;
mod kinematics;
mod motions;
mod outcome;
mod page;
mod plot;
mod reference;
mod shapes;
mod shares;
mod statistics;
mod subject;
mod ways;

use clap::Parser;
use continuum_demo::anatomy::Anatomy;
use continuum_demo::command::{self, Stages};
use continuum_demo::ctr;
use continuum_demo::steer::Random;
use continuum_studies::{long_table, quote};
use outcome::outcomes;
use std::fs;
use std::path::PathBuf;
use std::process::ExitCode;

/// Measure what accuracy costs: models, tolerances and engines on many shapes of a concentric tube
/// robot.
#[derive(Parser)]
struct Options {
    #[command(flatten)]
    anatomy: Anatomy,

    /// How many shapes are compared
    #[arg(long, value_name = "COUNT", default_value_t = SHAPES, value_parser = command::whole(10..=u32::MAX))]
    shapes: u32,

    /// How many of the shapes that touch no wall are timed
    #[arg(long, value_name = "COUNT", default_value_t = TIMED, value_parser = command::whole(1..=u32::MAX))]
    timed: u32,

    /// Edges of each length whose motion is checked
    #[arg(long, value_name = "COUNT", default_value_t = EDGES, value_parser = command::whole(1..=u32::MAX))]
    edges: u32,

    /// Measure this chapter alone, and leave the rest of the page as it is
    #[arg(long, value_enum)]
    only: Option<Chapter>,

    /// Where to write TRADEOFF.md, its long tables as tradeoff_*.csv, and tradeoff.svg [default:
    /// docs, or target/tradeoff with other options]
    #[arg(long, value_name = "DIRECTORY")]
    out: Option<PathBuf>,
}

/// A chapter that can be written alone.
#[derive(Clone, Copy, PartialEq, clap::ValueEnum)]
enum Chapter {
    Motions,
    /// The picture, from the table beside it
    Picture,
}

const EDGES: u32 = 400;
const SHAPES: u32 = 10_000;
const TIMED: u32 = 300;

/// Shapes with torsion.
const TWISTED: usize = 1000;

fn main() -> ExitCode {
    command::run(measure)
}

fn measure(options: &Options) -> Result<(), String> {
    let usual = options.anatomy.is_planned()
        && options.shapes == SHAPES
        && options.timed == TIMED
        && options.edges == EDGES;
    let out = options
        .out
        .clone()
        .unwrap_or_else(|| if usual { "docs" } else { "target/tradeoff" }.into());
    let mesh = options.anatomy.load()?;
    let base = options.anatomy.pose(&mesh)?;
    let robot = ctr::three_tubes();

    let file = out.join("TRADEOFF.md");
    if options.only == Some(Chapter::Picture) {
        let all = plot::from_table(&out.join("tradeoff_links.csv"))?;
        return plot::draw(&all, &out.join("tradeoff.svg"));
    }
    if options.only == Some(Chapter::Motions) {
        quote::check_chapter(motions::MARK, &file)?;
        let motions = motions::chapter(&robot, &mesh, &base, options.edges as usize)?;
        quote::in_page(&motions, motions::MARK, &file)?;
        println!("{}", file.display());
        return Ok(());
    }

    let stages = Stages::begin();
    stages.next("shapes");
    let mut random = Random(1);
    let shapes: Vec<_> = (0..options.shapes).map(|_| shapes::draw(&robot, &mut random)).collect();
    let outcomes = outcomes(&robot, &shapes, &mesh, &base)?;
    let timed: Vec<_> = shapes
        .iter()
        .zip(&outcomes)
        .filter(|(_, outcome)| outcome.truth > 0.0)
        .map(|(joints, _)| joints.clone())
        .take(options.timed as usize)
        .collect();
    if timed.is_empty() {
        return Err(
            "every shape touches the wall; move the robot with --base and --axis, or bring the mesh to \
                    millimetres with --scale"
                .into(),
        );
    }
    let touching: Vec<_> = shapes
        .iter()
        .zip(&outcomes)
        .filter(|(_, outcome)| outcome.truth <= 0.0)
        .map(|(joints, _)| joints.clone())
        .take(options.timed as usize)
        .collect();
    stages.next("the reference itself");
    let checked = reference::check(&robot, &timed, &mesh, &base)?;
    stages.next("torsion");
    let some = TWISTED.min(shapes.len());
    let (kinematics, torsion_median, torsion_worst) =
        kinematics::chapter(&robot, &shapes[..some], &outcomes[..some], &mesh, &base)?;
    stages.next("times");
    #[cfg(feature = "gpu")]
    let devices = gpu::devices();
    #[cfg(not(feature = "gpu"))]
    let devices = Vec::new();
    let times = clock::time(&robot, &timed, &mesh, &base, &devices)?;

    stages.next("from samples");
    let (from_samples, rows) = from_samples::chapter(
        &robot,
        [&timed, &touching],
        &mesh,
        &base,
        outcome::INPUT_SPACING,
        &out,
    )?;

    stages.next("motions");
    let motions = motions::chapter(&robot, &mesh, &base, options.edges as usize)?;

    stages.next("writing");
    let errors = front::errors(&outcomes);
    let all = front::combinations(&times, &errors);
    let features = if cfg!(feature = "gpu") { "--features gpu " } else { "" };
    let command = command::line(&format!("-p continuum-studies {features}--bin tradeoff"));
    let widest = robot.sections.iter().map(|section| section.radius).fold(0.0, f64::max);
    let trade = long_table::write(
        &page::table(&times, &errors),
        &out.join("tradeoff_links.csv"),
        page::is_shown,
    )?;
    let page = page::page(&page::Facts {
        command: &command,
        triangles: mesh.num_triangles(),
        timed: timed.len(),
        outcomes: &outcomes,
        checked: &checked,
        times: &times,
        errors: &errors,
        trade: &trade,
        all: &all,
        widest,
        device: devices.first().map(|device| device.name.as_str()),
    });
    fs::create_dir_all(&out).map_err(|error| unwritable(&out, error))?;
    let shares = shares::chapter(&outcomes, &out)?;
    let mark = motions::MARK;
    let motions = format!("<!-- {mark} -->\n{motions}<!-- /{mark} -->\n");
    fs::write(&file, [page, from_samples, motions, shares, kinematics].join("\n"))
        .map_err(|error| unwritable(&file, error))?;
    plot::draw(&all, &out.join("tradeoff.svg"))?;
    let guide = guide::text(&guide::Facts {
        command: &command,
        all: &all,
        times: &times,
        from_samples: &rows,
        forbidden: shares::forbidden(&outcomes, subject::Model::Capsule),
        torsion: [torsion_median, torsion_worst],
    });
    quote::in_page(&guide, "tradeoff", &out.join("book/trade.md"))?;
    stages.next("done");
    println!("{}", file.display());
    Ok(())
}

fn unwritable(path: &std::path::Path, error: std::io::Error) -> String {
    format!("cannot write {} ({error}); choose another --out", path.display())
}
