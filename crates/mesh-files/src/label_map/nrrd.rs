//! NRRD label maps in one file: raw, gzip or ASCII. Their frame is what `space` says, RAS or LPS.

use super::voxels::{Encoding, Kind, Voxels};
use super::{Fault, Place, Volume, count};
use crate::mesh::Frame;
use crate::text::shown;
use std::collections::HashMap;

/// The fields of the header by name, and what follows it.
struct File<'a> {
    fields: HashMap<String, String>,
    data: &'a [u8],
}

impl<'a> File<'a> {
    /// The header ends at the first empty line.
    fn new(bytes: &'a [u8]) -> Result<Self, String> {
        if !bytes.starts_with(b"NRRD000") {
            return Err("it does not begin with 'NRRD000' and a version".into());
        }
        let mut fields = HashMap::new();
        let mut data = bytes;
        loop {
            let end = data.iter().position(|&byte| byte == b'\n');
            let end = end.ok_or("its header is not followed by an empty line")?;
            let line = String::from_utf8_lossy(&data[..end]);
            data = &data[end + 1..];
            let line = line.trim();
            if line.is_empty() {
                return Ok(Self { fields, data });
            }
            if let Some((name, value)) = line.split_once(": ") {
                fields.insert(name.trim().to_ascii_lowercase(), value.trim().to_owned());
            }
        }
    }

    fn get(&self, name: &str) -> Option<&str> {
        self.fields.get(name).map(String::as_str)
    }

    fn need(&self, name: &str) -> Result<&str, String> {
        self.get(name).ok_or_else(|| format!("its header has no field '{name}'"))
    }

    fn unknown(name: &str, value: &str) -> String {
        format!("its {name} '{}' cannot be read", shown(value))
    }
}

pub fn read(bytes: &[u8]) -> Result<Volume<'_>, Fault> {
    let file = File::new(bytes)?;
    for name in ["data file", "datafile"] {
        if file.get(name).is_some() {
            return Err("its voxels are in a second file; save both in one, .nrrd".into());
        }
    }
    for name in ["byte skip", "line skip"] {
        if file.get(name).is_some_and(|skip| skip != "0") {
            return Err(format!("its '{name}' is not 0; save it again with 3D Slicer or ITK-SNAP").into());
        }
    }
    if file.need("dimension")? != "3" {
        return Err("it has not three dimensions; export one label map, without overlapping segments".into());
    }
    let sizes: Option<Vec<_>> =
        file.need("sizes")?.split_whitespace().map(|size| size.parse().ok()).collect();
    let sizes = sizes.and_then(|sizes| <[usize; 3]>::try_from(sizes).ok());
    let sizes = sizes.ok_or("its 'sizes' are not three numbers")?;
    let count = count(sizes)?;
    let kind = kind(file.need("type")?)?;
    let is_big_endian = file.get("endian").is_some_and(|endian| endian.eq_ignore_ascii_case("big"));
    if kind.size() > 1 && file.get("endian").is_none() && !is_text(file.need("encoding")?) {
        file.need("endian")?;
    }
    let encoding = match file.need("encoding")?.to_ascii_lowercase().as_str() {
        "raw" => Encoding::Raw,
        "gzip" | "gz" => Encoding::Gzip,
        encoding if is_text(encoding) => Encoding::Text,
        encoding => return Err(File::unknown("encoding", encoding).into()),
    };
    let (place, frame) = place(&file)?;
    let voxels = Voxels { data: file.data, encoding, skip: 0, count, kind, is_big_endian, scaling: None };
    Ok(Volume { sizes, voxels, place, frame, states_unit: file.get("space units").is_some() })
}

fn is_text(encoding: &str) -> bool {
    ["ascii", "text", "txt"].iter().any(|name| encoding.eq_ignore_ascii_case(name))
}

fn kind(name: &str) -> Result<Kind, String> {
    Ok(match name.to_ascii_lowercase().as_str() {
        "signed char" | "int8" | "int8_t" => Kind::I8,
        "uchar" | "unsigned char" | "uint8" | "uint8_t" => Kind::U8,
        "short" | "short int" | "signed short" | "signed short int" | "int16" | "int16_t" => Kind::I16,
        "ushort" | "unsigned short" | "unsigned short int" | "uint16" | "uint16_t" => Kind::U16,
        "int" | "signed int" | "int32" | "int32_t" => Kind::I32,
        "uint" | "unsigned int" | "uint32" | "uint32_t" => Kind::U32,
        "longlong" | "long long" | "long long int" | "signed long long" | "int64" | "int64_t" => Kind::I64,
        "ulonglong" | "unsigned long long" | "unsigned long long int" | "uint64" | "uint64_t" => Kind::U64,
        "float" => Kind::F32,
        "double" => Kind::F64,
        _ => return Err(File::unknown("type", name)),
    })
}

/// Where the voxels are, and in which frame.
fn place(file: &File) -> Result<(Place, Option<Frame>), String> {
    let space = file.get("space").unwrap_or_default();
    // The third frame of the format has no name here: mirrored, it is RAS.
    let (frame, mirror) = match space.to_ascii_lowercase().as_str() {
        "right-anterior-superior" | "ras" => (Some(Frame::Ras), 1.0),
        "left-posterior-superior" | "lps" => (Some(Frame::Lps), 1.0),
        "left-anterior-superior" | "las" => (Some(Frame::Ras), -1.0),
        "" | "3d-right-handed" => (None, 1.0),
        _ => return Err(File::unknown("space", space)),
    };
    let vectors = |name: &str, count: usize| -> Result<Vec<[f64; 3]>, String> {
        let text = file.need(name)?;
        let wrong = || format!("its '{name}' is not {count} x three numbers");
        let vector = |text: &str| -> Option<[f64; 3]> {
            let numbers: Option<Vec<_>> = text.split(',').map(|number| number.trim().parse().ok()).collect();
            numbers?.try_into().ok()
        };
        let parts = text.split(['(', ')']).map(str::trim).filter(|part| !part.is_empty());
        let vectors: Option<Vec<_>> = parts.map(vector).collect();
        vectors.filter(|vectors| vectors.len() == count).ok_or_else(wrong)
    };
    let directions = vectors("space directions", 3)?;
    let origin = vectors("space origin", 1)?[0];
    let units = file.get("space units").unwrap_or("\"mm\"").to_ascii_lowercase();
    let mut units = units.split('"').map(str::trim).filter(|unit| !unit.is_empty());
    let first = units.next().unwrap_or("mm");
    let unit = match first {
        _ if units.any(|unit| unit != first) => return Err("its space units are not all the same".into()),
        "mm" => 1.0,
        "m" => 1000.0,
        "cm" => 10.0,
        "um" => 1e-3,
        unit => return Err(File::unknown("unit", unit)),
    };
    let rows = [0, 1, 2].map(|row| {
        let sign = if row == 0 { mirror } else { 1.0 } * unit;
        [directions[0][row], directions[1][row], directions[2][row], origin[row]].map(|x| x * sign)
    });
    Ok((Place::new(rows, "space directions")?, frame))
}
