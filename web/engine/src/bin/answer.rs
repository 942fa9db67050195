//! The same questions without a browser: reads the file of a robot with radii or with radius 1 and,
//! if one is named, a mesh file; prints the distance of each link from it, or from the ventricle,
//! with all digits.

use continuum_web::{Files, Robot, Wall};
use std::path::Path;

fn main() -> Result<(), String> {
    let arguments: Vec<_> = std::env::args().skip(1).collect();
    let [line, mesh @ ..] = &arguments[..] else {
        return Err("give a CSV, or six joint values, and a mesh".into());
    };
    let mut files = Files::new();
    let mut add = |file: &str| -> Result<String, String> {
        let name = Path::new(file).file_name().unwrap_or_default().to_string_lossy().into_owned();
        files.add(&name, std::fs::read(file).map_err(|error| error.to_string())?);
        Ok(name)
    };
    let joints: Result<Vec<f64>, _> = line.split(',').map(str::parse).collect();
    let joints = joints.ok().filter(|joints| joints.len() == 6);
    let line = if joints.is_some() { String::new() } else { add(line)? };
    let mesh = mesh.first().map(|mesh| add(mesh)).transpose()?;
    let robot = match joints {
        Some(joints) => Robot::of_tubes(&joints[..3], &joints[3..])?,
        None => Robot::read(&files, &line, None, 1.0, None, None)
            .or_else(|_| Robot::read(&files, &line, None, 1.0, Some(1.0), None))?,
    };
    let mut wall = match mesh {
        Some(name) => Wall::read(&files, &name, None, 1.0, false)?,
        None => Wall::ventricle()?,
    };
    for distance in wall.ask(&robot, "")?.distances() {
        println!("{distance}");
    }
    Ok(())
}
