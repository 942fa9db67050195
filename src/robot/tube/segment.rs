//! A segment between two samples, and the curvature that two of them show.

use parry3d_f64::math::{Real, Vector};

/// Samples lie unevenly where a segment is so many times as long as its neighbour.
const UNEVEN: Real = 4.0;

/// A segment between two samples.
#[derive(Clone, Copy)]
pub(super) struct Segment {
    pub direction: Vector,
    pub length: Real,
    /// The length that it has at least, if its ends may be off.
    pub least: Real,
    /// What the rounding of the samples, or how far they may be off, can do to the direction.
    pub noise: Real,
}

impl Segment {
    /// None without a length.
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

    /// The same segment, whose ends may be so far off together.
    pub(super) fn with_gap(self, gap: Real) -> Self {
        if gap > 0.0 {
            let least = self.length - gap;
            Self { noise: self.noise + gap / least, least, ..self }
        } else {
            self
        }
    }

    /// Whether it is far longer or shorter than its neighbour.
    #[inline(always)]
    pub(super) fn is_uneven(&self, neighbour: &Self) -> bool {
        neighbour.length > UNEVEN * self.length || self.length > UNEVEN * neighbour.length
    }

    /// The share of its length by which it may be longer.
    pub(super) fn looseness(&self) -> Real {
        (self.length - self.least) / self.length
    }
}

/// The curvature that the turn from one segment to the next shows.
pub(super) fn curvature_between(before: &Segment, segment: &Segment) -> Real {
    let turn = (segment.direction - before.direction).length() + segment.noise + before.noise;
    turn / (0.5 * (segment.least + before.least))
}

/// The curvature that the turn from the direction at an end to the segment next to it shows.
pub(super) fn curvature_from(direction: Vector, segment: &Segment) -> Real {
    let turn = (segment.direction - direction).length() + segment.noise;
    turn / (0.5 * segment.least)
}
