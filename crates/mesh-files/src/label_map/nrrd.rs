//! Reads NRRD label maps: raw, gzip or ASCII, in one file or with the voxels in a file beside the
//! header. The field `space` states their frame, RAS or LPS.

use super::voxels::{Encoding, Kind, Voxels, last};
use super::{Fault, Place, Volume, count, elsewhere, voxels_path, without_position};
use crate::mesh::Frame;
use crate::text::{shown, unit_in_mm};
use std::collections::HashMap;
use std::path::PathBuf;

/// The names of the field that names the file of the voxels, if it is another one.
const ELSEWHERE: [&str; 2] = ["data file", "datafile"];

/// The fields of the header by name, and the data after it.
struct File<'a> {
    fields: HashMap<String, String>,
    data: &'a [u8],
}

impl<'a> File<'a> {
    /// Parses the header. It ends at the first empty line, or at the end of the file if the voxels
    /// are in another one.
    fn new(bytes: &'a [u8]) -> Result<Self, String> {
        if !bytes.starts_with(b"NRRD000") {
            return Err("it does not begin with 'NRRD000' and a version".into());
        }
        let mut fields = HashMap::new();
        let mut data = bytes;
        loop {
            let end = data.iter().position(|&byte| byte == b'\n').unwrap_or(data.len());
            let line = String::from_utf8_lossy(&data[..end]);
            let is_end = data.is_empty();
            data = data.get(end + 1..).unwrap_or_default();
            let line = line.trim();
            // Users' own keys and values are written as `key:=value`.
            if let Some((name, value)) = line.split_once(':')
                && !value.starts_with('=')
                && !line.starts_with('#')
            {
                fields.insert(name.trim().to_ascii_lowercase(), value.trim().to_owned());
            }
            if line.is_empty() && !is_end {
                return Ok(Self { fields, data });
            }
            if is_end {
                let is_apart = ELSEWHERE.iter().any(|&name| fields.contains_key(name));
                let whole = is_apart.then_some(Self { fields, data });
                return whole.ok_or_else(|| "its header is not followed by an empty line".into());
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

/// Returns the file of the voxels, if it is another one.
pub fn voxels_file(bytes: &[u8]) -> Option<PathBuf> {
    let file = File::new(bytes).ok()?;
    ELSEWHERE.iter().find_map(|name| file.get(name)).and_then(voxels_path)
}

/// Returns header and voxels as one file.
pub fn in_one(header: &[u8], voxels: &[u8]) -> Vec<u8> {
    let text = String::from_utf8_lossy(header);
    let is_elsewhere = |line: &str| {
        let name = line.split(':').next().unwrap_or_default().trim();
        ELSEWHERE.iter().any(|other| name.eq_ignore_ascii_case(other))
    };
    let fields =
        text.lines().take_while(|line| !line.trim().is_empty()).filter(|line| !is_elsewhere(line));
    let whole: String = fields.map(|line| format!("{line}\n")).collect();
    [whole.as_bytes(), b"\n", voxels].concat()
}

/// The axes of the voxels: the number of voxels along each, and the step from one voxel to the
/// next, if the file states it.
struct Axes {
    sizes: [usize; 3],
    steps: Option<[[f64; 3]; 3]>,
}

/// Returns a number for each axis.
fn list<T: std::str::FromStr>(file: &File, name: &str, count: usize) -> Result<Vec<T>, String> {
    let numbers: Option<Vec<T>> =
        file.need(name)?.split_whitespace().map(|number| number.parse().ok()).collect();
    let numbers = numbers.filter(|numbers| numbers.len() == count);
    let count = if count == 3 { "three".to_owned() } else { count.to_string() };
    numbers.ok_or_else(|| format!("its '{name}' are not {count} numbers"))
}

/// Returns a vector such as `(1,0,0)`, or `none`, for each axis.
fn vectors(file: &File, name: &str, count: usize) -> Result<Vec<Option<[f64; 3]>>, String> {
    let wrong = || format!("its '{name}' is not {count} x three numbers");
    let vector = |text: &str| -> Option<[f64; 3]> {
        let numbers: Option<Vec<_>> =
            text.split(',').map(|number| number.trim().parse().ok()).collect();
        numbers?.try_into().ok()
    };
    let mut vectors = Vec::new();
    for part in file.need(name)?.split(['(', ')']).map(str::trim).filter(|part| !part.is_empty()) {
        if part.split_whitespace().all(|word| word == "none") {
            vectors.extend(part.split_whitespace().map(|_| None));
        } else {
            vectors.push(Some(vector(part).ok_or_else(wrong)?));
        }
    }
    if vectors.len() == count { Ok(vectors) } else { Err(wrong()) }
}

fn axes(file: &File) -> Result<Axes, String> {
    const LAYERS: &str =
        "3D Slicer writes segments that overlap so: export them one by one, or as a label map";
    let count: usize =
        file.need("dimension")?.parse().map_err(|_| "its 'dimension' is no number")?;
    if !(3..=4).contains(&count) {
        return Err(format!("it has {count} dimensions, not three; export one label map"));
    }
    let mut sizes: Vec<usize> = list(file, "sizes", count)?;
    let mut steps = match file.get("space directions") {
        Some(_) => Some(vectors(file, "space directions", count)?),
        None => None,
    };
    if count == 4 {
        // An axis that is not spatial: a file with one layer is a label map.
        let is_layer = |index: &usize| steps.as_ref().is_none_or(|steps| steps[*index].is_none());
        let layer = (0..4).filter(is_layer).min_by_key(|&index| sizes[index]);
        let layer = layer.ok_or_else(|| format!("it has four dimensions, not three; {LAYERS}"))?;
        if sizes[layer] != 1 {
            return Err(format!("it holds {} layers; {LAYERS}", sizes[layer]));
        }
        sizes.remove(layer);
        if let Some(steps) = &mut steps {
            steps.remove(layer);
        }
    }
    let three = |steps: Vec<Option<[f64; 3]>>| -> Option<[[f64; 3]; 3]> {
        steps.into_iter().collect::<Option<Vec<_>>>()?.try_into().ok()
    };
    let wrong = "its 'space directions' is not 3 x three numbers";
    let steps = steps.map(|steps| three(steps).ok_or(wrong)).transpose()?;
    let sizes = sizes.try_into().map_err(|_| "its 'sizes' are not three numbers")?;
    Ok(Axes { sizes, steps })
}

pub fn read(bytes: &[u8], allow_no_position: bool) -> Result<Volume<'_>, Fault> {
    let file = File::new(bytes)?;
    if let Some(other) = ELSEWHERE.iter().find_map(|name| file.get(name)) {
        return Err(elsewhere(other, ".nrrd").into());
    }
    let axes = axes(&file)?;
    let count = count(axes.sizes)?;
    let kind = kind(file.need("type")?)?;
    let is_big_endian = file.get("endian").is_some_and(|endian| endian.eq_ignore_ascii_case("big"));
    if kind.size() > 1 && file.get("endian").is_none() && !is_text(file.need("encoding")?) {
        file.need("endian")?;
    }
    let encoding = match file.need("encoding")?.to_ascii_lowercase().as_str() {
        "raw" => Encoding::Raw,
        "gzip" | "gz" => Encoding::Gzip,
        encoding if is_text(encoding) => Encoding::Text,
        "bzip2" | "bz2" => {
            return Err("its encoding 'bzip2' cannot be read; save it as gzip or raw".into());
        }
        encoding => return Err(File::unknown("encoding", encoding).into()),
    };
    let skip = |name: &str| -> Result<i64, String> {
        file.get(name).unwrap_or("0").parse().map_err(|_| format!("its '{name}' is no number"))
    };
    let mut data = file.data;
    for _ in 0..skip("line skip")?.clamp(0, data.len() as i64) {
        let end = data.iter().position(|&byte| byte == b'\n');
        data = &data[end.map_or(data.len(), |end| end + 1)..];
    }
    // -1 means that the voxels are the last bytes.
    let byte_skip = skip("byte skip")?;
    let (data, skip) = match (usize::try_from(byte_skip), encoding) {
        (Ok(skip), _) => (data, skip),
        (_, Encoding::Raw) if byte_skip == -1 => (last(data, count, kind), 0),
        _ => {
            return Err(format!(
                "its 'byte skip' is {byte_skip}; save it again with 3D Slicer or ITK-SNAP"
            )
            .into());
        }
    };
    let (place, frame) = place(&file, &axes, allow_no_position)?;
    let voxels = Voxels { data, encoding, skip, count, kind, is_big_endian, scaling: None };
    Ok(Volume {
        sizes: axes.sizes,
        voxels,
        place,
        frame,
        states_unit: file.get("space units").is_some(),
        doubt: None,
    })
}

fn is_text(encoding: &str) -> bool {
    ["ascii", "text", "txt"].iter().any(|name| encoding.eq_ignore_ascii_case(name))
}

fn kind(name: &str) -> Result<Kind, String> {
    Ok(match name.to_ascii_lowercase().as_str() {
        "signed char" | "int8" | "int8_t" => Kind::I8,
        "uchar" | "unsigned char" | "uint8" | "uint8_t" => Kind::U8,
        "short" | "short int" | "signed short" | "signed short int" | "int16" | "int16_t" => {
            Kind::I16
        }
        "ushort" | "unsigned short" | "unsigned short int" | "uint16" | "uint16_t" => Kind::U16,
        "int" | "signed int" | "int32" | "int32_t" => Kind::I32,
        "uint" | "unsigned int" | "uint32" | "uint32_t" => Kind::U32,
        "longlong" | "long long" | "long long int" | "signed long long" | "int64" | "int64_t" => {
            Kind::I64
        }
        "ulonglong" | "unsigned long long" | "unsigned long long int" | "uint64" | "uint64_t" => {
            Kind::U64
        }
        "float" => Kind::F32,
        "double" => Kind::F64,
        _ => return Err(File::unknown("type", name)),
    })
}

/// Returns the map of the voxels, and their frame.
fn place(
    file: &File,
    axes: &Axes,
    allow_no_position: bool,
) -> Result<(Place, Option<Frame>), Fault> {
    let space = file.get("space").unwrap_or_default();
    // The third frame of the format has no counterpart here: mirrored, it is RAS.
    let (frame, mirror) = match space.to_ascii_lowercase().as_str() {
        "right-anterior-superior" | "ras" => (Some(Frame::Ras), 1.0),
        "left-posterior-superior" | "lps" => (Some(Frame::Lps), 1.0),
        "left-anterior-superior" | "las" => (Some(Frame::Ras), -1.0),
        "" | "3d-right-handed" => (None, 1.0),
        _ => return Err(File::unknown("space", space).into()),
    };
    let missing =
        ["space directions", "space origin"].into_iter().find(|name| file.get(name).is_none());
    if let Some(missing) = missing.filter(|_| !allow_no_position) {
        return Err(Fault::NoPosition(format!("its header has no field '{missing}'")));
    }
    let origin = match file.get("space origin") {
        Some(_) => {
            vectors(file, "space origin", 1)?[0].ok_or("its 'space origin' is not three numbers")?
        }
        None => [0.0; 3],
    };
    let units = file.get("space units").unwrap_or("\"mm\"").to_lowercase();
    let mut units = units.split('"').map(str::trim).filter(|unit| !unit.is_empty());
    let first = units.next().unwrap_or("mm");
    if units.any(|unit| unit != first) {
        return Err("its space units are not all the same".into());
    }
    let unit = unit_in_mm(first).ok_or_else(|| File::unknown("unit", first))?;
    let Some(directions) = axes.steps else {
        let spacings: Vec<f64> = match file.get("spacings") {
            Some(text) => text.split_whitespace().filter_map(|word| word.parse().ok()).collect(),
            None => vec![1.0; 3],
        };
        // A layer has no spacing.
        let spacings: Vec<_> = spacings.into_iter().filter(|spacing| !spacing.is_nan()).collect();
        let spacings = spacings.try_into().map_err(|_| "its 'spacings' are not three numbers")?;
        return Ok((Place::new(without_position(spacings), "spacings")?, None));
    };
    let rows = [0, 1, 2].map(|row| {
        let sign = if row == 0 { mirror } else { 1.0 } * unit;
        [directions[0][row], directions[1][row], directions[2][row], origin[row]].map(|x| x * sign)
    });
    Ok((Place::new(rows, "space directions")?, frame))
}
