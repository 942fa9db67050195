//! For this error, choose this: the guide of the README.

use crate::front::Combination;
use crate::machine;
use crate::statistics::length;
use crate::subject::Model;
use std::fmt::Write;

/// The errors that are asked for, mm.
const ERRORS: [f64; 5] = [0.02, 0.05, 0.1, 0.3, 1.0];

/// The guide.
pub fn text(command: &str, all: &[Combination]) -> String {
    format!("Measured by `{command}` on {}.\n\n{}", machine::description(), table(all))
}

/// The table: for each error the fastest of this crate's combinations that stays within it.
fn table(all: &[Combination]) -> String {
    let mut table = String::from(
        "| worst error allowed | model | `simplify` within | links | search, cold | search, warm | worst error measured |\n\
         |---|---|---|---|---|---|---|\n",
    );
    for error in ERRORS {
        let ours = |one: &&Combination| Model::OURS.contains(&one.model) && one.error <= error;
        let best = all.iter().filter(ours).min_by(|a, b| a.time.total_cmp(&b.time));
        let Some(best) = best else { continue };
        let time = |way: &str| {
            let same = |one: &&Combination| {
                one.model == best.model && one.tolerance == best.tolerance && one.way == way
            };
            all.iter().find(same).map_or("-".into(), |one| format!("{:.1} us", one.time * 1e6))
        };
        // Writing to a string cannot fail.
        let _ = writeln!(
            table,
            "| {error} mm | {} | {} mm | {} | {} | {} | {} mm |",
            best.model.name(),
            best.tolerance,
            best.links,
            time("search, cold"),
            time("search, warm"),
            length(best.error)
        );
    }
    table
}
