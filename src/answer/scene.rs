//! Answers and errors of queries about a scene of several structures and robots.

use super::{Contact, LinkProximity, ProximityError, RobotProximity};
use parry3d_f64::math::Real;
use thiserror::Error;

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
    /// The structure's number, in the order in which structures were added:
    /// [`Scene::name`](crate::proximity::Scene::name).
    pub structure: u32,
    /// The robot's index among the given robots.
    pub robot: u32,
    /// Its closest link, and the closest triangle of the structure. In a solid structure the
    /// distance is 0, and the robot's point nearest to the surface is the common point.
    pub nearest: LinkProximity,
    /// Distance minus the margin between the two, if they have one.
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

/// The reason why a scene has no answer, or why a structure cannot be part of it.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum SceneError {
    /// A structure is at fault.
    #[error("structure `{name}`: {error}")]
    Structure {
        /// The structure's name.
        name: String,
        /// What is wrong, and what to change.
        error: ProximityError,
    },
    /// A robot is at fault, perhaps together with a structure.
    #[error("robot {robot}{}: {error}", beside(.structure))]
    Robot {
        /// The robot's index among the given robots.
        robot: usize,
        /// The name of the structure that was queried; `None` if the robot alone is at fault.
        structure: Option<String>,
        /// What is wrong, and what to change.
        error: ProximityError,
    },
    /// Two robots together are at fault.
    #[error("robots {} and {}: {error}", .robots[0], .robots[1])]
    Robots {
        /// Their indices among the given robots, the lower first.
        robots: [usize; 2],
        /// What is wrong, and what to change.
        error: ProximityError,
    },
    /// The margin between robots is at fault.
    #[error("between robots: {0}")]
    BetweenRobots(ProximityError),
    /// A parameter of the query is at fault.
    #[error(transparent)]
    Query(ProximityError),
    /// Neither a structure nor the robots have a margin, so there is nothing to keep.
    #[error(
        "nothing in the scene has a margin, so no robot could violate one; give a structure or the robots a margin, or ask for \
         `per_structure`"
    )]
    NoMargin,
    /// The margin of moving robots to themselves is by arc length.
    #[error(
        "the margin of robots to themselves is by arc length, which motions do not have; remove the scene's arc length, or ask \
         `clears` or `clears_tube` about shapes on the way"
    )]
    SelfArcOfMotion,
    /// Two structures would have the same name.
    #[error("structure {structure} has the name `{name}` too; give each structure its own name")]
    NameTaken {
        /// The name that was given.
        name: String,
        /// The number of the structure that has it.
        structure: usize,
    },
    /// The mesh of a solid structure bounds no volume.
    #[error(
        "structure `{name}` cannot be solid: its mesh has {open_edges} open edges and {unbalanced_edges} edges whose triangles \
         face opposite ways; close the mesh and make all triangles face the same way, or do not make the structure solid"
    )]
    NotSolid {
        /// The structure's name.
        name: String,
        /// The number of edges of its openings.
        open_edges: usize,
        /// [`SurfaceReport::unbalanced_edges`](super::SurfaceReport::unbalanced_edges).
        unbalanced_edges: usize,
    },
    /// There is no structure with this number.
    #[error(
        "there is no structure {structure} among {structures}; give the number that `add` returned"
    )]
    NoSuchStructure {
        /// The number that was given.
        structure: usize,
        /// The number of structures.
        structures: usize,
    },
}

fn beside(structure: &Option<String>) -> String {
    structure.as_ref().map_or_else(String::new, |name| format!(" beside structure `{name}`"))
}

impl SceneError {
    /// The error in one word, the same in Rust and Python; for a wrapped error, the word of that
    /// error.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Structure { error, .. }
            | Self::Robot { error, .. }
            | Self::Robots { error, .. }
            | Self::BetweenRobots(error)
            | Self::Query(error) => error.kind(),
            Self::NoMargin => "no_margin",
            Self::SelfArcOfMotion => "self_arc_of_motion",
            Self::NameTaken { .. } => "name_taken",
            Self::NotSolid { .. } => "not_solid",
            Self::NoSuchStructure { .. } => "no_such_structure",
        }
    }
}
