//! Answers as their fields: written as they are, and read back only if an answer can have them.

/// What serde sees of an answer: its fields, under the name that is written. `$check` says what is wrong with fields that no
/// answer has.
macro_rules! checked_fields {
    ($written:literal, $name:ident { $($(#[$of_field:meta])* $field:ident: $type:ty),+ $(,)? }, $check:expr) => {
        #[cfg(feature = "serde-serialize")]
        mod serialised {
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
