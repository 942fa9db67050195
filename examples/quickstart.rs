//! The closest place of a robot to a wall: `cargo run -p clearance --example quickstart`.

use parry_continuum::Chain;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::proximity::{BvhSearch, Proximity};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (vertices, triangles) = mesh_files::load("examples/data/wall.stl")?.into_parts::<Vector>();
    let mut search = BvhSearch::from_triangles(&vertices, &triangles)?;
    // Points along the centreline, and one radius per segment, in the unit of the mesh.
    let points = [[0.0, 0.0, 4.0], [0.6, 0.0, 14.0], [2.6, 0.0, 24.0]].map(Vector::from);
    let robot = Chain::from_centreline(&points, &[2.0, 1.2])?;
    let closest = search.minimum(&robot, &Pose::IDENTITY)?;
    println!("closest: {:.3} mm from link {}", closest.distance, closest.link);
    assert!(search.clears(&robot, &Pose::IDENTITY, 1.0)?); // more than 1 mm everywhere
    Ok(())
}
