//! Decodes the numbers of a `DataArray` in VTK's XML files.

use super::xml::Element;
use crate::text::{no_number, shown};
use base64::Engine;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use flate2::read::ZlibDecoder;
use std::cell::Cell;
use std::io::Read;

/// The properties that all arrays of a file share.
pub struct Arrays<'a> {
    is_big_endian: bool,
    /// The number of bytes of a length in front of compressed bytes.
    header: usize,
    is_packed: bool,
    /// The appended data, and whether it is base64.
    appended: Option<(&'a [u8], bool)>,
    /// The number of bytes that all arrays together may still take, results included.
    left: Cell<u64>,
}

/// An upper bound on the bytes for each number: by itself, as an index, in a line, and as a point
/// of a line.
const EACH: u64 = 48;

/// The numbers of one array.
pub enum DataArray {
    Floats(Vec<f64>),
    Integers(Vec<i64>),
}

impl DataArray {
    pub fn into_numbers(self) -> Vec<f64> {
        match self {
            Self::Floats(numbers) => numbers,
            Self::Integers(numbers) => numbers.into_iter().map(|number| number as f64).collect(),
        }
    }

    pub fn into_indices(self) -> Result<Vec<u64>, String> {
        match self {
            Self::Floats(_) => Err("its lines name points by numbers that are no integers".into()),
            Self::Integers(numbers) => {
                let index = |number: i64| {
                    u64::try_from(number).map_err(|_| format!("{number} is no number of a point"))
                };
                numbers.into_iter().map(index).collect()
            }
        }
    }
}

impl<'a> Arrays<'a> {
    /// Reads the properties of the file. `appended` begins with its own tag.
    pub fn new(root: &Element, appended: Option<&'a [u8]>, limit: u64) -> Result<Self, String> {
        let is_packed = match root.attribute("compressor") {
            None | Some("") => false,
            Some("vtkZLibDataCompressor") => true,
            Some(other) => {
                let name =
                    other.strip_prefix("vtk").and_then(|name| name.strip_suffix("DataCompressor"));
                let name = shown(name.unwrap_or(other));
                return Err(format!(
                    "it is packed by {name}; save it with the compressor ZLib, or none"
                ));
            }
        };
        let header = if root.attribute("header_type") == Some("UInt64") { 8 } else { 4 };
        let is_big_endian = root.attribute("byte_order") == Some("BigEndian");
        let appended = match appended {
            None => None,
            Some(bytes) => {
                let tag = bytes.iter().position(|&byte| byte == b'>').ok_or(SHORT)?;
                let is_base64 = bytes[..tag].windows(6).any(|window| window == b"base64");
                let start = bytes[tag..].iter().position(|&byte| byte == b'_').ok_or(SHORT)?;
                Some((&bytes[tag + start + 1..], is_base64))
            }
        };
        Ok(Self { is_big_endian, header, is_packed, appended, left: Cell::new(limit) })
    }

    pub fn read(&self, array: &Element) -> Result<DataArray, String> {
        let kind = array.attribute("type").unwrap_or_default();
        let (size, is_float) = match kind {
            // The characters of a string.
            "Int8" | "UInt8" | "String" => (1, false),
            "Int16" | "UInt16" => (2, false),
            "Int32" | "UInt32" => (4, false),
            "Int64" | "UInt64" => (8, false),
            "Float32" => (4, true),
            "Float64" => (8, true),
            _ => return Err(format!("its numbers of type '{}' cannot be read", shown(kind))),
        };
        let text = array.text.as_str();
        let bytes = match array.attribute("format").unwrap_or("ascii") {
            "ascii" => {
                let wrong = |word: &str| format!("it has {}", no_number(word));
                let words = || text.split_whitespace();
                return if is_float {
                    let numbers: Result<_, _> =
                        words().map(|word| word.parse().map_err(|_| wrong(word))).collect();
                    Ok(DataArray::Floats(numbers?))
                } else {
                    let numbers: Result<_, _> =
                        words().map(|word| word.parse().map_err(|_| wrong(word))).collect();
                    Ok(DataArray::Integers(numbers?))
                };
            }
            "binary" => self.unpack_base64(text.trim().as_bytes(), size)?,
            "appended" => {
                let offset = array
                    .attribute("offset")
                    .and_then(|offset| offset.trim().parse::<usize>().ok());
                let (all, is_base64) =
                    self.appended.ok_or("its arrays are appended, but nothing is")?;
                let own = all.get(offset.ok_or("an array has no offset")?..).ok_or(SHORT)?;
                if is_base64 { self.unpack_base64(own, size)? } else { self.unpack(own, size)? }
            }
            other => return Err(format!("its format '{}' cannot be read", shown(other))),
        };
        if bytes.len() % size != 0 {
            return Err(SHORT.into());
        }
        let wide = |bytes: &[u8]| {
            let add = |number: u64, &byte: &u8| number << 8 | u64::from(byte);
            if self.is_big_endian {
                bytes.iter().fold(0, add)
            } else {
                bytes.iter().rev().fold(0, add)
            }
        };
        let numbers = bytes.chunks_exact(size).map(wide);
        Ok(match kind {
            "Float32" => DataArray::Floats(
                numbers.map(|bits| f64::from(f32::from_bits(bits as u32))).collect(),
            ),
            "Float64" => DataArray::Floats(numbers.map(f64::from_bits).collect()),
            "Int8" => DataArray::Integers(numbers.map(|bits| i64::from(bits as i8)).collect()),
            "Int16" => DataArray::Integers(numbers.map(|bits| i64::from(bits as i16)).collect()),
            "Int32" => DataArray::Integers(numbers.map(|bits| i64::from(bits as i32)).collect()),
            _ => DataArray::Integers(numbers.map(|bits| bits as i64).collect()),
        })
    }

    fn length(&self, bytes: &[u8], place: usize) -> Result<usize, String> {
        let from = place.checked_mul(self.header).ok_or(SHORT)?;
        let own = bytes.get(from..).and_then(|rest| rest.get(..self.header)).ok_or(SHORT)?;
        let add = |number: u64, &byte: &u8| number << 8 | u64::from(byte);
        let length = if self.is_big_endian {
            own.iter().fold(0, add)
        } else {
            own.iter().rev().fold(0, add)
        };
        usize::try_from(length).map_err(|_| SHORT.into())
    }

    /// Subtracts memory from the limit before it is allocated.
    fn spend(&self, bytes: u64) -> Result<(), String> {
        let left = self
            .left
            .get()
            .checked_sub(bytes)
            .ok_or("its arrays take more memory than is allowed")?;
        self.left.set(left);
        Ok(())
    }

    /// Returns the bytes after their lengths. `size` is the size of a number in bytes.
    fn unpack(&self, bytes: &[u8], size: usize) -> Result<Vec<u8>, String> {
        let each = 1 + EACH.div_ceil(size as u64);
        if !self.is_packed {
            let end = self.length(bytes, 0)?.checked_add(self.header).ok_or(SHORT)?;
            let own = bytes.get(self.header..end).ok_or(SHORT)?;
            self.spend((own.len() as u64).saturating_mul(each))?;
            return Ok(own.to_vec());
        }
        let blocks = self.length(bytes, 0)?;
        let mut at = blocks
            .checked_add(3)
            .and_then(|lengths| lengths.checked_mul(self.header))
            .ok_or(SHORT)?;
        if at > bytes.len() {
            return Err(SHORT.into());
        }
        let mut out = Vec::new();
        for block in 0..blocks {
            let end = self.length(bytes, 3 + block)?.checked_add(at).ok_or(SHORT)?;
            let packed = bytes.get(at..end).ok_or(SHORT)?;
            // Reading one byte more than the limit allows shows that the limit is exceeded.
            let room = self.left.get() / each + 1;
            let before = out.len() as u64;
            let read = ZlibDecoder::new(packed).take(room).read_to_end(&mut out);
            read.map_err(|_| "its packed bytes are damaged")?;
            self.spend((out.len() as u64 - before).saturating_mul(each))?;
            at = end;
        }
        Ok(out)
    }

    /// Decodes base64. The lengths of compressed bytes are a base64 text of their own, with padding
    /// in between.
    fn unpack_base64(&self, text: &[u8], size: usize) -> Result<Vec<u8>, String> {
        let lengths = if self.is_packed {
            let first = decode(text.get(..self.header.div_ceil(3) * 4).ok_or(SHORT)?)?;
            self.length(&first, 0)?
                .checked_add(3)
                .and_then(|lengths| lengths.checked_mul(self.header))
                .ok_or(SHORT)?
        } else {
            self.header
        };
        let first_text = lengths.div_ceil(3).checked_mul(4).ok_or(SHORT)?;
        if !self.is_packed {
            // Length and data are one base64 text.
            let length = self.length(&decode(text.get(..first_text).ok_or(SHORT)?)?, 0)?;
            let whole = length
                .checked_add(self.header)
                .and_then(|bytes| bytes.div_ceil(3).checked_mul(4))
                .ok_or(SHORT)?;
            return self.unpack(&decode(text.get(..whole).ok_or(SHORT)?)?, size);
        }
        let mut bytes = decode(text.get(..first_text).ok_or(SHORT)?)?;
        let blocks = self.length(&bytes, 0)?;
        let mut packed: usize = 0;
        for block in 0..blocks {
            packed = packed.checked_add(self.length(&bytes, 3 + block)?).ok_or(SHORT)?;
        }
        let end = packed
            .div_ceil(3)
            .checked_mul(4)
            .and_then(|text| text.checked_add(first_text))
            .ok_or(SHORT)?;
        bytes.truncate(lengths);
        bytes.extend(decode(text.get(first_text..end).ok_or(SHORT)?)?);
        self.unpack(&bytes, size)
    }
}

fn decode(text: &[u8]) -> Result<Vec<u8>, String> {
    let config = GeneralPurposeConfig::new()
        .with_decode_padding_mode(DecodePaddingMode::Indifferent)
        .with_decode_allow_trailing_bits(true);
    let engine = GeneralPurpose::new(&base64::alphabet::STANDARD, config);
    engine.decode(text).map_err(|error| format!("its base64 is damaged ({error})"))
}

const SHORT: &str = "it is shorter than it says";
