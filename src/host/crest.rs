//! The crest of a link: its outline in the plane of its axis and a contact's normal, on the
//! triangle's side.
//!
//! The crest is the barrel's line farthest along the normal. At a round end it continues on the cap
//! to the cap's point farthest along the normal. A surface that the crest touches cannot touch any
//! other part of barrel or cap. [`support_points`](super::support_points) covers the ends of the
//! crest. This file adds:
//!
//! 1. **Edges across it**, where they cross its plane. Near a round cap's own lowest point an edge
//!    is skipped: that point represents the contact, and a second one would hinder the cap from
//!    rolling.
//! 2. **An edge along it**: the two ends of its part beside the barrel.

use super::feature::{self, SAME_POINT};
use super::link_triangle_points::Meeting;
use super::support_points::{self, centre, leans_round, outward};
use crate::robot::ModifiedCylinder;
use parry3d_f64::math::{Real, Vector};
use parry3d_f64::shape::PackedFeatureId;

/// An edge within this share of the radius from the crest lies along it.
const ALONG_CREST: Real = 0.01;
/// A point within this share of the radius from the crest is near it: the surface leans by at most
/// 30 degrees.
const NEAR_CREST: Real = 0.5;
/// No edge counts within this share of the radius around a round cap's lowest point.
const LOWEST: Real = 0.25;

/// Adds the points where edges meet the crest.
pub(super) fn collect(meeting: &mut Meeting) {
    let Some(crest) = Crest::of(meeting.link, meeting.normal) else { return };
    for (j, (v, w)) in meeting.edges().into_iter().enumerate() {
        let edge = PackedFeatureId::edge(j as u32);
        if let Some(ends) = crest.along_barrel(v, w) {
            for (q, id) in ends.into_iter().zip([feature::ALONG_EDGE, feature::ALONG_EDGE + 1]) {
                let dist = crest.drop(q);
                let on_link = q - meeting.normal * dist;
                // Beside the crest the distance along the normal is slightly longer and may lead
                // past the barrel's end.
                let slack = SAME_POINT * meeting.size;
                if (-slack..=crest.length + slack).contains(&on_link.dot(crest.axis)) {
                    meeting.add(on_link, dist, PackedFeatureId::edge(id), edge);
                }
            }
        } else if let Some(q) = crest.across(v, w)
            && let Some(dist) = crest.below(meeting, q)
        {
            let name = PackedFeatureId::edge(feature::BARREL_LINE);
            meeting.add(q - meeting.normal * dist, dist, name, edge);
        }
    }
}

/// The plane of axis and normal, relative to the link's start. All directions are unit vectors.
pub(super) struct Crest {
    axis: Vector,
    normal: Vector,
    /// From the axis to the crest.
    lateral: Vector,
    /// Perpendicular to the plane.
    side: Vector,
    /// The components of the normal along `lateral` and along the axis.
    across: Real,
    slope: Real,
    radius: Real,
    length: Real,
}

impl Crest {
    /// Returns the crest of a link that starts at the origin, if it has one.
    pub fn of(link: &ModifiedCylinder, normal: Vector) -> Option<Self> {
        let axis = link.axis();
        let lateral = support_points::lateral(link, normal)?;
        let (across, slope) = (normal.dot(lateral), normal.dot(axis));
        let (radius, length) = (link.radius(), link.length());
        let side = axis.cross(lateral);
        Some(Self { axis, normal, lateral, side, across, slope, radius, length })
    }

    /// Returns the distance from the barrel to a point along the normal, if the normal line through
    /// the point meets the barrel near the crest.
    pub fn near(&self, q: Vector) -> Option<Real> {
        let dist = self.drop(q);
        let is_over = (0.0..=self.length).contains(&(q - self.normal * dist).dot(self.axis));
        (is_over && q.dot(self.side).abs() <= NEAR_CREST * self.radius).then_some(dist)
    }

    /// Returns the distance from the barrel to a point of the triangle, along the normal.
    fn drop(&self, q: Vector) -> Real {
        let aside = q.dot(self.side);
        let height = ((self.radius - aside) * (self.radius + aside)).max(0.0).sqrt();
        (q.dot(self.lateral) - height) / self.across
    }

    /// Returns the coordinate along the axis at which the normal line through a point meets the
    /// crest's line.
    fn along(&self, q: Vector) -> Real {
        q.dot(self.axis) - (q.dot(self.lateral) - self.radius) / self.across * self.slope
    }

    /// Case 2: returns the ends of an edge's part beside the barrel, if the edge is along the
    /// crest.
    fn along_barrel(&self, v: Vector, w: Vector) -> Option<[Vector; 2]> {
        let (at_v, at_w) = (self.along(v), self.along(w));
        let share = |z: Real| (z - at_v) / (at_w - at_v);
        let (from, to) = if at_v < at_w {
            (share(0.0).max(0.0), share(self.length).min(1.0))
        } else if at_w < at_v {
            (share(self.length).max(0.0), share(0.0).min(1.0))
        } else if (0.0..=self.length).contains(&at_v) {
            (0.0, 1.0)
        } else {
            return None;
        };
        let ends = [v.lerp(w, from), v.lerp(w, to)];
        let is_near = |q: &Vector| q.dot(self.side).abs() <= ALONG_CREST * self.radius;
        (from <= to && ends.iter().all(is_near)).then_some(ends)
    }

    /// Case 1: returns the place where an edge crosses the plane.
    fn across(&self, v: Vector, w: Vector) -> Option<Vector> {
        let (y0, y1) = (v.dot(self.side), w.dot(self.side));
        ((y0 <= 0.0) != (y1 <= 0.0)).then(|| v.lerp(w, y0 / (y0 - y1)))
    }

    /// Case 1: returns the distance from the crest to a point of its plane, along the normal, if
    /// the crest extends there.
    fn below(&self, meeting: &Meeting, q: Vector) -> Option<Real> {
        let z = self.along(q);
        if (0.0..=self.length).contains(&z) {
            return Some(self.drop(q));
        }
        let end = usize::from(z > self.length);
        let offset = q - centre(meeting.link, end);
        let height = offset.dot(self.normal);
        let aside = (offset - self.normal * height).length();
        let is_on_cap = leans_round(meeting.link, self.normal, end)
            && (LOWEST * self.radius..self.radius).contains(&aside);
        let on_cap = height - ((self.radius - aside) * (self.radius + aside)).max(0.0).sqrt();
        // Between the end of the barrel and the cap's lowest point.
        let outward = outward(meeting.link, end);
        let beyond = (offset - self.normal * on_cap).dot(outward);
        let is_between = (0.0..=self.radius * self.normal.dot(outward)).contains(&beyond);
        (is_on_cap && is_between).then_some(on_cap)
    }
}
