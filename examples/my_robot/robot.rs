//! The robot from a file: points, radii, and the frame where the file says.

use crate::Options;
use crate::rows::rows;
use mesh_files::Frame;
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

/// A robot on its way: the radius of the segment that begins at each point, if there is one.
struct Points {
    number: f64,
    points: Vec<Vector>,
    radii: Vec<Result<f64, String>>,
}

impl Points {
    fn push(&mut self, line: &str, place: &[f64], radius: Option<f64>, my: &Options) {
        let scale = my.scale.unwrap_or(1.0);
        self.points.push(Vector::new(place[0], place[1], place[2]) * scale);
        let radius = radius.map(|radius| radius * scale).or(my.radius);
        self.radii.push(
            radius.ok_or_else(|| format!("{line} has no radius; write it behind x,y,z, or give --radius")),
        );
    }

    fn finish(mut self) -> Result<Robot, String> {
        // No segment begins at the last point, but a radius that is none tells of a mistake.
        if let Some(Ok(unused)) = self.radii.pop()
            && !(0.0..f64::INFINITY).contains(&unused)
        {
            return Err(format!(
                "the radius of the last point is {unused}; write one that is at least 0, or none"
            ));
        }
        let radii = self.radii.into_iter().collect::<Result<_, _>>()?;
        Ok(Robot { number: self.number, points: self.points, radii, frame: None })
    }
}

/// One robot.
pub fn centreline(path: &Path, my: &Options) -> Result<Robot, Box<dyn Error>> {
    let name = path.to_string_lossy().to_ascii_lowercase();
    if [".vtp", ".vtk", ".json"].iter().any(|end| name.ends_with(end)) {
        let options = mesh_files::Options::scaled(my.scale.unwrap_or(1.0)).with_line(my.line);
        let line = mesh_files::load_centreline(path, &options)?;
        let points: Vec<Vector> = line.points.into_iter().map(Vector::from).collect();
        let radius = my.radius.ok_or_else(|| {
            format!("the radii of {} are those of a vessel, if any; give --radius", path.display())
        })?;
        let radii = vec![radius; points.len().saturating_sub(1)];
        return Ok(Robot { number: 0.0, points, radii, frame: line.frame });
    }
    if my.line.is_some() {
        return Err(format!("{} holds one robot; leave out --line", path.display()).into());
    }
    let mut robot = Points { number: 0.0, points: Vec::new(), radii: Vec::new() };
    for (line, row) in rows(path, 3..=4, "x,y,z or x,y,z,radius")? {
        robot.push(&line, &row[..3], row.get(3).copied(), my);
    }
    if robot.points.is_empty() {
        return Err(format!("{} has no points; write x,y,z or x,y,z,radius", path.display()).into());
    }
    Ok(robot.finish()?)
}

/// Many robots, one after the other.
pub fn shapes(path: &Path, my: &Options) -> Result<Vec<Robot>, Box<dyn Error>> {
    let mut robots: Vec<Points> = Vec::new();
    for (line, row) in rows(path, 4..=5, "shape,x,y,z or shape,x,y,z,radius")? {
        if robots.last().is_none_or(|robot| robot.number != row[0]) {
            robots.push(Points { number: row[0], points: Vec::new(), radii: Vec::new() });
        }
        if let Some(robot) = robots.last_mut() {
            robot.push(&line, &row[1..4], row.get(4).copied(), my);
        }
    }
    if robots.is_empty() {
        return Err(
            format!("{} has no points; write shape,x,y,z or shape,x,y,z,radius", path.display()).into()
        );
    }
    let of = |robot: Points| {
        let number = robot.number;
        robot.finish().map_err(|error| format!("shape {number}: {error}"))
    };
    Ok(robots.into_iter().map(of).collect::<Result<_, _>>()?)
}
