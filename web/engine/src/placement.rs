//! Where a robot is in the wall's frame, and what looks like a mistake in its frame or unit.

use crate::files::refused;
use crate::robot::{Line, Robot};
use crate::wall::Wall;
use mesh_files::{Bounds, Change, Frame, RadiusDoubt, misfits, radius_doubt, table_from_bytes};
use parry_continuum::parry::math::{Pose, Rot3, Vector};
use parry_continuum::pose_from_matrix;

/// The pose of a robot.
#[derive(Clone, Debug)]
pub struct Placement {
    pub pose: Pose,
    /// From which frame to which one the robot is turned.
    pub turned: Option<[Frame; 2]>,
    pub doubts: Vec<String>,
}

/// Returns the pose of a robot. Tubes stand at the wall's entry, points are in the wall's frame,
/// unless `matrix` is not blank: 4 lines of 4 numbers.
///
/// # Errors
/// The matrix is not a pose; it is not known whether to turn the robot; or the user chose both a
/// pose and a frame.
pub fn place(robot: &Robot, wall: &mut Wall, matrix: &str) -> Result<Placement, String> {
    let given = if matrix.trim().is_empty() { None } else { Some(pose_of(matrix)?) };
    let Some(line) = robot.line() else {
        let pose = given.unwrap_or_else(|| wall.entry());
        return Ok(Placement { pose, turned: None, doubts: Vec::new() });
    };
    if given.is_some() && line.frame.is_some() && !line.states_frame {
        return Err("the pose brings the robot into the wall's frame already; leave the robot's frame at 'not stated'".into());
    }
    let turned = if given.is_some() { None } else { turn(line, wall)? };
    let half_turn = Pose::from_parts(Vector::ZERO, Rot3::from_xyzw(0.0, 0.0, 1.0, 0.0));
    let unturned = given.unwrap_or(Pose::IDENTITY);
    let pose = if turned.is_some() { half_turn } else { unturned };
    let may_turn = given.is_none() && line.frame.is_none();
    let around = |change: Change| {
        let place = |point: &Vector| pose * Vector::from(change.apply(point.to_array()));
        Bounds::of_points(line.points.iter().map(|point| place(point).to_array()))
    };
    let doubts = wall.bounds().map_or_else(Vec::new, |bounds| {
        let misfits = misfits(around, &bounds, may_turn);
        let scale = misfits.remedy.map_or(1.0, |remedy| remedy.scale);
        let mut doubts = misfits.with_remedy(|change| words(change, line, wall));
        doubts.extend(doubt_radius(line, scale, &bounds));
        doubts
    });
    Ok(Placement { pose, turned, doubts })
}

fn pose_of(matrix: &str) -> Result<Pose, String> {
    let rows: Vec<[f64; 4]> = table_from_bytes("the pose", matrix.as_bytes(), "4 numbers")
        .map_err(|error| refused(&error))?;
    let count = rows.len();
    let rows = <[[f64; 4]; 4]>::try_from(rows)
        .map_err(|_| format!("the pose has {count} lines; write 4 lines of 4 numbers"))?;
    pose_from_matrix(rows).map_err(|error| format!("the pose: {error}"))
}

fn turn(line: &Line, wall: &Wall) -> Result<Option<[Frame; 2]>, String> {
    match (line.frame, wall.frame()) {
        (Some(own), Some(other)) => Ok((own != other).then_some([own, other])),
        (Some(own), None) => Err(format!(
            "the robot is in {}, but {} does not say whether it is RAS or LPS; choose the wall's frame",
            own.name(),
            wall.name()
        )),
        (None, _) => Ok(None),
    }
}

/// Doubts the radius, as it would be after the robot is scaled.
fn doubt_radius(line: &Line, scale: f64, wall: &Bounds) -> Option<String> {
    let RadiusDoubt { doubt, factor } = radius_doubt(line.scaled_radius(scale), wall)?;
    let place = if line.has_radii { " in the file" } else { "" };
    Some(format!("{doubt}: a radius{place} {factor} times as large would be usual"))
}

/// A remedy in terms of the page's choices.
fn words(change: Change, line: &Line, wall: &Wall) -> String {
    let scale =
        (change.scale != 1.0).then(|| format!("the robot's scale {}", change.scale * line.scale));
    let frames = change.turns.then(|| match wall.frame() {
        Some(Frame::Ras) => "the robot's frame LPS".to_owned(),
        Some(_) => "the robot's frame RAS".to_owned(),
        None => "the robot's frame LPS and the wall's frame RAS".to_owned(),
    });
    scale.into_iter().chain(frames).collect::<Vec<_>>().join(" and ")
}
