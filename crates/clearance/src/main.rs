//! The command `clearance`: how far is a continuum robot from a wall, link by link?
//!
//! # Algorithm
//! 1. Read the wall (`wall`), the robots (`robot`) and the pose, and turn the robots into the
//!    frame of the wall (`frames`).
//! 2. Doubt a robot whose unit, radius or frame does not fit the wall, and a wall without an inside
//!    (`doubts`).
//! 3. Ask the engine for one robot (`single`) or for many (`shapes`).
//! 4. Write the files (`plot`, `csv`, `proof`), then print the report (`report`).

mod csv;
mod doubts;
mod frames;
mod labels;
mod messages;
mod number;
mod options;
mod outputs;
mod plot;
mod plot_pixels;
mod proof;
mod report;
mod robot;
mod shapes;
mod sides;
mod single;
mod verdict;
mod wall;

use options::Options;
use parry_continuum::parry::math::Pose;
use parry_continuum::pose_from_matrix;
use std::path::Path;
use std::process::ExitCode;
use wall::Wall;

fn main() -> ExitCode {
    match answer(&Options::read()) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(1),
        Err(message) => {
            outputs::tell("error", &message);
            ExitCode::from(2)
        }
    }
}

/// Answers, and returns whether the margin is kept.
fn answer(my: &Options) -> Result<bool, String> {
    if my.labels {
        return labels::print(my).map(|()| true);
    }
    let mut pose = my.pose.as_deref().map_or(Ok(Pose::IDENTITY), read_pose)?;
    let robots = match (&my.shapes, &my.centreline) {
        (Some(path), _) => robot::shapes(path, my)?,
        (None, Some(path)) => vec![robot::centreline(path, my)?],
        (None, None) => return Err("give --centreline or --shapes".into()),
    };
    let mut wall = Wall::load(my)?;
    outputs::check(my, &wall.files)?;
    let turned = frames::turn(my, &robots[0], &wall)?;
    if turned.is_some() {
        pose = frames::half_turn() * pose;
    }
    let doubts = doubts::doubts(my, &robots, &wall, &pose);
    if my.shapes.is_some() {
        shapes::answer(my, &robots, &mut wall, &pose, doubts)
    } else {
        single::answer(my, &robots[0], &mut wall, &pose, turned, doubts)
    }
}

fn read_pose(path: &Path) -> Result<Pose, String> {
    let rows = mesh_files::load_table(path, "4 numbers", &mesh_files::Options::default())
        .map_err(|error| messages::of_file(&error))?;
    let matrix = Vec::try_into(rows).map_err(|_| "--pose needs 4 lines of 4 numbers")?;
    pose_from_matrix(matrix).map_err(|error| format!("--pose {}: {error}", path.display()))
}
