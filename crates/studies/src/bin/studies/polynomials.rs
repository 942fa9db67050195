//! Table V: roots of random polynomials by the four finders.

use super::turns::in_turns;
use continuum_studies::long_table;
use continuum_testing::Random;
use rayon::prelude::*;
use real_polynomial_roots::*;
use std::fmt::Write;
use std::hint::black_box;
use std::path::Path;

/// On one thread the finders take turns with this many parts of the polynomials, each this small a
/// share of all.
const TURNS: usize = 20;
const SHARE: usize = 200;
/// The degrees of the page: the quartics that discs lead to, and larger ones.
const SHOWN: [&str; 3] = ["4", "8", "15"];
const FINDERS: [&str; 4] = ["closed form", "Bairstow", "companion", "Jenkins-Traub"];

/// The paper's milliseconds for 1e6 polynomials: degree, finder, then CPU float, CPU double, GPU
/// float, GPU double.
const PAPER: [(usize, usize, [f64; 4]); 24] = [
    (2, 0, [8.70, 12.82, 2.65, 4.07]),
    (2, 1, [8.58, 13.35, 2.59, 4.11]),
    (2, 2, [9.08, 14.71, 3.04, 4.66]),
    (2, 3, [8.56, 14.67, 2.66, 4.32]),
    (3, 0, [15.44, 32.54, 2.21, 15.44]),
    (3, 1, [44.80, 53.30, 3.19, 11.77]),
    (3, 2, [70.44, 115.71, 6.53, 26.18]),
    (3, 3, [78.82, 112.19, 24.66, 51.11]),
    (4, 0, [31.83, 38.27, 4.35, 17.25]),
    (4, 1, [69.67, 114.40, 5.91, 22.51]),
    (4, 2, [200.54, 270.40, 14.20, 69.78]),
    (4, 3, [153.04, 185.10, 76.12, 163.36]),
    (6, 1, [179.0, 295.0, 12.0, 27.0]),
    (6, 2, [478.0, 758.0, 47.0, 167.0]),
    (6, 3, [357.0, 441.0, 222.0, 537.0]),
    (8, 1, [312.0, 397.0, 34.0, 97.0]),
    (8, 2, [936.0, 1534.0, 167.0, 348.0]),
    (8, 3, [665.0, 826.0, 467.0, 986.0]),
    (10, 1, [430.0, 663.0, 53.0, 135.0]),
    (10, 2, [1604.0, 2430.0, 281.0, 653.0]),
    (10, 3, [955.0, 1134.0, 802.0, 1817.0]),
    (15, 1, [1134.0, 1190.0, 173.0, 426.0]),
    (15, 2, [3752.0, 5867.0, 1631.0, 2598.0]),
    (15, 3, [1968.0, 2321.0, 2105.0, 4230.0]),
];

/// What a finder does with the polynomials of one degree.
#[derive(Clone, Copy)]
struct Outcome {
    /// Seconds for all polynomials on one thread, and on all.
    one: f64,
    all: f64,
    /// Share of all roots that were found.
    found: f64,
}

/// What counts the roots that a finder finds.
type Finder<T, const M: usize> = fn(&[[T; M]]) -> usize;

fn found<F: RootFinder, T: Real, const M: usize>(polynomials: &[[T; M]]) -> usize {
    polynomials
        .iter()
        .map(|coefficients| match black_box(F::roots(*coefficients)) {
            Ok(roots) | Err(RootsError::NotConverged { found: roots }) => roots.len(),
            Err(_) => 0,
        })
        .sum()
}

/// All finders on polynomials of degree M - 1.
fn outcomes<T: Real + Send + Sync, const M: usize>(count: usize) -> [Outcome; 4] {
    let mut random = Random::new(M as u64);
    let polynomials: Vec<[T; M]> =
        (0..count).map(|_| std::array::from_fn(|_| T::of(random.between(-100.0, 100.0)))).collect();
    let finders: [Finder<T, M>; 4] = [
        found::<ClosedForm, T, M>,
        found::<Bairstow, T, M>,
        found::<Companion, T, M>,
        found::<JenkinsTraub, T, M>,
    ];
    let part = count.div_ceil(SHARE);
    let piece = |turn: usize| polynomials.chunks(part).nth(turn).unwrap_or_default();
    let one = in_turns(
        TURNS,
        [
            &mut |turn| _ = black_box(finders[0](piece(turn))),
            &mut |turn| _ = black_box(finders[1](piece(turn))),
            &mut |turn| _ = black_box(finders[2](piece(turn))),
            &mut |turn| _ = black_box(finders[3](piece(turn))),
        ],
    );
    std::array::from_fn(|i| {
        let mut found = 0;
        let [all] =
            in_turns(1, [&mut |_| found = polynomials.par_chunks(1000).map(finders[i]).sum()]);
        Outcome {
            one: one[i] * count as f64 / part as f64,
            all,
            found: found as f64 / (count * (M - 1)) as f64,
        }
    })
}

/// The chapter of the page; its long table goes to `out`.
pub fn chapter(count: usize, out: &Path) -> Result<String, String> {
    let both = |degree: usize| -> [[Outcome; 4]; 2] {
        match degree {
            2 => [outcomes::<f32, 3>(count), outcomes::<f64, 3>(count)],
            3 => [outcomes::<f32, 4>(count), outcomes::<f64, 4>(count)],
            4 => [outcomes::<f32, 5>(count), outcomes::<f64, 5>(count)],
            6 => [outcomes::<f32, 7>(count), outcomes::<f64, 7>(count)],
            8 => [outcomes::<f32, 9>(count), outcomes::<f64, 9>(count)],
            10 => [outcomes::<f32, 11>(count), outcomes::<f64, 11>(count)],
            _ => [outcomes::<f32, 16>(count), outcomes::<f64, 16>(count)],
        }
    };
    let measured: Vec<_> = [2, 3, 4, 6, 8, 10, 15].map(|degree| (degree, both(degree))).into();
    let table = table(&measured).map_err(|error| error.to_string())?;
    let is_shown = |cells: &[&str]| SHOWN.contains(&cells[0]);
    let table = long_table::write(&table, &out.join("studies_roots.csv"), is_shown)?;
    Ok(page(count, &table) + &findings(&measured))
}

type Measured = (usize, [[Outcome; 4]; 2]);

fn page(count: usize, table: &str) -> String {
    let threads = rayon::current_num_threads();
    let [low, middle, high] = SHOWN;
    format!(
        "## Table V: roots of random polynomials\n\n\
         {count} polynomials of each degree, coefficients uniform in [-100, 100], one polynomial at a time: milliseconds on \
         one thread (from the median of {TURNS} parts of 1/{SHARE} each), and on all {threads} (in one go); and the share of the roots that were found. Every root is tested, in the time \
         given: one that does not solve the polynomial to rounding counts as not found. (The finders branch at every step, \
         so lanes of one pack would wait for each other; there is no packed version.) The last columns are multiples of \
         the closed form's time at degree 4: ours on one thread, and the paper's on its CPU and its GPU. Degrees {low}, \
         {middle} and {high}; [studies_roots.csv](studies_roots.csv) has all from 2 to 15.\n\n{table}"
    )
}

/// Every finder at every degree.
fn table(measured: &[Measured]) -> Result<String, std::fmt::Error> {
    let mut page = String::from(
        "| degree | finder | f32: ms | all threads | found | f64: ms | all threads | found | f32 ratio: ours | paper CPU | GPU | \
         f64 ratio: ours | paper CPU | GPU |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
    );
    let at = |degree: usize| measured.iter().find(|m| m.0 == degree).map(|m| m.1);
    let Some(unit) = at(4).map(|both| both.map(|finders| finders[0].one)) else { return Ok(page) };
    let paper_unit = [31.83, 38.27, 4.35, 17.25];
    for (degree, finder, paper) in PAPER {
        let Some(both) = at(degree) else { continue };
        write!(page, "| {degree} | {} |", FINDERS[finder])?;
        for finders in both {
            let Outcome { one, all, found } = finders[finder];
            write!(page, " {:.0} | {:.0} | {} |", one * 1e3, all * 1e3, percent(found))?;
        }
        for (precision, finders) in both.into_iter().enumerate() {
            let [cpu, gpu] =
                [precision, precision + 2].map(|column| paper[column] / paper_unit[column]);
            write!(page, " {:.2} | {cpu:.2} | {gpu:.2} |", finders[finder].one / unit[precision])?;
        }
        writeln!(page)?;
    }
    Ok(page)
}

/// All roots, or a percentage that does not hide a missing one.
pub fn percent(share: f64) -> String {
    if share == 1.0 { "all".into() } else { format!("{:.5} %", 100.0 * share) }
}

/// The paper's findings, each beside what was measured.
fn findings(measured: &[Measured]) -> String {
    // Whether one finder takes less time than others at these degrees, in both precisions.
    let faster = |one: usize, others: &[usize], low: usize, high: usize| {
        let rows = measured.iter().filter(|m| (low..=high).contains(&m.0)).flat_map(|m| m.1);
        let (mut yes, mut all) = (0, 0);
        for finders in rows {
            for other in others {
                yes += usize::from(finders[one].one < finders[*other].one);
                all += 1;
            }
        }
        match yes {
            0 => "refuted".to_string(),
            y if y == all => "confirmed".to_string(),
            y => format!("confirmed in {y} of {all} comparisons"),
        }
    };
    format!(
        "\nFindings: the closed form is the fastest up to degree 4: {}. Bairstow's method is the fastest of the other three \
         from degree 3: {}. Jenkins-Traub is faster than the companion matrix on a CPU: {}. Here each finder is safeguarded: \
         scaled, tested, and started anew where it fails, which the paper's were not.\n",
        faster(0, &[1, 2, 3], 2, 4),
        faster(1, &[2, 3], 3, 15),
        faster(3, &[2], 2, 15),
    )
}
