//! An answer about two motions.

#[cfg(feature = "serde-serialize")]
use super::checked_fields::check_motion;
use super::checked_fields::checked_fields;
use super::{Decision, RobotsInContact, UndecidedReason};
use parry3d_f64::math::Real;

/// Whether two robots that move keep a margin between them, and which shapes do not.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde-serialize",
    serde(try_from = "serialised::Fields", into = "serialised::Fields")
)]
#[non_exhaustive]
pub struct RobotMotionAnswer {
    /// Whether the margin is kept at every time from 0 to 1. `Undecided`: no shapes were found
    /// that are at most the margin apart, but some that are farther apart than that by no more
    /// than the resolution and stated errors; or some in which the end of a link becomes flat
    /// or round, so close to the other robot that this decides; or the limit of
    /// work was reached. `reason` says which.
    pub decision: Decision,
    /// The first interval of time in which it is not known whether the margin is kept: it is kept
    /// before it. `[1, 1]` where it always is; a contact may not be the first one, so that the
    /// interval begins with 0.
    pub interval: [Real; 2],
    /// Where the decision is `Contact`, two shapes that do not keep it, which stand at the end of
    /// the interval.
    pub contact: Option<RobotsInContact>,
    /// Where the decision is `Undecided`, why.
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

    /// Whether the margin is kept at every time. This is proven.
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
