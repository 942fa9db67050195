//! Answers about a scene of several structures and robots.

use super::{Contact, LinkProximity, RobotProximity};
use parry3d_f64::math::Real;

/// The least room that is left in a scene, and between whom, in the scene's frame and unit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Tightest {
    /// The distance less the margin: below 0 where the margin is not kept.
    pub slack: Real,
    /// Who is so near.
    pub between: Between,
}

/// Two that are near one another in a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Between {
    /// A robot and a structure.
    Structure(StructureProximity),
    /// Two robots.
    Robots {
        /// Their positions among the robots that were given, the lower first.
        robots: [u32; 2],
        /// Their closest links.
        nearest: RobotProximity,
    },
}

/// Where the robots are closest to one structure of a scene, in the scene's frame and unit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct StructureProximity {
    /// The structure's number, in the order in which structures were added.
    pub structure: u32,
    /// The robot's position among those that were given.
    pub robot: u32,
    /// Its closest link, and the closest triangle of the structure.
    pub nearest: LinkProximity,
    /// The distance less the structure's margin, if it has one.
    pub slack: Option<Real>,
}

/// A contact of a robot with one structure of a scene, in the scene's frame and unit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SceneContact {
    /// The structure's number.
    pub structure: u32,
    /// The robot's position among those that were given.
    pub robot: u32,
    /// Where and how they are near.
    pub contact: Contact,
}
