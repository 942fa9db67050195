//! How much it matters that tubes twist, beside the model of the links.

use crate::outcome::{Outcome, TOLERANCES};
use crate::shapes::Stations;
use crate::statistics::{Share, length, quantile};
use crate::subject::Model;
use crate::ways::text;
use continuum_demo::ctr::{Joints, Robot};
use parry_continuum::Chain;
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{BvhSearch, Proximity};
use rayon::prelude::*;
use std::fmt::Write;

/// Spacing of the stations, mm.
const SPACING: Real = 0.1;

/// A shape whose tubes twist, and what the model without torsion makes of it.
struct Twisted {
    /// The true clearance.
    truth: Real,
    /// Without torsion, the tubes' angles being those at the base, where motors set them:
    /// clearance and how far off the tip is.
    by_base: (Real, Real),
    /// Without torsion, the tubes' angles being those at the tubes' own ends.
    by_tip: (Real, Real),
}

fn twisted(
    robot: &Robot,
    joints: &Joints,
    base: &Pose,
    search: &mut BvhSearch,
) -> Result<Twisted, String> {
    let stations = Stations::graded(robot, joints, SPACING);
    let solution = robot.twisted(joints, &stations.arc_lengths);
    let mut clearance = |points: &[Vector]| -> Result<Real, String> {
        let chain = Chain::cylinders(points, &stations.radii).map_err(text)?;
        Ok(search.minimum(&chain, base).map_err(text)?.distance)
    };
    let truth = clearance(&solution.points)?;
    let tip = solution.tip.translation;
    let mut rigid = |joints: &Joints| -> Result<(Real, Real), String> {
        let frames = robot.frames(joints, &stations.arc_lengths);
        let points: Vec<_> = frames.iter().map(|frame| frame.translation).collect();
        let off = points.last().map_or(0.0, |end| end.distance(tip));
        Ok((clearance(&points)?, off))
    };
    let by_tip = rigid(joints)?;
    let set = Joints { extensions: joints.extensions.clone(), angles: solution.base_angles };
    Ok(Twisted { truth, by_base: rigid(&set)?, by_tip })
}

/// The chapter of the page, on some of the shapes, whose `outcomes` these are; and by how much the
/// clearance is off in the median and at worst where torsion is left out and the angles at the base
/// are the same.
pub fn chapter(
    robot: &Robot,
    shapes: &[Joints],
    outcomes: &[Outcome],
    mesh: &TriMesh,
    base: &Pose,
) -> Result<(String, Real, Real), String> {
    let of_some = |shapes: &[Joints]| -> Result<Vec<Twisted>, String> {
        let mut search = BvhSearch::new(mesh).map_err(text)?;
        shapes.iter().map(|joints| twisted(robot, joints, base, &mut search)).collect()
    };
    let some: Result<Vec<_>, _> = shapes.par_chunks(64).map(of_some).collect();
    let twisted: Vec<_> = some?.into_iter().flatten().collect();

    let mut page = format!(
        "## Beside the kinematic model\n\n\
         Real tubes twist. `crates/demo/src/torsion.rs` solves for that (Poisson's ratio 0.3); tests compare it with \
         published equations solved by an independent integrator. Here is what leaving it out does to the clearance, \
         beside what the model of the links does, on {} of the shapes. Of the robot with torsion, the angles at the \
         tubes' ends are those drawn. The same angles at the base: motors turn the tubes there. The same angles at the \
         ends: as if the angles there were measured. Differences are in magnitude and in mm, over the shapes that are \
         free with both. The last column: free with one and touching the wall with the other. The longest shapes twist \
         most, and touch the wall in every model: there the tip is off by up to {} mm. Where the base is \
         nearest nothing is off but capsules, hence the small medians.\n\n\
         | what is left out | tip off by: median | worst | clearance off by: median | 95 % below | worst | decided otherwise |\n\
         |---|---|---|---|---|---|---|\n",
        twisted.len(),
        length(twisted.iter().map(|shape| shape.by_base.1).fold(0.0, Real::max))
    );
    let by_base: Vec<_> = twisted.iter().map(|shape| (shape.truth, shape.by_base.0)).collect();
    let by_tip: Vec<_> = twisted.iter().map(|shape| (shape.truth, shape.by_tip.0)).collect();
    let tips = |found: fn(&Twisted) -> (Real, Real)| {
        let free = twisted.iter().filter(|shape| shape.truth > 0.0 && found(shape).0 > 0.0);
        let off: Vec<_> = free.map(|shape| found(shape).1).collect();
        let worst = off.iter().copied().fold(0.0, Real::max);
        format!("{} | {}", length(quantile(off, 0.5).unwrap_or(0.0)), length(worst))
    };
    row(&mut page, "torsion, same angles at the base", &tips(|shape| shape.by_base), &by_base);
    row(&mut page, "torsion, same angles at the ends", &tips(|shape| shape.by_tip), &by_tip);
    for (model, index) in [
        (Model::Capsule, 2),
        (Model::Cylinder, 2),
        (Model::Modified, 2),
        (Model::Modified, 4),
        (Model::Modified, 6),
    ] {
        let pairs: Vec<_> = outcomes
            .iter()
            .map(|shape| (shape.truth, shape.each[index].clearances[model.index()]))
            .collect();
        row(
            &mut page,
            &format!("{} within {} mm", model.name(), TOLERANCES[index]),
            "0 | 0",
            &pairs,
        );
    }
    let off = differences(&by_base);
    let worst = off.iter().copied().fold(0.0, Real::max);
    Ok((page, quantile(off, 0.5).unwrap_or(0.0), worst))
}

/// Of the clearances of two models, in magnitude, where both are free.
fn differences(pairs: &[(Real, Real)]) -> Vec<Real> {
    pairs.iter().filter(|(a, b)| *a > 0.0 && *b > 0.0).map(|(a, b)| (a - b).abs()).collect()
}

/// A row of the table, from true and other clearances.
fn row(page: &mut String, name: &str, tip: &str, pairs: &[(Real, Real)]) {
    let off = differences(pairs);
    let worst = off.iter().copied().fold(0.0, Real::max);
    let [median, most] =
        [0.5, 0.95].map(|share| length(quantile(off.clone(), share).unwrap_or(0.0)));
    let otherwise = Share::of(pairs.iter(), |(a, b)| (*a > 0.0) != (*b > 0.0));
    // Writing to a string cannot fail.
    let _ =
        writeln!(page, "| {name} | {tip} | {median} | {most} | {} | {otherwise} |", length(worst));
}
