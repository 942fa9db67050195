//! Reads NIfTI label maps of versions 1 and 2, compressed by gzip or not. Their frame is RAS, in
//! millimetres.

use super::voxels::{Encoding, Kind, Voxels, unpack};
use super::{Fault, Place, Volume, count, without_position};
use crate::mesh::Frame;
use std::borrow::Cow;

/// The length of the header of each version, and of the four bytes that state whether extensions
/// follow.
const HEADS: [usize; 2] = [348, 540];
const MORE: usize = 4;

/// A header. The offsets of fields are given for version 1 and version 2, as in nifti1.h and
/// nifti2.h.
struct Header<'a> {
    bytes: &'a [u8],
    is_second: bool,
    is_big_endian: bool,
    /// Whether the voxels are in a separate file.
    is_pair: bool,
}

impl<'a> Header<'a> {
    fn new(bytes: &'a [u8]) -> Result<Self, String> {
        const WRONG: &str = "its header is cut short or not NIfTI's";
        let is_magic = |place: usize, magic: &[u8; 4]| bytes.get(place..place + 4) == Some(magic);
        let (is_second, is_pair) = match () {
            () if is_magic(344, b"n+1\0") => (false, false),
            () if is_magic(344, b"ni1\0") => (false, true),
            () if is_magic(4, b"n+2\0") => (true, false),
            () if is_magic(4, b"ni2\0") => (true, true),
            () if bytes.len() >= HEADS[0] => {
                return Err(
                    "it has no mark of NIfTI; if it is Analyze 7.5, save it as NIfTI".into()
                );
            }
            () => return Err(WRONG.into()),
        };
        if bytes.len() < HEADS[usize::from(is_second)] {
            return Err(WRONG.into());
        }
        // The number of dimensions determines the byte order.
        let header = Self { bytes, is_second, is_big_endian: false, is_pair };
        let other = Self { is_big_endian: true, ..header };
        let fits = |header: &Self| (1..=7).contains(&header.dimension(0));
        if fits(&header) {
            Ok(header)
        } else if fits(&other) {
            Ok(other)
        } else {
            Err(format!("it has {} dimensions", header.dimension(0)))
        }
    }

    fn at<const SIZE: usize>(&self, place: usize) -> [u8; SIZE] {
        let mut own = [0; SIZE];
        own.copy_from_slice(&self.bytes[place..place + SIZE]);
        if self.is_big_endian {
            own.reverse();
        }
        own
    }

    fn real(&self, [first, second]: [usize; 2], index: usize) -> f64 {
        if self.is_second {
            f64::from_le_bytes(self.at(second + 8 * index))
        } else {
            f32::from_le_bytes(self.at(first + 4 * index)).into()
        }
    }

    fn short_or_int(&self, [first, second]: [usize; 2]) -> i64 {
        if self.is_second {
            i32::from_le_bytes(self.at(second)).into()
        } else {
            i16::from_le_bytes(self.at(first)).into()
        }
    }

    fn dimension(&self, index: usize) -> i64 {
        if self.is_second {
            i64::from_le_bytes(self.at(16 + 8 * index))
        } else {
            i16::from_le_bytes(self.at(40 + 2 * index)).into()
        }
    }

    fn data_type(&self) -> i64 {
        let place = if self.is_second { 12 } else { 70 };
        i16::from_le_bytes(self.at(place)).into()
    }

    fn spacing(&self, index: usize) -> f64 {
        self.real([76, 104], index)
    }

    fn offset(&self) -> f64 {
        if self.is_second {
            i64::from_le_bytes(self.at(168)) as f64
        } else {
            self.real([108, 168], 0)
        }
    }

    /// Returns the code of the unit of length.
    fn unit(&self) -> u8 {
        (if self.is_second { self.at::<4>(500)[0] } else { self.bytes[123] }) & 7
    }
}

/// Returns whether a file with this extension is one of a pair.
pub fn is_pair(extension: &str) -> bool {
    ["hdr", "img"].iter().any(|end| extension.eq_ignore_ascii_case(end))
}

/// Returns header and voxels of a pair as one file.
///
/// # Errors
/// The header is invalid.
pub fn in_one(header: &[u8], voxels: &[u8]) -> Result<Vec<u8>, String> {
    let read = Header::new(header)?;
    let length = HEADS[usize::from(read.is_second)];
    let start = length + MORE;
    let skip = read.offset();
    if !read.is_pair {
        return Err("it holds the voxels itself; give it the extension .nii".into());
    }
    if !(skip >= 0.0 && skip <= voxels.len() as f64) {
        return Err(format!(
            "its voxels begin at byte {skip}, but their file has {} bytes",
            voxels.len()
        ));
    }
    let mut whole = [&header[..length], &[0; MORE], &voxels[skip as usize..]].concat();
    let (place, mut offset) = if read.is_second {
        (168, (start as i64).to_le_bytes().to_vec())
    } else {
        (108, (start as f32).to_le_bytes().to_vec())
    };
    if read.is_big_endian {
        offset.reverse();
    }
    whole[place..place + offset.len()].copy_from_slice(&offset);
    whole[if read.is_second { 5 } else { 345 }] = b'+';
    Ok(whole)
}

pub fn read(bytes: &[u8], allow_no_position: bool) -> Result<Volume<'_>, Fault> {
    let is_packed = bytes.starts_with(b"\x1f\x8b");
    let most = HEADS[1] + MORE;
    let head: Cow<'_, [u8]> =
        if is_packed { unpack(bytes, most)?.into() } else { bytes[..bytes.len().min(most)].into() };
    let header = Header::new(&head)?;
    if header.is_pair {
        return Err(
            "its voxels are in a second file; load the .hdr file beside its .img file".into()
        );
    }
    let dimensions = header.dimension(0) as usize;
    if dimensions < 3 || (4..=dimensions).any(|index| header.dimension(index) > 1) {
        return Err("it is not one volume of three dimensions; save a single label map".into());
    }
    let size = |index: usize| usize::try_from(header.dimension(index));
    let [Ok(width), Ok(height), Ok(depth)] = [size(1), size(2), size(3)] else {
        return Err("one of its sizes is negative".into());
    };
    let sizes = [width, height, depth];
    let offset = header.offset();
    let least = HEADS[usize::from(header.is_second)] as f64;
    // A value beyond 32 bits is not the length of a header.
    if !(offset >= least && offset < f64::from(u32::MAX)) {
        return Err(format!(
            "its voxels begin at byte {offset}, which is in the header or past the end"
        )
        .into());
    }
    let kind = kind(&header)?;
    let voxels = Voxels {
        data: bytes,
        encoding: if is_packed { Encoding::Gzip } else { Encoding::Raw },
        skip: offset as usize,
        count: count(sizes)?,
        kind,
        is_big_endian: header.is_big_endian,
        scaling: scaling(&header, kind)?,
    };
    let (place, is_placed) = place(&header, allow_no_position)?;
    let frame = is_placed.then_some(Frame::Ras);
    let doubt = forms_apart(&header, sizes);
    Ok(Volume { sizes, voxels, place, frame, states_unit: header.unit() != 0, doubt })
}

/// Returns the scaling of the values, as nibabel reads it: none if the slope is 0, infinite or NaN,
/// for every intercept; otherwise an intercept that is not finite is an error.
///
/// Some writers store the slope 1 as 0.99999, and 60000 times that is 59999.4. So a slope of nearly
/// 1 is 1 for integers.
fn scaling(header: &Header, kind: Kind) -> Result<Option<[f64; 2]>, String> {
    let [slope, intercept] = [[112, 176], [116, 184]].map(|places| header.real(places, 0));
    let is_one = (slope - 1.0).abs() <= SLOPE_ERROR && !matches!(kind, Kind::F32 | Kind::F64);
    if slope == 0.0 || !slope.is_finite() {
        Ok(None)
    } else if intercept.is_finite() {
        Ok(Some([if is_one { 1.0 } else { slope }, intercept]))
    } else {
        Err(format!("its numbers are multiplied by {slope}, but {intercept} is added to them"))
    }
}

/// The largest difference between 1 and a slope that stands for 1. It is the difference that label
/// 1 may have from a whole number.
const SLOPE_ERROR: f64 = 1e-4;

fn kind(header: &Header) -> Result<Kind, String> {
    Ok(match header.data_type() {
        2 => Kind::U8,
        4 => Kind::I16,
        8 => Kind::I32,
        16 => Kind::F32,
        64 => Kind::F64,
        256 => Kind::I8,
        512 => Kind::U16,
        768 => Kind::U32,
        1024 => Kind::I64,
        1280 => Kind::U64,
        other => return Err(format!("its voxels are of type {other}, which holds no label")),
    })
}

/// Returns the map of the voxels, and whether the file states their position.
///
/// The sform applies if there is one, otherwise the qform (methods 3 and 2 of nifti1.h). Method 1
/// has no patient frame. An sform of zeros counts as absent.
///
/// # Errors
/// A spacing is negative: nibabel takes its absolute value, ITK mirrors the axis in every method.
fn place(header: &Header, allow_no_position: bool) -> Result<(Place, bool), Fault> {
    let unit = unit(header)?;
    let scaled =
        |rows: [[f64; 4]; 3], name| Place::new(rows.map(|row| row.map(|x| x * unit)), name);
    let [q, s] = codes(header).map(|code| code > 0);
    let sform = sform(header);
    let is_zero = is_zero(&sform);
    let spacing = [1, 2, 3].map(|index| header.spacing(index));
    if let Some(axis) = (0..3).find(|&axis| spacing[axis] < 0.0) {
        let (name, value) = (axis + 1, spacing[axis]);
        let wrong = format!(
            "its pixdim[{name}] is {value}: ITK and 3D Slicer mirror that axis, nibabel does not; save \
             it with the program that shows it right"
        );
        return Err(wrong.into());
    }
    if s && !is_zero {
        return Ok((scaled(sform, "sform")?, true));
    }
    if q {
        return Ok((scaled(qform(header, spacing), "qform")?, true));
    }
    if !allow_no_position {
        let zero = "its sform is zero and its qform unknown";
        let missing = if s { zero } else { "sform and qform are both unknown" };
        return Err(Fault::NoPosition(missing.into()));
    }
    Ok((scaled(without_position(spacing), "pixdim")?, false))
}

/// Returns the number of millimetres of the unit of length.
fn unit(header: &Header) -> Result<f64, String> {
    match header.unit() {
        0 | 2 => Ok(1.0),
        1 => Ok(1000.0),
        3 => Ok(1e-3),
        code => Err(format!("its unit of length has the unknown code {code}")),
    }
}

/// Returns the codes of the qform and of the sform: 0 if unknown.
fn codes(header: &Header) -> [i64; 2] {
    [[252, 344], [254, 348]].map(|places| header.short_or_int(places))
}

fn sform(header: &Header) -> [[f64; 4]; 3] {
    [0, 1, 2].map(|row| [0, 1, 2, 3].map(|column| header.real([280, 400], 4 * row + column)))
}

fn is_zero(sform: &[[f64; 4]; 3]) -> bool {
    sform.iter().all(|row| row[..3] == [0.0; 3])
}

/// Returns the doubt about a file whose sform and qform place the corners of the image differently,
/// by more than rounding.
///
/// **Rounding.** Each component b, c, d of the quaternion is rounded to single precision, so
/// `a = sqrt(1 - b^2 - c^2 - d^2)` has an error of at most `min(sqrt(e), e / a)` with `e = 2^-22`.
/// An entry of the rotation changes by at most 4 times as much, and moves corners in proportion to
/// the size of the image. Other numbers may be written with 6 digits.
fn forms_apart(header: &Header, sizes: [usize; 3]) -> Option<String> {
    let ([q, s], sform) = (codes(header), sform(header));
    if q <= 0 || s <= 0 || is_zero(&sform) {
        return None;
    }
    let forms = [sform, qform(header, [1, 2, 3].map(|index| header.spacing(index)))].map(Place);
    let length = |a: [f64; 3], b: [f64; 3]| {
        let squares = [0, 1, 2].map(|axis| (a[axis] - b[axis]).powi(2));
        let length = squares.iter().sum::<f64>().sqrt();
        if length.is_nan() { f64::INFINITY } else { length }
    };
    let [mut apart, mut extent, mut largest] = [0.0_f64; 3];
    for corner in 0..8 {
        let end =
            |axis: usize| if corner >> axis & 1 == 1 { sizes[axis] as f64 - 1.0 } else { 0.0 };
        let [a, b] = forms.map(|form| form.apply([end(0), end(1), end(2)]));
        apart = apart.max(length(a, b));
        extent = extent.max(length(a, forms[0].apply([0.0; 3])));
        largest = a.iter().chain(&b).fold(largest, |most, x| most.max(x.abs()));
    }
    let squares = [0, 1, 2].map(|index| header.real([256, 352], index).powi(2));
    let rest = (1.0 - squares.iter().sum::<f64>()).max(0.0);
    let e = 2_f64.powi(-22);
    let rounding = e.sqrt().min(e / rest.sqrt());
    if apart <= 4.0 * rounding * extent + 2.0 * SIX_DIGITS * largest {
        return None;
    }
    let apart = apart * unit(header).ok()?;
    // ITK takes the sform if its code is that of a scanner.
    let itk = if s == 1 { "and ITK do" } else { "does; ITK and 3D Slicer take the qform" };
    Some(format!(
        "its sform and its qform place it {apart:.3} mm apart; the sform is read, as nibabel {itk}"
    ))
}

/// The largest relative difference of neighbouring numbers of 6 digits.
const SIX_DIGITS: f64 = 1e-5;

/// Returns the quaternion's rotation times the spacings, with the third axis mirrored if the header
/// says so.
fn qform(header: &Header, [x, y, z]: [f64; 3]) -> [[f64; 4]; 3] {
    let [b, c, d, shift @ ..] = [0, 1, 2, 3, 4, 5].map(|index| header.real([256, 352], index));
    let a = (1.0 - b * b - c * c - d * d).max(0.0).sqrt();
    let rotation = [
        [a * a + b * b - c * c - d * d, 2.0 * (b * c - a * d), 2.0 * (b * d + a * c)],
        [2.0 * (b * c + a * d), a * a + c * c - b * b - d * d, 2.0 * (c * d - a * b)],
        [2.0 * (b * d - a * c), 2.0 * (c * d + a * b), a * a + d * d - b * b - c * c],
    ];
    let z = if header.spacing(0) < 0.0 { -z } else { z };
    [0, 1, 2]
        .map(|row| [rotation[row][0] * x, rotation[row][1] * y, rotation[row][2] * z, shift[row]])
}
