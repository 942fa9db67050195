//! `cargo run --release --example my_robot -- --mesh examples/data/wall.stl --centreline
//! examples/data/shape.csv`

mod doubts;
mod frames;
mod report;
mod robot;
mod shapes;
mod wall;

use clap::Parser;
use frames::Axes;
use parry_continuum::parry::math::Pose;
use parry_continuum::{Chain, Tube, pose_from_matrix, proximity::Proximity};
use report::Report;
use robot::Robot;
use std::{error::Error, path::Path, path::PathBuf};
use wall::Wall;

/// How far is my robot from my wall, link by link? All lengths are in one unit, that of the mesh.
#[derive(Parser)]
struct Options {
    /// The wall: an STL, OBJ, PLY, .vtp or .vtk file, or a segmentation in NIfTI, NRRD or
    /// MetaImage (which comes in millimetres)
    #[arg(long)]
    mesh: PathBuf,
    /// The label of the wall in a segmentation [default: all that are not 0]
    #[arg(long, value_parser = |s: &str| s.parse::<u32>().or(Err("write a whole number")))]
    label: Option<u32>,
    /// Points along the robot. A text file (.csv, .tsv, .txt, .dat) has a line for each: x,y,z and
    /// optionally the radius of the segment that begins there; a heading and lines that begin
    /// with # are passed over. Or a .vtp, .vtk or .mrk.json file
    #[arg(long, required_unless_present = "shapes")]
    centreline: Option<PathBuf>,
    /// Which line of a .vtp, .vtk or .mrk.json file with several, counted from 0. A list of
    /// fiducials needs it too
    #[arg(long, value_parser = |s: &str| s.parse::<usize>().or(Err("write a whole number")))]
    line: Option<usize>,
    /// Many shapes instead of one: lines of shape,x,y,z and optionally the radius. Lines that
    /// follow one another with the same number of a shape are one robot. Prints a CSV with a
    /// line for each
    #[arg(long, conflicts_with_all = ["centreline", "tolerance"])]
    shapes: Option<PathBuf>,
    /// The radius of all segments, if the file has none
    #[arg(long, allow_negative_numbers = true, value_parser = radius)]
    radius: Option<f64>,
    /// Multiplies the robot's coordinates and the radii in its file (not --radius), for example
    /// 1000 for metres to millimetres
    #[arg(long, allow_negative_numbers = true, value_parser = positive)]
    scale: Option<f64>,
    /// The frame of the centreline, if it is not that of the mesh and the file does not say: x and
    /// y change sign between the two
    #[arg(long, conflicts_with = "pose")]
    frame: Option<Axes>,
    /// The frame of the mesh, if its file does not say
    #[arg(long)]
    mesh_frame: Option<Axes>,
    /// A file with a 4x4 matrix, row by row: it brings the robot into the frame of the mesh
    #[arg(long)]
    pose: Option<PathBuf>,
    /// Also bound the clearance of the curve through the points: how far apart the two bounds may
    /// be
    #[arg(long, allow_negative_numbers = true, value_parser = positive)]
    tolerance: Option<f64>,
    /// Print JSON, with all digits
    #[arg(long)]
    json: bool,
}

fn radius(text: &str) -> Result<f64, &'static str> {
    let radius = text.parse().ok().filter(|radius| (0.0..f64::INFINITY).contains(radius));
    radius.ok_or("write a number that is at least 0")
}

fn positive(text: &str) -> Result<f64, &'static str> {
    let number = text.parse().ok().filter(|&number| number > 0.0 && number < f64::INFINITY);
    number.ok_or("write a number greater than 0, with a point for decimals")
}

fn main() {
    let asked = ask(&Options::parse()).inspect_err(|error| eprintln!("error: {error}"));
    std::process::exit(asked.is_err().into());
}

fn ask(my: &Options) -> Result<(), Box<dyn Error>> {
    let mut pose = my.pose.as_deref().map_or(Ok(Pose::IDENTITY), read_pose)?;
    let robots = match (&my.shapes, &my.centreline) {
        (Some(path), _) => robot::shapes(path, my)?,
        (None, Some(path)) => vec![robot::centreline(path, my)?],
        (None, None) => return Err("give --centreline or --shapes".into()),
    };
    let mut wall = Wall::load(my)?;
    let turned = frames::turn(my, &robots[0], &wall)?;
    if turned.is_some() {
        pose = frames::half_turn() * pose;
    }
    let doubts = doubts::doubts(my, &robots, &wall, &pose);
    let warn = || doubts.iter().for_each(|doubt| eprintln!("warning: {doubt}"));
    if my.shapes.is_some() {
        warn();
        return shapes::print(my, &robots, &mut wall, &pose);
    }
    let Robot { points, radii, .. } = &robots[0];
    let robot = Chain::from_centreline(points, radii)?;
    let mut links = Vec::new();
    wall.search.per_link(&robot, &pose, &mut links)?;
    let minimum = wall.search.minimum(&robot, &pose)?;
    let base = wall.search.side(pose * points[0]);
    let curve = my.tolerance.map(|tolerance| -> Result<_, Box<dyn Error>> {
        Ok(wall.search.clearance(&Tube::from_samples(points, radii, None)?, &pose, tolerance)?)
    });
    // Print the links even if the curve fails.
    let (curve, failed) = match curve.transpose() {
        Ok(curve) => (curve, None),
        Err(error) => (None, Some(error)),
    };
    warn();
    Report { wall: &wall, turned, base, links, curve, minimum, doubts: &doubts }.print(my.json)?;
    failed.map_or(Ok(()), |error| Err(format!("no bounds for the curve: {error}").into()))
}

fn read_pose(path: &Path) -> Result<Pose, Box<dyn Error>> {
    let rows = mesh_files::load_table(path, 4..=4, "4 numbers", &mesh_files::Options::default())?;
    let matrix = rows.iter().map(|row| [row[0], row[1], row[2], row[3]]).collect();
    Ok(pose_from_matrix(Vec::try_into(matrix).map_err(|_| "--pose needs 4 lines of 4 numbers")?)?)
}
