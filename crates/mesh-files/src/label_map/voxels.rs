//! Reads the values of voxels, of any type, as labels.

use super::fault::Fault;
use crate::text::shown;
use flate2::read::{MultiGzDecoder, ZlibDecoder};
use std::io::{self, Read};

/// The type of a voxel's value.
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
    /// Returns the size in bytes.
    pub fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }
}

/// Returns the largest difference between a value and the label that it represents.
///
/// Some writers store labels times a scale, rounded to single precision or to a few digits. An
/// image is still refused, since some of its values are farther from whole numbers.
fn tolerance(number: f64) -> f64 {
    (number * f64::from(f32::EPSILON)).clamp(1e-4, 1e-2)
}

/// Returns a voxel's value as a label. -1 stands for voxels that are ignored or outside, and is
/// read as background.
///
/// # Errors
/// The value is not a label: the file is an image and not a segmentation.
pub fn label(number: f64) -> Result<u32, Fault> {
    let whole = number.round();
    let is_whole = (whole - number).abs() <= tolerance(number);
    if is_whole && (0.0..=f64::from(u32::MAX)).contains(&whole) {
        Ok(whole as u32)
    } else if is_whole && whole == -1.0 {
        Ok(0)
    } else {
        Err(Fault::NotALabel(number))
    }
}

/// The encoding of the voxels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Encoding {
    Raw,
    Gzip,
    Zlib,
    Text,
}

/// The voxels of a file. Each pass decodes them again, so that a small archive of a large volume
/// takes no memory.
pub struct Voxels<'a> {
    pub data: &'a [u8],
    pub encoding: Encoding,
    /// The number of unpacked bytes before the first voxel.
    pub skip: usize,
    pub count: usize,
    pub kind: Kind,
    pub is_big_endian: bool,
    /// The factor of a value, and the offset that is added then.
    pub scaling: Option<[f64; 2]>,
}

impl Voxels<'_> {
    /// Passes the labels of all voxels to `see`, in order, some at a time.
    ///
    /// # Errors
    /// There are fewer voxels than the header states, or values that are not labels.
    pub fn each(&self, see: &mut dyn FnMut(&[u32])) -> Result<(), Fault> {
        let size =
            self.count.checked_mul(self.kind.size()).and_then(|size| size.checked_add(self.skip));
        match (self.encoding, size) {
            (Encoding::Text, _) => self.each_of_text(see),
            (Encoding::Raw, Some(size)) => {
                let data = self.data.get(self.skip..size).ok_or(SHORT)?;
                self.each_of_bytes(data, see)
            }
            (Encoding::Gzip | Encoding::Zlib, Some(size)) if could_hold(self.data, size) => {
                let mut unpacked: Box<dyn Read> = match self.encoding {
                    Encoding::Zlib => Box::new(ZlibDecoder::new(self.data)),
                    _ => Box::new(MultiGzDecoder::new(self.data)),
                };
                let skip = io::copy(&mut unpacked.by_ref().take(self.skip as u64), &mut io::sink());
                if skip.map_err(|_| DAMAGED)? < self.skip as u64 {
                    return Err(SHORT.into());
                }
                self.each_of_bytes(unpacked, see)
            }
            _ => Err(SHORT.into()),
        }
    }

    /// Reads numbers of [`Kind`] from a stream that may be longer.
    fn each_of_bytes(
        &self,
        mut stream: impl Read,
        see: &mut dyn FnMut(&[u32]),
    ) -> Result<(), Fault> {
        let mut bytes = vec![0; AT_ONCE * self.kind.size()];
        let mut labels = Vec::with_capacity(AT_ONCE);
        for first in (0..self.count).step_by(AT_ONCE) {
            let bytes = &mut bytes[..AT_ONCE.min(self.count - first) * self.kind.size()];
            let mut there = 0;
            while there < bytes.len() {
                match stream.read(&mut bytes[there..]) {
                    Ok(0) => return Err(SHORT.into()),
                    Ok(more) => there += more,
                    Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                    Err(_) => return Err(DAMAGED.into()),
                }
            }
            labels.clear();
            self.decode(bytes, &mut labels)?;
            see(&labels);
        }
        Ok(())
    }

    fn decode(&self, bytes: &[u8], labels: &mut Vec<u32>) -> Result<(), Fault> {
        match self.kind {
            Kind::I8 => self.numbers(bytes, |b| i8::from_le_bytes(b).into(), labels),
            Kind::U8 => self.numbers(bytes, |b| u8::from_le_bytes(b).into(), labels),
            Kind::I16 => self.numbers(bytes, |b| i16::from_le_bytes(b).into(), labels),
            Kind::U16 => self.numbers(bytes, |b| u16::from_le_bytes(b).into(), labels),
            Kind::I32 => self.numbers(bytes, |b| i32::from_le_bytes(b).into(), labels),
            Kind::U32 => self.numbers(bytes, |b| u32::from_le_bytes(b).into(), labels),
            Kind::I64 => self.numbers(bytes, |b| i64::from_le_bytes(b) as f64, labels),
            Kind::U64 => self.numbers(bytes, |b| u64::from_le_bytes(b) as f64, labels),
            Kind::F32 => self.numbers(bytes, |b| f32::from_le_bytes(b).into(), labels),
            Kind::F64 => self.numbers(bytes, f64::from_le_bytes, labels),
        }
    }

    fn numbers<const SIZE: usize>(
        &self,
        bytes: &[u8],
        number: impl Fn([u8; SIZE]) -> f64,
        labels: &mut Vec<u32>,
    ) -> Result<(), Fault> {
        for &voxel in bytes.as_chunks().0 {
            let mut voxel: [u8; SIZE] = voxel;
            if self.is_big_endian {
                voxel.reverse();
            }
            labels.push(label(self.scaled(number(voxel)))?);
        }
        Ok(())
    }

    fn scaled(&self, number: f64) -> f64 {
        self.scaling.map_or(number, |[slope, intercept]| slope * number + intercept)
    }

    /// Reads numbers as words. A voxel takes at least two bytes, so no more voxels are read than
    /// the file has bytes.
    fn each_of_text(&self, see: &mut dyn FnMut(&[u32])) -> Result<(), Fault> {
        let text = String::from_utf8_lossy(self.data.get(self.skip..).ok_or(SHORT)?);
        let mut seen = 0;
        for word in text.split_whitespace().take(self.count) {
            let number = word.parse();
            let number = number
                .map_err(|_| format!("a voxel holds '{}', which is no number", shown(word)))?;
            see(&[label(self.scaled(number))?]);
            seen += 1;
        }
        if seen == self.count { Ok(()) } else { Err(SHORT.into()) }
    }
}

/// The number of voxels that are read at once.
const AT_ONCE: usize = 1 << 14;
const SHORT: &str = "it is shorter than its header says";
const DAMAGED: &str = "its packed voxels are damaged or cut short";

/// Returns the last bytes of a file, as many as the voxels take; all of them if there are too few.
pub fn last(data: &[u8], count: usize, kind: Kind) -> &[u8] {
    let size = count.saturating_mul(kind.size());
    &data[data.len().saturating_sub(size)..]
}

/// Deflate compresses at most 1032 bytes into one, so a header that promises more is wrong.
fn could_hold(archive: &[u8], count: usize) -> bool {
    count / 1032 <= archive.len()
}

/// Returns the first bytes of an archive's content, fewer if it has fewer.
pub fn unpack(archive: &[u8], count: usize) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    let unpacked = MultiGzDecoder::new(archive).take(count as u64).read_to_end(&mut bytes);
    unpacked.map_err(|_| DAMAGED)?;
    Ok(bytes)
}
