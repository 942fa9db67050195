//! The least clearance of a motion, between bounds.

use super::Witness;
use parry3d_f64::math::Real;
use std::ops::{Deref, DerefMut};

/// The time and the place where a motion is closest to a mesh, between bounds. All fields are in
/// the mesh's frame and unit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde-serialize",
    serde(try_from = "serialised::Fields", into = "serialised::Fields")
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

impl Deref for MotionClearance {
    type Target = Witness;

    fn deref(&self) -> &Witness {
        &self.witness
    }
}

impl DerefMut for MotionClearance {
    fn deref_mut(&mut self) -> &mut Witness {
        &mut self.witness
    }
}

#[cfg(feature = "serde-serialize")]
mod serialised {
    use super::{MotionClearance, Witness};
    use parry3d_f64::math::Real;
    use serde::{Deserialize, Serialize};

    /// The fields of a [`MotionClearance`].
    #[derive(Serialize, Deserialize)]
    #[serde(rename = "MotionClearance")]
    pub(crate) struct Fields {
        lower: Real,
        upper: Real,
        resolved: bool,
        uncertainty: Real,
        t: Real,
        section: u32,
        #[serde(flatten)]
        witness: Witness,
    }

    impl From<MotionClearance> for Fields {
        fn from(found: MotionClearance) -> Self {
            let MotionClearance { lower, upper, resolved, uncertainty, t, section, witness } =
                found;
            Self { lower, upper, resolved, uncertainty, t, section, witness }
        }
    }

    /// Rejects fields that no engine returns: bounds that are negative, out of order or not finite,
    /// or a time outside the motion.
    impl TryFrom<Fields> for MotionClearance {
        type Error = String;

        fn try_from(fields: Fields) -> Result<Self, String> {
            let Fields { lower, upper, resolved, uncertainty, t, section, witness } = fields;
            if !(0.0 <= lower && lower <= upper && upper.is_finite()) {
                return Err(format!(
                    "the bounds are {lower} and {upper}; they must be finite, at least 0, and in order"
                ));
            }
            if !(uncertainty.is_finite() && uncertainty >= 0.0) {
                return Err(format!(
                    "the uncertainty is {uncertainty}; it must be finite and at least 0"
                ));
            }
            if !(0.0..=1.0).contains(&t) {
                return Err(format!("times of a motion are from 0 to 1, not {t}"));
            }
            Ok(Self { lower, upper, resolved, uncertainty, t, section, witness })
        }
    }
}
