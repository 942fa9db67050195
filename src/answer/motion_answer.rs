//! The decision about a motion.

#[cfg(feature = "serde-serialize")]
use super::checked_fields::check_motion;
use super::checked_fields::checked_fields;
use super::{Decision, ShapeInContact, UndecidedReason};
use parry3d_f64::math::Real;

/// Whether a motion keeps a margin from the mesh, until when, and which shape does not.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde-serialize",
    serde(try_from = "serialised::Fields", into = "serialised::Fields")
)]
#[non_exhaustive]
pub struct MotionAnswer {
    /// Whether the motion keeps the margin at every time from 0 to 1. `Undecided` has one of these
    /// causes, which `reason` names:
    ///
    /// - A shape is farther than the margin by at most the resolution.
    /// - The end of a link becomes flat or round so close to the mesh that this decides.
    /// - The query has reached its limit of work.
    pub decision: Decision,
    /// The first interval of time in which the motion may not keep the margin; it keeps the margin
    /// before. `[1, 1]` if it always does.
    pub interval: [Real; 2],
    /// For `Contact`: a shape at most the margin away, at the end of the interval.
    pub contact: Option<ShapeInContact>,
    /// For `Undecided`: the reason.
    pub reason: Option<UndecidedReason>,
}

impl MotionAnswer {
    pub(crate) fn clear() -> Self {
        Self { decision: Decision::Clear, interval: [1.0; 2], contact: None, reason: None }
    }

    pub(crate) fn undecided((interval, reason): ([Real; 2], UndecidedReason)) -> Self {
        Self { decision: Decision::Undecided, interval, contact: None, reason: Some(reason) }
    }

    pub(crate) fn contact(clear_until: Real, contact: ShapeInContact) -> Self {
        Self {
            decision: Decision::Contact,
            interval: [clear_until, contact.t],
            contact: Some(contact),
            reason: None,
        }
    }

    /// Returns whether the motion provably keeps the margin at every time.
    pub fn is_clear(&self) -> bool {
        self.decision == Decision::Clear
    }
}

checked_fields!(
    "MotionAnswer",
    MotionAnswer {
        decision: Decision,
        interval: [Real; 2],
        contact: Option<ShapeInContact>,
        reason: Option<UndecidedReason>,
    },
    |&Fields { decision, interval, contact, reason }| {
        check_motion(decision, interval, contact.as_ref(), reason)
    }
);
