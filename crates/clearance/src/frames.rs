//! The frames of patients: RAS and LPS differ by half a turn about the third axis.

use crate::options::Options;
use crate::robot::Robot;
use crate::wall::Wall;
use mesh_files::Frame;
use parry_continuum::parry::math::{Pose, Rotation, Vector};

pub fn half_turn() -> Pose {
    Pose::from_parts(Vector::ZERO, Rotation::from_xyzw(0.0, 0.0, 1.0, 0.0))
}

/// Returns the frame of the robot and the frame of the wall, if the two differ.
///
/// # Errors
/// An option contradicts the file, or the frame of the mesh is unknown.
pub fn turn(my: &Options, robot: &Robot, wall: &Wall) -> Result<Option<[Frame; 2]>, String> {
    if my.pose.is_some() {
        return Ok(None); // The pose leads into the frame of the mesh.
    }
    let own = Frame::resolve(robot.frame, my.frame.map(Frame::from)).map_err(|stated| {
        format!("the centreline's file says that it is {}; leave out --frame", stated.name())
    })?;
    match (own, wall.frame) {
        (Some(own), Some(other)) => Ok((own != other).then_some([own, other])),
        (Some(_), None) => {
            let file = my.mesh.display();
            Err(format!("{file} does not say whether it is LPS or RAS; say it with --mesh-frame"))
        }
        (None, _) => Ok(None),
    }
}
