//! parry-continuum for numpy: the module `parry_continuum._native`. Users see it through the Python
//! package beside it.
//!
//! `input` makes plain numbers of what Python hands over, `motions` has a class for each kind of
//! motion, `threads` asks about them without the GIL, `queries` has a file for each question, and
//! `output` makes arrays of the answers.

mod error;
mod files;
mod input;
mod mesh;
mod motions;
mod output;
mod queries;
mod robots;
mod scene;
mod threads;
mod warning;

use pyo3::prelude::*;

/// The compiled half of `parry_continuum`.
#[pymodule(gil_used = true)]
mod _native {
    #[pymodule_export]
    use super::files::{load, load_centreline};
    #[pymodule_export]
    use super::mesh::{Mesh, gpu_available};
    #[pymodule_export]
    use super::motions::{
        BendingMotion, LinearMotion, Motion, MotionPath, MovingBase, RigidMotion, verify_motion,
    };
    #[pymodule_export]
    use super::queries::two_robots::{RobotPair, SelfQuery};
    #[pymodule_export]
    use super::robots::{link_surfaces, simplify};
    #[pymodule_export]
    use super::scene::Scene;
    use super::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        threads::watch_forks();
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
