//! A sampled centreline as runs of one radius, for functions that remove points.

use super::RobotError;
use super::chain::check_segments;
use parry3d_f64::math::{Real, Vector};
use std::borrow::Cow;

/// A centreline without repeated points, with the indices of the points that must stay.
pub(super) struct RadiusRuns<'a> {
    points: Cow<'a, [Vector]>,
    /// The two ends and each change of radius, ascending.
    must_stay: Vec<usize>,
    /// The radius of each run between two points that must stay.
    radii: Vec<Real>,
}

/// The points of one run. Both ends must stay, and no two consecutive points are equal.
pub(super) struct RadiusRun<'a> {
    pub(super) points: &'a [Vector],
    pub(super) radius: Real,
}

impl<'a> RadiusRuns<'a> {
    /// Splits a centreline, to be simplified within a tolerance, into runs.
    ///
    /// A segment without length is removed with its radius. If that radius differs from a
    /// neighbour's, the point counts as a change of radius.
    ///
    /// # Errors
    /// As [`check_segments`]; a tolerance that is negative or not finite; all points equal.
    pub(super) fn of(
        points: &'a [Vector],
        segment_radii: &'a [Real],
        tolerance: Real,
    ) -> Result<Self, RobotError> {
        check_segments(points, segment_radii)?;
        if !(0.0..Real::INFINITY).contains(&tolerance) {
            return Err(RobotError::Negative { parameter: "tolerance", value: tolerance });
        }
        let has_repeats = points.windows(2).any(|ends| ends[0] == ends[1]);
        let mut distinct = Vec::with_capacity(if has_repeats { points.len() } else { 0 });
        distinct.extend_from_slice(if has_repeats { &points[..1] } else { &[] });
        let (mut must_stay, mut radii) = (vec![0], vec![]);
        // `here`: index of the last distinct point. `last_radius`: radius of the last segment.
        // `radius_before`: radius of the last segment that has a length.
        let (mut here, mut last_radius, mut radius_before) =
            (0, segment_radii[0], segment_radii[0]);
        for (ends, &radius) in points.windows(2).zip(segment_radii) {
            if radius != last_radius && must_stay.last() != Some(&here) {
                must_stay.push(here);
                radii.push(radius_before);
            }
            last_radius = radius;
            if ends[0] != ends[1] {
                here += 1;
                radius_before = radius;
                if has_repeats {
                    distinct.push(ends[1]);
                }
            }
        }
        if here == 0 {
            return Err(RobotError::AllPointsEqual);
        }
        if must_stay.last() != Some(&here) {
            must_stay.push(here);
            radii.push(radius_before);
        }
        let points = if has_repeats { Cow::Owned(distinct) } else { Cow::Borrowed(points) };
        Ok(Self { points, must_stay, radii })
    }

    pub(super) fn first_point(&self) -> Vector {
        self.points[0]
    }

    pub(super) fn iter(&self) -> impl ExactSizeIterator<Item = RadiusRun<'_>> {
        let ends = self.must_stay.windows(2);
        ends.zip(&self.radii)
            .map(|(ends, &radius)| RadiusRun { points: &self.points[ends[0]..=ends[1]], radius })
    }
}
