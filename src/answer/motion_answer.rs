//! An answer about a motion.

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
    /// Whether the margin is kept at every time from 0 to 1. `Undecided`: no shape was found that
    /// is at most the margin away, but one that is so by the resolution more; or one in which
    /// the end of a link becomes flat or round, so close to the mesh that this decides; or the
    /// limit of work was reached. `reason` says which.
    pub decision: Decision,
    /// The first interval of time in which the margin may not be kept: it is kept before it. `[1,
    /// 1]` where it always is.
    pub interval: [Real; 2],
    /// Where the decision is `Contact`, a shape that does not keep it, which stands at the end of
    /// the interval.
    pub contact: Option<ShapeInContact>,
    /// Where the decision is `Undecided`, why.
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

    /// Whether the margin is kept at every time. This is proven.
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
