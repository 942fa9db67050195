//! The robot from a file: points, radii, and the frame where the file says.

use crate::Options;
use mesh_files::{Centreline, Frame};
use parry_continuum::parry::math::Vector;
use std::{error::Error, path::Path};

pub struct Robot {
    /// The number of the shape in its file.
    pub number: f64,
    pub points: Vec<Vector>,
    /// One for each segment between two points.
    pub radii: Vec<f64>,
    pub frame: Option<Frame>,
}

/// One robot.
pub fn centreline(path: &Path, my: &Options) -> Result<Robot, Box<dyn Error>> {
    let name = path.to_string_lossy().to_ascii_lowercase();
    if my.line.is_some() && ![".vtp", ".vtk", ".json"].iter().any(|end| name.ends_with(end)) {
        return Err(format!("{} holds one robot; leave out --line", path.display()).into());
    }
    let options = mesh_files::Options::scaled(my.scale.unwrap_or(1.0)).with_line(my.line);
    let line = mesh_files::load_centreline(path, &options)?;
    if line.skipped_points > 0 {
        eprintln!(
            "note: left out of {}: {} points without a place",
            path.display(),
            line.skipped_points
        );
    }
    Ok(robot(0.0, line, path, my)?)
}

/// Many robots, one after the other.
pub fn shapes(path: &Path, my: &Options) -> Result<Vec<Robot>, Box<dyn Error>> {
    let options = mesh_files::Options::scaled(my.scale.unwrap_or(1.0));
    let shapes = mesh_files::load_shapes(path, &options)?;
    let of = |(number, line)| {
        robot(number, line, path, my).map_err(|error| format!("shape {number}: {error}"))
    };
    Ok(shapes.into_iter().map(of).collect::<Result<_, _>>()?)
}

fn robot(number: f64, line: Centreline, path: &Path, my: &Options) -> Result<Robot, String> {
    let file = path.display();
    let points: Vec<Vector> = line.points.into_iter().map(Vector::from).collect();
    let segments = points.len().saturating_sub(1);
    let radii = match (line.radii, my.radius) {
        (Some(radii), None) => radii,
        (None, Some(radius)) => vec![radius; segments],
        (Some(_), Some(_)) => {
            return Err(format!("{file} has a column of radii; leave out --radius, or the column"));
        }
        (None, None) => {
            return Err(format!(
                "{file} has no radius; write it behind x,y,z, or give --radius (radii of a vessel are not read)"
            ));
        }
    };
    Ok(Robot { number, points, radii, frame: line.frame })
}
