//! For this error, choose this: the guide of the README.

use crate::clock::Times;
use crate::front::Combination;
use crate::statistics::{Share, length};
use crate::subject::Model;
use continuum_studies::machine;
use std::fmt::Write;

/// The errors that are asked for, mm.
const ERRORS: [f64; 6] = [0.003, 0.01, 0.03, 0.1, 0.3, 1.0];

/// What the guide is made of.
pub struct Facts<'a> {
    pub command: &'a str,
    pub all: &'a [Combination],
    pub times: &'a Times,
    /// Free shapes that capsules forbid.
    pub forbidden: Share,
    /// By how much the clearance is off without torsion: in the median and at worst, mm.
    pub torsion: [f64; 2],
}

/// The guide.
pub fn text(facts: &Facts) -> String {
    let Facts { command, all, times, forbidden, torsion: [median, worst] } = facts;
    let time = |model: Model, way: &str| {
        let same = |one: &&Combination| one.model == model && one.way == way && one.tolerance == 0.1;
        all.iter().find(same).map_or(f64::NAN, |one| one.time)
    };
    let warm = time(Model::Modified, "search, warm");
    let simplifying = times.building.iter().map(|one| one.simplify * 1e6);
    let (quick, slow) =
        simplifying.fold((f64::INFINITY, 0.0_f64), |(low, high), us| (low.min(us), high.max(us)));
    let most = 100.0 * forbidden.count as f64 / forbidden.of.max(1) as f64;
    format!(
        "Measured by `{command}` on {}: a concentric tube robot of radius 1.25 to 0.5 mm in a ventricle, times of \
         `minimum` on one thread. [docs/TRADEOFF.md](docs/TRADEOFF.md) has the rest.\n\n\
         {}\n\
         - The links decide the error, the engine only the time: all engines agree. Within 0.1 mm, `Exhaustive::<f32>` \
         takes {:.0} times as long as the warm search, and parry's cylinders {:.0} times.\n\
         - A flat face is perpendicular to its link, not to the curve. In a fine chain that is the largest error. *Faces \
         fixed* cures it: let links end 0.3 and 0.01 mm before each face.\n\
         - To be on the safe side, ask `clears` with the worst error added to the margin.\n\
         - Capsules cover the tube, but forbade {most:.1} % of the free shapes. Cylinders have gaps at the bends and take {:.1} \
         times as long as modified cylinders.\n\
         - `simplify` took {quick:.0} to {slow:.0} us a shape. In a control loop choose the stations once.\n\
         - Leaving out that tubes twist changed the clearance by {} mm in the median, at worst {} mm.\n",
        machine::description(),
        table(all),
        time(Model::Modified, "exhaustive, f32") / warm,
        time(Model::ParryCylinder, "parry's search") / warm,
        time(Model::Cylinder, "search, warm") / warm,
        length(*median),
        length(*worst)
    )
}

/// The table: for each error the fastest of this crate's combinations that stays within it.
fn table(all: &[Combination]) -> String {
    let mut table = String::from(
        "| worst error allowed | model | `simplify` within | links | search, cold | search, warm | worst error measured |\n\
         |---|---|---|---|---|---|---|\n",
    );
    for error in ERRORS {
        // Cylinders have the errors of modified cylinders, and gaps.
        let models = [Model::Capsule, Model::Modified, Model::Faced];
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
            best.links,
            time("search, cold"),
            time("search, warm"),
            length(best.error)
        );
    }
    table
}
