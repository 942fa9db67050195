//! What looks like a mistake, though an answer exists: a robot in another frame or unit than the
//! wall, a radius or a margin in another unit, points out of order, or a wall without an inside.
//! The remedy is in the words of the options.

use crate::number::{all_digits, short};
use crate::options::Options;
use crate::robot::Robot;
use crate::wall::Wall;
use mesh_files::{Bounds, Change, Frame, margin_doubt, misfits, radius_doubt};
use parry_continuum::parry::math::{Pose, Vector};

/// Returns one line for each doubt.
pub fn doubts(my: &Options, robots: &[Robot], wall: &Wall, pose: &Pose) -> Vec<String> {
    let bounds = Bounds { low: wall.bounds.mins.into(), high: wall.bounds.maxs.into() };
    // The box of all robots, changed and moved.
    let around = |change: Change| {
        let points = robots.iter().flat_map(|robot| &robot.points);
        let placed = |point: &Vector| *pose * Vector::from(change.apply((*point).into()));
        Bounds::of_points(points.map(|point| placed(point).into()))
    };
    // A frame that is stated by file or option is not wrong.
    let states_frame = my.frame.is_some() || robots.iter().any(|robot| robot.frame.is_some());
    let may_turn = my.pose.is_none() && !states_frame;
    let misfits = misfits(around, &bounds, may_turn);
    let scale = misfits.remedy.map_or(1.0, |remedy| remedy.scale);
    let mut doubts = misfits.with_remedy(|change| options(change, my, wall));
    doubts.extend(radius_in_another_unit(my, robots, scale, &bounds));
    doubts.extend(my.margin.and_then(|margin| margin_doubt(margin, &bounds)));
    doubts.extend(in_files(my, robots));
    doubts.extend(wall.search.surface().doubts());
    doubts
}

/// Returns the doubts about the robot's file; of many shapes, about the first doubtful one.
fn in_files(my: &Options, robots: &[Robot]) -> Vec<String> {
    let mut doubtful = robots.iter().filter(|robot| !robot.doubts.is_empty());
    let Some(robot) = doubtful.next() else { return Vec::new() };
    let of = match &my.shapes {
        Some(_) => format!("shape {}: ", all_digits(robot.number)),
        None => String::new(),
    };
    let mut doubts: Vec<_> = robot.doubts.iter().map(|doubt| format!("{of}{doubt}")).collect();
    let others = doubtful.count();
    if others > 0 {
        doubts.push(format!("the points of {others} other shapes look doubtful too"));
    }
    doubts
}

/// Returns the options that make a change.
fn options(change: Change, my: &Options, wall: &Wall) -> String {
    let scale = (change.scale != 1.0)
        .then(|| format!("--scale {}", change.scale * my.scale.unwrap_or(1.0)));
    let turn = change.turns.then_some(match wall.frame {
        Some(Frame::Ras) => "--frame lps",
        Some(_) => "--frame ras",
        None => "--frame lps --mesh-frame ras",
    });
    scale.into_iter().chain(turn.map(str::to_owned)).collect::<Vec<_>>().join(" ")
}

/// Doubts the largest radius, as it would be after the robot is scaled.
fn radius_in_another_unit(
    my: &Options,
    robots: &[Robot],
    scale: f64,
    wall: &Bounds,
) -> Option<String> {
    let robot = robots.iter().find(|robot| !robot.radii.is_empty())?;
    let radii = robots.iter().flat_map(|robot| &robot.radii).copied();
    let largest = radii.filter(|radius| radius.is_finite()).fold(0.0, f64::max);
    let radius = largest * if robot.has_own_radii { scale } else { 1.0 };
    let found = radius_doubt(radius, wall)?;
    let usual = radius * found.factor;
    let remedy = if robot.has_own_radii {
        let in_file = short(usual / (scale * my.scale.unwrap_or(1.0)));
        format!("a radius of {in_file} in the file would be usual")
    } else {
        format!("--radius {} would be usual", short(usual))
    };
    Some(format!("{}: {remedy}", found.doubt))
}
