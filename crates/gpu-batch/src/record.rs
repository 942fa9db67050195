//! Records that the host writes and shaders read: one list of fields defines both, in WGSL's
//! layout.

use crate::Precision;

/// The type of a record's field.
pub trait Field {
    /// The type in WGSL, where `real` is a number of the device's precision.
    const WGSL: &'static str;

    /// The alignment in bytes.
    fn alignment(precision: Precision) -> usize;

    /// Its bytes, as a shader reads them.
    fn write(&self, precision: Precision, to: &mut Vec<u8>);
}

impl Field for u32 {
    const WGSL: &'static str = "u32";

    fn alignment(_: Precision) -> usize {
        size_of::<u32>()
    }

    fn write(&self, _: Precision, to: &mut Vec<u8>) {
        to.extend(self.to_ne_bytes());
    }
}

impl Field for f64 {
    const WGSL: &'static str = "real";

    fn alignment(precision: Precision) -> usize {
        precision.size() as usize
    }

    fn write(&self, precision: Precision, to: &mut Vec<u8>) {
        precision.write(*self, to);
    }
}

impl Field for [f64; 3] {
    const WGSL: &'static str = "vec3<real>";

    fn alignment(precision: Precision) -> usize {
        4 * precision.size() as usize
    }

    fn write(&self, precision: Precision, to: &mut Vec<u8>) {
        self.iter().for_each(|&number| precision.write(number, to));
    }
}

/// A record that is sent to a device.
pub trait Record: Default {
    /// Its name in WGSL.
    const NAME: &'static str;

    /// The names and the types of its fields in WGSL.
    const FIELDS: &'static [(&'static str, &'static str)];

    /// Its bytes, as a shader reads them.
    fn write(&self, precision: Precision, to: &mut Vec<u8>);

    /// Bytes.
    fn size(precision: Precision) -> u64 {
        let mut bytes = Vec::new();
        Self::default().write(precision, &mut bytes);
        bytes.len() as u64
    }

    /// The declaration in WGSL.
    fn wgsl() -> String {
        let fields = Self::FIELDS.iter().map(|(name, kind)| format!("    {name}: {kind},\n"));
        format!("struct {} {{\n{}}}\n", Self::NAME, fields.collect::<String>())
    }
}

/// Declares a [`Record`] of fields that are `u32`, `f64` (a `real` of the device's precision) or
/// `[f64; 3]` (a `vec3<real>`).
///
/// ```
/// use gpu_batch::{Precision, Record, record};
///
/// record! {
///     /// A ball.
///     pub struct Sphere {
///         /// Its centre.
///         pub centre: [f64; 3],
///         /// Its radius.
///         pub radius: f64,
///     }
/// }
///
/// assert_eq!(Sphere::wgsl(), "struct Sphere {\n    centre: vec3<real>,\n    radius: real,\n}\n");
/// assert_eq!((Sphere::size(Precision::F32), Sphere::size(Precision::F64)), (16, 32));
/// ```
#[macro_export]
macro_rules! record {
    ($(#[$attribute:meta])* $record_vis:vis struct $name:ident {
        $($(#[$field_attribute:meta])* $vis:vis $field:ident: $kind:ty,)*
    }) => {
        $(#[$attribute])*
        #[derive(Clone, Copy, Debug, Default)]
        $record_vis struct $name {
            $($(#[$field_attribute])* $vis $field: $kind,)*
        }

        impl $crate::Record for $name {
            const NAME: &'static str = stringify!($name);
            const FIELDS: &'static [(&'static str, &'static str)] =
                &[$((stringify!($field), <$kind as $crate::Field>::WGSL)),*];

            fn write(&self, precision: $crate::Precision, to: &mut Vec<u8>) {
                let (begin, mut largest) = (to.len(), 1);
                $(
                    let alignment = <$kind as $crate::Field>::alignment(precision);
                    largest = largest.max(alignment);
                    to.resize(begin + (to.len() - begin).next_multiple_of(alignment), 0);
                    $crate::Field::write(&self.$field, precision, to);
                )*
                to.resize(begin + (to.len() - begin).next_multiple_of(largest), 0);
            }
        }
    };
}
