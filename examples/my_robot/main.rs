//! `cargo run --release --example my_robot -- --mesh examples/data/wall.stl --centreline examples/data/shape.csv`

mod rows;

use clap::Parser;
use parry_continuum::parry::{math::Pose, math::Vector, shape::TriMesh};
use parry_continuum::{Chain, Tube, pose_from_matrix, proximity::BvhSearch, proximity::Proximity};
use rows::rows;
use std::{error::Error, io::Write, path::PathBuf};

/// How far is my robot from my wall, link by link? All lengths are in one unit, that of the mesh.
#[derive(Parser)]
struct Options {
    /// The wall: an STL, OBJ or PLY file, or a segmentation in NIfTI or NRRD (which comes in millimetres)
    #[arg(long)]
    mesh: PathBuf,
    /// The label of the wall in a segmentation [default: all that are not 0]
    #[arg(long, value_parser = |s: &str| s.parse::<u32>().or(Err("write a whole number")))]
    label: Option<u32>,
    /// A line for each point of the centreline: x,y,z and optionally the radius of the segment that begins there. A heading
    /// and lines that begin with # are passed over
    #[arg(long)]
    centreline: PathBuf,
    /// The radius of each segment for which the centreline's file has none
    #[arg(long, allow_negative_numbers = true, value_parser = radius)]
    radius: Option<f64>,
    /// A file with a 4x4 matrix, row by row: it brings the robot into the frame of the mesh
    #[arg(long)]
    pose: Option<PathBuf>,
    /// Also bound the clearance of the curve through the points: how far apart the two bounds may be
    #[arg(long, allow_negative_numbers = true, value_parser = tolerance)]
    tolerance: Option<f64>,
}

fn radius(text: &str) -> Result<f64, &'static str> {
    let radius = text.parse().ok().filter(|radius| (0.0..f64::INFINITY).contains(radius));
    radius.ok_or("write a number that is at least 0")
}

fn tolerance(text: &str) -> Result<f64, &'static str> {
    let tolerance = text.parse().ok().filter(|&tolerance| tolerance > 0.0 && tolerance < f64::INFINITY);
    tolerance.ok_or("write a number greater than 0, with a point for decimals")
}

fn main() {
    let asked = clearance(&Options::parse()).inspect_err(|error| eprintln!("error: {error}"));
    std::process::exit(asked.is_err().into());
}

fn clearance(my: &Options) -> Result<(), Box<dyn Error>> {
    let (mut points, mut radii, mut links, mut out) = (Vec::new(), Vec::new(), Vec::new(), std::io::stdout());
    for (line, row) in rows(&my.centreline, 3..=4, "x,y,z or x,y,z,radius")? {
        points.push(Vector::new(row[0], row[1], row[2]));
        let none = format!("{line} has no radius; write it as a fourth number, or give --radius");
        radii.push(row.get(3).copied().or(my.radius).ok_or(none));
    }
    // No segment begins at the last point, but a radius that is none tells of a mistake.
    if let Some(Ok(unused)) = radii.pop()
        && !(0.0..f64::INFINITY).contains(&unused)
    {
        return Err(format!(
            "the radius of the last point is {unused}; write one that is at least 0, or none"
        )
        .into());
    }
    let radii = radii.into_iter().collect::<Result<Vec<f64>, _>>()?;
    let mut pose = Pose::IDENTITY;
    if let Some(path) = &my.pose {
        let matrix = rows(path, 4..=4, "4 numbers")?.iter().map(|(_, r)| [r[0], r[1], r[2], r[3]]).collect();
        pose = pose_from_matrix(Vec::try_into(matrix).map_err(|_| "--pose needs 4 lines of 4 numbers")?)?;
    }
    let reading = mesh_files::Options::default().with_label(my.label);
    let wall = mesh_files::load_with(&my.mesh, &reading)?;
    if wall.skipped_faces > 0 {
        eprintln!("note: left out of {}: {} faces without area", my.mesh.display(), wall.skipped_faces);
    }
    let (vertices, triangles) = wall.into_parts();
    let mut search = BvhSearch::new(&TriMesh::new(vertices, triangles)?)?;
    let robot = Chain::from_centreline(&points, &radii)?;
    search.per_link(&robot, &pose, &mut links)?;
    let bound = |tolerance| -> Result<_, Box<dyn Error>> {
        Ok(search.clearance(&Tube::from_samples(&points, &radii, None)?, &pose, tolerance)?)
    };
    let curve = my.tolerance.map(bound).transpose()?;
    for l in &links {
        writeln!(out, "link {}: {:.6}, from {:.6} to {:.6}", l.link, l.distance, l.on_robot, l.on_mesh)?;
    }
    if let Some(curve) = curve {
        writeln!(out, "curve: {:.6} to {:.6}, {:.3} along it", curve.lower, curve.upper, curve.arc_length)?;
    }
    Ok(writeln!(out, "minimum {:.6}", search.minimum(&robot, &pose)?.distance)?)
}
