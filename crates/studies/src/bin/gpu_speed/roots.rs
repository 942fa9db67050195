//! Table V: roots of random polynomials by the four finders.

use crate::timed::{medians, milliseconds};
use crate::{Opened, text};
use continuum_studies::long_table;
use real_polynomial_roots::gpu::{Finder, GpuRoots};
use std::fmt::Write;
use std::path::Path;
use std::time::Duration;

const DEGREES: [usize; 7] = [2, 3, 4, 6, 8, 10, 15];
/// Degrees on the page.
const SHOWN: [&str; 3] = ["4", "8", "15"];

/// The chapter of the page, and its whole table beside it in `out`.
pub fn chapter(
    opened: &[Opened],
    count: usize,
    enough: Duration,
    out: &Path,
) -> Result<String, String> {
    let introduction = format!(
        "## Table V: roots of random polynomials\n\n\
         {count} polynomials of each degree, coefficients uniform in [-100, 100], a thread each. Milliseconds by the \
         device's clock, and with transfers; and the share of the roots that converged. Unlike on the CPU no root is tested \
         afterwards. In double precision the closed form's cosines and cube roots start in single precision. \
         [gpu_roots.csv](gpu_roots.csv) has all degrees.\n\n"
    );
    let mut table = String::from("| degree | finder |");
    for opened in opened {
        write!(table, " {} device | end to end | converged |", opened.name).map_err(text)?;
    }
    writeln!(table, "\n|---|---|{}", "---|---|---|".repeat(opened.len())).map_err(text)?;
    let mut state = 5_u64;
    let mut number = || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 * 2.0_f64.powi(-53) * 200.0 - 100.0
    };
    for degree in DEGREES {
        let coefficients: Vec<f64> = (0..count * (degree + 1)).map(|_| number()).collect();
        for finder in Finder::ALL {
            if finder == Finder::ClosedForm && degree > 4 {
                continue;
            }
            write!(table, "| {degree} | {finder:?} |").map_err(text)?;
            for opened in opened {
                let mut roots = GpuRoots::new(opened.gpu.device(), finder, degree).map_err(text)?;
                let mut out = Vec::new();
                let timed = medians(
                    &mut [&mut || {
                        roots.solve(&coefficients, &mut out).map_err(text)?;
                        Ok(roots.device_time())
                    }],
                    enough,
                )?;
                let found =
                    out.iter().filter(|root| !root.re.is_nan()).count() as f64 / out.len() as f64;
                write!(
                    table,
                    " {} | {} | {:.2} % |",
                    milliseconds(timed[0].device),
                    milliseconds(Some(timed[0].whole)),
                    100.0 * found
                )
                .map_err(text)?;
            }
            table.push('\n');
        }
    }
    let is_shown = |cells: &[&str]| SHOWN.contains(&cells[0]);
    Ok(introduction + &long_table::write(&table, &out.join("gpu_roots.csv"), is_shown)?)
}
