//! NIfTI-1 label maps, packed by gzip or not. Their frame is RAS, in millimetres.

use super::voxels::{Encoding, Kind, Voxels, unpack};
use super::{Fault, Place, Volume, count};
use crate::mesh::Frame;
use nifti::{Endianness, NiftiHeader, NiftiType};
use std::borrow::Cow;

/// The header, and the four bytes that tell whether more follows.
const HEAD: usize = 352;

pub fn read(bytes: &[u8]) -> Result<Volume<'_>, Fault> {
    let is_packed = bytes.starts_with(b"\x1f\x8b");
    let head: Cow<'_, [u8]> =
        if is_packed { unpack(bytes, HEAD)?.into() } else { bytes[..bytes.len().min(HEAD)].into() };
    if head.get(4..8) == Some(b"n+2\0") {
        return Err("it is NIfTI-2; save it as NIfTI-1".into());
    }
    let header =
        NiftiHeader::from_reader(&head[..]).map_err(|_| "its header is cut short or not NIfTI-1's")?;
    if &header.magic == b"ni1\0" {
        return Err("its voxels are in a second file; save both in one, .nii or .nii.gz".into());
    }
    let [dimensions, width, height, depth, ref more @ ..] = header.dim.map(usize::from);
    let is_series = more.iter().take(dimensions.saturating_sub(3)).any(|&size| size > 1);
    if dimensions < 3 || is_series {
        return Err("it is not one volume of three dimensions; save a single label map".into());
    }
    let sizes = [width, height, depth];
    let offset = header.vox_offset;
    // What does not fit in 32 bits is no header's length.
    if !(offset >= 348.0 && f64::from(offset) < f64::from(u32::MAX)) {
        return Err(
            format!("its voxels begin at byte {offset}, which is in the header or past the end").into()
        );
    }
    let voxels = Voxels {
        data: bytes,
        encoding: if is_packed { Encoding::Gzip } else { Encoding::Raw },
        skip: offset as usize,
        count: count(sizes)?,
        kind: kind(&header)?,
        is_big_endian: header.endianness == Endianness::Big,
        scaling: scaling(&header)?,
    };
    Ok(Volume {
        sizes,
        voxels,
        place: place(&header)?,
        frame: Some(Frame::Ras),
        states_unit: header.xyzt_units & 7 != 0,
    })
}

/// What is done with the numbers, as nibabel reads it: nothing where the slope is 0, infinite or not a number, whatever
/// the intercept is; otherwise an intercept that is not finite is an error.
fn scaling(header: &NiftiHeader) -> Result<Option<[f64; 2]>, String> {
    let [slope, intercept] = [header.scl_slope, header.scl_inter].map(f64::from);
    if slope == 0.0 || !slope.is_finite() {
        Ok(None)
    } else if intercept.is_finite() {
        Ok(Some([slope, intercept]))
    } else {
        Err(format!("its numbers are multiplied by {slope}, but {intercept} is added to them"))
    }
}

fn kind(header: &NiftiHeader) -> Result<Kind, String> {
    Ok(match header.data_type() {
        Ok(NiftiType::Int8) => Kind::I8,
        Ok(NiftiType::Uint8) => Kind::U8,
        Ok(NiftiType::Int16) => Kind::I16,
        Ok(NiftiType::Uint16) => Kind::U16,
        Ok(NiftiType::Int32) => Kind::I32,
        Ok(NiftiType::Uint32) => Kind::U32,
        Ok(NiftiType::Int64) => Kind::I64,
        Ok(NiftiType::Uint64) => Kind::U64,
        Ok(NiftiType::Float32) => Kind::F32,
        Ok(NiftiType::Float64) => Kind::F64,
        _ => return Err(format!("its voxels are of type {}, which holds no label", header.datatype)),
    })
}

/// Where the voxels are: the sform if there is one, otherwise the qform (methods 3 and 2 of nifti1.h). Method 1 knows
/// no patient, so a file without both is refused.
fn place(header: &NiftiHeader) -> Result<Place, String> {
    let unit = match header.xyzt_units & 7 {
        0 | 2 => 1.0,
        1 => 1000.0,
        3 => 1e-3,
        code => return Err(format!("its unit of length has the unknown code {code}")),
    };
    let (rows, name) = if header.sform_code > 0 {
        ([header.srow_x, header.srow_y, header.srow_z].map(|row| row.map(f64::from)), "sform")
    } else if header.qform_code > 0 {
        (qform(header), "qform")
    } else {
        return Err("it does not say where its voxels are: sform and qform are both unknown".into());
    };
    Place::new(rows.map(|row| row.map(|x| x * unit)), name)
}

/// The quaternion's rotation times the spacings, the third one mirrored if the header says so.
fn qform(header: &NiftiHeader) -> [[f64; 4]; 3] {
    let [b, c, d] = [header.quatern_b, header.quatern_c, header.quatern_d].map(f64::from);
    let a = (1.0 - b * b - c * c - d * d).max(0.0).sqrt();
    let rotation = [
        [a * a + b * b - c * c - d * d, 2.0 * (b * c - a * d), 2.0 * (b * d + a * c)],
        [2.0 * (b * c + a * d), a * a + c * c - b * b - d * d, 2.0 * (c * d - a * b)],
        [2.0 * (b * d - a * c), 2.0 * (c * d + a * b), a * a + d * d - b * b - c * c],
    ];
    let [mirror, x, y, z, ..] = header.pixdim.map(f64::from);
    let z = if mirror < 0.0 { -z } else { z };
    let shift = [header.quatern_x, header.quatern_y, header.quatern_z].map(f64::from);
    [0, 1, 2].map(|row| [rotation[row][0] * x, rotation[row][1] * y, rotation[row][2] * z, shift[row]])
}
