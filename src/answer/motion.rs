//! Answers about a motion and a mesh.

use super::checked_fields::checked_fields;
#[cfg(feature = "serde-serialize")]
use super::checked_fields::{check_bounds, check_motion, check_shape, check_time};
use super::{Decision, UndecidedReason, Witness};
use parry3d_f64::math::Real;

/// Whether a motion keeps a margin from the mesh, until when, and which shape does not.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde-serialize",
    serde(try_from = "motion_answer_fields::Fields", into = "motion_answer_fields::Fields")
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
    motion_answer_fields,
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

/// A shape of a motion that is at most the margin away, in the mesh's frame and unit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde-serialize",
    serde(try_from = "shape_in_contact_fields::Fields", into = "shape_in_contact_fields::Fields")
)]
#[non_exhaustive]
pub struct ShapeInContact {
    /// The time of the shape, from 0 to 1.
    pub t: Real,
    /// Upper bound on its clearance, at most the margin.
    pub upper: Real,
    /// The section of constant radius at the place that realises `upper`, counted from the base.
    pub section: u32,
    /// A point of the tube and a point of the mesh that are at most `upper` apart.
    pub witness: Witness,
}

checked_fields!(
    shape_in_contact_fields,
    "ShapeInContact",
    ShapeInContact {
        t: Real,
        upper: Real,
        section: u32,
        #[serde(flatten)]
        witness: Witness,
    },
    |&Fields { t, upper, .. }| check_shape(t, upper)
);

/// The time and the place where a motion is closest to a mesh, between bounds. All fields are in
/// the mesh's frame and unit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde-serialize",
    serde(try_from = "motion_clearance_fields::Fields", into = "motion_clearance_fields::Fields")
)]
#[non_exhaustive]
pub struct MotionClearance {
    /// Lower bound on the clearance of every shape of the motion.
    pub lower: Real,
    /// Upper bound on the clearance of the shape at `t`: 0 if it touches the mesh.
    pub upper: Real,
    /// Whether the bounds meet the tolerance: `upper - lower <= tolerance + uncertainty`.
    pub resolved: bool,
    /// The part of the gap that no finer tolerance closes: the errors that the shapes state of
    /// themselves.
    pub uncertainty: Real,
    /// The time of the shape that realises `upper`, from 0 to 1.
    pub t: Real,
    /// The section of constant radius at the place that realises `upper`, counted from the base.
    pub section: u32,
    /// A point of the tube and a point of the mesh that are at most `upper` apart.
    pub witness: Witness,
}

checked_fields!(
    motion_clearance_fields,
    "MotionClearance",
    MotionClearance {
        lower: Real,
        upper: Real,
        resolved: bool,
        uncertainty: Real,
        t: Real,
        section: u32,
        #[serde(flatten)]
        witness: Witness,
    },
    |&Fields { lower, upper, uncertainty, t, .. }| check_bounds([lower, upper], uncertainty)
        .and(check_time(t))
);
