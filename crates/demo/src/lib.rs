//! The demo that examples, benches and tests share: a brain ventricle, a concentric tube robot in
//! it, and a picture of both. Lengths are in millimetres.
//!
//! | what | modules |
//! |---|---|
//! | the wall | [`ventricle`], grown from a [`field`] by [`surface`] and [`remesh`]; [`cavity`] and [`lumen`], of any size; [`subdivide`] |
//! | the robot | [`ctr`]; [`joint_motion`], while its joints move; [`torsion`], where its tubes twist; `rod`, where it bends (feature `rod`) |
//! | the way | [`steer`] finds a start and a goal in a mesh that nobody has planned a path for |
//! | pictures | `picture`, `figure`, `outline`, `canvas`, `lettering`, `colour_map`, `ticks` (feature `pictures`) |
//! | programs | `command`, `anatomy` (feature `command`); [`timing`], [`levels`] |

#[cfg(feature = "command")]
pub mod anatomy;
pub mod cavity;
#[cfg(feature = "pictures")]
pub mod colour_map;
#[cfg(feature = "command")]
pub mod command;
pub mod ctr;
pub mod field;
#[cfg(feature = "pictures")]
pub mod figure;
pub mod joint_motion;
pub mod levels;
pub mod lumen;
#[cfg(feature = "pictures")]
pub mod outline;
#[cfg(feature = "pictures")]
pub mod picture;
pub mod remesh;
#[cfg(feature = "rod")]
pub mod rod;
pub mod steer;
pub mod subdivide;
pub mod surface;
#[cfg(feature = "pictures")]
pub mod ticks;
pub mod timing;
pub mod torsion;
pub mod ventricle;

#[cfg(feature = "pictures")]
pub use continuum_pictures::{canvas, lettering};
