//! Records that the host writes and shaders read: one list of their fields makes both, laid out as WGSL says.

use super::Precision;
use parry3d_f64::math::Real;

/// What a record is made of.
pub(super) trait Field {
    /// The type in WGSL, where `real` is a number of the device's precision.
    const WGSL: &'static str;

    /// What its place in memory is a multiple of, in bytes.
    fn alignment(precision: Precision) -> usize;

    /// As a shader reads it.
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

impl Field for Real {
    const WGSL: &'static str = "real";

    fn alignment(precision: Precision) -> usize {
        precision.size() as usize
    }

    fn write(&self, precision: Precision, to: &mut Vec<u8>) {
        precision.write(*self, to);
    }
}

impl Field for [Real; 3] {
    const WGSL: &'static str = "vec3<real>";

    fn alignment(precision: Precision) -> usize {
        4 * precision.size() as usize
    }

    fn write(&self, precision: Precision, to: &mut Vec<u8>) {
        self.iter().for_each(|&number| precision.write(number, to));
    }
}

/// A record that goes to a device.
pub(super) trait Record: Default {
    /// Its name and its fields in WGSL.
    const NAME: &'static str;
    const FIELDS: &'static [(&'static str, &'static str)];

    /// As a shader reads it.
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

macro_rules! record {
    ($(#[$attribute:meta])* $name:ident { $($(#[$field_attribute:meta])* $field:ident: $kind:ty,)* }) => {
        $(#[$attribute])*
        #[derive(Clone, Copy, Debug, Default)]
        pub(super) struct $name {
            $($(#[$field_attribute])* pub $field: $kind,)*
        }

        impl $crate::gpu::record::Record for $name {
            const NAME: &'static str = stringify!($name);
            const FIELDS: &'static [(&'static str, &'static str)] =
                &[$((stringify!($field), <$kind as $crate::gpu::record::Field>::WGSL)),*];

            fn write(&self, precision: $crate::gpu::Precision, to: &mut Vec<u8>) {
                use $crate::gpu::record::Field;
                let (begin, mut largest) = (to.len(), 1);
                $(
                    let alignment = <$kind as Field>::alignment(precision);
                    largest = largest.max(alignment);
                    to.resize(begin + (to.len() - begin).next_multiple_of(alignment), 0);
                    self.$field.write(precision, to);
                )*
                to.resize(begin + (to.len() - begin).next_multiple_of(largest), 0);
            }
        }
    };
}

pub(super) use record;
