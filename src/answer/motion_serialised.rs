//! Answers about motions as data (feature `serde-serialize`), points as `[x, y, z]`.

use super::place::check_place;
use super::{FirstContact, MotionAnswer};
use parry3d_f64::math::{Real, Vector};
use serde::{Deserialize, Serialize};

/// The fields of a [`MotionAnswer`].
#[derive(Serialize, Deserialize)]
#[serde(rename = "MotionAnswer")]
pub(crate) enum Answer {
    Clear,
    Contact(Touch),
    Undecided { interval: [Real; 2] },
}

/// The fields of a [`FirstContact`].
#[derive(Serialize, Deserialize)]
#[serde(rename = "FirstContact")]
pub(crate) enum First {
    Never,
    Within { clear_until: Real, contact: Touch },
    Undecided { interval: [Real; 2] },
}

/// A shape that is at most the margin away.
#[derive(Serialize, Deserialize)]
pub(crate) struct Touch {
    t: Real,
    upper: Real,
    arc_length: Real,
    section: u32,
    triangle: u32,
    on_robot: [Real; 3],
    on_mesh: [Real; 3],
}

impl Touch {
    /// No query names a time outside of the motion, a distance that is negative or not finite, nor such a place.
    fn check(self) -> Result<Self, String> {
        let Self { t, upper, arc_length, on_robot, on_mesh, .. } = self;
        check_times([0.0, t])?;
        if !(upper.is_finite() && upper >= 0.0) {
            return Err(format!("the clearance is {upper}; it must be finite and at least 0"));
        }
        check_place(arc_length, Vector::from_array(on_robot), Vector::from_array(on_mesh))?;
        Ok(self)
    }
}

/// Times of a motion are from 0 to 1, the earlier one first.
fn check_times([from, to]: [Real; 2]) -> Result<[Real; 2], String> {
    if 0.0 <= from && from <= to && to <= 1.0 {
        Ok([from, to])
    } else {
        Err(format!("times of a motion are from 0 to 1 and in order, not {from} to {to}"))
    }
}

impl From<MotionAnswer> for Answer {
    fn from(answer: MotionAnswer) -> Self {
        match answer {
            MotionAnswer::Clear => Self::Clear,
            MotionAnswer::Contact { t, upper, arc_length, section, triangle, on_robot, on_mesh } => {
                let (on_robot, on_mesh) = (on_robot.to_array(), on_mesh.to_array());
                Self::Contact(Touch { t, upper, arc_length, section, triangle, on_robot, on_mesh })
            }
            MotionAnswer::Undecided { interval } => Self::Undecided { interval },
        }
    }
}

impl TryFrom<Answer> for MotionAnswer {
    type Error = String;

    fn try_from(answer: Answer) -> Result<Self, String> {
        Ok(match answer {
            Answer::Clear => Self::Clear,
            Answer::Contact(touch) => {
                let Touch { t, upper, arc_length, section, triangle, on_robot, on_mesh } = touch.check()?;
                let (on_robot, on_mesh) = (Vector::from_array(on_robot), Vector::from_array(on_mesh));
                Self::Contact { t, upper, arc_length, section, triangle, on_robot, on_mesh }
            }
            Answer::Undecided { interval } => Self::Undecided { interval: check_times(interval)? },
        })
    }
}

impl From<FirstContact> for First {
    fn from(answer: FirstContact) -> Self {
        match answer {
            FirstContact::Never => Self::Never,
            FirstContact::Within {
                clear_until,
                t,
                upper,
                arc_length,
                section,
                triangle,
                on_robot,
                on_mesh,
            } => {
                let (on_robot, on_mesh) = (on_robot.to_array(), on_mesh.to_array());
                let contact = Touch { t, upper, arc_length, section, triangle, on_robot, on_mesh };
                Self::Within { clear_until, contact }
            }
            FirstContact::Undecided { interval } => Self::Undecided { interval },
        }
    }
}

impl TryFrom<First> for FirstContact {
    type Error = String;

    fn try_from(answer: First) -> Result<Self, String> {
        Ok(match answer {
            First::Never => Self::Never,
            First::Within { clear_until, contact } => {
                let Touch { t, upper, arc_length, section, triangle, on_robot, on_mesh } = contact.check()?;
                check_times([clear_until, t])?;
                let (on_robot, on_mesh) = (Vector::from_array(on_robot), Vector::from_array(on_mesh));
                Self::Within { clear_until, t, upper, arc_length, section, triangle, on_robot, on_mesh }
            }
            First::Undecided { interval } => Self::Undecided { interval: check_times(interval)? },
        })
    }
}
