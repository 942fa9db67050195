//! Exact proximity queries between continuum robots and triangle meshes.
#![forbid(unsafe_code)]
#![warn(missing_docs)]

pub use parry3d_f64 as parry;

pub mod distance;
mod host;
pub mod proximity;
mod robot;

pub use host::ContinuumDispatcher;
pub use robot::{Cap, Chain, ModifiedCylinder, RobotError, simplify};
