//! The page's interface to the library: walls, robots and their distances, in the wall's frame and
//! unit.

mod answers;
mod csv;
mod robot;
mod wall;

pub use answers::Answers;
pub use robot::Robot;
pub use wall::Wall;

use parry_continuum::parry::math::{Real, Vector};

/// Points as the page has them: x, y, z of one after the other.
fn flat<'a>(points: impl IntoIterator<Item = &'a Vector>) -> Vec<Real> {
    points.into_iter().flat_map(|point| point.to_array()).collect()
}
