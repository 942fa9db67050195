//! The lines of a file.

use super::poly_data::PolyData;
use crate::mesh::Frame;

/// Points along a line.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Centreline {
    /// The points in the file's order.
    pub points: Vec<[f64; 3]>,
    /// The radius of the segment that begins at each point but the last, if the file is a text with
    /// a column for it. A column of diameters gives half of them.
    pub radii: Option<Vec<f64>>,
    /// The frame of the coordinates, if the file or its format states it.
    pub frame: Option<Frame>,
    /// Whether the unit of length is stated. Markups state it, and the heading of a text may. Such
    /// points are converted to millimetres before they are scaled.
    pub states_unit: bool,
    /// The number of points that are left out because they have no position yet.
    pub skipped_points: usize,
    /// What looks like a mistake, though the file is valid: one sentence each, without a full stop.
    pub doubts: Vec<String>,
}

/// A line of a file.
#[derive(Default)]
pub(super) struct Line {
    pub(super) points: Vec<[f64; 3]>,
    pub(super) skipped_points: usize,
    /// The type that the file names, if it is not a curve.
    pub(super) other: Option<String>,
}

/// All lines of a file.
pub(super) struct Lines {
    pub(super) lines: Vec<Line>,
    pub(super) frame: Option<Frame>,
    pub(super) states_unit: bool,
}

impl Lines {
    /// Returns the lines of PolyData.
    pub(super) fn of(data: PolyData) -> Result<Self, String> {
        let frame = data.frame;
        let line = |points| Line { points, ..Line::default() };
        Ok(Self {
            lines: data.into_lines()?.into_iter().map(line).collect(),
            frame,
            states_unit: false,
        })
    }
}
