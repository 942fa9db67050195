//! What looks like a mistake, though an answer exists: a robot in another frame or unit than the
//! wall.

use crate::Options;
use crate::frames::{half_turn, name};
use crate::robot::Robot;
use crate::wall::Wall;
use mesh_files::Frame;
use parry_continuum::parry::bounding_volume::{Aabb, BoundingVolume};
use parry_continuum::parry::math::Pose;

/// A robot is hardly ever this many times larger or smaller than the wall.
const FAR_FROM_ALIKE: f64 = 100.0;

/// What to try, and what would then be done to the robot.
struct Remedy {
    options: String,
    scale: f64,
    turns: bool,
}

/// One line for each doubt.
pub fn doubts(my: &Options, robots: &[Robot], wall: &Wall, pose: &Pose) -> Vec<String> {
    // Where all shapes are, moved and scaled anew.
    let around = |scale: f64, pose: &Pose| {
        let points =
            robots.iter().flat_map(|robot| &robot.points).filter(|point| point.is_finite());
        Aabb::from_points(points.map(|&point| *pose * (point * scale)))
    };
    let size = |around: &Aabb| around.extents().length();
    let alike = |around: &Aabb| {
        let ratio = size(around) / size(&wall.bounds);
        (1.0 / FAR_FROM_ALIKE..=FAR_FROM_ALIKE).contains(&ratio)
    };
    let robot = around(1.0, pose);
    let mut doubts = Vec::new();
    if !alike(&robot) {
        doubts.push(format!(
            "the robot's box measures {:.3}, the wall's {:.3}",
            size(&robot),
            size(&wall.bounds)
        ));
    }
    if !robot.intersects(&wall.bounds) {
        let gap = (robot.mins - wall.bounds.maxs).max(wall.bounds.mins - robot.maxs).max_element();
        doubts.push(format!(
            "the robot's box and the wall's do not overlap; they are {gap:.3} apart"
        ));
    }
    let helps = |remedy: &Remedy| {
        let pose = if remedy.turns { half_turn() * *pose } else { *pose };
        let mended = around(remedy.scale, &pose);
        mended.intersects(&wall.bounds) && alike(&mended)
    };
    if let Some(last) = doubts.last_mut()
        && let Some(remedy) = remedies(my, wall).into_iter().find(helps)
    {
        last.push_str(&format!("; with {} they fit", remedy.options));
    }
    doubts
}

fn remedies(my: &Options, wall: &Wall) -> Vec<Remedy> {
    let turn = if my.pose.is_some() || my.frame.is_some() {
        None
    } else {
        Some(match wall.frame {
            Some(Frame::Lps) => "--frame ras".to_owned(),
            Some(frame) => format!("--frame {}", if name(frame) == "RAS" { "lps" } else { "ras" }),
            None => "--frame lps --mesh-frame ras".to_owned(),
        })
    };
    let scales = [1000.0, 1e-3, 10.0, 0.1]
        .map(|factor| (factor, format!("--scale {}", factor * my.scale.unwrap_or(1.0))));
    let mut remedies = Vec::new();
    if let Some(turn) = &turn {
        remedies.push(Remedy { options: turn.clone(), scale: 1.0, turns: true });
    }
    remedies.extend(scales.iter().map(|(scale, options)| Remedy {
        options: options.clone(),
        scale: *scale,
        turns: false,
    }));
    if let Some(turn) = &turn {
        let both = |(scale, options): &(f64, String)| Remedy {
            options: format!("{options} {turn}"),
            scale: *scale,
            turns: true,
        };
        remedies.extend(scales.iter().map(both));
    }
    remedies
}
