//! A segment between two samples, and the curvature that two neighbouring segments show.

use parry3d_f64::math::{Real, Vector};

/// Samples lie unevenly if one segment is this many times as long as its neighbour.
const UNEVEN: Real = 4.0;

/// A segment between two samples.
#[derive(Clone, Copy)]
pub(super) struct Segment {
    pub direction: Vector,
    pub length: Real,
    /// A lower bound on its length if its ends may be off.
    pub least: Real,
    /// Upper bound on the error of the direction: rounding of the samples, and errors of its ends.
    pub noise: Real,
}

impl Segment {
    /// Returns `None` for a segment without length.
    #[inline(always)]
    pub(super) fn between(from: Vector, to: Vector, rounding: Real) -> Option<Self> {
        let along = to - from;
        let length = along.length();
        if length > 0.0 {
            let inverse = 1.0 / length;
            Some(Self {
                direction: along * inverse,
                length,
                least: length,
                noise: rounding * inverse,
            })
        } else {
            None
        }
    }

    /// Returns the segment with ends that may be off by `gap` in sum.
    pub(super) fn with_gap(self, gap: Real) -> Self {
        if gap > 0.0 {
            let least = self.length - gap;
            Self { noise: self.noise + gap / least, least, ..self }
        } else {
            self
        }
    }

    /// Returns whether it is far longer or shorter than its neighbour.
    #[inline(always)]
    pub(super) fn is_uneven(&self, neighbour: &Self) -> bool {
        neighbour.length > UNEVEN * self.length || self.length > UNEVEN * neighbour.length
    }

    /// Returns the relative amount by which it may be longer or shorter.
    pub(super) fn looseness(&self) -> Real {
        (self.length - self.least) / self.length
    }
}

/// Returns the curvature that the turn between two segments shows, errors included.
pub(super) fn curvature_between(before: &Segment, segment: &Segment) -> Real {
    let turn = (segment.direction - before.direction).length() + segment.noise + before.noise;
    turn / (0.5 * (segment.least + before.least))
}

/// Returns the curvature that the turn from an end direction to the next segment shows.
pub(super) fn curvature_from(direction: Vector, segment: &Segment) -> Real {
    let turn = (segment.direction - direction).length() + segment.noise;
    turn / (0.5 * segment.least)
}
