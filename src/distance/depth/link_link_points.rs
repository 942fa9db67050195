//! The contact point of two links after they are moved apart along the normal of the widest gap.
//!
//! The part of a link that is farthest along a normal is
//! - a disc, if the normal is along the axis and the end is flat;
//! - a segment of the barrel, if the normal is perpendicular to the axis;
//! - otherwise a point.
//!
//! After the translation the two parts lie in one plane and meet. A point is the contact itself.
//! For a segment and another segment or a disc, the contact is the closest point. For two discs it
//! is the middle of the common part of the line through both centres.

use super::direction::{unit, unit_across};
use super::link_link::{Gap, LinkLink, SolidLink};
use crate::distance::{Vec3, segment_disc, segment_segment};
use parry3d_f64::math::{Real, Vector};

/// A point below the plane by at most this share of the link's size lies in the plane. The value is
/// above the rounding of a normal, and below a tilt that visibly moves the contact.
const IN_PLANE: Real = 1e-12;

/// The part of a link that is farthest along a normal.
enum Foremost {
    Point(Vector),
    Segment([Vector; 2]),
    Disc(Vector),
}

impl Foremost {
    fn of(body: &SolidLink, n: Vector) -> Self {
        let end = body.end_toward(n);
        let (_, offset) = body.beyond(end, n);
        let Some(axis) = body.axis else { return Self::Point(body.start + offset) };
        let near = IN_PLANE * ((body.end - body.start).length() + body.radius);
        if (body.end - body.start).dot(n).abs() <= near {
            let lateral = unit_across(n, axis).unwrap_or(n) * body.radius;
            return Self::Segment([body.start + lateral, body.end + lateral]);
        }
        let across = (n - axis * axis.dot(n)).length();
        if body.flat[end] && across * body.radius <= near {
            return Self::Disc(body.centre(end));
        }
        Self::Point(body.centre(end) + offset)
    }
}

impl LinkLink {
    /// Returns the point of the first link that touches the second link after its translation by
    /// `-gap.width` along the normal.
    pub(crate) fn touching_point(&self, gap: Gap) -> Vector {
        let n = gap.normal;
        let apart = n * gap.width;
        let [one, other] = [Foremost::of(&self.first, n), Foremost::of(&self.second, -n)];
        let (r1, r2) = (self.first.radius, self.second.radius);
        let onto = |segment: [Vector; 2], centre: Vector, normal: Option<Vector>, radius| {
            let normal = normal.unwrap_or(n);
            Vector::from(
                segment_disc(segment.map(Vec3::from), centre.into(), normal.into(), radius).point1,
            )
        };
        match (one, other) {
            (Foremost::Point(p), _) => p,
            (_, Foremost::Point(q)) => q - apart,
            (Foremost::Segment(s), Foremost::Segment(t)) => {
                let t = t.map(|q| q - apart);
                let reversed = (s[1] - s[0]).dot(t[1] - t[0]) < 0.0;
                let t = if reversed { [t[1], t[0]] } else { t };
                middle_along(s, t).unwrap_or_else(|| {
                    segment_segment(s.map(Vec3::from), t.map(Vec3::from)).point1.into()
                })
            }
            (Foremost::Segment(s), Foremost::Disc(q)) => onto(s, q - apart, self.second.axis, r2),
            (Foremost::Disc(p), Foremost::Segment(t)) => {
                onto(t.map(|q| q - apart), p, self.first.axis, r1)
            }
            (Foremost::Disc(p), Foremost::Disc(q)) => {
                let way = q - apart - p;
                let Some(along) = unit(way) else { return p };
                let length = way.length();
                p + along * (0.5 * ((-r1).max(length - r2) + r1.min(length + r2)))
            }
        }
    }
}

/// Returns the middle of the common part of two segments, if they lie on one line.
fn middle_along(s: [Vector; 2], t: [Vector; 2]) -> Option<Vector> {
    let along = unit(s[1] - s[0])?;
    let near = IN_PLANE * ((s[1] - s[0]).length() + (t[1] - t[0]).length());
    let is_on_line = |q: Vector| {
        let offset = q - s[0];
        (offset - along * offset.dot(along)).length() <= near
    };
    let ends = t.map(|q| (q - s[0]).dot(along));
    let (from, to) = (ends[0].max(0.0), ends[1].min((s[1] - s[0]).length()));
    (t.into_iter().all(is_on_line) && from <= to).then(|| s[0] + along * (0.5 * (from + to)))
}
