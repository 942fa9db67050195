//! How near a motion comes.

use super::Witness;
use parry3d_f64::math::Real;
use std::ops::{Deref, DerefMut};

/// When and where a motion comes nearest to a mesh, between bounds. All in the mesh's frame and
/// unit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde-serialize",
    serde(try_from = "serialised::Fields", into = "serialised::Fields")
)]
#[non_exhaustive]
pub struct MotionClearance {
    /// No shape of the motion is nearer than this.
    pub lower: Real,
    /// The shape at `t` is no farther away than this: 0 where it touches the mesh.
    pub upper: Real,
    /// Whether the bounds are as close as was asked for: no farther apart than the tolerance and
    /// `uncertainty`.
    pub resolved: bool,
    /// What the errors that shapes state for themselves cost, and no finer tolerance can mend.
    pub uncertainty: Real,
    /// The time of the shape that realises `upper`, from 0 to 1.
    pub t: Real,
    /// The section of constant radius at the place that realises `upper`, counted from the base.
    pub section: u32,
    /// A point of the tube and one of the mesh that are `upper` apart, or nearer.
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

    /// No engine gives bounds that are negative, in the wrong order or not finite, or a time
    /// outside of the motion.
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
