//! What was measured at the extremes, as tables and as one line for each pair, category and
//! precision.

use super::measure::{Found, Measurement, PAIRS};
use super::problems::Extreme;
use super::reference::median_and_worst;
use crate::long_table::shown;
use std::fmt::Write;

/// The instruction sets that have columns in the file.
pub const LEVELS: [&str; 3] = ["AVX-512", "AVX2", "SSE2"];

/// Median and worst of some errors.
pub fn cell(errors: Vec<f64>) -> String {
    match median_and_worst(errors) {
        Some((median, worst)) => format!("{median:.2},{worst:.2}"),
        None => "-,-".into(),
    }
}

/// One line for each precision, category and pair. `peer` writes the columns of parry.
pub fn lines(
    measurement: &Measurement,
    mut peer: impl FnMut(Extreme, &[usize]) -> String,
) -> Vec<String> {
    let mut lines = Vec::new();
    for (extreme, category, _) in Extreme::ALL {
        for (pair, kernels) in PAIRS {
            let here = |found: &&Found| found.extreme == extreme && kernels.contains(&found.kernel);
            let found: Vec<_> = measurement.found.iter().filter(here).collect();
            let scalar = cell(found.iter().map(|found| found.scalar).collect());
            let mut line =
                format!("{},{category},{pair},{},{scalar}", measurement.precision, found.len());
            for level in LEVELS {
                let index = measurement.levels.iter().position(|name| *name == level);
                let errors = |index: usize| {
                    found.iter().filter_map(|f| f.levels.get(index).copied()).collect()
                };
                write!(line, ",{}", cell(index.map(errors).unwrap_or_default())).ok();
            }
            write!(line, ",{}", peer(extreme, kernels)).ok();
            lines.push(line);
        }
    }
    lines
}

/// The head of the lines.
pub fn head() -> String {
    let levels = LEVELS.map(|level| format!("{level} median,{level} worst")).join(",");
    format!(
        "precision,category,pair,problems,scalar median,scalar worst,{levels},parry median,parry worst"
    )
}

/// The categories on the page, the worst of all among them; a file has the others too.
const SHOWN: [&str; 10] = [
    "generic",
    "parallel",
    "near parallel",
    "contact",
    "needle",
    "sliver",
    "short link",
    "long link",
    "offset",
    "scale",
];

/// What the page shows of the scalar errors, which are the same on every machine.
pub fn tables(double: &Measurement, single: &Measurement, ranges: [[i32; 2]; 2]) -> String {
    let categories = shown(&by_category(double, single), |cells| SHOWN.contains(&cells[0]));
    let pairs = shown(&by_pair(double, single), |cells| is_pair_shown(cells[0]));
    let [[low, high], [single_low, single_high]] = ranges;
    format!(
        "{categories}\nBy pair, over all categories ([accuracy_pairs.csv](accuracy_pairs.csv) has the plane and the disc too):\n\n{pairs}\n\
         The usable range: problems of a size from 2^{low} to 2^{high} in f64 and from 2^{single_low} to 2^{single_high} \
         in f32 are answered within 16 units. No proof left more than {:.1} units open.\n",
        double.gap.max(single.gap)
    )
}

/// Whether the page shows a pair: not the plane, which is no part of a mesh.
pub fn is_pair_shown(pair: &str) -> bool {
    pair != "plane and disc"
}

/// The scalar errors of all pairs in each category.
pub fn by_category(double: &Measurement, single: &Measurement) -> String {
    let mut text = String::from(
        "| category | what it is | f64: answers | median | worst | f32: answers | median | worst |\n\
         |---|---|---|---|---|---|---|---|\n",
    );
    for (extreme, name, what) in Extreme::ALL {
        let of = |measurement| row(measurement, |found| found.extreme == extreme);
        writeln!(text, "| {name} | {what} | {} | {} |", of(double), of(single)).ok();
    }
    text
}

/// The scalar errors of each pair over all categories.
pub fn by_pair(double: &Measurement, single: &Measurement) -> String {
    let mut text = String::from(
        "| pair | f64: answers | median | worst | f32: answers | median | worst |\n|---|---|---|---|---|---|---|\n",
    );
    for (name, kernels) in PAIRS {
        let of = |measurement| row(measurement, |found| kernels.contains(&found.kernel));
        writeln!(text, "| {name} | {} | {} |", of(double), of(single)).ok();
    }
    text
}

/// The worst error of any pair at each power of ten: a line for each power, a column for each
/// category and precision.
pub fn powers(double: &Measurement, single: &Measurement) -> String {
    let series: Vec<_> =
        Extreme::ALL.into_iter().filter(|(extreme, ..)| extreme.powers(16) > 0).collect();
    let names: Vec<_> =
        series.iter().map(|(_, name, _)| format!("{name} f64,{name} f32")).collect();
    let mut text = format!("k,{}\n", names.join(","));
    for power in 1..=16 {
        write!(text, "{power}").ok();
        for (extreme, ..) in &series {
            for measurement in [double, single] {
                let here = |found: &&Found| found.extreme == *extreme && found.power == power;
                let errors = measurement.found.iter().filter(here).map(|found| found.scalar);
                let worst =
                    errors.reduce(f64::max).map_or("-".into(), |worst| format!("{worst:.1}"));
                write!(text, ",{worst}").ok();
            }
        }
        text.push('\n');
    }
    text
}

fn row(measurement: &Measurement, of: impl Fn(&Found) -> bool) -> String {
    let errors: Vec<_> =
        measurement.found.iter().filter(|found| of(found)).map(|f| f.scalar).collect();
    let count = errors.len();
    match median_and_worst(errors) {
        Some((median, worst)) => format!("{count} | {median:.2} | {worst:.2}"),
        None => "0 | - | -".into(),
    }
}
