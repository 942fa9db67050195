//! Where a program puts the robot: as its options say, or as the mesh allows.

use super::{steer, ventricle};
use parry_continuum::parry::math::{Pose, Real, Rot3, Vector};
use parry_continuum::parry::shape::TriMesh;
use std::path::Path;

/// Parses three numbers for an option.
///
/// # Errors
/// What was written is no point.
pub fn vector(text: &str) -> Result<Vector, String> {
    let numbers: Result<Vec<Real>, _> = text.split(',').map(|number| number.trim().parse()).collect();
    match numbers.as_deref() {
        Ok(&[x, y, z]) if Vector::new(x, y, z).is_finite() => Ok(Vector::new(x, y, z)),
        _ => Err("write three numbers, for example 68.6,105.2,104.6".into()),
    }
}

/// Parses a direction for an option, of any length but 0.
///
/// # Errors
/// What was written is no direction.
pub fn direction(text: &str) -> Result<Vector, String> {
    vector(text)?.try_normalize().ok_or("a direction needs a length; write for example 0,0,-1".into())
}

/// The robot's pose as asked for; what is not said is found in the mesh, which came from `file` or was grown.
///
/// # Errors
/// No base was named, and the mesh encloses nothing.
pub fn pose(
    base: Option<Vector>,
    axis: Option<Vector>,
    mesh: &TriMesh,
    file: Option<&Path>,
) -> Result<Pose, String> {
    let base = match (base, file) {
        (Some(base), _) => base,
        (None, None) => ventricle::entry().translation,
        (None, Some(path)) => steer::deepest_point(mesh).ok_or(format!(
            "{} encloses nothing, so a start inside cannot be found; name one with --base x,y,z and --axis x,y,z",
            path.display()
        ))?,
    };
    let axis = axis.unwrap_or_else(|| steer::clear_direction(mesh, base));
    Ok(Pose::from_parts(base, Rot3::from_rotation_arc(Vector::Z, axis)))
}

/// What to say when no goal was found from `base`.
pub fn no_goal(none: &steer::NoGoal, base: &Pose) -> String {
    match none {
        steer::NoGoal::NoRoom => format!(
            "the robot has no room at {} along {}: every shape touches the wall; \
             move it with --base and --axis, or bring the mesh to millimetres with --scale",
            show(base.translation),
            show(base.rotation * Vector::Z)
        ),
        steer::NoGoal::Robot(error) => error.to_string(),
        steer::NoGoal::Query(error) => error.to_string(),
    }
}

/// A point as text.
pub fn show(v: Vector) -> String {
    format!("({:.2}, {:.2}, {:.2})", v.x, v.y, v.z)
}
