// Exhaustive, so that a kernel for both precisions covers all precisions.
/// The numbers with which a GPU computes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Precision {
    /// Single precision: fast on every GPU.
    F32,
    /// Double precision: needs Vulkan and a GPU that has it, and is fast on few.
    F64,
}

impl Precision {
    /// Bytes of a number.
    pub fn size(self) -> u64 {
        match self {
            Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// The nearest number of this precision, as a GPU reads it.
    pub fn write(self, value: f64, to: &mut Vec<u8>) {
        match self {
            Self::F32 => to.extend((value as f32).to_ne_bytes()),
            Self::F64 => to.extend(value.to_ne_bytes()),
        }
    }

    /// Numbers that a GPU has written.
    pub fn read(self, from: &[u8]) -> impl Iterator<Item = f64> + '_ {
        let size = self.size() as usize;
        from.chunks_exact(size).map(move |bytes| match *bytes {
            [a, b, c, d] => f32::from_ne_bytes([a, b, c, d]).into(),
            [a, b, c, d, e, f, g, h] => f64::from_ne_bytes([a, b, c, d, e, f, g, h]),
            _ => 0.0, // chunks are of 4 or 8 bytes
        })
    }
}
