//! Reads MetaImage label maps: `.mha`, and `.mhd` with its voxels in a second file. As in ITK,
//! their frame is LPS, in millimetres unless `DistanceUnits` states another unit, which ITK
//! ignores.

use super::voxels::{Encoding, Kind, Voxels, last};
use super::{Fault, Place, Volume, count, elsewhere, voxels_path};
use crate::mesh::Frame;
use crate::text::{shown, unit_in_mm};
use std::collections::HashMap;
use std::path::PathBuf;

/// The last field of the header, which names the file of the voxels.
const LAST: &str = "ElementDataFile";
const HERE: &str = "LOCAL";

fn is_here(name: &str) -> bool {
    name.eq_ignore_ascii_case(HERE)
}

/// The fields of the header by name, and the data after it.
struct File<'a> {
    fields: HashMap<String, String>,
    data: &'a [u8],
}

impl<'a> File<'a> {
    fn new(bytes: &'a [u8]) -> Result<Self, String> {
        let mut fields = HashMap::new();
        let mut data = bytes;
        while !fields.contains_key(LAST) {
            let end = data.iter().position(|&byte| byte == b'\n').unwrap_or(data.len());
            let line = String::from_utf8_lossy(&data[..end]);
            let (name, value) = line.split_once('=').ok_or_else(|| {
                format!("its header has '{}' where a field should be", shown(line.trim()))
            })?;
            fields.insert(name.trim().to_owned(), value.trim().to_owned());
            data = data.get(end + 1..).unwrap_or_default();
        }
        Ok(Self { fields, data })
    }

    fn get(&self, names: &[&str]) -> Option<&str> {
        names.iter().find_map(|&name| self.fields.get(name)).map(String::as_str)
    }

    fn need(&self, name: &str) -> Result<&str, String> {
        self.get(&[name]).ok_or_else(|| format!("its header has no field '{name}'"))
    }

    fn says(&self, name: &str) -> bool {
        self.get(&[name]).is_some_and(|value| value.eq_ignore_ascii_case("true"))
    }

    /// Returns the numbers of the field that has one of these names.
    fn numbers<const COUNT: usize>(
        &self,
        names: &[&str],
        otherwise: [f64; COUNT],
    ) -> Result<[f64; COUNT], String> {
        let Some(text) = self.get(names) else { return Ok(otherwise) };
        let numbers: Option<Vec<f64>> =
            text.split_whitespace().map(|number| number.parse().ok()).collect();
        let numbers = numbers.and_then(|numbers| numbers.try_into().ok());
        numbers.ok_or_else(|| format!("its '{}' is not {COUNT} numbers", names[0]))
    }
}

/// Returns the file of the voxels, if it is another one.
pub fn voxels_file(bytes: &[u8]) -> Option<PathBuf> {
    let file = File::new(bytes).ok()?;
    file.get(&[LAST]).filter(|other| !is_here(other)).and_then(voxels_path)
}

/// Returns header and voxels as one file.
pub fn in_one(header: &[u8], voxels: &[u8]) -> Vec<u8> {
    let text = String::from_utf8_lossy(header);
    let fields =
        text.lines().take_while(|line| line.split('=').next().map(str::trim) != Some(LAST));
    let mut whole: String = fields.map(|line| format!("{line}\n")).collect();
    whole.push_str(&format!("{LAST} = {HERE}\n"));
    let mut whole = whole.into_bytes();
    whole.extend(voxels);
    whole
}

pub fn read(bytes: &[u8], allow_no_position: bool) -> Result<Volume<'_>, Fault> {
    let file = File::new(bytes)?;
    let here = file.need(LAST)?;
    if !is_here(here) {
        return Err(elsewhere(here, ".mha").into());
    }
    if file.need("NDims")? != "3"
        || file.get(&["ElementNumberOfChannels"]).is_some_and(|channels| channels != "1")
    {
        return Err("it is not one volume of three dimensions; save a single label map".into());
    }
    let sizes: Option<Vec<_>> =
        file.need("DimSize")?.split_whitespace().map(|size| size.parse().ok()).collect();
    let sizes = sizes.and_then(|sizes| <[usize; 3]>::try_from(sizes).ok());
    let sizes = sizes.ok_or("its 'DimSize' is not three numbers")?;
    let kind = kind(file.need("ElementType")?)?;
    let is_text =
        file.get(&["BinaryData"]).is_some_and(|value| value.eq_ignore_ascii_case("false"));
    let encoding = match (is_text, file.says("CompressedData")) {
        (true, _) => Encoding::Text,
        (_, true) => Encoding::Zlib,
        _ => Encoding::Raw,
    };
    let count = count(sizes)?;
    // The bytes before the voxels; -1 means that the voxels are the last bytes.
    let skip: i64 = file
        .get(&["HeaderSize"])
        .unwrap_or("0")
        .parse()
        .map_err(|_| "its 'HeaderSize' is no number")?;
    let (data, skip) = match (usize::try_from(skip), encoding) {
        (Ok(skip), _) => (file.data, skip),
        (_, Encoding::Raw) if skip == -1 => (last(file.data, count, kind), 0),
        _ => {
            return Err(format!(
                "its 'HeaderSize' is {skip}; save it again with 3D Slicer or ITK-SNAP"
            )
            .into());
        }
    };
    let is_big_endian = file.says("BinaryDataByteOrderMSB") || file.says("ElementByteOrderMSB");
    let voxels = Voxels { data, encoding, skip, count, kind, is_big_endian, scaling: None };
    let (place, frame) = place(&file, allow_no_position)?;
    Ok(Volume { sizes, voxels, place, frame, states_unit: true, doubt: None })
}

fn kind(name: &str) -> Result<Kind, String> {
    Ok(match name {
        "MET_CHAR" | "MET_ASCII_CHAR" => Kind::I8,
        "MET_UCHAR" => Kind::U8,
        "MET_SHORT" => Kind::I16,
        "MET_USHORT" => Kind::U16,
        "MET_INT" | "MET_LONG" => Kind::I32,
        "MET_UINT" | "MET_ULONG" => Kind::U32,
        "MET_LONG_LONG" => Kind::I64,
        "MET_ULONG_LONG" => Kind::U64,
        "MET_FLOAT" => Kind::F32,
        "MET_DOUBLE" => Kind::F64,
        _ => return Err(format!("its ElementType '{}' cannot be read", shown(name))),
    })
}

/// The names of each field, the first as ITK writes it.
const SPACING: [&str; 2] = ["ElementSpacing", "ElementSize"];
const OFFSET: [&str; 3] = ["Offset", "Position", "Origin"];
const AXES: [&str; 3] = ["TransformMatrix", "Rotation", "Orientation"];

/// Returns the map of the voxels, and their frame. The matrix has the direction of each axis in
/// turn, and the offset is the centre of the first voxel.
///
/// ITK reads a file without spacing or offset as spacing 1 or offset 0; here this needs the option.
/// The frame is then unknown unless the file states offset or axes.
fn place(file: &File, allow_no_position: bool) -> Result<(Place, Option<Frame>), Fault> {
    let missing = [&SPACING[..], &OFFSET].into_iter().find(|names| file.get(names).is_none());
    if let Some(names) = missing.filter(|_| !allow_no_position) {
        return Err(Fault::NoPosition(format!("its header has no field '{}'", names[0])));
    }
    // `?` is MetaIO's own mark of an unknown unit.
    let unit = file.get(&["DistanceUnits"]).filter(|&unit| unit != "?").unwrap_or("mm");
    let unit = unit_in_mm(&unit.to_ascii_lowercase()).ok_or_else(|| {
        format!("its DistanceUnits '{}' cannot be read; save it in mm", shown(unit))
    })?;
    let spacing = file.numbers(&SPACING, [1.0; 3])?;
    let origin = file.numbers(&OFFSET, [0.0; 3])?;
    let turned = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    let axes: [f64; 9] = file.numbers(&AXES, turned)?;
    let rows = [0, 1, 2].map(|row| {
        let along = |axis: usize| axes[3 * axis + row] * spacing[axis];
        [along(0), along(1), along(2), origin[row]].map(|x| x * unit)
    });
    let is_placed = file.get(&OFFSET).or(file.get(&AXES)).is_some();
    Ok((Place::new(rows, AXES[0])?, is_placed.then_some(Frame::Lps)))
}
