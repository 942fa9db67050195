//! A stretch of the tube with one radius, and its flat faces.

use super::cap_persistence::CapPersistence;
use super::curve::CurveBound;
use crate::distance::Scalar;
use parry3d_f64::math::{Real, Vector};

/// A stretch of the tube with one radius. Places along it are *ticks*: the samples, or even shares
/// of the section where the curve is a function.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Section {
    pub first: u32,
    pub last: u32,
    /// Arc lengths, along the polyline through the ticks, where it begins and ends.
    pub start: Real,
    pub end: Real,
    pub radius: Real,
    /// The curve's curvature is at most this.
    pub curvature: Real,
    /// The mean of the bounds on its curvature along it.
    pub mean_curvature: Real,
    /// What its curvature is at most within two radii of its ends, by arc length.
    pub curvature_at: [Real; 2],
    /// What of that was stated or shown. A section with a flat end bends by less than 1 / radius
    /// next to it.
    pub shown_at: [Real; 2],
    /// Whether no more is known of one part than of another.
    pub is_even: bool,
    /// The curve between two ticks is at most so many times as long as the polyline.
    pub stretch: Real,
    /// The flat ends. The others are round.
    pub faces: [Option<EndFace>; 2],
    /// Whether the direction of the flat ends may get lost in other shapes: bodies take them for
    /// round then.
    pub fades: bool,
}

/// A flat end of a section.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EndFace {
    pub centre: Vector,
    /// The unit normal, out of the section.
    pub outward: Vector,
    /// How large the angle between `outward` and the true normal may be.
    pub tilt: Real,
    /// Whether it is there in other shapes of the robot, too.
    pub persistence: CapPersistence,
}

impl Section {
    /// A section of a known radius, so far without length.
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

    /// Takes over what is known of its segments, which reach from one arc length to the next.
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

    /// How far from the flat face at an end, by arc length, a ball on the centreline stays behind
    /// it. A disc at arc length s from the face lies at least sin(curvature s) / curvature
    /// behind its plane, which is the radius where s is asin(curvature radius) / curvature, not
    /// farther away than pi / 2 radii.
    pub(crate) fn room(&self, end: usize) -> Real {
        let curvature = self.curvature_at[end];
        let bend = (curvature * self.radius).min(1.0);
        if bend > 0.0 { libm::asin(bend) / curvature } else { self.radius }
    }
}

/// How many times as long as a polyline the curve may be that turns by so much over a segment.
pub(super) fn stretch(bend: Real) -> Real {
    1.0 + bend * bend / 20.0 + 8.0 * Real::UNIT_ROUNDOFF
}
