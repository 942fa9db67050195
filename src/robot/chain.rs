//! A robot as a chain of links.

use super::{ModifiedCylinder, RobotError};
use parry3d_f64::math::{Real, Vector};
use std::ops::Range;

/// A continuum robot: links joined end to end along a centreline.
#[derive(Clone, Debug, PartialEq)]
pub struct Chain {
    links: Vec<ModifiedCylinder>,
    segments: Vec<Range<usize>>,
}

impl Chain {
    /// Capsules.
    ///
    /// # Errors
    /// As for each link.
    pub fn capsules(points: &[Vector], segment_radii: &[Real]) -> Result<Self, RobotError> {
        let links = points
            .windows(2)
            .zip(segment_radii)
            .map(|(ends, &radius)| ModifiedCylinder::capsule(ends[0], ends[1], radius))
            .collect::<Result<Vec<_>, _>>()?;
        let segments = (0..links.len()).map(|k| k..k + 1).collect();
        Ok(Self { links, segments })
    }

    /// The links, from the base to the tip.
    pub fn links(&self) -> &[ModifiedCylinder] {
        &self.links
    }

    /// The input segments that a link stands for.
    pub fn segments_of(&self, link: usize) -> Range<usize> {
        self.segments[link].clone()
    }
}
