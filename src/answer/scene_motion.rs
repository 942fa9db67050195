//! Answers about tubes and motions in a scene.

use super::{Decision, PairWitness, RobotsInContact, ShapeInContact, UndecidedReason, Witness};
use parry3d_f64::math::Real;

/// Whether robots that move in a scene keep all margins, and what does not.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SceneMotionAnswer {
    /// Whether all margins are kept at every time from 0 to 1.
    pub decision: Decision,
    /// The first interval of time in which a margin may be violated; all margins are kept before.
    /// `[1, 1]` if all are always kept. A contact of
    /// [`Scene::clears_motion`](crate::proximity::Scene::clears_motion) may not be the first one,
    /// so its interval begins with 0.
    pub interval: [Real; 2],
    /// For `Contact`: what is in contact, where, and when.
    pub contact: Option<SceneMotionContact>,
    /// For `Undecided`: the reason of the interval.
    pub reason: Option<UndecidedReason>,
}

impl SceneMotionAnswer {
    pub(crate) fn clear() -> Self {
        Self { decision: Decision::Clear, interval: [1.0; 2], contact: None, reason: None }
    }

    pub(crate) fn undecided((interval, reason): ([Real; 2], UndecidedReason)) -> Self {
        Self { decision: Decision::Undecided, interval, contact: None, reason: Some(reason) }
    }

    pub(crate) fn contact(clear_until: Real, contact: SceneMotionContact) -> Self {
        Self {
            decision: Decision::Contact,
            interval: [clear_until, contact.t()],
            contact: Some(contact),
            reason: None,
        }
    }

    /// Returns whether all margins are provably kept at every time.
    pub fn is_clear(&self) -> bool {
        self.decision == Decision::Clear
    }
}

/// Two objects of a scene that violate a margin at some time of a motion, in the scene's frame and
/// unit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum SceneMotionContact {
    /// A robot and a structure.
    Structure {
        /// The structure's number, in the order in which structures were added.
        structure: u32,
        /// The robot's index among the given motions.
        robot: u32,
        /// The robot's shape at that time, and the contact.
        shape: ShapeInContact,
    },
    /// Two robots.
    Robots {
        /// Their indices among the given motions, the lower first.
        robots: [u32; 2],
        /// Their shapes at that time, and the contact.
        shapes: RobotsInContact,
    },
    /// A robot and itself.
    Itself {
        /// The robot's index among the given motions.
        robot: u32,
        /// Two parts of its shape at that time, the one nearer to the base first.
        shapes: RobotsInContact,
    },
}

impl SceneMotionContact {
    /// Returns the time of the contact, from 0 to 1.
    pub fn t(&self) -> Real {
        match self {
            Self::Structure { shape, .. } => shape.t,
            Self::Robots { shapes, .. } | Self::Itself { shapes, .. } => shapes.t,
        }
    }

    /// Returns an upper bound on the clearance of the two objects, at most their margin.
    pub fn upper(&self) -> Real {
        match self {
            Self::Structure { shape, .. } => shape.upper,
            Self::Robots { shapes, .. } | Self::Itself { shapes, .. } => shapes.upper,
        }
    }
}

/// The least slack of tubes in a scene, between bounds, and its place.
///
/// The slack is the clearance minus the margin: negative if the margin is violated.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SceneClearance {
    /// Lower bound on every slack.
    pub lower: Real,
    /// Upper bound on the slack at `place`.
    pub upper: Real,
    /// Whether the bounds meet the tolerance: `upper - lower <= tolerance + uncertainty`.
    pub resolved: bool,
    /// The part of the gap that no finer tolerance closes: the errors that the tubes state of
    /// themselves.
    pub uncertainty: Real,
    /// The two objects with this slack, and where.
    pub place: ScenePlace,
}

/// The least slack of robots that move in a scene, between bounds, and its place and time.
///
/// The slack is the clearance minus the margin: negative if the margin is violated.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SceneMotionClearance {
    /// Lower bound on every slack at every time from 0 to 1.
    pub lower: Real,
    /// Upper bound on the slack at `place`, at the time `t`.
    pub upper: Real,
    /// Whether the bounds meet the tolerance: `upper - lower <= tolerance + uncertainty`.
    pub resolved: bool,
    /// The part of the gap that no finer tolerance closes: the errors that the shapes state of
    /// themselves.
    pub uncertainty: Real,
    /// The time of the shapes that realise `upper`, from 0 to 1.
    pub t: Real,
    /// The two objects with this slack, and where.
    pub place: ScenePlace,
}

/// Two objects of a scene and their nearest points, in the scene's frame and unit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum ScenePlace {
    /// A robot and a structure.
    Structure {
        /// The structure's number, in the order in which structures were added.
        structure: u32,
        /// The robot's index among the given robots.
        robot: u32,
        /// The section of constant radius at the place, counted from the base.
        section: u32,
        /// A point of the robot and a point of the structure.
        witness: Witness,
    },
    /// Two robots.
    Robots {
        /// Their indices among the given robots, the lower first.
        robots: [u32; 2],
        /// The sections of constant radius at the place, counted from each base.
        sections: [u32; 2],
        /// A point of each robot.
        witness: PairWitness,
    },
}
