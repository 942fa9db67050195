//! The page of the trade: what was measured, and what geometry says about it.

use crate::clock::Times;
use crate::front::{Combination, front};
use crate::guide;
use crate::outcome::{INPUT_SPACING, Outcome, REFERENCE_SPACING, TOLERANCES};
use crate::reference::Checked;
use crate::statistics::{Errors, length, quantile, signed};
use crate::subject::Model;
use continuum_studies::machine;
use std::fmt::Write;

/// The largest curvature of the robot's curve, 1 / mm: all tubes bend the same way.
const CURVATURE: f64 = 0.0523;

/// What the page is made of.
pub struct Facts<'a> {
    pub command: &'a str,
    pub triangles: usize,
    pub timed: usize,
    pub outcomes: &'a [Outcome],
    pub checked: &'a Checked,
    pub times: &'a Times,
    pub errors: &'a [[Errors; Model::ALL.len()]],
    /// What the page shows of the table of models.
    pub trade: &'a str,
    pub all: &'a [Combination],
    /// The largest radius of the robot.
    pub widest: f64,
    /// The GPU, if one took part.
    pub device: Option<&'a str>,
}

/// The page, without the chapters of the shares and of torsion.
pub fn page(facts: &Facts) -> String {
    let Facts {
        command,
        triangles,
        timed,
        outcomes,
        checked,
        times,
        errors,
        trade,
        all,
        widest,
        device,
    } = *facts;
    format!(
        "# What accuracy costs\n\n\
         Written by `{command}` on {}{}.\n\n\
         A concentric tube robot takes random shapes in a mesh of {triangles} triangles. Some may come out by up to 15 % of \
         the robot's length, some by up to 30 %, the others by up to 60 %. {}.\n\n\
         An error is the difference from the *true* clearance, that of the curved tube with flat end faces. A very fine chain \
         stands for it: its links are at most {REFERENCE_SPACING} mm long, and at the end faces a hundredth of that. Twice as \
         many links change its clearance by at most {} mm, four times as many by at most {} mm. {}. A round cap next to an end \
         face can stick out of the face by at most {} mm.\n\n\
         ## The trade\n\n\
         The query is `minimum`, the robot's clearance; it is asked for the first {timed} shapes that are free, on one \
         thread. Times are medians over the shapes, the chain already built. *First time*: without a warm start. \
         *Again*: with the answers of a shape a small step earlier (0.1 mm of each extension, 0.01 rad of each \
         angle). The search works \
         in f32 and the exhaustive engines in f32 or f64; all measure the candidates again in f64, so precision costs \
         time, not accuracy: here {}. parry is queried link by link (or sphere by sphere), each within the clearance \
         so far. *Error* is the model's clearance \
         less the true one, over all free shapes: positive is over, the unsafe side. The links stay within {SHOWN} mm, and the bounds of the *tube* (`clearance`) are \
         at most as far apart: the lower one counts; \
         [tradeoff_links.csv](tradeoff_links.csv) has all tolerances from {} to {} mm.\n\n{}\n{}\n\n\
         ![Worst error against the time of a query: the front, the tube with a warm start, and parry's shapes.](tradeoff.svg)\n\n\
         The front of the picture:\n\n{}\n\
         For an error that you can bear, the fastest row that stays within it:\n\n{}\n\
         ### What geometry predicts\n\n\
         `simplify` promises that the links' axis and the curve are within the tolerance of each other, and an error on \
         the side of a tube is no larger. A flat face follows the last link's direction. A chord of sagitta t turns by \
         sqrt(2 t kappa) from the curve's direction, so at a radius r the rim would be out of place by r sqrt(2 t kappa), here \
         at most with r = {widest} mm and kappa = {CURVATURE} / mm. The links at a face are therefore so short that its rim is \
         within the tolerance, too. A capsule's end reaches r beyond a flat face: its clearance falls short by up to r, at any \
         tolerance.\n\n{}\n\
         ### Before the query\n\n\
         From a curve with a point every {INPUT_SPACING} mm to the links, and from the links to the chain (medians):\n\n{}",
        machine::description(),
        device.map_or(String::new(), |name| format!(" and {name}")),
        clearances(outcomes),
        length(checked.halved),
        length(checked.quartered),
        by_algorithm_1(checked.algorithm_1),
        length(widest - (widest * widest - (0.5 * widest * widest * CURVATURE).powi(2)).sqrt()),
        agreement(times.apart),
        TOLERANCES[0],
        TOLERANCES[TOLERANCES.len() - 1],
        trade,
        base_cap(outcomes),
        front_table(all),
        guide::table(all),
        predictions(outcomes, errors, widest),
        building(times)
    )
}

/// The tolerance whose models the page compares; a file has all of them.
const SHOWN: f64 = 0.1;

/// Whether the page shows a row of the table of models.
pub fn is_shown(cells: &[&str]) -> bool {
    cells[1] == format!("{SHOWN} mm")
}

/// The table of all models at all tolerances.
pub fn table(times: &Times, errors: &[[Errors; Model::ALL.len()]]) -> String {
    let of_model =
        |index: usize, model| times.queries[index].iter().filter(move |timed| timed.model == model);
    let ways: Vec<_> = of_model(0, Model::ALL[0]).map(|timed| timed.way).collect();
    let mut page = format!(
        "| model | within | links | {} | error: median | worst over | worst under |\n{}\n",
        ways.join(" | "),
        "|---".repeat(6 + ways.len()) + "|"
    );
    for (which, model) in Model::ALL.into_iter().enumerate() {
        for (index, tolerance) in TOLERANCES.into_iter().enumerate() {
            let error = &errors[index][which];
            let links = of_model(index, model).next();
            let mut cells: Vec<_> =
                of_model(index, model).map(|timed| microseconds(timed.time)).collect();
            // parry has one way, a search without memory.
            cells.resize(ways.len(), String::new());
            // Writing to a string cannot fail.
            let _ = writeln!(
                page,
                "| {} | {tolerance} mm | {} | {} | {} | {} | {} |",
                model.name(),
                links.and_then(|timed| timed.links).map_or("-".into(), |links| links.to_string()),
                cells.join(" | "),
                signed(error.median),
                signed(error.over),
                signed(error.under),
            );
        }
    }
    page
}

/// The front, from the fastest to the most accurate.
fn front_table(all: &[Combination]) -> String {
    let mut page =
        String::from("| time | worst error | model | within | way |\n|---|---|---|---|---|\n");
    for one in front(all) {
        let _ = writeln!(
            page,
            "| {} | {} mm | {} | {} mm | {} |",
            microseconds(one.time),
            length(one.error),
            one.model.name(),
            one.tolerance,
            one.way
        );
    }
    page
}

/// What geometry predicts, beside what was measured.
fn predictions(outcomes: &[Outcome], errors: &[[Errors; Model::ALL.len()]], widest: f64) -> String {
    let mut page = String::from(
        "| within | face out of place: a chord of that sagitta | found | fitted caps: worst over | worst under | capsules: over | under |\n\
         |---|---|---|---|---|---|---|\n",
    );
    for (index, tolerance) in TOLERANCES.into_iter().enumerate() {
        let found = outcomes.iter().map(|shape| shape.each[index].tilt).fold(0.0, f64::max);
        let [capsules, _, modified, ..] = &errors[index];
        let _ = writeln!(
            page,
            "| {tolerance} mm | {} | {} | {} | {} | {} | {} |",
            length(widest * (2.0 * tolerance * CURVATURE).sqrt()),
            length(found),
            signed(modified.over),
            signed(modified.under),
            signed(capsules.over),
            signed(capsules.under),
        );
    }
    page
}

/// How the chains that users build compare with the reference.
fn by_algorithm_1(apart: f64) -> String {
    if apart == 0.0 {
        "`Chain::from_centreline` with the same links gives the same clearances".into()
    } else {
        format!(
            "`Chain::from_centreline` with the same links differs by at most {} mm",
            length(apart)
        )
    }
}

fn agreement(apart: f64) -> String {
    if apart == 0.0 {
        "all engines agree to the last bit".into()
    } else {
        format!("two engines differ by at most {apart:.0e} mm")
    }
}

/// What the base's cap does to capsules.
fn base_cap(outcomes: &[Outcome]) -> String {
    let free: Vec<_> = outcomes.iter().filter(|shape| shape.truth > 0.0).collect();
    let others: Vec<_> = free.iter().filter(|shape| !shape.cap_at_base).collect();
    let k = Model::Capsule.index();
    let errors = Errors::of(others.iter().map(|shape| shape.each[0].clearances[k] - shape.truth));
    format!(
        "In {} of the {} free shapes it is the round cap at the robot's base that is nearest if links are capsules: it \
         reaches back towards the wall around the entry. In the other {} the error of capsules within {} mm is {} mm in the \
         median and at worst {} mm.",
        free.len() - others.len(),
        free.len(),
        others.len(),
        TOLERANCES[0],
        signed(errors.median),
        signed(errors.under)
    )
}

/// What comes before a query.
fn building(times: &Times) -> String {
    let mut page = String::from("| within | links | `simplify` | the chain |\n|---|---|---|---|\n");
    for (building, tolerance) in times.building.iter().zip(TOLERANCES) {
        let _ = writeln!(
            page,
            "| {tolerance} mm | {} | {} | {} |",
            building.links,
            microseconds(building.simplify),
            microseconds(building.chain)
        );
    }
    page
}

/// The longest and the middle clearance, to know what the errors are to be compared with.
fn clearances(outcomes: &[Outcome]) -> String {
    let free: Vec<_> =
        outcomes.iter().map(|shape| shape.truth).filter(|&truth| truth > 0.0).collect();
    let base = outcomes.iter().filter(|shape| shape.truth > 0.0 && shape.at_base).count();
    format!(
        "{} of the {} shapes do not touch the wall. Their clearance is {} mm in the median and at most {} mm; in {} of \
         them it is the face at the base that is nearest to the wall",
        free.len(),
        outcomes.len(),
        length(quantile(free.clone(), 0.5).unwrap_or(0.0)),
        length(free.iter().copied().fold(0.0, f64::max)),
        base
    )
}

fn microseconds(seconds: f64) -> String {
    let us = seconds * 1e6;
    if us < 100.0 { format!("{us:.1} us") } else { format!("{us:.0} us") }
}
