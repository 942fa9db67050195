//! Motions as objects: a class for each kind, and what all of them are.

mod bending;
mod linear;
mod motion_list;
mod motion_pair;
mod motion_path;
mod moving;
mod moving_base;
mod recipe;
mod rigid;
mod verify;
mod way;

pub(crate) use bending::BendingMotion;
pub(crate) use linear::{LinearMotion, Maker, maker};
pub(crate) use motion_list::MotionList;
pub(crate) use motion_pair::MotionPair;
pub(crate) use motion_path::MotionPath;
pub(crate) use moving::Moving;
pub(crate) use moving_base::MovingBase;
use recipe::Recipe;
pub(crate) use rigid::RigidMotion;
pub(crate) use verify::verify_motion;

use crate::error::Refused;
use crate::input::{place_in, together};
use crate::threads::{Asked, compute};
use mesh_files::Frame;
use pyo3::PyClass;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use std::ops::Range;
use std::sync::Arc;

/// A robot that changes with time, from 0 to 1; or a batch of such.
///
/// `LinearMotion`, `RigidMotion` and `BendingMotion` are motions. `MovingBase` moves the base of
/// any of them, and `MotionPath` puts them one after another. `Mesh.clears_motion`,
/// `time_of_contact`, `clearance_of_motion` and `clears_motion_while` take any of them. A motion
/// copies its arguments, never changes, and can be pickled.
#[pyclass(frozen, subclass, module = "parry_continuum")]
pub(crate) struct Motion {
    motions: Arc<Vec<Moving>>,
    size: Size,
    /// How many there are; none where one motion was given, without a first index.
    count: Option<usize>,
    /// The arguments of the motion's class.
    recipe: Option<Recipe>,
    /// The frame that its points state.
    frame: Option<Frame>,
}

#[pymethods]
impl Motion {
    /// How many motions there are; None of one that is no batch.
    #[getter]
    fn count(&self) -> Option<usize> {
        self.count
    }

    /// The frame that its points state, "RAS" or "LPS", or None.
    ///
    /// Poses may lead into another frame: points that poses move count as stating a frame only if
    /// one of the poses is the identity. A query warns if a motion and a mesh, or two motions,
    /// state different frames.
    #[getter]
    fn frame(&self) -> Option<&'static str> {
        self.frame.map(Frame::name)
    }

    fn __copy__(slf: Bound<'_, Self>) -> Bound<'_, Self> {
        slf // it never changes
    }

    fn __deepcopy__<'py>(slf: Bound<'py, Self>, _memo: &Bound<'py, PyAny>) -> Bound<'py, Self> {
        slf
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        match &slf.get().recipe {
            Some(recipe) => recipe.reduced(slf.get_type().into_any()),
            None => Err(PyTypeError::new_err("this motion cannot be pickled")),
        }
    }

    fn __repr__(slf: &Bound<'_, Self>) -> PyResult<String> {
        let name = slf.get_type().name()?;
        Ok(match slf.get().count {
            Some(count) => format!("<{name}: a batch of {count}>"),
            None => format!("<{name}>"),
        })
    }
}

impl Motion {
    /// The motion of one, or of each of a batch. `make` runs without the GIL.
    pub(crate) fn new(
        py: Python<'_>,
        count: Option<usize>,
        make: impl Fn(usize) -> Result<Moving, Refused> + Sync,
    ) -> PyResult<Self> {
        /// How many steps pass between two checks for signals.
        const CHUNK: usize = 1024;
        let all = count.unwrap_or(1);
        let mut motions = Vec::with_capacity(all);
        for start in (0..all).step_by(CHUNK) {
            let range = start..all.min(start + CHUNK);
            let refused = compute(py, || {
                range.clone().find_map(|place| match make(place) {
                    Ok(motion) => {
                        motions.push(motion);
                        None
                    }
                    Err(refused) => Some((place, refused)),
                })
            })?;
            if let Some((place, refused)) = refused {
                return Err(refused.raise(py, count.map(|_| place)));
            }
            py.check_signals()?;
        }
        Ok(Self { motions: Arc::new(motions), size: Size::ONE, count, recipe: None, frame: None })
    }

    /// The same, made of others.
    fn of(self, size: Size) -> Self {
        Self { size, ..self }
    }

    /// The same, with the arguments of its class.
    fn with_recipe(self, recipe: Recipe) -> Self {
        Self { recipe: Some(recipe), ..self }
    }

    /// The same, whose points state a frame.
    fn with_frame(self, frame: Option<Frame>) -> Self {
        Self { frame, ..self }
    }

    /// The frame that its points state.
    pub(crate) fn stated_frame(&self) -> Option<Frame> {
        self.frame
    }

    /// An object of a class of motions.
    fn into_class<C: PyClass<BaseType = Self>>(self, class: C) -> PyClassInitializer<C> {
        PyClassInitializer::from(self).add_subclass(class)
    }

    /// How many motions there are, and those: one stands for all of a batch.
    fn parts(&self) -> (Option<usize>, Arc<Vec<Moving>>) {
        (self.count, Arc::clone(&self.motions))
    }
}

/// How many motions each of a batch is made of, and how deep they are in one another.
#[derive(Clone, Copy)]
struct Size {
    parts: usize,
    depth: usize,
}

impl Size {
    const ONE: Self = Self { parts: 1, depth: 1 };

    /// The size of a motion that has these parts. Each level asks the level below it several times,
    /// so size and depth are limited.
    fn of(py: Python<'_>, parts: impl Iterator<Item = Self>) -> PyResult<Self> {
        const MOST_PARTS: usize = 1 << 20;
        const MOST_DEEP: usize = 6;
        let mut size = Self { parts: 0, depth: 0 };
        for part in parts {
            size.parts = size.parts.saturating_add(part.parts);
            size.depth = size.depth.max(part.depth);
        }
        size.depth += 1;
        if size.depth <= MOST_DEEP && size.parts <= MOST_PARTS {
            return Ok(size);
        }
        let text = format!(
            "there are {} motions, {} deep in one another, more than {MOST_PARTS} or deeper than {MOST_DEEP}; make one path of all \
             motions, and move the base of that",
            size.parts, size.depth
        );
        Err(Refused::other("nested_too_deep", text).raise(py, None))
    }
}

/// The motion at an index of a batch. A single motion stands for the whole batch.
fn at(motions: &[Moving], place: usize) -> &Moving {
    &motions[if motions.len() == 1 { 0 } else { place }]
}

/// Some motions of a batch, which share its memory.
#[derive(Default)]
pub(crate) struct SomeMotions {
    first: usize,
    motions: Arc<Vec<Moving>>,
}

impl Asked for Motion {
    type Block = SomeMotions;
    type One<'a> = &'a Moving;

    // One may take as long as thousands of robots.
    const FEW: usize = 2;

    fn count(&self) -> Option<usize> {
        self.count
    }

    fn copy(&self, range: Range<usize>, block: &mut SomeMotions) -> Result<(), Refused> {
        (block.first, block.motions) = (range.start, Arc::clone(&self.motions));
        Ok(())
    }

    fn one(block: &SomeMotions, place: usize) -> &Moving {
        &block.motions[block.first + place]
    }
}
