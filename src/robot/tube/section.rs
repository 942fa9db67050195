//! A stretch of the tube with one radius, and its flat faces.

use super::lasting::Lasting;
use parry3d_f64::math::{Real, Vector};

/// A stretch of the tube with one radius. Places along it are *ticks*: the samples, or even shares of the section where
/// the curve is a function.
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
    /// What of that was stated or shown. A section with a flat end bends by less than 1 / radius next to it.
    pub shown_at: [Real; 2],
    /// Whether no more is known of one part than of another.
    pub is_even: bool,
    /// The curve between two ticks is at most so many times as long as the polyline.
    pub stretch: Real,
    /// The flat ends. The others are round.
    pub faces: [Option<Face>; 2],
}

/// A flat end of a section.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Face {
    pub centre: Vector,
    /// The unit normal, out of the section.
    pub outward: Vector,
    /// How large the angle between `outward` and the true normal may be.
    pub tilt: Real,
    /// Whether it is there in other shapes of the robot, too.
    pub lasting: Lasting,
}

impl Section {
    /// How far from the flat face at an end, by arc length, a ball on the centreline stays behind it. A disc at arc length s
    /// from the face lies at least sin(curvature s) / curvature behind its plane, which is the radius where s is
    /// asin(curvature radius) / curvature, not farther away than pi / 2 radii.
    pub(crate) fn room(&self, end: usize) -> Real {
        let curvature = self.curvature_at[end];
        let bend = (curvature * self.radius).min(1.0);
        if bend > 0.0 { libm::asin(bend) / curvature } else { self.radius }
    }
}
