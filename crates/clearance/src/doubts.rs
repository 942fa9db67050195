//! What looks like a mistake, though an answer exists: a robot in another frame or unit than the
//! wall, or a radius in another unit.

use crate::frames::{half_turn, name};
use crate::number::short;
use crate::options::Options;
use crate::robot::Robot;
use crate::wall::Wall;
use mesh_files::Frame;
use parry_continuum::parry::bounding_volume::{Aabb, BoundingVolume};
use parry_continuum::parry::math::Pose;
use std::ops::RangeInclusive;

/// A robot is hardly ever this many times larger or smaller than the wall.
const FAR_FROM_ALIKE: f64 = 100.0;

/// The ratios of the radius to the diagonal of the wall's box that are not doubted. Instruments
/// have 1/50 (a bronchoscope in a trachea) to 1/4000 (a guide wire in an aorta).
const USUAL_RADII: RangeInclusive<f64> = 1.0 / 5000.0..=1.0 / 10.0;

/// The ratio of most instruments. A factor of 100 takes it out of the range on either side.
const TYPICAL_RADIUS: f64 = 1.0 / 200.0;

/// Factors by which a radius may be wrong.
const UNITS: [f64; 6] = [1000.0, 100.0, 10.0, 0.1, 0.01, 0.001];

/// What to try, and what would then be done to the robot.
struct Remedy {
    options: String,
    scale: f64,
    turns: bool,
}

/// Returns one line for each doubt.
pub fn doubts(my: &Options, robots: &[Robot], wall: &Wall, pose: &Pose) -> Vec<String> {
    // The box of all robots, scaled and moved.
    let around = |scale: f64, pose: &Pose| {
        let points =
            robots.iter().flat_map(|robot| &robot.points).filter(|point| point.is_finite());
        Aabb::from_points(points.map(|&point| *pose * (point * scale)))
    };
    let size = |around: &Aabb| around.extents().length();
    let is_alike = |around: &Aabb| {
        let ratio = size(around) / size(&wall.bounds);
        (1.0 / FAR_FROM_ALIKE..=FAR_FROM_ALIKE).contains(&ratio)
    };
    let robot = around(1.0, pose);
    let mut doubts = Vec::new();
    if !is_alike(&robot) {
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
        let corrected = around(remedy.scale, &pose);
        corrected.intersects(&wall.bounds) && is_alike(&corrected)
    };
    let mut scale = 1.0;
    if let Some(last) = doubts.last_mut()
        && let Some(remedy) = remedies(my, wall).into_iter().find(helps)
    {
        last.push_str(&format!("; with {} they fit", remedy.options));
        scale = remedy.scale;
    }
    doubts.extend(radius_doubt(my, robots, scale, size(&wall.bounds)));
    doubts
}

/// Doubts the largest radius, as it would be after the robot is scaled, beside the size of the
/// wall.
fn radius_doubt(my: &Options, robots: &[Robot], scale: f64, wall: f64) -> Option<String> {
    let robot = robots.iter().find(|robot| !robot.radii.is_empty())?;
    let radii = robots.iter().flat_map(|robot| &robot.radii).copied();
    let largest = radii.filter(|radius| radius.is_finite()).fold(0.0, f64::max);
    let radius = largest * if robot.has_own_radii { scale } else { 1.0 };
    if radius == 0.0 || USUAL_RADII.contains(&(radius / wall)) {
        return None;
    }
    let size = if radius / wall > *USUAL_RADII.end() { "large" } else { "small" };
    let doubt = format!(
        "the radius {} is {size} beside the wall's box, which measures {wall:.3}",
        short(radius),
    );
    // The correction that comes closest to the typical radius.
    let off = |factor: &f64| (radius * factor / wall / TYPICAL_RADIUS).ln().abs();
    let factor = UNITS.into_iter().min_by(|a, b| off(a).total_cmp(&off(b)))?;
    let remedy = if robot.has_own_radii {
        let in_file = radius * factor / (scale * my.scale.unwrap_or(1.0));
        format!("a radius of {} in the file would be usual", short(in_file))
    } else {
        format!("--radius {} would be usual", short(radius * factor))
    };
    Some(format!("{doubt}; check its unit: {remedy}"))
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
