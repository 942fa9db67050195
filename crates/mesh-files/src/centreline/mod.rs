//! Reads centrelines, which are sequences of points, from the files of programs that draw or
//! extract them.

mod data_array;
mod format;
mod heading;
mod lines;
mod markups;
mod poly_data;
mod table;
pub mod vtk_legacy;
pub mod vtk_xml;
mod xml;

use crate::doubts::sharp_turns;
use crate::mesh::Mesh;
use crate::{MeshFileError, Options, read_file, text};
use format::Format;
pub use lines::Centreline;
use lines::{Line, Lines};
use poly_data::{JOINING, PolyData};
use std::path::{Path, PathBuf};
pub use table::{load_shapes, load_table, table_from_bytes};

/// Returns the surface of PolyData.
pub fn surface(read: Result<PolyData, String>) -> Result<Mesh, String> {
    read.and_then(PolyData::into_mesh)
}

/// Reads the centreline in a file.
///
/// - 3D Slicer's markups (`.mrk.json`): a curve.
/// - Text (`.csv`, `.tsv`, `.txt`, `.dat`): points with x, y, z and optionally the radius. Units in
///   the heading are converted to millimetres.
/// - VTK's PolyData (`.vtp`, `.vtk`), as VMTK, SimVascular and SOFA write it: a line. Cells whose
///   ends meet are one line, where ends that differ by rounding meet too. Radii are not read: they
///   belong to the vessel, not to the robot.
///
/// A file with several lines needs [`Options::line`], and so does a markup that is not a curve,
/// such as a list of fiducials.
///
/// # Errors
/// As [`load_with`](crate::load_with); there is no line, or several and none is chosen; the line
/// has fewer than two points; or a line names a point that does not exist.
pub fn load_centreline(
    path: impl AsRef<Path>,
    options: &Options,
) -> Result<Centreline, MeshFileError> {
    let path = path.as_ref();
    Format::of(path)?;
    centreline_from_bytes(path, &read_file(path, options)?, options)
}

/// Same as [`load_centreline`], for the content of a file with this name.
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
        Format::Table => {
            let mut lines = table::centrelines(path, bytes, options)?;
            let line = choose(&file, lines.len(), options.line)?;
            let mut line = lines.swap_remove(line);
            options.scale_all(path, &mut line.points)?;
            return with_points(file, line);
        }
        Format::Markups if bytes.len() as u64 * markups::EACH > options.memory_limit => {
            Err("its values take more memory than is allowed".into())
        }
        Format::Markups => markups::read(bytes),
        Format::VtkLegacy => vtk_legacy::read(bytes).and_then(Lines::of),
        Format::VtkXml => vtk_xml::read(bytes, options.memory_limit).and_then(|data| {
            if data.lines.len() as u64 * JOINING > options.memory_limit {
                return Err("its lines take more memory than is allowed".into());
            }
            Lines::of(data)
        }),
    };
    let Lines { mut lines, frame, states_unit } = read.map_err(|reason| {
        let (file, format) = (file.clone(), format.name());
        match text::looks_like(bytes) {
            Some(
                found @ ("PLY" | "STL" | "OBJ" | "NRRD" | "NIfTI" | "a zip archive" | "VTK"
                | "VTK XML"),
            ) if found != format => MeshFileError::Misnamed { file, format, found },
            _ => MeshFileError::Broken { file, format, reason },
        }
    })?;
    let line = choose(&file, lines.len(), options.line)?;
    if options.line.is_none()
        && let Some(found) = lines[line].other.take()
    {
        return Err(MeshFileError::NotACurve { file, found });
    }
    let Line { mut points, skipped_points, .. } = lines.swap_remove(line);
    options.scale_all(&file, &mut points)?;
    let (radii, doubts) = (None, Vec::new());
    with_points(file, Centreline { points, radii, frame, states_unit, skipped_points, doubts })
}

/// Returns a centreline if it has at least two points.
fn with_points(file: PathBuf, mut line: Centreline) -> Result<Centreline, MeshFileError> {
    match line.points.len() {
        count @ ..2 => Err(MeshFileError::TooFewPoints { file, count }),
        _ => {
            line.doubts.extend(sharp_turns(&line.points));
            Ok(line)
        }
    }
}

/// Returns the index of the chosen line, or of the only one.
fn choose(file: &Path, count: usize, line: Option<usize>) -> Result<usize, MeshFileError> {
    let file = file.to_owned();
    match (line, count) {
        (_, 0) => Err(MeshFileError::NoLine { file }),
        (None, 1) => Ok(0),
        (None, _) => Err(MeshFileError::SeveralLines { file, count }),
        (Some(line), _) if line < count => Ok(line),
        (Some(line), _) => Err(MeshFileError::NoSuchLine { file, line, count }),
    }
}
