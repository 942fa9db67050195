//! Measures the narrow phase, the engines and parry: `cargo run --release -p continuum-studies
//! --bin accuracy`.
//!
//! Writes `docs/ACCURACY.md`, tables by category beside it (`accuracy*.csv`) and the picture
//! `docs/correctness.png`. They show the errors of this crate's distances, on the reference cases
//! and on seeded problems at the extremes, and the errors of parry's `query::distance` for the same
//! links. With the feature `gpu` the kernels on the GPU are measured too.

#[cfg(feature = "gpu")]
mod device;
mod peers;
mod slice;

use clap::Parser;
use continuum_demo::command::{self, Stages};
use continuum_demo::levels::levels;
use continuum_studies::accuracy::measure::{Measurement, measure, problems, range};
use continuum_studies::accuracy::{EACH, LARGEST, certificates, engines, reference, tables};
use continuum_studies::long_table;
use continuum_studies::quote::between;
use continuum_testing::distance_cases;
use peers::{Peer, comparison};
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Measure how exact the narrow phase, the engines and parry are.
#[derive(Parser)]
struct Options {
    /// Where to write ACCURACY.md, the tables by category and the picture
    #[arg(long, value_name = "DIRECTORY", default_value = "docs")]
    out: PathBuf,
}

const INTRODUCTION: &str = "# Accuracy

Written by `cargo run --release -p continuum-studies --bin accuracy`. `cargo test -p continuum-studies --test accuracy`
computes this crate's errors again and fails if one of them differs from what is written here.

The 2,050 reference cases (`tests/data/distance.jsonl`) were computed with far more digits than a double has. They
include what usually goes wrong: contact, near-parallel edges, needles, triangles without area, wires, huge and tiny
sizes, and problems far from the origin.

## In millimetres

The worst error in a scene of 100 mm, whether the gap is 2 mm or none: that of the cases of each pair, taken to this size.

<!-- millimetres -->
";

const IN_ROUNDINGS: &str = "<!-- /millimetres -->

## In roundings

The error is the difference from the reference distance, in units of u x extent. u is 2^-53 in double precision (f64)
and 2^-24 in single precision (f32). The extent is the largest difference between two coordinates of the problem, or
its radius. An error of 1 means one rounding of a number as large as the problem. The crate promises at most 16.
Single precision is measured on the cases whose input it can hold. Where two errors are in the middle, the median is the
smaller. The numbers do not depend on the machine, because the kernels use only operations that IEEE 754 rounds
correctly. [accuracy_cases.csv](accuracy_cases.csv) has each category by itself.

<!-- ours -->
";

const EXTREMES: &str = "<!-- /ours -->

## At the extremes

Seeded problems, each driven to an extreme: a triangle and a link, from which every pair takes its part. The expected
distance is proven for each, by two points and a plane between the shapes, computed with twice the digits of f64. k goes
from 1 to 12, to 16 for short links, or to the last digit of the precision. Among subnormal numbers half their spacing is
the unit, as no answer can be nearer.

Ten of the 18 categories, those with the worst errors among them. [accuracy_categories.csv](accuracy_categories.csv) has
all, [accuracy.csv](accuracy.csv) each pair in each category by itself, and [accuracy_powers.csv](accuracy_powers.csv) the
worst error of any pair at each k.

<!-- extremes -->
";

const LEVELS: &str = "<!-- /extremes -->

The same links and triangles computed in packs, at each instruction set of the machine that wrote this page. Fused
operations make the difference.

";

const ENGINES: &str = "
The engines on meshes of a dozen of these triangles, each with a cylinder and with a capsule. The error is that of the
least distance, in units of the link and the triangle that are named. Exhaustive engines ran with and without culling.

";

const CERTIFICATES: &str = "
## Certificates

How far apart the bounds of `Certificate::between` lie, in units of u x extent, on the links of the reference cases and
on the extreme problems with each choice of caps. None is to be wider than 16. Rows are by what the nearest point of the
link lies on; [accuracy_certificates.csv](accuracy_certificates.csv) tells the features of the triangle apart too.

<!-- certificates -->
";

const GPU: &str = "
## On the GPU

The extreme problems by the kernels of the feature `gpu`; `--features gpu` measures them. Without a GPU, or with one in
software only, what a GPU was measured at is kept.

<!-- gpu -->
";

const PEERS: &str = "
## parry at the extremes

parry's `distance` for the same capsules and cylinders, in the same units (u x extent, f64). An over-estimate reports more
clearance than there is, by more than 1e-9 of the extent. *No answer* is a panic, NaN or infinity. Eight of the
categories; [accuracy_parry.csv](accuracy_parry.csv) has all of them.

";

const COMPARISON: &str = "
## Beside parry

The same triangles and links, asked of `parry::query::distance`: capsules and cylinders, which parry has too. Errors are
relative to the extent here. *As given*, nine in ten cases have an extent between 1 and 250. *x 1e-3* is the same
problem with all lengths multiplied by 1e-3, as when millimetres become metres; that rounds the input once more, for
parry and for this crate. parry stops on absolute tolerances, so its worst answers are those of the smallest problems.

An *over-estimate* reports more clearance than there is, by more than 1e-9 of the extent: the unsafe side. The last
column is the largest over-estimate relative to the true distance, among the cases whose distance is at least 1/1000 of
the extent.

![Two panels of one slice of configurations, coloured by the relative error of the clearance: in parry's it is mostly between 1e-12 and 1e-7, in this crate's it is the rounding of a double everywhere.](correctness.png)

In the picture a triangle moves around a tube half a millimetre thick; all lengths are in metres. Every cell is one
query. Its colour is the error relative to the true clearance, which is proven for each.

";

fn main() -> ExitCode {
    command::run(|options: &Options| write_all(&options.out))
}

fn write_all(docs: &Path) -> Result<(), String> {
    let path = docs.join("ACCURACY.md");
    let cases = distance_cases();
    let levels = levels();
    let stages = Stages::begin();
    stages.next("random problems");
    let (problems, single) = (problems::<f64>(EACH), problems::<f32>(EACH));
    let (double_errors, single_errors) = (measure(&problems, &levels), measure(&single, &levels));
    stages.next("parry");
    let peer = Peer::ask(&problems);
    std::fs::create_dir_all(docs).map_err(|error| {
        format!("cannot make {} ({error}); choose another --out", docs.display())
    })?;
    let before = std::fs::read_to_string(&path).unwrap_or_default();
    let on_gpu = between(&before, "gpu").unwrap_or("No GPU has been measured yet.\n").to_owned();
    #[cfg(feature = "gpu")]
    let on_gpu = device::section(docs, &on_gpu, &problems, &single)?.unwrap_or(on_gpu);
    stages.next("certificates");
    let gaps = certificates::measure(&cases, &problems);
    let parry =
        long_table::write(&peer.table(), &docs.join("accuracy_parry.csv"), peers::is_shown)?;
    stages.next("engines");
    let page = [
        INTRODUCTION,
        &reference::in_millimetres(&cases),
        IN_ROUNDINGS,
        &reference::table(&cases),
        EXTREMES,
        &tables::tables(
            &double_errors,
            &single_errors,
            [range::<f64>(LARGEST[0]), range::<f32>(LARGEST[1])],
        ),
        LEVELS,
        &by_level(&double_errors, &single_errors),
        ENGINES,
        &engines_table(&engines::measure(&problems, &levels)),
        CERTIFICATES,
        &gaps.table(),
        "<!-- /certificates -->\n",
        GPU,
        &on_gpu,
        "<!-- /gpu -->\n",
        PEERS,
        &parry,
        COMPARISON,
        &comparison(&cases),
    ]
    .concat();
    save(&path, &page)?;
    save(&docs.join("accuracy.csv"), &file(&double_errors, &single_errors, &peer))?;
    let categories = tables::by_category(&double_errors, &single_errors);
    save(&docs.join("accuracy_categories.csv"), &long_table::csv(&categories))?;
    save(
        &docs.join("accuracy_pairs.csv"),
        &long_table::csv(&tables::by_pair(&double_errors, &single_errors)),
    )?;
    save(&docs.join("accuracy_powers.csv"), &tables::powers(&double_errors, &single_errors))?;
    save(&docs.join("accuracy_certificates.csv"), &gaps.lines())?;
    let mut lines = vec![reference::HEAD.to_owned()];
    lines.extend(reference::lines(&cases, peers::on_cases));
    save(&docs.join("accuracy_cases.csv"), &(lines.join("\n") + "\n"))?;
    stages.next("picture");
    let picture = docs.join("correctness.png");
    slice::draw()
        .save(&picture)
        .map_err(|error| format!("cannot write {} ({error})", picture.display()))?;
    println!("{}", picture.display());
    Ok(())
}

fn file(double: &Measurement, single: &Measurement, peer: &Peer) -> String {
    let mut lines = vec![tables::head()];
    lines.extend(tables::lines(double, |extreme, kernels| peer.cells(extreme, kernels)));
    lines.extend(tables::lines(single, |_, _| "-,-".into()));
    lines.join("\n") + "\n"
}

/// A row for each instruction set, on the pairs that have packs.
fn by_level(double: &Measurement, single: &Measurement) -> String {
    let mut text = String::from(
        "| numbers | f64 median | f64 worst | f32 median | f32 worst |\n|---|---|---|---|---|\n",
    );
    let columns = std::iter::once("scalar").chain(double.levels.iter().copied());
    for (column, name) in columns.enumerate() {
        write!(text, "| {name} |").ok();
        for measurement in [double, single] {
            let packed = measurement.found.iter().filter(|found| !found.levels.is_empty());
            let errors = packed
                .map(|found| if column == 0 { found.scalar } else { found.levels[column - 1] });
            write!(text, " {} |", tables::cell(errors.collect()).replace(',', " | ")).ok();
        }
        text.push('\n');
    }
    text
}

fn engines_table(errors: &engines::Errors) -> String {
    let mut text = String::from("| engine | queries | median | worst |\n|---|---|---|---|\n");
    for (name, errors) in errors {
        let (median, worst) = reference::median_and_worst(errors.clone()).unwrap_or_default();
        writeln!(text, "| {name} | {} | {median:.2} | {worst:.2} |", errors.len()).ok();
    }
    text
}

fn save(path: &Path, text: &str) -> Result<(), String> {
    std::fs::write(path, text)
        .map_err(|error| format!("cannot write {} ({error})", path.display()))?;
    println!("{}", path.display());
    Ok(())
}
