//! The class `Mesh`: how it is made and how it moves. Its queries are in `queries`.

use crate::error::Refused;
use crate::input::{
    DeviceName, FrameName, HasWarned, Names, Numbers, Robots, faces, in_frame, mesh_text,
    object_of, shape_text, stated_frame, vectors,
};
use crate::motions::Motion;
use crate::output::{array, flat, framed, read_only};
use crate::threads::{DeviceKind, Engine, Held, alone, interruptible, is_available};
use crate::warning::warn;
use mesh_files::Frame;
use numpy::PyArrayDyn;
use parry_continuum::parry::math::Vector;
use parry_continuum::proximity::Proximity;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyString, PyTuple};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// A triangle mesh that is asked how near robots are to it.
///
/// ``Mesh(vertices, faces)`` copies both. ``Mesh(other)`` takes a mesh of trimesh (or a scene),
/// pyvista, meshio or Open3D, or what else has ``.vertices`` and ``.faces``; polygons are cut into
/// triangles, and lines and points are left out. Lengths are in one unit of your choice, the same
/// for mesh and robots. `load` reads a file.
///
/// Any number of threads may ask one mesh at the same time: queries run without the GIL.
/// `set_vertices` moves the vertices for all queries that begin later. A mesh can be copied and
/// pickled.
///
/// A mesh with ``device="gpu"`` answers large batches of `distance`, `minimum`, `per_link` and
/// `clears` on the GPU, and the last bit of an answer is that of the CPU. The size from which on a
/// batch counts as large depends on the question and on the number of threads; `gpu_seconds`
/// changes if one ran there. All other questions, smaller batches and single robots are answered on
/// the CPU. `set_vertices` moves the vertices on the GPU, and the search on the CPU follows at the
/// next question that needs it, or at `prepare`. With 65,536 faces or more, those four questions
/// are asked of the GPU until then, about one robot too. One thread at a time uses the GPU for a
/// mesh and its copies; others are answered on the CPU. A GPU that fails raises a `ContinuumError`.
///
/// A mesh on the GPU is copied and pickled as such. Where a pickle finds no GPU, the mesh is on the
/// CPU, with a warning. A forked child answers on the CPU; it cannot use the GPU of its parent.
///
/// Parameters
/// ----------
/// vertices : (V, 3) array of any number type, or a mesh of another package
/// faces : (F, 3) array of any integer type
///     Three positions among the vertices for each triangle, counted from 0.
/// frame : {"RAS", "LPS"}, optional
///     The frame of the vertices, for warnings about centrelines in the other one. A mesh that
///     states the other frame is turned, as by `load`: a `Mesh`, or one of pyvista whose field data
///     has an array ``SPACE``, as 3D Slicer writes it. Without ``frame`` the mesh keeps its own.
/// unit : str, optional
///     The unit of the vertices, such as "mm". Nothing is computed from it. trimesh's `units`
///     is not taken over.
/// device : {"cpu", "gpu"}
///     What answers large batches. "gpu" needs a released wheel, or a build with the feature
///     ``gpu``, and a GPU: see `gpu_available`. ``Mesh(mesh, device="gpu")`` is the same mesh on
///     the GPU.
///
/// Raises
/// ------
/// ContinuumError
///     A vertex is not finite or out of range, a face names a vertex that is not there (its
///     ``index`` is the face), there is no face, or an array has another shape. With
///     ``device="gpu"``: this build has no GPU, none is found or it fails, or the mesh does not fit
///     into its memory.
///
/// Examples
/// --------
/// >>> import numpy as np
/// >>> from parry_continuum import Mesh
/// >>> floor = Mesh([[-9, -9, 0], [9, -9, 0], [0, 9, 0]], [[0, 1, 2]])
/// >>> floor
/// Mesh(3 vertices, 1 faces)
/// >>> floor.distance([[0, 0, 2], [1, 0, 2]], 0.5)
/// 1.5
#[pyclass(frozen, module = "parry_continuum", weakref)]
pub(crate) struct Mesh {
    engine: Held<Arc<Engine>>,
    origin: Origin,
    /// Whether it has warned of points in another frame.
    has_warned: HasWarned,
    /// Whether the orientation of its triangles has been looked at.
    has_checked_sides: AtomicBool,
}

/// The frame and unit of a mesh, if known, and the number of faces left out of its file.
#[derive(Clone, Debug, Default)]
pub(crate) struct Origin {
    pub frame: Option<Frame>,
    pub unit: Option<String>,
    pub skipped_faces: usize,
}

/// A function and its arguments, whose call makes the mesh again.
type Reduced<'py> = (Bound<'py, PyAny>, Bound<'py, PyTuple>);

impl Mesh {
    fn of(engine: Arc<Engine>, origin: Origin) -> Self {
        let (has_warned, has_checked_sides) = Default::default();
        Self { engine: Held::new(engine), origin, has_warned, has_checked_sides }
    }

    /// A new mesh with the given triangles.
    pub(crate) fn new_from(
        py: Python<'_>,
        vertices: Vec<Vector>,
        triangles: Vec<[u32; 3]>,
        origin: Origin,
        DeviceName(device): DeviceName,
    ) -> PyResult<Self> {
        Ok(Self::of(Arc::new(Engine::new(py, vertices, triangles, device)?), origin))
    }

    /// A mesh of another package, scaled, and turned into a frame.
    pub(crate) fn of_parts(
        parts: &Parts<'_>,
        frame: Option<FrameName>,
        scale: f64,
        origin: Origin,
        device: DeviceName,
    ) -> PyResult<Self> {
        let py = parts.vertices.py();
        let mut vertices = rows(&parts.vertices, "vertices")?.points().to_vec();
        let faces = self::faces(&parts.faces, vertices.len())?;
        vertices.as_flattened_mut().iter_mut().for_each(|coordinate| *coordinate *= scale);
        let frame = in_frame(&mut vertices, parts.frame, frame);
        Self::new_from(py, vectors(&vertices), faces, Origin { frame, ..origin }, device)
    }

    /// Warns of an open or badly joined surface. `name` is the file's.
    pub(crate) fn warn_of_surface(&self, py: Python<'_>, name: &str) -> PyResult<()> {
        self.has_checked_sides.store(true, Ordering::Relaxed);
        let search = self.engine(py).base(py);
        let doubts = interruptible(py, move || search.surface().doubts())?;
        doubts.iter().try_for_each(|doubt| warn(py, &format!("{name}: {doubt}")))
    }

    /// Warns once before a question about sides if triangles face opposite ways.
    pub(crate) fn note_sides(&self, py: Python<'_>) -> PyResult<()> {
        if self.has_checked_sides.swap(true, Ordering::Relaxed) {
            return Ok(());
        }
        let report = alone(py, &self.engine(py), |session| session.search.surface().clone())?;
        if report.misoriented_edges == 0 {
            return Ok(());
        }
        report.doubts().iter().try_for_each(|doubt| warn(py, doubt))
    }

    /// The engine of the mesh as it is now.
    pub(crate) fn engine(&self, py: Python<'_>) -> Arc<Engine> {
        self.engine.with(py, |engine| Arc::clone(engine))
    }

    /// The robots of a question. Warns once if their points state another frame than the mesh.
    pub(crate) fn robots<'py>(
        &self,
        points: &Bound<'py, PyAny>,
        radii: &Bound<'py, PyAny>,
        pose: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Robots<'py>> {
        let robots = Robots::new(Names::one("points"), points, radii, pose)?;
        // A pose leads into the mesh's frame.
        if pose.is_none() {
            self.note_frame("points", points)?;
        }
        Ok(robots)
    }

    /// The frame that the mesh states.
    pub(crate) fn stated_frame(&self) -> Option<Frame> {
        self.origin.frame
    }

    /// Warns once if points or a motion state another frame than the mesh.
    pub(crate) fn note_frame(&self, name: &str, given: &Bound<'_, PyAny>) -> PyResult<()> {
        let Some(frames) = self.frames(given)? else { return Ok(()) };
        let is_motion = given.is_instance_of::<Motion>();
        self.has_warned.warn(given.py(), &mesh_text(name, is_motion, frames))
    }

    /// As many vertices as the mesh has; `name` is the parameter's.
    pub(crate) fn moved_vertices(
        &self,
        given: &Bound<'_, PyAny>,
        name: &str,
    ) -> PyResult<Vec<Vector>> {
        let py = given.py();
        let vertices = vectors(rows(given, name)?.points());
        self.note_frame(name, given)?;
        let (got, expected) = (vertices.len(), self.engine(py).vertices(py).as_slice().len());
        if got == expected {
            return Ok(vertices);
        }
        let text = format!(
            "`{name}` has {got} vertices, but the mesh has {expected}; give as many, in its order, or make a new `Mesh`"
        );
        Err(Refused::other("vertex_count", text).raise(py, None))
    }

    /// The frame of points or of a motion, and that of the mesh, if both are stated and differ.
    pub(crate) fn frames(&self, given: &Bound<'_, PyAny>) -> PyResult<Option<[Frame; 2]>> {
        let Some(mesh) = self.origin.frame else { return Ok(None) };
        let stated = stated_frame(given)?;
        Ok(stated.filter(|stated| *stated != mesh).map(|stated| [stated, mesh]))
    }
}

/// What a mesh of another package holds.
pub(crate) struct Parts<'py> {
    vertices: Bound<'py, PyAny>,
    faces: Bound<'py, PyAny>,
    frame: Option<Frame>,
}

/// The parts of a mesh of another package; `name` is the parameter's.
pub(crate) fn parts<'py>(given: &Bound<'py, PyAny>, name: &str) -> PyResult<Parts<'py>> {
    type Found<'py> = (Bound<'py, PyAny>, Bound<'py, PyAny>, Option<FrameName>);
    let py = given.py();
    let found = py.import("parry_continuum._meshes")?.call_method1("parts", (given,))?;
    let own = given.cast::<Mesh>().ok().and_then(|mesh| mesh.get().origin.frame);
    let parts = found.extract::<Option<Found<'py>>>()?.map(|(vertices, faces, frame)| Parts {
        vertices,
        faces,
        frame: frame.map(|FrameName(frame)| frame).or(own),
    });
    parts.ok_or_else(|| {
        let text = match name {
            "vertices" => {
                "`faces` is missing; give vertices and faces, or a mesh of trimesh, pyvista, meshio or Open3D"
            }
            _ => "`path` is neither a path nor a file object; give one of them",
        };
        Refused::other("bad_type", text).raise(py, None)
    })
}

/// Whether it is a file object. A mesh of meshio has a function `read` too.
pub(crate) fn is_file(given: &Bound<'_, PyAny>) -> PyResult<bool> {
    Ok(given.hasattr("read")? && !given.hasattr("points")?)
}

/// Refuses a path: `Mesh` reads no files.
fn refuse_path(given: &Bound<'_, PyAny>) -> PyResult<()> {
    if given.is_instance_of::<PyString>()
        || given.is_instance_of::<PyBytes>()
        || given.hasattr("__fspath__")?
        || is_file(given)?
    {
        let text = "`vertices` is a path or a file; use load(), which reads files";
        return Err(Refused::other("bad_type", text).raise(given.py(), None));
    }
    Ok(())
}

/// Vertices as an array of rows; `name` is the parameter's.
pub(crate) fn rows<'py>(given: &Bound<'py, PyAny>, name: &str) -> PyResult<Numbers<'py>> {
    let numbers = Numbers::new(given, name)?;
    match *numbers.shape() {
        [_, 3] => Ok(numbers),
        ref shape => {
            let advice = match shape {
                // It may be three points without z too.
                [3, 2] => "give three coordinates for each vertex",
                [3, _] => "give its transpose, `.T`",
                _ => "give a row of three coordinates for each vertex",
            };
            let text =
                format!("`{name}` has the shape {}, not (V, 3); {advice}", shape_text(shape));
            Err(Refused::other("bad_shape", text).raise(given.py(), None))
        }
    }
}

#[pymethods]
impl Mesh {
    #[new]
    #[pyo3(signature = (vertices, faces = None, *, frame = None, unit = None, device = DeviceName::CPU), text_signature = "(vertices, faces=None, *, frame=None, unit=None, device=\"cpu\")")]
    fn new(
        vertices: &Bound<'_, PyAny>,
        faces: Option<&Bound<'_, PyAny>>,
        frame: Option<FrameName>,
        #[pyo3(from_py_with = object_of::unit)] unit: Option<String>,
        device: DeviceName,
    ) -> PyResult<Self> {
        let py = vertices.py();
        let own = if faces.is_none() { vertices.cast::<Self>().ok() } else { None };
        let origin = own.map_or_else(Origin::default, |mesh| mesh.get().origin.clone());
        let unit = unit.or(origin.unit);
        let asked = frame.as_ref().map(|FrameName(frame)| *frame);
        let is_turned = origin.frame.zip(asked).is_some_and(|(stated, asked)| stated != asked);
        if let Some(mesh) = own.filter(|_| !is_turned) {
            let engine = mesh.get().engine(py).on(py, device.0)?;
            let frame = asked.or(origin.frame);
            return Ok(Self::of(engine, Origin { frame, unit, ..origin }));
        }
        let parts = match faces {
            Some(faces) => {
                let frame = stated_frame(vertices)?;
                Parts { vertices: vertices.clone(), faces: faces.clone(), frame }
            }
            None => {
                refuse_path(vertices)?;
                parts(vertices, "vertices")?
            }
        };
        Self::of_parts(&parts, frame, 1.0, Origin { unit, ..origin }, device)
    }

    /// The frame of the vertices, "RAS" or "LPS": that of the file, or the one that was asked for;
    /// None if unknown.
    #[getter]
    fn frame(&self) -> Option<&'static str> {
        self.origin.frame.map(Frame::name)
    }

    /// The unit of length that the file states, such as "mm"; None if unknown.
    #[getter]
    fn unit(&self) -> Option<&str> {
        self.origin.unit.as_deref()
    }

    /// Where large batches are answered: "cpu", or "gpu". In a forked child it is "cpu".
    #[getter]
    fn device(&self, py: Python<'_>) -> &'static str {
        self.engine(py).device().name()
    }

    /// The seconds that the GPU computed for the last batch that it answered, without transfers.
    ///
    /// The batch may be one of a copy of the mesh. None before the first batch, on the CPU, and for
    /// a GPU that keeps no time.
    #[getter]
    fn gpu_seconds(&self, py: Python<'_>) -> Option<f64> {
        self.engine(py).gpu_seconds(py)
    }

    /// How many faces of the file were left out because they have no area.
    #[getter]
    fn skipped_faces(&self) -> usize {
        self.origin.skipped_faces
    }

    /// The vertices as they are now, a (V, 3) array with the frame of the mesh. It is a copy that
    /// cannot be written to: `set_vertices` moves the mesh.
    #[getter]
    fn vertices<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let vertices = self.engine(py).vertices(py);
        let vertices = vertices.as_slice();
        let array = array(py, vec![vertices.len(), 3], flat(vertices.iter().copied()))?;
        framed(read_only(array)?, self.frame())
    }

    /// The triangles, an (F, 3) array of int64. It is a copy that cannot be written to.
    #[getter]
    fn faces<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<i64>>> {
        let search = self.engine(py).base(py);
        let numbers: Vec<_> =
            search.triangles().as_flattened().iter().map(|&vertex| vertex.into()).collect();
        read_only(array(py, vec![search.triangles().len(), 3], numbers)?)
    }

    /// Moves the vertices, in the order that they have.
    ///
    /// Queries that begin after this returns see the new vertices. Queries that already run in
    /// other threads use the old vertices, for a whole batch alike. A move costs a fraction of
    /// building a mesh.
    ///
    /// Parameters
    /// ----------
    /// vertices : (V, 3) array of any number type
    ///     As many as there are.
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     There are more or fewer than before, or one is not finite or out of range. The mesh then
    ///     stays where it was.
    ///
    /// Examples
    /// --------
    /// >>> from parry_continuum import Mesh
    /// >>> floor = Mesh([[-9, -9, 0], [9, -9, 0], [0, 9, 0]], [[0, 1, 2]])
    /// >>> floor.set_vertices(floor.vertices + [0, 0, 1])
    /// >>> floor.distance([[0, 0, 2], [1, 0, 2]], 0.5)
    /// 0.5
    fn set_vertices(&self, vertices: &Bound<'_, PyAny>) -> PyResult<()> {
        let py = vertices.py();
        let vertices = self.moved_vertices(vertices, "vertices")?;
        let moved = Arc::new(self.engine(py).moved(py, vertices)?);
        let before = self.engine.with(py, |engine| std::mem::replace(engine, moved));
        drop(before); // not under the lock
        Ok(())
    }

    /// Builds now what a first question would build, so that none has to wait.
    ///
    /// Call it after `set_vertices` too, where the first question after it must not take longer
    /// than others.
    fn prepare(&self, py: Python<'_>) -> PyResult<()> {
        alone(py, &self.engine(py), |session| session.search.prepare())
    }

    fn __copy__(&self, py: Python<'_>) -> Self {
        // Engines never change, so that two meshes may have one until either moves.
        Self::of(self.engine(py), self.origin.clone())
    }

    fn __deepcopy__(&self, py: Python<'_>, _memo: &Bound<'_, PyAny>) -> Self {
        self.__copy__(py)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        let make = slf.py().import("parry_continuum._copies")?.getattr("mesh")?;
        let parts = ["vertices", "faces", "frame", "unit", "device"].map(|name| slf.getattr(name));
        let parts = parts.into_iter().collect::<PyResult<Vec<_>>>()?;
        Ok((make, PyTuple::new(slf.py(), parts)?))
    }

    fn __repr__(&self, py: Python<'_>) -> String {
        let engine = self.engine(py);
        let search = engine.base(py);
        let device = match engine.device() {
            DeviceKind::Cpu => String::new(),
            DeviceKind::Gpu => ", device='gpu'".to_owned(),
        };
        let (vertices, faces) = (search.vertices().len(), search.triangles().len());
        format!("Mesh({vertices} vertices, {faces} faces{device})")
    }
}

/// Whether ``Mesh(.., device="gpu")`` finds a GPU.
///
/// Opens the GPU, which takes a moment; the meshes of the process then share it. It is False for a
/// build without the feature ``gpu``, for a machine without a GPU that Vulkan, Metal or Direct3D 12
/// offers, and in a child of a process that had opened the GPU before it forked. A GPU in software,
/// such as Mesa's, counts: it is right, but slow.
#[pyfunction]
pub(crate) fn gpu_available(py: Python<'_>) -> PyResult<bool> {
    is_available(py)
}
