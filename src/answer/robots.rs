//! Answers about two robots, or about one robot and itself.

use super::checked_fields::checked_fields;
#[cfg(feature = "serde-serialize")]
use super::checked_fields::{check_bounds, check_distance, check_motion, check_shape, check_time};
use super::tube::resolve;
use super::{Decision, PairWitness, ProximityError, UndecidedReason};
use crate::curve::TooSharp;
use parry3d_f64::math::Real;

/// The place where two links are closest, one of each robot, in the frame and unit of the poses.
///
/// For one robot and itself, the first link is the one nearer to the base, and the frame is the
/// robot's own.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde-serialize",
    serde(try_from = "robot_proximity_fields::Fields", into = "robot_proximity_fields::Fields")
)]
#[non_exhaustive]
pub struct RobotProximity {
    /// The links' indices in [`Chain::links`](crate::Chain::links), of the first robot and of the
    /// second.
    pub links: [u32; 2],
    /// The distance between the two links, 0 if they touch or overlap.
    pub distance: Real,
    /// The closest points of the two links and their places.
    pub witness: PairWitness,
}

checked_fields!(
    robot_proximity_fields,
    "RobotProximity",
    RobotProximity {
        links: [u32; 2],
        distance: Real,
        #[serde(flatten)]
        witness: PairWitness,
    },
    |&Fields { distance, .. }| check_distance(distance)
);

/// The place where two tubes are closest, between bounds, in the frame and unit of the poses.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde-serialize",
    serde(try_from = "robot_clearance_fields::Fields", into = "robot_clearance_fields::Fields")
)]
#[non_exhaustive]
pub struct RobotClearance {
    /// Lower bound on the clearance.
    pub lower: Real,
    /// Upper bound on the clearance: 0 if the tubes touch or overlap.
    pub upper: Real,
    /// Whether the bounds meet the tolerance: `upper - lower <= tolerance + uncertainty`.
    pub resolved: bool,
    /// The part of the gap that no finer tolerance closes: the errors that the tubes state of
    /// themselves. Near a flat face of unknown direction ([`Tube::fit`](crate::Tube::fit)) it
    /// includes the effect of that direction.
    pub uncertainty: Real,
    /// The sections of constant radius that realise `upper`, counted from each base.
    pub sections: [u32; 2],
    /// A point of each tube, at most `upper` apart, and their places.
    pub witness: PairWitness,
}

impl RobotClearance {
    /// Combines two answers to one query: the larger `lower`, and the smaller `upper` with its
    /// place.
    pub(crate) fn and(self, other: Self, tolerance: Real) -> Self {
        let nearer = if other.upper < self.upper { other } else { self };
        let lower = self.lower.max(other.lower);
        let uncertainties = [self.uncertainty, other.uncertainty];
        let (resolved, uncertainty) = resolve(nearer.upper - lower, uncertainties, tolerance);
        Self { lower, resolved, uncertainty, ..nearer }
    }
}

checked_fields!(
    robot_clearance_fields,
    "RobotClearance",
    RobotClearance {
        lower: Real,
        upper: Real,
        resolved: bool,
        uncertainty: Real,
        sections: [u32; 2],
        #[serde(flatten)]
        witness: PairWitness,
    },
    |&Fields { lower, upper, uncertainty, .. }| check_bounds([lower, upper], uncertainty)
);

/// Whether two moving robots keep a margin between them, and which shapes do not.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde-serialize",
    serde(
        try_from = "robot_motion_answer_fields::Fields",
        into = "robot_motion_answer_fields::Fields"
    )
)]
#[non_exhaustive]
pub struct RobotMotionAnswer {
    /// Whether the robots keep the margin at every time from 0 to 1. `Undecided` has one of these
    /// causes, which `reason` names:
    ///
    /// - Two shapes are farther apart than the margin by at most the resolution and the stated
    ///   errors.
    /// - The end of a link becomes flat or round so close to the other robot that this decides.
    /// - The query has reached its limit of work.
    pub decision: Decision,
    /// The first interval of time in which it is unknown whether the robots keep the margin; they
    /// keep it before. `[1, 1]` if they always do. A contact of
    /// [`clears_motions`](crate::proximity::RobotPair::clears_motions) may not be the first one, so
    /// its interval begins with 0.
    pub interval: [Real; 2],
    /// For `Contact`: two shapes at most the margin apart, at the end of the interval.
    pub contact: Option<RobotsInContact>,
    /// For `Undecided`: the reason.
    pub reason: Option<UndecidedReason>,
}

impl RobotMotionAnswer {
    pub(crate) fn clear() -> Self {
        Self { decision: Decision::Clear, interval: [1.0; 2], contact: None, reason: None }
    }

    pub(crate) fn undecided((interval, reason): ([Real; 2], UndecidedReason)) -> Self {
        Self { decision: Decision::Undecided, interval, contact: None, reason: Some(reason) }
    }

    pub(crate) fn contact(clear_until: Real, contact: RobotsInContact) -> Self {
        Self {
            decision: Decision::Contact,
            interval: [clear_until, contact.t],
            contact: Some(contact),
            reason: None,
        }
    }

    /// Returns whether the robots provably keep the margin at every time.
    pub fn is_clear(&self) -> bool {
        self.decision == Decision::Clear
    }
}

checked_fields!(
    robot_motion_answer_fields,
    "RobotMotionAnswer",
    RobotMotionAnswer {
        decision: Decision,
        interval: [Real; 2],
        contact: Option<RobotsInContact>,
        reason: Option<UndecidedReason>,
    },
    |&Fields { decision, interval, contact, reason }| {
        check_motion(decision, interval, contact.as_ref(), reason)
    }
);

/// Two shapes that motions take at the same time, at most the margin apart, in the frame and unit
/// of the motions.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde-serialize",
    serde(
        try_from = "robots_in_contact_fields::Fields",
        into = "robots_in_contact_fields::Fields"
    )
)]
#[non_exhaustive]
pub struct RobotsInContact {
    /// The time of the shapes, from 0 to 1.
    pub t: Real,
    /// Upper bound on their clearance, at most the margin: 0 if they touch or overlap.
    pub upper: Real,
    /// The sections of constant radius that realise `upper`, counted from each base.
    pub sections: [u32; 2],
    /// A point of each robot, at most `upper` apart, and their places.
    pub witness: PairWitness,
}

checked_fields!(
    robots_in_contact_fields,
    "RobotsInContact",
    RobotsInContact {
        t: Real,
        upper: Real,
        sections: [u32; 2],
        #[serde(flatten)]
        witness: PairWitness,
    },
    |&Fields { t, upper, .. }| check_shape(t, upper)
);

/// The time and the places where two moving robots are closest, between bounds, in the frame and
/// unit of the motions.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde-serialize",
    serde(
        try_from = "robot_motion_clearance_fields::Fields",
        into = "robot_motion_clearance_fields::Fields"
    )
)]
#[non_exhaustive]
pub struct RobotMotionClearance {
    /// Lower bound on the clearance at every time from 0 to 1.
    pub lower: Real,
    /// Upper bound on the clearance of the shapes at `t`: 0 if they touch or overlap.
    pub upper: Real,
    /// Whether the bounds meet the tolerance: `upper - lower <= tolerance + uncertainty`.
    pub resolved: bool,
    /// The part of the gap that no finer tolerance closes: the errors that the shapes state of
    /// themselves.
    pub uncertainty: Real,
    /// The time of the shapes that realise `upper`, from 0 to 1.
    pub t: Real,
    /// The sections of constant radius that realise `upper`, counted from each base.
    pub sections: [u32; 2],
    /// A point of each robot, at most `upper` apart, and their places.
    pub witness: PairWitness,
}

checked_fields!(
    robot_motion_clearance_fields,
    "RobotMotionClearance",
    RobotMotionClearance {
        lower: Real,
        upper: Real,
        resolved: bool,
        uncertainty: Real,
        t: Real,
        sections: [u32; 2],
        #[serde(flatten)]
        witness: PairWitness,
    },
    |&Fields { lower, upper, uncertainty, t, .. }| check_bounds([lower, upper], uncertainty)
        .and(check_time(t))
);

impl From<TooSharp> for ProximityError {
    fn from(too_sharp: TooSharp) -> Self {
        match too_sharp {
            TooSharp::Joint { joint, angle, radius, length } => {
                Self::JointTooSharp { joint, angle, radius, length }
            }
            TooSharp::Bend { arc_length, curvature, radius } => {
                Self::BendsWithinRadius { arc_length, curvature, radius }
            }
        }
    }
}
