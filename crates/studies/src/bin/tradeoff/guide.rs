//! For this error, choose this: the guide of the book, and the table of links for an error.

use crate::clock::Times;
use crate::from_samples::FromSamples;
use crate::front::Combination;
use crate::statistics::{Share, length};
use crate::subject::Model;
use continuum_studies::machine;
use std::fmt::Write;

/// The errors of the table, mm.
const ERRORS: [f64; 6] = [0.003, 0.01, 0.03, 0.1, 0.3, 1.0];

/// What the guide is made of.
pub struct Facts<'a> {
    pub command: &'a str,
    pub all: &'a [Combination],
    pub times: &'a Times,
    pub from_samples: &'a [FromSamples],
    /// Free shapes that capsules forbid.
    pub forbidden: Share,
    /// By how much the clearance is off without torsion: in the median and at worst, mm.
    pub torsion: [f64; 2],
}

/// The guide.
pub fn text(facts: &Facts) -> String {
    let Facts { command, all, times, from_samples, forbidden, torsion: [median, worst] } = facts;
    let time = |model: Model, way: &str| {
        let same =
            |one: &&Combination| one.model == model && one.way == way && one.tolerance == 0.1;
        all.iter().find(same).map_or(f64::NAN, |one| one.time)
    };
    let again = time(Model::Modified, "search, again");
    let same = |one: &&Combination| one.model == Model::Modified && one.tolerance == 0.1;
    let worst_of_links = all.iter().find(same).map_or(f64::NAN, |one| one.error);
    let simplifying = times.building.iter().map(|one| one.simplify * 1e6);
    let (quick, slow) =
        simplifying.fold((f64::INFINITY, 0.0_f64), |(low, high), us| (low.min(us), high.max(us)));
    let most = 100.0 * forbidden.count as f64 / forbidden.of.max(1) as f64;
    format!(
        "**Take a `Tube`, and call `clearance` or `clears_tube` with the error that you can bear.** The bounds hold for your \
         curve, and the larger the error, the less the query does.\n\n\
         Measured by `{command}` on {}: a concentric tube robot of radius 1.25 to 0.5 mm in a ventricle of {} triangles. Times \
         from about 270 samples of a new shape to its clearance, on one thread:\n\n\
         {}\n\
         Links instead of a curve suit parry, rapier and robots that are made of rigid parts:\n\n\
         - The links decide the error, the engine only the time. `docs/TRADEOFF.md` has a table of links for an \
         error. Links within 0.1 mm of the curve err by at most {} mm, and a query takes {:.1} us in a loop. \
         `Exhaustive::<f32>` takes {:.0} times as long, and parry's cylinders {:.0} times.\n\
         - Capsules cover the tube, but forbade {most:.1} % of the free shapes. Cylinders leave gaps at the bends.\n\
         - `simplify` took {quick:.0} to {slow:.0} us for a free shape.\n\
         - Leaving out that tubes twist changed the clearance by {} mm in the median, at worst {} mm.\n",
        machine::description(),
        from_samples.first().map_or(0, |row| row.triangles),
        samples_table(from_samples),
        length(worst_of_links),
        again * 1e6,
        time(Model::Modified, "exhaustive, f32") / again,
        time(Model::ParryCylinder, "parry's search") / again,
        length(*median),
        length(*worst)
    )
}

/// From samples to a clearance: a tube beside links chosen for the same error.
fn samples_table(rows: &[FromSamples]) -> String {
    let mut table = String::from(
        "| error | free shape: `Tube` | `simplify` and a chain | touching shape: `Tube` | `simplify` and a chain |\n\
         |---|---|---|---|---|\n",
    );
    for row in rows {
        let [[free_tube, free_links], [tube, links]] =
            row.free_and_touching.map(|times| times.map(|time| time * 1e6));
        // Writing to a string cannot fail.
        let _ = writeln!(
            table,
            "| {} mm | {free_tube:.1} us | {free_links:.1} us | {tube:.1} us | {links:.1} us |",
            row.tolerance
        );
    }
    table
}

/// The table: for each error the fastest of this crate's combinations that stays within it.
pub fn table(all: &[Combination]) -> String {
    let mut table = String::from(
        "| worst error allowed | model | within | links | search, first time | search, again | worst error measured |\n\
         |---|---|---|---|---|---|---|\n",
    );
    for error in ERRORS {
        // Cylinders have the errors of modified cylinders, and gaps.
        let models = [Model::Capsule, Model::Modified, Model::Tube];
        let ours = |one: &&Combination| models.contains(&one.model) && one.error <= error;
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
            best.links.map_or("-".into(), |links| links.to_string()),
            time("search, first time"),
            time("search, again"),
            length(best.error)
        );
    }
    table
}
