//! The page's interface to the library: files, walls, robots and their distances, in the wall's
//! frame and unit.

mod answers;
mod files;
mod placement;
mod questions;
mod robot;
mod wall;

pub use answers::Answers;
pub use files::Files;
pub use robot::Robot;
pub use wall::Wall;

use mesh_files::Frame;
use parry_continuum::parry::math::{Real, Vector};

/// Points as the page has them: x, y, z of one after the other.
fn flat<'a>(points: impl IntoIterator<Item = &'a Vector>) -> Vec<Real> {
    points.into_iter().flat_map(|point| point.to_array()).collect()
}

/// Returns the frame of this name.
///
/// # Errors
/// The name is neither RAS nor LPS.
fn frame_of(name: &str) -> Result<Frame, String> {
    match name {
        "RAS" => Ok(Frame::Ras),
        "LPS" => Ok(Frame::Lps),
        other => Err(format!("the frame is '{other}'; choose RAS or LPS")),
    }
}
