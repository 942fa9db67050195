//! The same questions without a browser: reads a CSV of points (`x,y,z,radius`) and, if one is
//! named, a mesh file; prints the distance of each link from it, or from the ventricle, with all
//! digits.

use continuum_web::{Robot, Wall};
use std::path::Path;

fn main() -> Result<(), String> {
    let arguments: Vec<_> = std::env::args().skip(1).collect();
    let [line, mesh @ ..] = &arguments[..] else {
        return Err("give a CSV, or six joint values, and a mesh".into());
    };
    let text = |error: std::io::Error| error.to_string();
    let joints: Result<Vec<f64>, _> = line.split(',').map(str::parse).collect();
    let robot = match joints {
        Ok(joints) if joints.len() == 6 => Robot::of_tubes(&joints[..3], &joints[3..])?,
        _ => Robot::from_csv(&std::fs::read_to_string(line).map_err(text)?, 1.0)?,
    };
    let mut wall = match mesh.first() {
        Some(file) => {
            let name = Path::new(file).file_name().unwrap_or_default().to_string_lossy();
            Wall::read(&name, &std::fs::read(file).map_err(text)?)?
        }
        None => Wall::ventricle()?,
    };
    let found = wall.ask(&robot)?;
    for distance in found.distances() {
        println!("{distance}");
    }
    Ok(())
}
