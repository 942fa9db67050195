//! Writes a query to one file, to be attached to a report of a wrong distance: robot, pose, mesh
//! and answer as JSON, every number with all its digits. Copy `report` into your program, which
//! needs the feature `serde-serialize`.
//!
//! `cargo run --example report` writes `target/report.json`, reads it back, and asks again.

use parry_continuum::Chain;
use parry_continuum::parry::math::{Pose, Rot3, Vector};
use parry_continuum::parry::shape::{Ball, TriMesh};
use parry_continuum::proximity::{BvhSearch, LinkProximity, Proximity};
use serde::{Deserialize, Serialize};
use std::error::Error;
use std::path::Path;

/// A query and its answer.
#[derive(Deserialize, Serialize)]
struct Report {
    robot: Chain,
    /// The robot's pose in the mesh's frame: its origin, and its rotation as a quaternion x, y, z,
    /// w.
    origin: [f64; 3],
    rotation: [f64; 4],
    vertices: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
    answer: LinkProximity,
}

/// Writes the query to the file.
fn report(
    file: &Path,
    robot: &Chain,
    pose: &Pose,
    mesh: &TriMesh,
    answer: LinkProximity,
) -> Result<(), Box<dyn Error>> {
    let report = Report {
        robot: robot.clone(),
        origin: pose.translation.to_array(),
        rotation: pose.rotation.to_array(),
        vertices: mesh.vertices().iter().map(|vertex| vertex.to_array()).collect(),
        triangles: mesh.indices().to_vec(),
        answer,
    };
    Ok(serde_json::to_writer(std::fs::File::create(file)?, &report)?)
}

fn main() -> Result<(), Box<dyn Error>> {
    let (vertices, triangles) = Ball::new(10.0).to_trimesh(64, 32);
    let mesh = TriMesh::new(vertices, triangles)?;
    let robot = Chain::from_centreline(
        &[Vector::ZERO, Vector::Z * 3.0, Vector::new(1.0, 0.0, 5.0)],
        &[0.5; 2],
    )?;
    let pose = Pose::from_parts(Vector::new(0.1, 0.2, 0.3), Rot3::from_rotation_x(0.4));
    let answer = BvhSearch::new(&mesh)?.minimum(&robot, &pose)?;
    let file = Path::new("target/report.json");
    std::fs::create_dir_all("target")?;
    report(file, &robot, &pose, &mesh, answer)?;

    // What the receiver does.
    let read: Report = serde_json::from_reader(std::fs::File::open(file)?)?;
    let mesh = TriMesh::new(read.vertices.into_iter().map(Vector::from).collect(), read.triangles)?;
    let pose = Pose::from_parts(Vector::from(read.origin), Rot3::from_array(read.rotation));
    let again = BvhSearch::new(&mesh)?.minimum(&read.robot, &pose)?;
    println!("{}: {} in the file, {} again", file.display(), read.answer.distance, again.distance);
    Ok(())
}
