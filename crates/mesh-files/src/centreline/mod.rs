//! Centrelines: points one after the other, from the files of programs that draw and extract them.

mod data_array;
mod markups;
mod vtk_legacy;
mod vtk_xml;

use crate::mesh::Frame;
use crate::{MeshFileError, Options, read_file, text};
use std::path::Path;

/// Points along a line.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Centreline {
    /// The points in the file's order.
    pub points: Vec<[f64; 3]>,
    /// The frame of the coordinates, where the file states it.
    pub frame: Option<Frame>,
}

/// All lines of a file.
struct Lines {
    lines: Vec<Vec<[f64; 3]>>,
    frame: Option<Frame>,
}

/// Points, and lines that name them.
#[derive(Default)]
struct PolyData {
    points: Vec<[f64; 3]>,
    lines: Vec<Vec<u64>>,
}

impl PolyData {
    /// The lines by their points.
    ///
    /// # Errors
    /// A line names a point that is not there.
    fn resolve(self) -> Result<Vec<Vec<[f64; 3]>>, String> {
        let count = self.points.len();
        let point = |index: u64| {
            let point = usize::try_from(index).ok().and_then(|index| self.points.get(index));
            point
                .copied()
                .ok_or_else(|| format!("a line names point {index}, but there are {count}, counted from 0"))
        };
        self.lines.into_iter().map(|line| line.into_iter().map(point).collect()).collect()
    }
}

/// What a centreline's extension says it holds.
#[derive(Clone, Copy)]
enum Format {
    Markups,
    VtkLegacy,
    VtkXml,
}

impl Format {
    fn of(path: &Path) -> Result<Self, MeshFileError> {
        let name = path.file_name().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        match name.rsplit_once('.').map_or("", |(_, extension)| extension) {
            "json" => Ok(Self::Markups),
            "vtk" => Ok(Self::VtkLegacy),
            "vtp" => Ok(Self::VtkXml),
            _ => Err(MeshFileError::UnknownCentreline { file: path.to_owned() }),
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Markups => "markups",
            Self::VtkLegacy => "VTK",
            Self::VtkXml => "VTK XML",
        }
    }
}

/// The centreline in the file: a curve of 3D Slicer's markups (`.mrk.json`), or a line of VTK's PolyData (`.vtp`, `.vtk`),
/// as VMTK and SOFA write. A file with several lines needs [`Options::line`]. Radii in the file are not read: they are
/// those of the vessel, not of the robot.
///
/// # Errors
/// As [`load_with`](crate::load_with); there is no line, or several and none is chosen; or a line names a point that is
/// not there.
pub fn load_centreline(path: impl AsRef<Path>, options: &Options) -> Result<Centreline, MeshFileError> {
    let path = path.as_ref();
    Format::of(path)?;
    centreline_from_bytes(path, &read_file(path, options)?, options)
}

/// As [`load_centreline`], for a file of this name that holds these bytes.
///
/// # Errors
/// As [`load_centreline`].
pub fn centreline_from_bytes(
    path: impl AsRef<Path>,
    bytes: &[u8],
    options: &Options,
) -> Result<Centreline, MeshFileError> {
    let path = path.as_ref();
    let format = Format::of(path)?;
    options.check_scale()?;
    let file = path.to_owned();
    let read = match format {
        Format::Markups => markups::read(bytes),
        Format::VtkLegacy => vtk_legacy::read(bytes),
        Format::VtkXml => vtk_xml::read(bytes, options.memory_limit),
    };
    let Lines { mut lines, frame } = read.map_err(|reason| {
        let (file, format) = (file.clone(), format.name());
        match text::looks_like(bytes) {
            Some(found @ ("PLY" | "STL" | "OBJ" | "NRRD" | "NIfTI" | "a zip archive")) => {
                MeshFileError::Misnamed { file, format, found }
            }
            _ => MeshFileError::Broken { file, format, reason },
        }
    })?;
    let count = lines.len();
    let line = match (options.line, count) {
        (_, 0) => return Err(MeshFileError::NoLine { file }),
        (None, 1) => 0,
        (None, _) => return Err(MeshFileError::SeveralLines { file, count }),
        (Some(line), _) if line < count => line,
        (Some(line), _) => return Err(MeshFileError::NoSuchLine { file, line, count }),
    };
    let mut points = lines.swap_remove(line);
    options.scale_all(&file, &mut points)?;
    Ok(Centreline { points, frame })
}
