//! A shape of a motion that violates a margin.

use super::Witness;
use super::checked_fields::checked_fields;
use parry3d_f64::math::Real;
use std::ops::{Deref, DerefMut};

/// A shape of a motion that is at most the margin away, in the mesh's frame and unit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde-serialize",
    serde(try_from = "serialised::Fields", into = "serialised::Fields")
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

impl Deref for ShapeInContact {
    type Target = Witness;

    fn deref(&self) -> &Witness {
        &self.witness
    }
}

impl DerefMut for ShapeInContact {
    fn deref_mut(&mut self) -> &mut Witness {
        &mut self.witness
    }
}

checked_fields!(
    "ShapeInContact",
    ShapeInContact {
        t: Real,
        upper: Real,
        section: u32,
        #[serde(flatten)]
        witness: Witness,
    },
    |&Fields { t, upper, .. }| {
        if !(0.0..=1.0).contains(&t) {
            return Err(format!("times of a motion are from 0 to 1, not {t}"));
        }
        if !(upper.is_finite() && upper >= 0.0) {
            return Err(format!("the clearance is {upper}; it must be finite and at least 0"));
        }
        Ok(())
    }
);
