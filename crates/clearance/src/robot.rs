//! The robot from a file: points, radii, and the frame if the file states it.

use crate::messages;
use crate::number::all_digits;
use crate::options::Options;
use mesh_files::{Centreline, Frame};
use parry_continuum::parry::math::Vector;
use std::path::Path;

pub struct Robot {
    /// The number of the shape in its file; 0 for a centreline.
    pub number: f64,
    pub points: Vec<Vector>,
    /// One for each segment between two points.
    pub radii: Vec<f64>,
    /// Whether the radii are in the file: --scale then multiplies them.
    pub has_own_radii: bool,
    pub frame: Option<Frame>,
    /// The number of points in the file that are left out, because they have no position.
    pub skipped_points: usize,
    /// What looks like a mistake in the file.
    pub doubts: Vec<String>,
}

/// Reads one robot.
pub fn centreline(path: &Path, my: &Options) -> Result<Robot, String> {
    let options = mesh_files::Options::scaled(my.scale.unwrap_or(1.0)).with_line(my.line);
    let line =
        mesh_files::load_centreline(path, &options).map_err(|error| messages::of_file(&error))?;
    robot(0.0, line, path, my)
}

/// Reads many robots.
pub fn shapes(path: &Path, my: &Options) -> Result<Vec<Robot>, String> {
    let options = mesh_files::Options::scaled(my.scale.unwrap_or(1.0));
    let shapes =
        mesh_files::load_shapes(path, &options).map_err(|error| messages::of_file(&error))?;
    let of = |(number, line)| {
        robot(number, line, path, my)
            .map_err(|error| format!("shape {}: {error}", all_digits(number)))
    };
    shapes.into_iter().map(of).collect()
}

fn robot(number: f64, line: Centreline, path: &Path, my: &Options) -> Result<Robot, String> {
    let file = path.display();
    let points: Vec<Vector> = line.points.into_iter().map(Vector::from).collect();
    let segments = points.len().saturating_sub(1);
    let has_own_radii = line.radii.is_some();
    let radii = match (line.radii, my.radius) {
        (Some(radii), None) => radii,
        (None, Some(radius)) => vec![radius; segments],
        (Some(_), Some(_)) => {
            return Err(format!("{file} has a column of radii; leave out --radius, or the column"));
        }
        (None, None) => {
            return Err(format!(
                "{file} has no radius; write it behind x,y,z, or give --radius (radii of a vessel \
                 are not read)"
            ));
        }
    };
    let Centreline { frame, skipped_points, doubts, .. } = line;
    Ok(Robot { number, points, radii, has_own_radii, frame, skipped_points, doubts })
}
