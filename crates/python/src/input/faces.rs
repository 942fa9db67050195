//! The triangles of a mesh, from integers of any type.

use super::numbers::{as_array, numpy, refuse_masked, shape_text};
use crate::error::Refused;
use numpy::{PyArray2, PyArrayDescrMethods, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::prelude::*;

/// Triangles as three positions among `count` vertices.
pub(crate) fn faces(given: &Bound<'_, PyAny>, count: usize) -> PyResult<Vec<[u32; 3]>> {
    let py = given.py();
    refuse_masked(given, "faces")?;
    let array = as_array(given, "faces")?;
    let shape = array.shape().to_vec();
    let is_empty = shape.contains(&0);
    if !is_empty && !matches!(array.dtype().kind(), b'i' | b'u') {
        let text = format!("`faces` has the type {}; give an array of integers", array.dtype());
        return Err(Refused::other("bad_type", text).raise(py, None));
    }
    if !is_empty && !matches!(shape[..], [_, 3]) {
        let advice = match shape[..] {
            [3, _] => "give its transpose",
            [_, 4] => "cut the quadrilaterals into triangles",
            _ => "give three vertices for each triangle",
        };
        let text = format!("`faces` has the shape {}, not (F, 3); {advice}", shape_text(&shape));
        return Err(Refused::other("bad_shape", text).raise(py, None));
    }
    // Numbers beyond 63 bits become negative, and are refused with the others.
    let array = numpy(py)?.call_method1("require", (array, "int64", "CA"))?;
    let Ok(array) = array.cast::<PyArray2<i64>>() else { return Ok(Vec::new()) };
    // SAFETY: the GIL is held, and no code of Python's runs before the numbers are copied.
    let numbers = unsafe { array.as_slice() }?.as_chunks::<3>().0;
    let mut faces = Vec::with_capacity(numbers.len());
    for (face, corners) in numbers.iter().enumerate() {
        let mut triangle = [0; 3];
        for (corner, &number) in triangle.iter_mut().zip(corners) {
            match u32::try_from(number) {
                Ok(vertex) if (vertex as usize) < count => *corner = vertex,
                _ => {
                    let text = format!(
                        "face {face} names vertex {number}, but there are {count} vertices, counted from 0; repair `faces`"
                    );
                    let error = Refused::Other {
                        kind: "no_such_vertex",
                        text,
                        index: Some(face),
                        possible: None,
                    };
                    return Err(error.raise(py, None));
                }
            }
        }
        faces.push(triangle);
    }
    Ok(faces)
}
