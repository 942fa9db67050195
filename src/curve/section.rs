//! A section: a range of the tube with one radius, and its flat faces.

use super::curve_bound::CurveBound;
use crate::distance::Scalar;
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

/// Whether a flat end is flat in other shapes of the robot, too.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum CapPersistence {
    /// In every shape: the robot's two ends, the wider side of each step in radius, all ends of
    /// links with flat caps, and all flat ends of a motion of one shape.
    Always,
    /// At a joint of a curve, where flat and round describe the same tube.
    Either,
    /// Flat while it is too near the limit (reason 2).
    WhileNear,
    /// As `WhileNear` in a chain that may be capped by vertex radii: too near the limit and every
    /// vertex between the limit and the end.
    WhileAllNear,
    /// The direction is unknown.
    Never,
}

impl CapPersistence {
    /// Returns whether a bounding body with this flat end contains the tube at other times, too.
    pub(crate) fn is_safe(self) -> bool {
        matches!(self, Self::Always | Self::Either)
    }
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

/// Upper bound on the length of a curve over its polyline, if it turns by `bend <= 1` per segment
/// (`samples`, claim 1).
pub(super) fn stretch(bend: Real) -> Real {
    1.0 + bend * bend / 20.0 + 8.0 * Real::UNIT_ROUNDOFF
}
