//! Exact proximity queries between continuum robots and triangle meshes.
#![forbid(unsafe_code)]
#![warn(missing_docs)]

pub use parry3d_f64 as parry;

pub mod distance;
pub mod proximity;
mod robot;
pub mod roots;

pub use robot::{Cap, Chain, ModifiedCylinder, RobotError, simplify};
