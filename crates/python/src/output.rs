//! From plain numbers to what Python gets: arrays, and tuples with names.

use crate::input::numpy;
use numpy::{Element, IxDyn, PyArray1, PyArrayDyn, PyArrayMethods};
use parry_continuum::parry::math::Vector;
use parry_continuum::proximity::{Decision, Side, UndecidedReason};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyTuple;
use pyo3::{BoundObject, IntoPyObjectExt};

/// So few numbers are copied sooner than their memory is handed to numpy.
const FEW: usize = 4096;

/// An array of this shape.
pub(crate) fn array<'py, T: Element + Copy>(
    py: Python<'py>,
    shape: Vec<usize>,
    numbers: Vec<T>,
) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
    if numbers.len() > FEW || numbers.len() != shape.iter().product::<usize>() {
        return PyArray1::from_vec(py, numbers).reshape(shape);
    }
    // SAFETY: the array is new, so that nobody else has it, and contiguous. All of it is written,
    // with numbers that need no drop.
    unsafe {
        let array = PyArrayDyn::new(py, shape, false);
        std::ptr::copy_nonoverlapping(numbers.as_ptr(), array.data(), numbers.len());
        Ok(array)
    }
}

/// An array with a row of N numbers, or one number, for each of some answers. It is written where
/// it lies, which takes least of answers that have many arrays.
pub(crate) fn rows<'py, S, T: Element + Copy, const N: usize>(
    py: Python<'py>,
    answers: &[S],
    row: impl Fn(&S) -> [T; N],
) -> Bound<'py, PyAny> {
    let shape = [answers.len(), N];
    // SAFETY: the array is new, so that nobody else has it, and contiguous, with a row for each of
    // the answers. All of them are written, with numbers that need no drop.
    unsafe {
        let array =
            PyArrayDyn::<T>::new(py, IxDyn(if N == 1 { &shape[..1] } else { &shape }), false);
        let place = array.data().cast::<[T; N]>();
        for (number, answer) in answers.iter().enumerate() {
            place.add(number).write(row(answer));
        }
        array.into_any()
    }
}

/// An array of this shape, or the number itself where the shape is that of one.
pub(crate) fn array_or_number<'py, T>(
    py: Python<'py>,
    shape: Vec<usize>,
    numbers: Vec<T>,
) -> PyResult<Bound<'py, PyAny>>
where
    T: Element + Copy + IntoPyObject<'py>,
{
    match (&shape[..], &numbers[..]) {
        ([], &[number]) => number.into_bound_py_any(py),
        _ => Ok(array(py, shape, numbers)?.into_any()),
    }
}

/// An array that cannot be written to. A copy that could be would be taken for the mesh itself.
pub(crate) fn read_only<T: Element>(
    array: Bound<'_, PyArrayDyn<T>>,
) -> PyResult<Bound<'_, PyArrayDyn<T>>> {
    array.call_method1("setflags", (false,))?;
    Ok(array)
}

/// The points with their frame, if it is known.
pub(crate) fn framed<'py>(
    points: Bound<'py, PyArrayDyn<f64>>,
    frame: Option<&str>,
) -> PyResult<Bound<'py, PyAny>> {
    let Some(frame) = frame else { return Ok(points.into_any()) };
    let py = points.py();
    let points = points.call_method1("view", (answers(py)?.getattr("FramedPoints")?,))?;
    points.setattr("frame", frame)?;
    Ok(points)
}

/// Points one after the other.
pub(crate) fn flat(points: impl IntoIterator<Item = Vector>) -> Vec<f64> {
    points.into_iter().map(|point| point.to_array()).collect::<Vec<_>>().into_flattened()
}

/// An answer of the package's Python half: the named tuple `class` with the given values. `answer!`
/// does the same with a place of its own to keep the class.
///
/// The class's own `__new__` is Python code, whose work this does: `tuple.__new__` with as many
/// values as the class has names.
pub(crate) fn named<'py, V>(
    py: Python<'py>,
    kept: &'static PyOnceLock<Py<PyAny>>,
    class: &str,
    values: V,
) -> PyResult<Bound<'py, PyAny>>
where
    V: IntoPyObject<'py, Target = PyTuple>,
    PyErr: From<V::Error>,
{
    static NEW: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    let new = || Ok::<_, PyErr>(py.get_type::<PyTuple>().getattr("__new__")?.unbind());
    let find = || Ok::<_, PyErr>(answers(py)?.getattr(class)?.unbind());
    let values = values.into_pyobject(py)?.into_bound();
    NEW.get_or_try_init(py, new)?.bind(py).call1((kept.get_or_try_init(py, find)?.bind(py), values))
}

/// The tuple with names of a class of `_answers.py`.
macro_rules! answer {
    ($py:expr, $class:literal, $values:expr) => {{
        static KEPT: ::pyo3::sync::PyOnceLock<::pyo3::Py<::pyo3::PyAny>> =
            ::pyo3::sync::PyOnceLock::new();
        $crate::output::named($py, &KEPT, $class, $values)
    }};
}
pub(crate) use answer;

fn answers(py: Python<'_>) -> PyResult<&Bound<'_, PyAny>> {
    static ANSWERS: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    let import = || Ok::<_, PyErr>(py.import("parry_continuum._answers")?.into_any().unbind());
    Ok(ANSWERS.get_or_try_init(py, import)?.bind(py))
}

/// An enumeration of `_answers.py`.
#[derive(Clone, Copy)]
pub(crate) enum Enumeration {
    Side,
    Decision,
    UndecidedReason,
}

/// A member of an enumeration, or an array of members; of reasons, an array of their values.
pub(crate) fn members<'py>(
    py: Python<'py>,
    of: Enumeration,
    shape: Vec<usize>,
    values: Vec<i8>,
) -> PyResult<Bound<'py, PyAny>> {
    let (one, many) = match of {
        Enumeration::Side => ("Side", Some("Sides")),
        Enumeration::Decision => ("Decision", Some("Decisions")),
        Enumeration::UndecidedReason => ("UndecidedReason", None),
    };
    if let ([], &[value]) = (&shape[..], &values[..]) {
        return answers(py)?.getattr(one)?.call1((value,));
    }
    let values = array(py, shape, values)?;
    match many {
        Some(class) => answers(py)?.getattr(class)?.call_method1("_from_values", (values,)),
        None => Ok(values.into_any()),
    }
}

/// As the class `Side` has it.
pub(crate) fn side_value(side: Side) -> i8 {
    match side {
        Side::Inside => -1,
        Side::Undecided => 0,
        Side::Outside => 1,
    }
}

/// As the class `Decision` has it.
pub(crate) fn decision_value(decision: Decision) -> i8 {
    match decision {
        Decision::Contact => -1,
        Decision::Undecided => 0,
        Decision::Clear => 1,
    }
}

/// As the class `UndecidedReason` has it.
pub(crate) fn reason_value(reason: Option<UndecidedReason>) -> i8 {
    match reason {
        None => 0,
        Some(UndecidedReason::Work) => 2,
        Some(_) => 1,
    }
}

/// An array of texts.
pub(crate) fn texts<'py>(py: Python<'py>, texts: Vec<&str>) -> PyResult<Bound<'py, PyAny>> {
    let is_empty = texts.is_empty();
    let array = numpy(py)?.call_method1("array", (texts,))?;
    if is_empty { array.call_method1("astype", ("U",)) } else { Ok(array) }
}

/// An array of names, or one name if the shape is empty.
pub(crate) fn names<'py>(
    py: Python<'py>,
    shape: &[usize],
    names: Vec<&str>,
) -> PyResult<Bound<'py, PyAny>> {
    match names[..] {
        [name] if shape.is_empty() => Ok(name.into_pyobject(py)?.into_any()),
        _ => texts(py, names)?.call_method1("reshape", (shape.to_vec(),)),
    }
}

/// Why answers of a batch are missing, as the `kind` of their errors; of one answer the empty
/// string.
pub(crate) fn statuses<'py, A>(
    py: Python<'py>,
    answers: &[Result<A, &str>],
    is_batch: bool,
) -> PyResult<Bound<'py, PyAny>> {
    if !is_batch {
        return Ok("".into_pyobject(py)?.into_any());
    }
    texts(py, answers.iter().map(|it| it.as_ref().err().copied().unwrap_or_default()).collect())
}
