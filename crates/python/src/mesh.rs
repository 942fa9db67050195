//! The class `Mesh`: what it is made of, and how it moves. Its questions are in `queries`.

use crate::error::Refused;
use crate::input::{Numbers, faces, shape_text, vectors};
use crate::output::{array, flat};
use crate::threads::{Engine, Held, alone, compute};
use mesh_files::Options;
use numpy::PyArrayDyn;
use parry_continuum::proximity::Proximity;
use pyo3::prelude::*;
use pyo3::types::PyType;
use std::path::PathBuf;
use std::sync::Arc;

/// A triangle mesh that is asked how near robots are to it.
///
/// ``Mesh(vertices, faces)`` copies both. ``Mesh(other)`` takes what has ``.vertices`` and ``.faces``, such as a mesh of
/// trimesh. Lengths are in one unit of your choice, the same for mesh and robots.
///
/// Any number of threads may ask one mesh at the same time: queries run without the GIL. `move` moves the vertices for all
/// queries that begin later. A mesh can be copied and pickled.
///
/// Parameters
/// ----------
/// vertices : (V, 3) array of any number type, or an object with ``.vertices`` and ``.faces``
/// faces : (F, 3) array of any integer type
///     Three positions among the vertices for each triangle, counted from 0.
///
/// Raises
/// ------
/// ContinuumError
///     A vertex is not finite or out of range, a face names a vertex that is not there (its ``index`` is the face), there is
///     no face, or an array has another shape.
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
pub(crate) struct Mesh(Held<Arc<Engine>>);

/// A class, and what it is called with to make the mesh again.
type Reduced<'py> = (Bound<'py, PyType>, (Bound<'py, PyAny>, Bound<'py, PyAny>));

impl Mesh {
    fn of(engine: Arc<Engine>) -> Self {
        Self(Held::new(engine))
    }

    /// The engine of the mesh as it is now.
    pub(crate) fn engine(&self, py: Python<'_>) -> Arc<Engine> {
        self.0.with(py, |engine| Arc::clone(engine))
    }
}

/// Vertices as an array of rows; `name` is the parameter's.
pub(crate) fn rows<'py>(given: &Bound<'py, PyAny>, name: &str) -> PyResult<Numbers<'py>> {
    let numbers = Numbers::new(given, name)?;
    match *numbers.shape() {
        [_, 3] => Ok(numbers),
        ref shape => {
            let advice = match shape {
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
    #[pyo3(signature = (vertices, faces = None))]
    fn new(vertices: &Bound<'_, PyAny>, faces: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        let py = vertices.py();
        let (vertices, triangles) = match faces {
            Some(faces) => (vertices.clone(), faces.clone()),
            None => match (vertices.getattr("vertices"), vertices.getattr("faces")) {
                (Ok(vertices), Ok(faces)) => (vertices, faces),
                _ => {
                    let text =
                        "`faces` is missing; give vertices and faces, or an object that has both";
                    return Err(Refused::other("bad_type", text).raise(py, None));
                }
            },
        };
        let vertices = vectors(rows(&vertices, "vertices")?.points());
        let triangles = self::faces(&triangles, vertices.len())?;
        Ok(Self::of(Arc::new(Engine::new(py, &vertices, &triangles)?)))
    }

    /// The vertices as they are now, a (V, 3) array of your own.
    #[getter]
    fn vertices<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let search = self.engine(py).search(py)?;
        let vertices = search.vertices();
        array(py, vec![vertices.len(), 3], flat(vertices.iter().copied()))
    }

    /// The triangles, an (F, 3) array of int64 of your own.
    #[getter]
    fn faces<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<i64>>> {
        let search = self.engine(py).search(py)?;
        let numbers: Vec<_> =
            search.triangles().as_flattened().iter().map(|&vertex| vertex.into()).collect();
        array(py, vec![search.triangles().len(), 3], numbers)
    }

    /// Moves the vertices, in the order that they have.
    ///
    /// Queries that begin after this returns see the new vertices. Those that run meanwhile, in other threads, see the old
    /// ones, a whole batch alike. It costs a fraction of building a mesh.
    ///
    /// Parameters
    /// ----------
    /// vertices : (V, 3) array of any number type
    ///     As many as there are.
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     There are more or fewer than before, or one is not finite or out of range. The mesh then stays where it was.
    ///
    /// Examples
    /// --------
    /// >>> from parry_continuum import Mesh
    /// >>> floor = Mesh([[-9, -9, 0], [9, -9, 0], [0, 9, 0]], [[0, 1, 2]])
    /// >>> floor.move(floor.vertices + [0, 0, 1])
    /// >>> floor.distance([[0, 0, 2], [1, 0, 2]], 0.5)
    /// 0.5
    fn r#move(&self, vertices: &Bound<'_, PyAny>) -> PyResult<()> {
        let py = vertices.py();
        let vertices = vectors(rows(vertices, "vertices")?.points());
        let moved = Arc::new(self.engine(py).moved(py, &vertices)?);
        let before = self.0.with(py, |engine| std::mem::replace(engine, moved));
        drop(before); // not under the lock
        Ok(())
    }

    /// Builds now what a first question would build, so that none has to wait.
    ///
    /// Call it after `move` too, where the first question after it must not take longer than others.
    fn prepare(&self, py: Python<'_>) -> PyResult<()> {
        alone(py, &self.engine(py), |session| session.search.prepare())
    }

    fn __copy__(&self, py: Python<'_>) -> Self {
        // Engines never change, so that two meshes may have one until either moves.
        Self::of(self.engine(py))
    }

    fn __deepcopy__(&self, py: Python<'_>, _memo: &Bound<'_, PyAny>) -> Self {
        self.__copy__(py)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        Ok((slf.get_type(), (slf.getattr("vertices")?, slf.getattr("faces")?)))
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let search = self.engine(py).search(py)?;
        Ok(format!(
            "Mesh({} vertices, {} faces)",
            search.vertices().len(),
            search.triangles().len()
        ))
    }
}

/// The mesh in a file: STL, OBJ or PLY, or the surface of a label map in NIfTI or NRRD, by the file's extension.
///
/// Parameters
/// ----------
/// path : str or os.PathLike
/// scale : float
///     Multiplies every coordinate, for example 1000 for metres to millimetres. A label map comes in millimetres.
/// label : int, optional
///     The label whose surface is taken from a label map; without one all voxels that are not 0 are inside.
///
/// Raises
/// ------
/// ContinuumError
///     The file cannot be read or holds no mesh; ``kind`` is ``"file"``, and the text says what to change.
#[pyfunction]
#[pyo3(signature = (path, *, scale = 1.0, label = None))]
pub(crate) fn load(
    py: Python<'_>,
    path: PathBuf,
    scale: f64,
    label: Option<u32>,
) -> PyResult<Mesh> {
    let options = Options::scaled(scale).with_label(label);
    let file = compute(py, || mesh_files::load_with(&path, &options))?;
    let file = file.map_err(|error| Refused::other("file", error.to_string()).raise(py, None))?;
    let (vertices, triangles) = file.into_parts::<[f64; 3]>();
    Ok(Mesh::of(Arc::new(Engine::new(py, &vectors(&vertices), &triangles)?)))
}
