//! Where two links touch once they are moved apart along the normal of the widest gap.
//!
//! What a link has furthest along a normal is a point, or a disc where the normal is along the axis
//! and the end is flat, or a segment of the barrel where it is perpendicular to the axis. After the
//! move these two lie in one plane and meet. A point is the contact then; of a segment and another,
//! or a disc, it is the nearest point, and of two discs the middle of what their centres' line has
//! in common.

use super::direction::{unit, unit_across};
use super::link_link::{Gap, LinkLink, SolidLink};
use crate::distance::{Vec3, segment_disc, segment_segment};
use parry3d_f64::math::{Real, Vector};

/// What is no further below the plane than this share of the link's size lies in it: between what
/// rounding leaves of a normal and what a tilt moves the contact by that is visible.
const IN_PLANE: Real = 1e-12;

/// What a link has furthest along a normal.
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
    /// The point of the first link that touches the second once that is moved by `-gap.width` along
    /// the normal.
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

/// The middle of what two segments on one line have in common, if they are on one line.
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
