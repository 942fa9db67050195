//! The numbers of the voxels, of any type, as labels.

use super::Fault;
use flate2::read::MultiGzDecoder;
use std::io::Read;

/// The type of a voxel's number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

impl Kind {
    /// How many bytes it takes.
    pub fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }
}

/// A voxel's number as a label.
///
/// # Errors
/// It is none: the file holds an image and not a segmentation.
pub fn label(number: f64) -> Result<u32, Fault> {
    if number >= 0.0 && number <= f64::from(u32::MAX) && number.fract() == 0.0 {
        Ok(number as u32)
    } else {
        Err(Fault::NotALabel(number))
    }
}

/// The labels in the bytes. `scaled` is what the file asks to do with each number.
pub fn labels(
    bytes: &[u8],
    kind: Kind,
    is_big_endian: bool,
    scaled: impl Fn(f64) -> f64,
) -> Result<Vec<u32>, Fault> {
    let is_big = is_big_endian;
    match kind {
        Kind::I8 => each(bytes, is_big, |b| i8::from_le_bytes(b).into(), scaled),
        Kind::U8 => each(bytes, is_big, |b| u8::from_le_bytes(b).into(), scaled),
        Kind::I16 => each(bytes, is_big, |b| i16::from_le_bytes(b).into(), scaled),
        Kind::U16 => each(bytes, is_big, |b| u16::from_le_bytes(b).into(), scaled),
        Kind::I32 => each(bytes, is_big, |b| i32::from_le_bytes(b).into(), scaled),
        Kind::U32 => each(bytes, is_big, |b| u32::from_le_bytes(b).into(), scaled),
        Kind::I64 => each(bytes, is_big, |b| i64::from_le_bytes(b) as f64, scaled),
        Kind::U64 => each(bytes, is_big, |b| u64::from_le_bytes(b) as f64, scaled),
        Kind::F32 => each(bytes, is_big, |b| f32::from_le_bytes(b).into(), scaled),
        Kind::F64 => each(bytes, is_big, f64::from_le_bytes, scaled),
    }
}

fn each<const SIZE: usize>(
    bytes: &[u8],
    is_big_endian: bool,
    number: impl Fn([u8; SIZE]) -> f64,
    scaled: impl Fn(f64) -> f64,
) -> Result<Vec<u32>, Fault> {
    let voxels = bytes.as_chunks().0.iter().copied().map(|mut voxel: [u8; SIZE]| {
        if is_big_endian {
            voxel.reverse();
        }
        label(scaled(number(voxel)))
    });
    voxels.collect()
}

/// What the archive holds, up to `count` bytes.
pub fn unpack(archive: &[u8], count: usize) -> Result<Vec<u8>, String> {
    // Deflate packs 1032 bytes into one at most: a header that promises more is not believed.
    if count / 1032 > archive.len() {
        return Err("it is shorter than its header says".into());
    }
    let mut bytes = Vec::new();
    let unpacked = MultiGzDecoder::new(archive).take(count as u64).read_to_end(&mut bytes);
    unpacked.map_err(|_| "its gzip archive is damaged or cut short")?;
    Ok(bytes)
}
