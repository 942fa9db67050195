//! Robots of sections of constant curvature: a row for each section, and radii.

use super::counts::place_in;
use super::numbers::{Numbers, shape_text};
use crate::error::Refused;
use parry_continuum::BendingSection;
use pyo3::prelude::*;

/// Lengths and curvatures of one robot, or of many.
pub(crate) struct Sections {
    rows: Vec<[f64; 3]>,
    /// How many a robot has.
    pub each: usize,
    pub count: Option<usize>,
}

impl Sections {
    pub(crate) fn new(given: &Bound<'_, PyAny>, name: &str) -> PyResult<Self> {
        let numbers = Numbers::new(given, name)?;
        let (count, each) = match *numbers.shape() {
            [each, 3] => (None, each),
            [(1..), 0, 3] => {
                let text = format!(
                    "`{name}` has the shape {}, no sections; give at least one",
                    shape_text(numbers.shape())
                );
                return Err(Refused::other("no_sections", text).raise(given.py(), None));
            }
            [count, each, 3] => (Some(count), each),
            ref shape => {
                let text = format!(
                    "`{name}` has the shape {}, not (S, 3) or (B, S, 3); give a row for each section: its length, and its curvature \
                     towards x and y",
                    shape_text(shape)
                );
                return Err(Refused::other("bad_shape", text).raise(given.py(), None));
            }
        };
        Ok(Self { rows: numbers.points().to_vec(), each, count })
    }

    /// The sections at a place of the batch.
    pub(crate) fn at(
        &self,
        place: usize,
        radii: &SectionRadii,
    ) -> impl Iterator<Item = BendingSection> {
        let first = self.each * place_in(self.count, place);
        let rows = &self.rows[first..first + self.each];
        let section = move |(number, &[length, x, y]): (usize, &[f64; 3])| BendingSection {
            length,
            radius: radii.at(place, number),
            bend: [x, y],
        };
        rows.iter().enumerate().map(section)
    }
}

/// A radius for each section, or one for all.
pub(crate) struct SectionRadii {
    radii: Vec<f64>,
    sections: usize,
    pub count: Option<usize>,
}

impl SectionRadii {
    pub(crate) fn new(given: &Bound<'_, PyAny>, sections: usize) -> PyResult<Self> {
        let numbers = Numbers::new(given, "radii")?;
        let radii = numbers.values();
        match *numbers.shape() {
            [] => Ok(Self { radii: vec![radii[0]; sections], sections, count: None }),
            [each] if each == sections => Ok(Self { radii: radii.to_vec(), sections, count: None }),
            [count, each] if each == sections => {
                Ok(Self { radii: radii.to_vec(), sections, count: Some(count) })
            }
            ref shape => {
                let text = format!(
                    "`radii` has the shape {}; give a number, or the shape ({sections},) or (B, {sections}): one radius for each \
                     section",
                    shape_text(shape)
                );
                Err(Refused::other("bad_shape", text).raise(given.py(), None))
            }
        }
    }

    fn at(&self, place: usize, section: usize) -> f64 {
        let first = self.sections * place_in(self.count, place);
        self.radii[first + section]
    }
}
