//! The errors of the libraries in the words of the options. Each is one line.

use crate::number::all_digits;
use mesh_files::MeshFileError;
use parry_continuum::RobotError;
use parry_continuum::proximity::{PlacementFault, ProximityError};
use std::path::Path;

/// Returns a text whose control characters are escaped.
pub fn in_one_line(text: &str) -> String {
    let escaped = |c: char| match c.is_control() {
        true => c.escape_default().collect::<String>(),
        false => c.into(),
    };
    text.chars().map(escaped).collect()
}

/// Returns the message for a file that cannot be read.
pub fn of_file(error: &MeshFileError) -> String {
    let text = error.to_string();
    match error {
        MeshFileError::NoPosition { file, missing, .. } => format!(
            "{} does not say where its voxels are ({missing}); save it again with a position, or \
             give --allow-no-position, which puts its first voxel at the origin",
            file.display()
        ),
        MeshFileError::WithoutLabels { file, format, .. } => format!(
            "{} holds triangles without labels ({format}); leave out --label, or give the \
             segmentation",
            file.display()
        ),
        MeshFileError::TooLarge { .. } => text.replace(", or raise Options::memory_limit", ""),
        MeshFileError::NoSuchLabel { .. } => {
            text.replace("choose one of them", "choose one of them with --label")
        }
        MeshFileError::NoSuchLine { .. } => {
            text.replace("choose one of them", "choose one of them with --line")
        }
        MeshFileError::SeveralLines { .. } => text + " with --line",
        MeshFileError::NotACurve { .. } => text.replace("choose line 0", "give --line 0"),
        MeshFileError::NotFinite { .. } => {
            text.replace("choose a smaller scale", "choose a smaller --scale")
        }
        _ => text,
    }
}

/// Returns the message for a robot from this file.
pub fn of_robot(error: &RobotError, file: &Path) -> String {
    let file = file.display();
    match error {
        RobotError::PointNotFinite { index, value, .. } => {
            format!(
                "point {index} of {file} has a coordinate that is not finite ({value}); repair it"
            )
        }
        RobotError::PointOutOfRange { index, value, limit, .. } => format!(
            "point {index} of {file} has the coordinate {}, beyond +-{limit:e}; choose a \
             smaller --scale",
            all_digits(*value)
        ),
        RobotError::BadRadius { index, value, limit, .. } => format!(
            "radius {index} is {} in {file}; write a number of at least 0 and at most {limit:e}",
            all_digits(*value)
        ),
        RobotError::TooFewPoints { count, .. } => {
            format!("{file} has {count} point; a robot needs at least 2")
        }
        RobotError::AllPointsEqual => {
            format!("all points of {file} are the same; a robot needs two different points")
        }
        RobotError::HidesLength { index, value, length, .. } => format!(
            "radius {index} of {file} is {}, beside which the length {} of its segment is lost; \
             check the unit of the radii",
            all_digits(*value),
            all_digits(*length)
        ),
        RobotError::TurnsTooSharply { index, .. } => format!(
            "the curve turns so sharply at point {index} of {file} that its samples do not bound \
             it; write more points there, or leave out --tolerance for a robot of straight links"
        ),
        RobotError::BendsWithinRadius { index, radius, .. } => format!(
            "the curve bends within its radius {} at point {index} of {file}; check the unit of the \
             radii, or leave out --tolerance",
            all_digits(*radius)
        ),
        _ => error.to_string(),
    }
}

/// Returns the message for a query about the robot from this file.
pub fn of_query(error: &ProximityError, file: &Path) -> String {
    match error {
        ProximityError::ToleranceTooFine { tolerance, possible, .. } => format!(
            "the bounds are {} apart at best, not {}; give a larger --tolerance, or more points in \
             {}",
            all_digits(*possible),
            all_digits(*tolerance),
            file.display()
        ),
        ProximityError::Pose(PlacementFault::OutOfRange { limit, .. })
        | ProximityError::Pose(PlacementFault::TubeOutOfRange { limit }) => {
            format!("--pose moves {} beyond +-{limit:e}; choose a smaller shift", file.display())
        }
        _ => error.to_string(),
    }
}

/// Why a curve has no bounds.
pub enum CurveError {
    Robot(RobotError),
    Query(ProximityError),
}

impl From<RobotError> for CurveError {
    fn from(error: RobotError) -> Self {
        Self::Robot(error)
    }
}

impl From<ProximityError> for CurveError {
    fn from(error: ProximityError) -> Self {
        Self::Query(error)
    }
}

/// Returns the message for the curve through the points of this file.
pub fn of_curve(error: CurveError, file: &Path) -> String {
    let reason = match error {
        CurveError::Robot(error) => of_robot(&error, file),
        CurveError::Query(error) => of_query(&error, file),
    };
    format!("no bounds for the curve: {reason}")
}
