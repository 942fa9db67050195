//! The part of the page that a GPU writes.

use continuum_studies::accuracy::measure::Problem;
use continuum_studies::accuracy::{
    gpu,
    measure::{Found, PAIRS},
    tables::{cell, is_pair_shown},
};
use parry_continuum::gpu::{Gpu, Precision};
use std::path::Path;

/// Measures the GPU, and writes the table by category beside the page. None where there is no GPU,
/// or where it is one in software and another was measured before.
///
/// # Errors
/// The GPU fails, or the table cannot be written.
pub fn section(
    docs: &Path,
    before: &str,
    double: &[Problem<f64>],
    single: &[Problem<f32>],
) -> Result<Option<String>, String> {
    let opened = match Gpu::open(Precision::F32) {
        Ok(opened) => opened,
        Err(error) => {
            println!("{error}");
            return Ok(None);
        }
    };
    let was_measured = before.contains("Measured on") && !before.contains("in software");
    if opened.adapter().is_software && was_measured {
        return Ok(None);
    }
    let mut text = format!("Measured on {}.\n\n", opened.adapter());
    let error = |error| format!("{error}");
    let mut measured = Vec::new();
    match Gpu::open(Precision::F64) {
        Ok(opened) => measured.push(("f64", gpu::measure(&opened, double).map_err(error)?)),
        Err(error) => text += &format!("{error}.\n\n"),
    }
    measured.push(("f32", gpu::measure(&opened, single).map_err(error)?));
    let mut lines = vec![gpu::HEAD.to_owned()];
    measured.iter().for_each(|(precision, found)| lines.extend(gpu::lines(precision, found)));
    crate::save(&docs.join("accuracy_gpu.csv"), &(lines.join("\n") + "\n"))?;
    text += &table(&measured);
    text += "\n[accuracy_gpu.csv](accuracy_gpu.csv) has each category by itself.\n";
    Ok(Some(text))
}

/// The errors by pair.
fn table(measured: &[(&str, Vec<Found>)]) -> String {
    let mut text = String::from("| pair |");
    measured
        .iter()
        .for_each(|(precision, _)| text += &format!(" {precision} median | {precision} worst |"));
    text += &format!("\n|---|{}\n", "---|---|".repeat(measured.len()));
    for (pair, kernels) in PAIRS.into_iter().filter(|(pair, _)| is_pair_shown(pair)) {
        text += &format!("| {pair} |");
        for (_, found) in measured {
            let here = |found: &&Found| kernels.contains(&found.kernel);
            let errors = found.iter().filter(here).map(|found| found.scalar).collect();
            text += &format!(" {} |", cell(errors).replace(',', " | "));
        }
        text.push('\n');
    }
    text
}
