//! A section: a range of the tube with one radius, and its flat faces: which of its ends are flat.
//!
//! # Which ends are flat
//!
//! The tube is the union of its discs. At the end of a section that continues in the next one,
//! without a step or within a wider one, a ball lies in the tube's discs. A bounding body with a
//! round end is cheaper to search than one with a face, so such ends are round. The walks of
//! Algorithm 1 (`algorithm_1`) decide it. A curve needs a stricter test than the printed distance
//! between limit and joint: on a bent centreline, a ball one radius away may stick out of the
//! limit's face.
//!
//! **Definitions.**
//! - `e`: the centre of the end. `r`: its radius. The ball: radius r around e.
//! - `p`: the limit, the centre of the last face. `a`: the tilt of that face.
//! - `x`: a point of the ball behind the plane across the curve at e.
//!
//! **Claim.** The ball lies in the tube if one of two conditions holds:
//!
//! 1. e is at least r behind the plane of the face at p. With a normal known up to the angle a, e
//!    is certainly behind it by the computed depth minus `|e - p| a`.
//! 2. `|e - p| > 2 r`.
//!
//! **Proof.** Radii do not grow from p to e, so each disc between them has at least the radius r.
//! Consider the point of the centreline between p and e that is nearest to x.
//!
//! - An inner point: x lies in the plane of its disc, and no farther from its centre than from e.
//!   So x lies in the disc.
//! - The point e: x lies in the plane of the disc at e.
//! - The point p: x may lie ahead of the plane of the face. Condition 1 excludes this, because the
//!   whole ball is behind that plane. Condition 2 excludes it, because x is within r of e and so
//!   nearer to e than to p.
//!
//! The rest of the ball lies in the section's own discs, or in the ball at its other end. A face at
//! the other end cuts the ball off.
//!
//! Otherwise the end is flat. That is right at any joint, since the tube is its discs.
//!
//! **Rounding.** If rounding makes an end round that is flat, the ball sticks out by that rounding
//! at most.

use super::Tube;
use super::cap_persistence::CapPersistence;
use super::centreline::CurveBound;
use crate::distance::Scalar;
use crate::robot::RadiusSteps;
use parry3d_f64::math::{Real, Vector};

/// A range of the tube with one radius. Places along it are *ticks*: the samples, or even shares of
/// the section if the curve is a function.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Section {
    pub first: u32,
    pub last: u32,
    /// Arc lengths of its start and end, along the polyline through the ticks.
    pub start: Real,
    pub end: Real,
    pub radius: Real,
    /// Upper bound on the curvature.
    pub curvature: Real,
    /// The mean of the curvature bounds along it.
    pub mean_curvature: Real,
    /// Upper bounds on the curvature within two radii of each end, by arc length.
    pub curvature_at: [Real; 2],
    /// The part of `curvature_at` that was stated or shown. Next to a flat end it is below
    /// `1 / radius`.
    pub shown_at: [Real; 2],
    /// Whether one bound holds for all its parts.
    pub is_even: bool,
    /// Upper bound on the length of the curve between two ticks over the length of the polyline.
    pub stretch: Real,
    /// The flat ends; `None` for a round end.
    pub faces: [Option<EndFace>; 2],
    /// Whether the flat ends may lose their direction in other shapes. Bounding bodies then treat
    /// them as round.
    pub fades: bool,
}

/// A flat end of a section.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EndFace {
    pub centre: Vector,
    /// The unit normal, out of the section.
    pub outward: Vector,
    /// Upper bound on the angle between `outward` and the true normal.
    pub tilt: Real,
    /// Whether the end is flat in other shapes of the robot, too.
    pub persistence: CapPersistence,
}

impl Section {
    /// A section of radius `radius` that still has no length.
    pub(super) fn beginning(first: usize, start: Real, radius: Real) -> Self {
        Self {
            first: first as u32,
            last: first as u32,
            start,
            end: start,
            radius,
            curvature: 0.0,
            mean_curvature: 0.0,
            curvature_at: [0.0; 2],
            shown_at: [0.0; 2],
            is_even: true,
            stretch: 1.0,
            faces: [None; 2],
            fades: false,
        }
    }

    /// Derives its bounds from its segments. `arcs` are the arc lengths of the segments' ends.
    pub(super) fn bound_by(&mut self, bounds: &[CurveBound], arcs: &[Real]) {
        let all = || bounds.iter().zip(arcs.windows(2));
        let most = |of: &dyn Fn(&CurveBound, &[Real]) -> Real| {
            all().fold(0.0, |most: Real, (bound, arcs)| most.max(of(bound, arcs)))
        };
        self.is_even = false;
        self.curvature = most(&|bound, _| bound.curvature);
        let turn: Real = all().map(|(bound, arcs)| bound.curvature * (arcs[1] - arcs[0])).sum();
        self.mean_curvature = (turn / (self.end - self.start)).min(self.curvature);
        self.stretch = stretch(most(&|bound, arcs| bound.curvature * (arcs[1] - arcs[0])));
        let near = 2.0 * self.radius;
        let (start, end) = (self.start, self.end);
        self.curvature_at = [
            most(&|bound, arcs| if arcs[0] - start <= near { bound.curvature } else { 0.0 }),
            most(&|bound, arcs| if end - arcs[1] <= near { bound.curvature } else { 0.0 }),
        ];
        self.shown_at = self.curvature_at;
    }

    /// Returns an arc length from a flat end at which, and beyond which, a ball of the tube's
    /// radius does not cross the face.
    ///
    /// A disc at arc length s from the face lies at least `sin(k s) / k` behind its plane, for the
    /// curvature k. This equals the radius r at `s = asin(k r) / k`, which is at most `(pi / 2) r`.
    pub(crate) fn room(&self, end: usize) -> Real {
        let curvature = self.curvature_at[end];
        let bend = (curvature * self.radius).min(1.0);
        if bend > 0.0 { libm::asin(bend) / curvature } else { self.radius }
    }
}

/// Upper bound on the length of a curve over its polyline, if it turns by `bend` per segment.
pub(super) fn stretch(bend: Real) -> Real {
    1.0 + bend * bend / 20.0 + 8.0 * Real::UNIT_ROUNDOFF
}

impl Tube {
    /// One walk of Algorithm 1. Calls `visit` with each section and the section of the last limit,
    /// which comes before it or is the same.
    pub(super) fn walk(&mut self, end: usize, mut visit: impl FnMut(&mut Self, usize, usize)) {
        let count = self.sections.len();
        let (mut limit, mut steps) = (0, RadiusSteps::default());
        for step in 0..count {
            let number = if end == 0 { step } else { count - 1 - step };
            if steps.is_up(self.sections[number].radius) {
                limit = number;
            }
            visit(self, number, limit);
        }
    }

    /// Returns whether a section is flat at an end with this centre, if the last limit is at that
    /// end of the section `limit`.
    pub(super) fn is_flat(&self, end: usize, number: usize, limit: usize, centre: Vector) -> bool {
        let radius = self.sections[number].radius;
        let is_free = |limit: EndFace| {
            let ahead = limit.centre - centre;
            let apart = ahead.length();
            apart > 2.0 * radius || ahead.dot(limit.outward) - apart * limit.tilt >= radius
        };
        number == limit || !self.sections[limit].faces[end].is_some_and(is_free)
    }
}
