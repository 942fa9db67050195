//! Results of queries about a scene of several structures and robots.

use super::{Contact, LinkProximity, RobotProximity};
use parry3d_f64::math::Real;

/// The least slack of a scene and its place, in the scene's frame and unit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Tightest {
    /// Distance minus margin: negative if the margin is violated.
    pub slack: Real,
    /// The two objects with this slack.
    pub between: Between,
}

/// Two objects that are near one another in a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Between {
    /// A robot and a structure.
    Structure(StructureProximity),
    /// Two robots.
    Robots {
        /// Their indices among the given robots, the lower first.
        robots: [u32; 2],
        /// Their closest links.
        nearest: RobotProximity,
    },
}

/// The place where the robots are closest to one structure of a scene, in the scene's frame and
/// unit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct StructureProximity {
    /// The structure's number, in the order in which structures were added.
    pub structure: u32,
    /// The robot's index among the given robots.
    pub robot: u32,
    /// Its closest link, and the closest triangle of the structure.
    pub nearest: LinkProximity,
    /// Distance minus the structure's margin, if it has one.
    pub slack: Option<Real>,
}

/// A contact of a robot with one structure of a scene, in the scene's frame and unit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SceneContact {
    /// The structure's number.
    pub structure: u32,
    /// The robot's index among the given robots.
    pub robot: u32,
    /// The contact itself.
    pub contact: Contact,
}
