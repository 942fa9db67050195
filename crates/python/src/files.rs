//! Meshes and centrelines from files, with the frame and the unit that the files state.

use crate::error::Refused;
use crate::input::{DeviceName, FrameName, in_frame, of, vectors};
use crate::mesh::{Mesh, Origin, Parts, is_file, parts};
use crate::output::{answer, array};
use crate::threads::interruptible;
use crate::warning::{in_one_line, warn};
use mesh_files::{Frame, MeshFileError, Options};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyInt, PyString};
use std::path::{Path, PathBuf};

/// The unit after scaling of what a file states in millimetres.
fn unit(states_unit: bool, scale: f64) -> Option<String> {
    let units = [(1.0, "mm"), (0.1, "cm"), (1e-3, "m"), (1e3, "um")];
    let found = units.into_iter().find(|(factor, _)| states_unit && *factor == scale);
    found.map(|(_, unit)| unit.to_owned())
}

/// The error of reading, in the words of the functions here.
fn refuse(py: Python<'_>, error: &MeshFileError) -> PyErr {
    let text = match error {
        MeshFileError::NoPosition { file, missing, .. } => format!(
            "{} does not say where its voxels are ({missing}); save it again with a position, or give `allow_no_position=True`, \
             which puts its first voxel at the origin",
            file.display()
        ),
        error => error.to_string().replace(", or raise Options::memory_limit", ""),
    };
    Refused::other("file", in_one_line(&text)).raise(py, None)
}

/// The mesh in a file: STL, OBJ, PLY, VTK's .vtp or .vtk, or the surface of a label map in NIfTI,
/// NRRD or MetaImage, by the file's extension.
///
/// What the file states of its coordinates is kept: `Mesh.frame` and `Mesh.unit`. A warning says if
/// faces without area are left out (`Mesh.skipped_faces`), if several labels are read as one
/// surface, if the sform and the qform of a NIfTI label map place it differently, and if the mesh
/// is open or badly joined (`Mesh.surface`).
///
/// Parameters
/// ----------
/// path : str, bytes, os.PathLike or file object
///     A file object, opened for reading bytes, has a ``name`` with the extension. A mesh of
///     another package is taken too, as by `Mesh`.
/// label : int, optional
///     The label whose surface is taken from a label map; without one all voxels that are not 0 are
///     inside.
/// frame : {"RAS", "LPS"}, optional
///     The frame that the mesh gets. A mesh whose file states the other one is turned: x and y
///     change sign. A file that states none is taken to be in this frame. Without it, the mesh
///     stays as it is.
/// scale : float
///     Multiplies every coordinate, for example 1000 for metres to millimetres. A label map comes
///     in millimetres.
/// allow_no_position : bool
///     Whether to read a label map that states the spacing of its voxels but not their position;
///     its first voxel is then the origin.
/// device : {"cpu", "gpu"}
///     What answers large batches: as for `Mesh`.
///
/// Raises
/// ------
/// ContinuumError
///     The file cannot be read or holds no mesh; ``kind`` is ``"file"``, and the text says what to
///     change. Or as for `Mesh`.
#[pyfunction]
#[pyo3(signature = (path, *, label = None, frame = None, scale = 1.0, allow_no_position = false, device = DeviceName::CPU), text_signature = "(path, *, label=None, frame=None, scale=1.0, allow_no_position=False, device=\"cpu\")")]
pub(crate) fn load(
    py: Python<'_>,
    path: &Bound<'_, PyAny>,
    #[pyo3(from_py_with = of::optional::label)] label: Option<u32>,
    frame: Option<FrameName>,
    #[pyo3(from_py_with = of::scale)] scale: f64,
    allow_no_position: bool,
    device: DeviceName,
) -> PyResult<Mesh> {
    let options =
        Options::scaled(scale).with_label(label).with_no_position_allowed(allow_no_position);
    let (path, bytes) = match Source::of(path)? {
        Source::Mesh(parts) if label.is_none() => {
            options.check_scale().map_err(|error| refuse(py, &error))?;
            let mesh = Mesh::of_parts(&parts, frame, scale, Origin::default(), device)?;
            mesh.warn_of_surface(py, "the mesh")?;
            return Ok(mesh);
        }
        Source::Mesh(..) => {
            let text = "`label` is given beside a mesh, which has no labels; leave it out";
            return Err(Refused::other("bad_type", text).raise(py, None));
        }
        Source::Path(path) => (path, None),
        Source::File(path, bytes) => (path, Some(bytes)),
    };
    let file = path.clone();
    let read = interruptible(py, move || match bytes {
        Some(bytes) => mesh_files::from_bytes(&file, &bytes, &options),
        None => mesh_files::load_with(&file, &options),
    })?;
    let mesh = made(py, &path, read.map_err(|error| refuse(py, &error))?, frame, scale, device)?;
    mesh.warn_of_surface(py, &path.display().to_string())?;
    Ok(mesh)
}

/// Where a mesh or a centreline is.
enum Source<'py> {
    Path(PathBuf),
    /// The content of a file object, and its name.
    File(PathBuf, Vec<u8>),
    /// A mesh of another package.
    Mesh(Parts<'py>),
}

impl<'py> Source<'py> {
    fn of(given: &Bound<'py, PyAny>) -> PyResult<Self> {
        let py = given.py();
        if given.is_instance_of::<PyString>()
            || given.is_instance_of::<PyBytes>()
            || given.hasattr("__fspath__")?
        {
            return Ok(Self::Path(decoded(given)?));
        }
        if !is_file(given)? {
            return Ok(Self::Mesh(parts(given, "path")?));
        }
        let name = given.getattr_opt("name")?.filter(|name| !name.is_instance_of::<PyInt>());
        let name = name.filter(|name| !name.is_none()).ok_or_else(|| {
            let text = "`path` is a file object without a name, whose extension would say its format; set its `name`, as in \
                        file.name = 'wall.stl'";
            Refused::other("bad_type", text).raise(py, None)
        })?;
        let content = given.call_method0("read")?;
        let bytes = match content.extract::<Vec<u8>>() {
            Ok(bytes) => bytes,
            // A file that was opened as text.
            Err(_) => content.extract::<String>()?.into_bytes(),
        };
        if bytes.is_empty() && is_past_its_start(given)? {
            let text = "`path` is a file object at its end; call its `seek(0)` first";
            return Err(Refused::other("bad_type", text).raise(py, None));
        }
        Ok(Self::File(decoded(&name)?, bytes))
    }
}

/// Whether a file object has been read, or written, before.
fn is_past_its_start(file: &Bound<'_, PyAny>) -> PyResult<bool> {
    let Some(tell) = file.getattr_opt("tell")? else { return Ok(false) };
    // A stream such as a pipe has no position.
    Ok(tell.call0().and_then(|position| position.extract::<u64>()).is_ok_and(|it| it > 0))
}

/// A path of any type that Python has for paths.
fn decoded(path: &Bound<'_, PyAny>) -> PyResult<PathBuf> {
    path.py().import("os")?.call_method1("fsdecode", (path,))?.extract()
}

/// The mesh of a file that was read.
fn made(
    py: Python<'_>,
    path: &Path,
    mut file: mesh_files::Mesh,
    frame: Option<FrameName>,
    scale: f64,
    device: DeviceName,
) -> PyResult<Mesh> {
    let name = path.display();
    if file.skipped_faces > 0 {
        warn(py, &format!("left out of {name}: {} faces without area", file.skipped_faces))?;
    }
    if file.labels.len() > 1 {
        let labels = mesh_files::list_labels(&file.labels);
        warn(
            py,
            &format!(
                "{name} has the labels {labels}, read as one surface; choose one with `label`"
            ),
        )?;
    }
    for doubt in &file.doubts {
        warn(py, &format!("{name}: {doubt}"))?;
    }
    let frame = in_frame(&mut file.vertices, file.frame, frame);
    let origin =
        Origin { frame, unit: unit(file.states_unit, scale), skipped_faces: file.skipped_faces };
    let (vertices, triangles) = file.into_parts::<[f64; 3]>();
    Mesh::new_from(py, vectors(&vertices), triangles, origin, device)
}

/// The centreline in a file: VTK's .vtp or .vtk, 3D Slicer's .mrk.json, or a text (.csv, .tsv,
/// .txt, .dat) with x,y,z and optionally the radius in its lines. A heading is optional: it names
/// x,y,z, and r,a,s or l,p,s state the frame. Units in its names, such as ``x [m]``, are converted
/// to millimetres. A warning names what looks like a mistake: a robot that turns by more than 90
/// degrees at a point, and columns whose names do not say that they are the position.
///
/// Parameters
/// ----------
/// path : str, bytes, os.PathLike or file object
/// line : int, optional
///     The line of a file that has several, counted from 0. A list of fiducials needs it too.
/// frame : {"RAS", "LPS"}, optional
///     The frame that the points get: as for `load`.
/// scale : float
///     Multiplies every coordinate and radius, for example 1000 for metres to millimetres.
///
/// Returns
/// -------
/// Centreline
///     ``points`` (N, 3); ``radii`` (N - 1,), or None: a segment has the radius of its first point;
///     ``frame`` and ``unit``, or None where the file does not state them; and ``skipped``, the
///     number of points that have no position yet. A query of a `Mesh` in another frame warns about
///     these points.
///
/// Raises
/// ------
/// ContinuumError
///     The file cannot be read, holds no line, or several and none is chosen; ``kind`` is
///     ``"file"``, and the text says what to change.
#[pyfunction]
#[pyo3(signature = (path, *, line = None, frame = None, scale = 1.0))]
pub(crate) fn load_centreline<'py>(
    py: Python<'py>,
    path: &Bound<'py, PyAny>,
    #[pyo3(from_py_with = of::optional::line)] line: Option<u32>,
    frame: Option<FrameName>,
    #[pyo3(from_py_with = of::scale)] scale: f64,
) -> PyResult<Bound<'py, PyAny>> {
    let options = Options::scaled(scale).with_line(line.map(|line| line as usize));
    let source = Source::of(path)?;
    let (name, read) = match source {
        Source::Path(path) => {
            let name = path.display().to_string();
            (name, interruptible(py, move || mesh_files::load_centreline(&path, &options))?)
        }
        Source::File(path, bytes) => {
            let name = path.display().to_string();
            let read = move || mesh_files::centreline_from_bytes(&path, &bytes, &options);
            (name, interruptible(py, read)?)
        }
        Source::Mesh(..) => {
            let text = "`path` is a mesh; give a path or a file object of a centreline";
            return Err(Refused::other("bad_type", text).raise(py, None));
        }
    };
    let mut read = read.map_err(|error| refuse(py, &error))?;
    for doubt in &read.doubts {
        warn(py, &format!("{name}: {doubt}"))?;
    }
    let frame = in_frame(&mut read.points, read.frame, frame).map(Frame::name);
    let points = array(py, vec![read.points.len(), 3], read.points.into_flattened())?;
    let points = crate::output::framed(points, frame)?;
    let radii = read.radii.map(|radii| array(py, vec![radii.len()], radii)).transpose()?;
    answer!(
        py,
        "Centreline",
        (points, radii, frame, unit(read.states_unit, scale), read.skipped_points)
    )
}
