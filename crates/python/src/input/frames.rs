//! The frame that points or motions state, and the warning about two that differ.

use super::scalars::FrameName;
use crate::warning::warn;
use mesh_files::Frame;
use numpy::PyUntypedArray;
use pyo3::prelude::*;
use pyo3::types::{PyList, PyTuple};
use std::sync::atomic::{AtomicBool, Ordering};

/// The frame of points or of a motion: its attribute `frame`. Of a list it is the first that an
/// entry states.
pub(crate) fn stated_frame(given: &Bound<'_, PyAny>) -> PyResult<Option<Frame>> {
    // A plain array has no frame, and is what most queries get.
    if given.cast_exact::<PyUntypedArray>().is_ok() {
        return Ok(None);
    }
    let mut entries: Box<dyn Iterator<Item = Bound<'_, PyAny>>> =
        if let Ok(list) = given.cast_exact::<PyList>() {
            Box::new(list.iter())
        } else if let Ok(tuple) = given.cast_exact::<PyTuple>() {
            Box::new(tuple.iter())
        } else {
            Box::new(std::iter::once(given.clone()))
        };
    entries.find_map(|entry| attribute(&entry).transpose()).transpose()
}

fn attribute(given: &Bound<'_, PyAny>) -> PyResult<Option<Frame>> {
    let Some(stated) = given.getattr_opt("frame")? else { return Ok(None) };
    Ok(stated.extract::<FrameName>().ok().map(|FrameName(frame)| frame))
}

/// Turns points from one frame to the other: half a turn about the third axis.
fn half_turn(points: &mut [[f64; 3]]) {
    for [x, y, _] in points {
        (*x, *y) = (-*x, -*y);
    }
}

/// The frame of what was read, in the frame that was asked for: `points` are turned if the file
/// states another one.
pub(crate) fn in_frame(
    points: &mut [[f64; 3]],
    stated: Option<Frame>,
    asked: Option<FrameName>,
) -> Option<Frame> {
    let Some(FrameName(asked)) = asked else { return stated };
    if stated.is_some_and(|stated| stated != asked) {
        half_turn(points);
    }
    Some(asked)
}

/// The text of a warning: one thing states another frame than another thing.
fn text(one: &str, frames: [Frame; 2], other: &str, remedy: &str) -> String {
    let [frame, others] = frames.map(Frame::name);
    format!(
        "{one} the frame {frame}, and {other} {others}: x and y have opposite signs; load both with frame='{others}'{remedy}"
    )
}

/// That points or a motion are in another frame than the mesh, and what to do.
pub(crate) fn mesh_text(name: &str, is_motion: bool, frames: [Frame; 2]) -> String {
    if is_motion {
        return text(&format!("`{name}` states"), frames, "the mesh", "");
    }
    let remedy = format!(", or give `{name} * [-1, -1, 1]`");
    text(&format!("`{name}` state"), frames, "the mesh", &remedy)
}

/// Whether a warning about frames has been given: it is given once.
#[derive(Default)]
pub(crate) struct HasWarned(AtomicBool);

impl HasWarned {
    /// Warns, if nothing has warned before.
    pub(crate) fn warn(&self, py: Python<'_>, text: &str) -> PyResult<()> {
        if self.0.swap(true, Ordering::Relaxed) { Ok(()) } else { warn(py, text) }
    }

    /// Warns if two robots or motions state different frames.
    pub(crate) fn note_pair(
        &self,
        py: Python<'_>,
        names: [&str; 2],
        frames: [Option<Frame>; 2],
    ) -> PyResult<()> {
        match frames {
            [Some(one), Some(other)] if one != other => {
                let [first, second] = names.map(|name| format!("`{name}`"));
                self.warn(py, &text(&format!("{first} is in"), [one, other], &second, ""))
            }
            _ => Ok(()),
        }
    }
}
