//! The shapes that a model wrongly forbids or wrongly allows.

use crate::outcome::{METRES_AT, Outcome, TOLERANCES};
use crate::statistics::{Share, length};
use crate::subject::Model;
use continuum_studies::long_table;
use std::fmt::Write;
use std::path::Path;

/// The margins at which a shape is accepted, mm: its clearance must be larger.
const MARGINS: [f64; 2] = [0.0, 0.5];

/// The tolerances that are shown: fine, middle and coarse.
const SHOWN: [usize; 3] = [2, 4, 6];

/// The free shapes that a model takes for touching, within the middle tolerance.
pub fn forbidden(outcomes: &[Outcome], model: Model) -> Share {
    let free = outcomes.iter().filter(|shape| shape.truth > 0.0);
    Share::of(free, |shape| shape.each[SHOWN[1]].clearances[model.index()] <= 0.0)
}

/// The chapter of the page; its long table goes to `out`.
pub fn chapter(outcomes: &[Outcome], out: &Path) -> Result<String, String> {
    let page = format!(
        "## What a model forbids and allows\n\n\
         A model *accepts* a shape if its clearance is larger than a margin. It wrongly *forbids* a shape that the true \
         clearance accepts, and wrongly *allows* one that the true clearance does not. Margin 0: free, or touching the \
         wall. Shares of the {} shapes that are truly accepted or not, with 95 % confidence (Wilson). The links stay within \
         {} mm; [tradeoff_decisions.csv](tradeoff_decisions.csv) has finer and coarser ones, and the margin of {} mm.\n\n",
        outcomes.len(),
        TOLERANCES[SHOWN[1]],
        MARGINS[1]
    );
    let mut table = String::from(
        "| model | within | margin | accepted shapes wrongly forbidden | others wrongly allowed |\n|---|---|---|---|---|\n",
    );
    for margin in MARGINS {
        for model in Model::ALL {
            // parry's answers equal the answers for capsules and cylinders up to the error of GJK,
            // which has its own table.
            for tolerance in if Model::OURS.contains(&model) || model == Model::Tube {
                &SHOWN[..]
            } else {
                &SHOWN[1..2]
            } {
                let tolerance = *tolerance;
                let model_of = |shape: &&Outcome| shape.each[tolerance].clearances[model.index()];
                let forbids =
                    Share::of(outcomes.iter().filter(|shape| shape.truth > margin), |shape| {
                        model_of(shape) <= margin
                    });
                let allows =
                    Share::of(outcomes.iter().filter(|shape| shape.truth <= margin), |shape| {
                        model_of(shape) > margin
                    });
                // Writing to a string cannot fail.
                let _ = writeln!(
                    table,
                    "| {} | {} mm | {margin} mm | {forbids} | {allows} |",
                    model.name(),
                    TOLERANCES[tolerance]
                );
            }
        }
    }
    let [within, margin] = [TOLERANCES[SHOWN[1]], MARGINS[0]].map(|mm| format!("{mm} mm"));
    let table = long_table::write(&table, &out.join("tradeoff_decisions.csv"), |cells| {
        [cells[1], cells[2]] == [within.as_str(), margin.as_str()]
    })?;
    Ok(page + &table + &alone(outcomes))
}

/// What the gaps of cylinders do alone, and the iterations of GJK: against the same links without
/// them.
fn alone(outcomes: &[Outcome]) -> String {
    let mut page = String::from(
        "\n### Gaps alone, and GJK alone\n\n\
         The rows above mix causes. Here two models have the same links, so one thing differs: the gaps between \
         cylinders at the bends, or GJK in place of exact distances. Differences over all shapes, in mm. *Wrongly \
         allowed*: shapes that touch the wall in the second model and are free in the first.\n\n\
         | alone | within | most above | most below | wrongly allowed |\n|---|---|---|---|---|\n",
    );
    let mut row = |name: &str, tolerance: usize, pair: &dyn Fn(&Outcome) -> (f64, f64)| {
        let pairs: Vec<_> = outcomes.iter().map(pair).collect();
        let off = |a: f64, (one, other): &(f64, f64)| a.max(one - other);
        let above = pairs.iter().fold(0.0, off);
        let below =
            pairs.iter().map(|&(one, other)| (other, one)).fold(0.0, |a, pair| off(a, &pair));
        let allowed =
            Share::of(pairs.iter().filter(|(_, exact)| *exact <= 0.0), |(one, _)| *one > 0.0);
        let _ = writeln!(
            page,
            "| {name} | {} mm | {} | {} | {allowed} |",
            TOLERANCES[tolerance],
            length(above),
            length(below)
        );
    };
    let pair = |one: Model, other: Model, tolerance: usize| {
        move |shape: &Outcome| {
            let each = &shape.each[tolerance].clearances;
            (each[one.index()], each[other.index()])
        }
    };
    for tolerance in SHOWN {
        row(
            "gaps: cylinders beside fitted caps",
            tolerance,
            &pair(Model::Cylinder, Model::Modified, tolerance),
        );
    }
    for tolerance in [SHOWN[0], SHOWN[1]] {
        row(
            "GJK: parry's Capsule beside capsules",
            tolerance,
            &pair(Model::ParryCapsule, Model::Capsule, tolerance),
        );
        row(
            "GJK: parry's Cylinder beside cylinders",
            tolerance,
            &pair(Model::ParryCylinder, Model::Cylinder, tolerance),
        );
    }
    for (index, model) in [Model::Capsule, Model::Cylinder].into_iter().enumerate() {
        let name =
            format!("GJK: the same in metres, {}", if index == 0 { "Capsule" } else { "Cylinder" });
        row(&name, METRES_AT, &|shape| {
            (shape.metres[index], shape.each[METRES_AT].clearances[model.index()])
        });
    }
    page
}
