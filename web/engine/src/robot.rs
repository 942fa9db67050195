//! The robot: concentric tubes, or a centreline from a file.

use crate::files::{Files, options, refused};
use crate::frame_of;
use continuum_demo::ctr::{Joints, three_tubes};
use continuum_demo::ventricle;
use mesh_files::{Frame, centreline_from_bytes};
use parry_continuum::Chain;
use parry_continuum::parry::math::{Real, Vector};
use std::path::Path;
use wasm_bindgen::prelude::wasm_bindgen;

/// How many links stand for the tubes.
const LINKS: usize = 30;

/// A robot: concentric tubes, or the user's points.
#[wasm_bindgen]
#[derive(Debug)]
pub struct Robot {
    chain: Chain,
    line: Option<Line>,
}

/// A robot from a file.
#[derive(Debug)]
pub struct Line {
    pub points: Vec<Vector>,
    pub radius: Real,
    /// Whether the file has the radii, so that the scale applies to them.
    pub has_radii: bool,
    /// The factor of the coordinates in the file.
    pub scale: Real,
    /// By the file or by the user.
    pub frame: Option<Frame>,
    pub states_frame: bool,
    pub name: String,
    skipped_points: usize,
    doubts: Vec<String>,
}

impl Line {
    /// Returns the radius after another factor of the file's lengths.
    pub fn scaled_radius(&self, scale: Real) -> Real {
        if self.has_radii { scale * self.radius } else { self.radius }
    }
}

#[wasm_bindgen]
impl Robot {
    /// Three concentric tubes, each so far out of the one around it and turned by an angle (rad).
    ///
    /// # Errors
    /// Nothing is out.
    pub fn of_tubes(extensions: &[Real], angles: &[Real]) -> Result<Robot, String> {
        let joints = Joints { extensions: extensions.to_vec(), angles: angles.to_vec() };
        let line = three_tubes().centreline(&joints, LINKS);
        let chain =
            Chain::from_centreline(&line.points, &line.radii).map_err(|error| error.to_string())?;
        Ok(Self { chain, line: None })
    }

    /// Reads the robot in a file, by the rules of `mesh_files::load_centreline`.
    ///
    /// - `line`: the line of a file with several, counted from 0.
    /// - `scale`: the factor of the coordinates and the radii in the file.
    /// - `radius`: the radius of all links if the file has none, in the wall's unit.
    /// - `frame`: RAS or LPS, if the file does not state it.
    ///
    /// # Errors
    /// The file is invalid, the points make no robot, or a choice contradicts the file.
    pub fn read(
        files: &Files,
        name: &str,
        line: Option<u32>,
        scale: Real,
        radius: Option<Real>,
        frame: Option<String>,
    ) -> Result<Robot, String> {
        let bytes = files.get(Path::new(name)).unwrap_or_default();
        let options = options(scale).with_line(line.map(|line| line as usize));
        let read = centreline_from_bytes(name, bytes, &options).map_err(|error| refused(&error))?;
        let asked = frame.as_deref().map(frame_of).transpose()?;
        let frame = Frame::resolve(read.frame, asked).map_err(|stated| {
            format!("{name} says that it is {}; choose this frame for the robot", stated.name())
        })?;
        let points: Vec<_> = read.points.into_iter().map(Vector::from).collect();
        let has_radii = read.radii.is_some();
        let radii = match (read.radii, radius) {
            (Some(radii), None) => radii,
            (None, Some(radius)) => vec![radius; points.len().saturating_sub(1)],
            (Some(_), Some(_)) => {
                return Err(format!(
                    "{name} has a column of radii; leave the radius empty, or remove the column"
                ));
            }
            (None, None) => {
                return Err(format!(
                    "{name} has no radius; enter one, or add a column radius to a CSV (radii of a vessel are not read)"
                ));
            }
        };
        let chain =
            Chain::from_centreline(&points, &radii).map_err(|error| format!("{name}: {error}"))?;
        let line = Line {
            points,
            radius: radii.into_iter().fold(0.0, Real::max),
            has_radii,
            scale,
            frame,
            states_frame: read.frame.is_some(),
            name: name.to_owned(),
            skipped_points: read.skipped_points,
            doubts: read.doubts,
        };
        Ok(Self { chain, line: Some(line) })
    }

    /// The frame that the file states: RAS, LPS or none.
    pub fn stated_frame(&self) -> Option<String> {
        let line = self.line.as_ref().filter(|line| line.states_frame)?;
        line.frame.map(|frame| frame.name().to_owned())
    }

    /// What was left out of the file, and what looks like a mistake in it.
    pub fn notes(&self) -> Vec<String> {
        let Some(Line { name, skipped_points, doubts, .. }) = &self.line else { return Vec::new() };
        let skipped = (*skipped_points > 0)
            .then(|| format!("left out of {name}: {skipped_points} points without a position"));
        let doubts = doubts.iter().map(|doubt| format!("{name}: {doubt}"));
        skipped.into_iter().chain(doubts).collect()
    }

    /// How far each tube can be out.
    pub fn longest() -> Vec<Real> {
        three_tubes().sections.iter().map(|section| section.length).collect()
    }

    /// Three extensions and three angles at which the tubes reach the end of the ventricle.
    pub fn goal() -> Vec<Real> {
        let Joints { extensions, angles } = ventricle::goal();
        [extensions, angles].concat()
    }
}

impl Robot {
    pub(crate) fn chain(&self) -> &Chain {
        &self.chain
    }

    /// The file's line; `None` for concentric tubes.
    pub(crate) fn line(&self) -> Option<&Line> {
        self.line.as_ref()
    }
}
