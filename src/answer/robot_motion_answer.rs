//! The decision about two motions.

#[cfg(feature = "serde-serialize")]
use super::checked_fields::check_motion;
use super::checked_fields::checked_fields;
use super::{Decision, RobotsInContact, UndecidedReason};
use parry3d_f64::math::Real;

/// Whether two moving robots keep a margin between them, and which shapes do not.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde-serialize",
    serde(try_from = "serialised::Fields", into = "serialised::Fields")
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
    /// keep it before. `[1, 1]` if they always do. A contact may not be the first one, so its
    /// interval begins with 0.
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

    pub(crate) fn contact(contact: RobotsInContact) -> Self {
        Self {
            decision: Decision::Contact,
            interval: [0.0, contact.t],
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
