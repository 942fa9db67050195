//! Measures the narrow phase, and parry's, on the reference cases: `cargo run --release --example accuracy`.
//!
//! Writes `docs/ACCURACY.md`. It tells how far this crate's distances are from the reference, for every kind of
//! pair and category of case, and how far those of parry's `query::distance` are for the same links: as given, and
//! in another unit of length.

#[path = "scene/accuracy.rs"]
mod accuracy;
#[path = "../tests/common/mod.rs"]
mod common;

use accuracy::{categories, distance, median_and_worst, tables};
use common::{Case, distance_cases};
use parry_continuum::parry::math::{Pose, Rot3, Vector};
use parry_continuum::parry::query;
use parry_continuum::parry::shape::{Capsule, Cylinder, Triangle};
use std::fmt::Write;
use std::process::ExitCode;

const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/ACCURACY.md");

const INTRODUCTION: &str = "# Accuracy

Written by `cargo run --release --example accuracy`. `cargo test --test accuracy` computes this crate's errors again and
fails if one of them differs from what is written here.

The 2,050 reference cases (`tests/data/distance.jsonl`) were computed with far more digits than a double has. They
include what usually goes wrong: contact, near-parallel edges, needles, triangles without area, wires, huge and tiny
sizes, and problems far from the origin.

## This crate

The error is the difference from the reference distance, in units of u x extent. u is 2^-53 in double precision (f64)
and 2^-24 in single precision (f32). The extent is the largest difference between two coordinates of the problem, or
its radius. An error of 1 means one rounding of a number as large as the problem. The crate promises at most 16.
Single precision is measured on the cases whose input it can hold. Of two errors in the middle, the median is the
smaller. The numbers do not depend on the machine, because the kernels use only operations that IEEE 754 rounds
correctly.

<!-- ours -->
";

const COMPARISON: &str = "<!-- /ours -->

## Beside parry

The same triangles and links, asked of `parry::query::distance`: capsules and cylinders, which parry has too. Errors are
relative to the extent here. *As given*, nine in ten cases have an extent between 1 and 250. *x 1e-3* is the same
problem with all lengths multiplied by 1e-3, as when millimetres become metres; that rounds the input once more, for
parry and for this crate. parry stops on absolute tolerances, so its worst answers are those of the smallest problems.

An *over-estimate* reports more clearance than there is, by more than 1e-9 of the extent: the unsafe side. The last
column is the largest over-estimate relative to the true distance, among the cases whose distance is at least 1/1000 of
the extent.

";

fn main() -> ExitCode {
    let cases = distance_cases();
    let text = format!("{INTRODUCTION}{}{COMPARISON}{}", tables(&cases), comparison(&cases));
    match std::fs::write(FILE, text) {
        Ok(()) => {
            println!("{} cases, tables: {FILE}", cases.len());
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("error: cannot write {FILE} ({error})");
            ExitCode::FAILURE
        }
    }
}

/// A way to answer a case after its lengths are multiplied by a factor.
type Program = fn(&Case, f64) -> f64;
const PROGRAMS: [(&str, Program); 2] = [("this crate", distance::<f64>), ("parry", parry)];
const UNITS: [(&str, f64); 2] = [("as given", 1.0), ("x 1e-3", 1e-3)];

/// parry's distance between the triangle and the link of a case.
fn parry(case: &Case, factor: f64) -> f64 {
    let point = |p: [f64; 3]| Vector::from(p) * factor;
    let triangle = Triangle::new(point(case.tri[0]), point(case.tri[1]), point(case.tri[2]));
    let (start, end, radius) = (point(case.p0), point(case.p1), case.r * factor);
    let world = Pose::identity();
    let answer = if case.flat() == [true; 2] {
        // parry's cylinder stands on the y axis.
        let turn = (end - start)
            .try_normalize()
            .map_or(Rot3::IDENTITY, |axis| Rot3::from_rotation_arc(Vector::Y, axis));
        let pose = Pose::from_parts(start + (end - start) * 0.5, turn);
        query::distance(&world, &triangle, &pose, &Cylinder::new((end - start).length() * 0.5, radius))
    } else {
        query::distance(&world, &triangle, &world, &Capsule::new(start, end, radius))
    };
    answer.map_or(f64::NAN, |answer| answer.distance)
}

fn comparison(cases: &[Case]) -> String {
    let is_link = |case: &&Case| case.kind.contains("capsule") || case.kind.contains("cylinder");
    let alike = |case: &&Case, flat| is_link(case) && case.flat() == [flat; 2];
    let capsules: Vec<_> = cases.iter().filter(|case| alike(case, false)).collect();
    let cylinders: Vec<_> = cases.iter().filter(|case| alike(case, true)).collect();
    let mut text = String::from(
        "| link | cases | lengths | program | median | worst | off by > 1e-6 | over-estimates | largest, of the distance |\n\
         |---|---|---|---|---|---|---|---|---|\n",
    );
    for (name, cases) in [("capsule", &capsules), ("cylinder", &cylinders)] {
        for (unit, factor) in UNITS {
            for (program, answer) in PROGRAMS {
                let total = Total::of(cases, answer, factor);
                writeln!(text, "| {name} | {} | {unit} | {program} | {total} |", cases.len()).ok();
            }
        }
    }
    text += "\nThe worst error relative to the extent, and parry's over-estimates, by category:\n";
    for (name, cases) in [("Capsules", &capsules), ("Cylinders", &cylinders)] {
        write!(
            text,
            "\n### {name} by category\n\n| category | cases | this crate | parry | parry, x 1e-3 | over-estimates | x 1e-3 |\n|---|---|---|---|---|---|---|\n"
        )
        .ok();
        for category in categories(cases) {
            let some: Vec<_> = cases.iter().copied().filter(|case| case.cat == category).collect();
            let ours = Total::of(&some, distance::<f64>, 1.0);
            let [given, metres] = UNITS.map(|(_, factor)| Total::of(&some, parry, factor));
            writeln!(
                text,
                "| {} | {} | {} | {} | {} | {} | {} |",
                category.replace('_', " "),
                some.len(),
                digit(ours.worst),
                digit(given.worst),
                digit(metres.worst),
                given.over,
                metres.over
            )
            .ok();
        }
    }
    text
}

/// How a program does on some cases.
struct Total {
    median: f64,
    worst: f64,
    /// Errors beyond 1e-6 of the extent.
    off: usize,
    /// Over-estimates beyond 1e-9 of the extent.
    over: usize,
    /// The largest over-estimate relative to the distance.
    largest: f64,
}

impl Total {
    fn of(cases: &[&Case], answer: Program, factor: f64) -> Self {
        let signed: Vec<_> =
            cases.iter().map(|case| (answer(case, factor) / factor - case.distance()) / case.scale).collect();
        let (median, worst) =
            median_and_worst(signed.iter().map(|error| error.abs()).collect()).unwrap_or_default();
        let relative = signed.iter().zip(cases).filter(|(_, case)| case.distance() >= 1e-3 * case.scale);
        Self {
            median,
            worst,
            off: signed.iter().filter(|error| error.abs() > 1e-6).count(),
            over: signed.iter().filter(|&&error| error > 1e-9).count(),
            largest: relative.map(|(error, case)| error * case.scale / case.distance()).fold(0.0, f64::max),
        }
    }
}

impl std::fmt::Display for Total {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        let Self { median, worst, off, over, largest } = self;
        let [median, worst, largest] = [*median, *worst, *largest].map(digit);
        write!(f, "{median} | {worst} | {off} | {over} | {largest}")
    }
}

/// One digit and the power of ten.
fn digit(value: f64) -> String {
    if value == 0.0 { "0".into() } else { format!("{value:.0e}") }
}
