//! Serialisation of answers: fields are written as they are, and checked when they are read.

/// Defines the serde form of an answer in the module `$module`: its fields, under the written name.
/// `$check` returns an error for fields that no query returns.
macro_rules! checked_fields {
    ($module:ident, $written:literal, $name:ident { $($(#[$of_field:meta])* $field:ident: $type:ty),+ $(,)? }, $check:expr) => {
        #[cfg(feature = "serde-serialize")]
        mod $module {
            use super::*;

            #[derive(serde::Serialize, serde::Deserialize)]
            #[serde(rename = $written)]
            pub(crate) struct Fields {
                $($(#[$of_field])* $field: $type,)+
            }

            impl From<$name> for Fields {
                fn from($name { $($field),+ }: $name) -> Self {
                    Self { $($field),+ }
                }
            }

            impl TryFrom<Fields> for $name {
                type Error = String;

                fn try_from(fields: Fields) -> Result<Self, String> {
                    let check: fn(&Fields) -> Result<(), String> = $check;
                    check(&fields)?;
                    let Fields { $($field),+ } = fields;
                    Ok(Self { $($field),+ })
                }
            }
        }
    };
}

pub(super) use checked_fields;

/// Rejects fields that no query about a motion returns. The times must be ordered within 0 to 1.
/// There is a contact exactly for `Contact`, and a reason exactly for `Undecided`.
#[cfg(all(feature = "serde-serialize", feature = "tubes"))]
pub(super) fn check_motion<C: std::fmt::Debug>(
    decision: super::Decision,
    [from, to]: [parry3d_f64::math::Real; 2],
    contact: Option<&C>,
    reason: Option<super::UndecidedReason>,
) -> Result<(), String> {
    if !(0.0 <= from && from <= to && to <= 1.0) {
        return Err(format!("times of a motion are from 0 to 1 and in order, not {from} to {to}"));
    }
    if (decision == super::Decision::Contact) != contact.is_some() {
        return Err(format!("the decision is {decision:?}, and the contact is {contact:?}"));
    }
    if (decision == super::Decision::Undecided) != reason.is_some() {
        return Err(format!("the decision is {decision:?}, and the reason is {reason:?}"));
    }
    Ok(())
}

/// Rejects a distance that no query returns: negative or not finite.
#[cfg(feature = "serde-serialize")]
pub(super) fn check_distance(distance: parry3d_f64::math::Real) -> Result<(), String> {
    if distance.is_finite() && distance >= 0.0 {
        Ok(())
    } else {
        Err(format!("the distance is {distance}; it must be finite and at least 0"))
    }
}

/// Rejects bounds that no query returns: negative, out of order or not finite.
#[cfg(all(feature = "serde-serialize", feature = "tubes"))]
pub(super) fn check_bounds(
    [lower, upper]: [parry3d_f64::math::Real; 2],
    uncertainty: parry3d_f64::math::Real,
) -> Result<(), String> {
    if !(0.0 <= lower && lower <= upper && upper.is_finite()) {
        return Err(format!(
            "the bounds are {lower} and {upper}; they must be finite, at least 0, and in order"
        ));
    }
    if !(uncertainty.is_finite() && uncertainty >= 0.0) {
        return Err(format!("the uncertainty is {uncertainty}; it must be finite and at least 0"));
    }
    Ok(())
}

/// Rejects a shape in contact that no query returns: a time outside the motion, or a clearance that
/// is negative or not finite.
#[cfg(all(feature = "serde-serialize", feature = "tubes"))]
pub(super) fn check_shape(
    t: parry3d_f64::math::Real,
    upper: parry3d_f64::math::Real,
) -> Result<(), String> {
    check_time(t)?;
    if upper.is_finite() && upper >= 0.0 {
        Ok(())
    } else {
        Err(format!("the clearance is {upper}; it must be finite and at least 0"))
    }
}

/// Rejects a time outside the motion.
#[cfg(all(feature = "serde-serialize", feature = "tubes"))]
pub(super) fn check_time(t: parry3d_f64::math::Real) -> Result<(), String> {
    if (0.0..=1.0).contains(&t) {
        Ok(())
    } else {
        Err(format!("times of a motion are from 0 to 1, not {t}"))
    }
}
