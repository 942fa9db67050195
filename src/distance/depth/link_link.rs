//! The least translation that separates two links that overlap.
//!
//! ```text
//!      ________________
//!     |  link 1    ____|_________
//!     |           |    |  link 2 |      ---> n
//!     |___________|____|         |
//!                 |____|_________|
//!                 |<-->|
//!                depth(n)
//! ```
//!
//! # Definitions
//! - `depth(n)`: the translation of the second link along the unit vector `n` that separates the
//!   two: the last point of the first link along `n` minus the first point of the second.
//! - `gap(n) = -depth(n)`.
//!
//! # Claim
//! The least depth belongs to one of these normals or its opposite, each row both ways round:
//!
//! | link | link | normal |
//! |---|---|---|
//! | flat cap | any | the axis |
//! | barrel | barrel | perpendicular to both axes |
//! | barrel | half ball | from the axis to the ball's centre, perpendicular to the axis |
//! | half ball | half ball | from centre to centre |
//! | rim | half ball | from the rim's nearest or farthest point to the ball's centre |
//! | rim | barrel | perpendicular to the other axis, by [`ellipse`](super::ellipse) |
//! | rim | rim | no closed form, see below |
//!
//! Rim and barrel: projected along the barrel's axis, the rim is half an ellipse and the axis a
//! point. The normal is the normal at the ellipse's point closest to this point. The barrel's
//! radius lies along the same normal.
//!
//! # Proof
//! As for a [link and a triangle](super::separation): the least depth is the distance from the
//! origin to the surface of the Minkowski difference, attained inside a smooth piece. The rows are
//! the smooth pieces.
//!
//! **All ends round.** The difference of the axes is a parallelogram, or a segment if they are
//! parallel. The Minkowski difference is this shape enlarged by `r1 + r2`. If the origin is at the
//! distance `d` from it, the least depth is `r1 + r2 - d`. Its direction is from axis to axis; if
//! the axes cross (`d = 0`), the normal of the parallelogram; if the shape is a segment through the
//! origin, any normal perpendicular to it. The rows contain all of these.
//!
//! # Two rims
//! For rims around `p` and `q` that face each other, with the unit axes `a` and `b`,
//!
//! ```text
//! gap(n) = (q - p) . n - r1 |n - a (a . n)| - r2 |n - b (b . n)|,
//! ```
//!
//! which is smooth unless `n` is along an axis. Let `u` be the unit vector along `n - a (a . n)`,
//! and `w` the unit vector perpendicular to `a` and `u`. The first rim contributes `-r1 u` to the
//! gradient and `-r1 w w^T / |n - a (a . n)|` to the second derivative; the second rim contributes
//! the same terms of `b`. On the unit sphere the second derivative also has `-gap` times the
//! identity.
//!
//! Newton's steps climb from the best normal of the other rows, and from the bisectors of the faces
//! turned towards one another. Each step is shortened until the gap grows. A maximum that they miss
//! only makes the reported depth larger: `depth` is evaluated for the normal at hand, so the
//! translation always separates.
//!
//! # The contact point
//! After the two links are moved apart along the normal of the widest gap, they meet in one plane.
//! The part of a link that is farthest along a normal is
//! - a disc, if the normal is along the axis and the end is flat;
//! - a segment of the barrel, if the normal is perpendicular to the axis;
//! - otherwise a point.
//!
//! After the translation the two parts lie in one plane and meet. A point is the contact itself.
//! For a segment and another segment or a disc, the contact is the closest point. For two discs it
//! is the middle of the common part of the line through both centres.

use super::direction::{perpendicular, unit, unit_across};
use super::separation::across_rim;
use crate::distance::{Vec3, segment_disc, segment_segment};
use parry3d_f64::math::{Real, Vector};

/// The maximum number of Newton's steps of a climb, and of halvings of a step. A climb ends earlier
/// if the gap no longer grows.
const STEPS: usize = 12;
const HALVINGS: usize = 6;

/// A placed link.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SolidLink {
    pub start: Vector,
    pub end: Vector,
    /// The unit axis; `None` for a ball, whose caps count as round.
    pub axis: Option<Vector>,
    pub radius: Real,
    pub flat: [bool; 2],
}

impl SolidLink {
    pub(crate) fn new(start: Vector, end: Vector, radius: Real, flat: [bool; 2]) -> Self {
        let axis = unit(end - start);
        Self { start, end, axis, radius, flat: flat.map(|flat| flat && axis.is_some()) }
    }

    /// Returns the centre of an end.
    pub(crate) fn centre(&self, end: usize) -> Vector {
        if end == 0 { self.start } else { self.end }
    }

    /// Returns the end that the farthest point along a unit vector belongs to.
    fn end_toward(&self, n: Vector) -> usize {
        usize::from(self.axis.is_some_and(|axis| axis.dot(n) > 0.0))
    }

    /// Returns the outward unit vector of an end.
    fn outward(&self, end: usize) -> Option<Vector> {
        self.axis.map(|axis| if end == 0 { -axis } else { axis })
    }

    /// Returns how far the end's surface extends beyond its centre along `n`, which leans outwards
    /// over this end, and the vector from the centre to the point there.
    pub(crate) fn beyond(&self, end: usize, n: Vector) -> (Real, Vector) {
        match self.axis.filter(|_| self.flat[end]) {
            None => (self.radius, n * self.radius),
            Some(axis) => {
                let across = n - axis * axis.dot(n);
                (self.radius * across.length(), unit(across).unwrap_or(Vector::ZERO) * self.radius)
            }
        }
    }
}

/// Two links in one frame, near its origin and with numbers near one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LinkLink {
    pub first: SolidLink,
    pub second: SolidLink,
}

/// A unit vector and its gap: how far the second body begins beyond the end of the first along it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gap {
    pub width: Real,
    pub normal: Vector,
}

impl LinkLink {
    /// Returns the gap along a unit vector.
    pub(crate) fn gap(&self, n: Vector) -> Real {
        let (end1, end2) = (self.first.end_toward(n), self.second.end_toward(-n));
        let between = self.second.centre(end2) - self.first.centre(end1);
        let share = |body: &SolidLink, end: usize| match body.axis.filter(|_| body.flat[end]) {
            None => 1.0,
            Some(axis) => (n - axis * axis.dot(n)).length(),
        };
        let reach = [
            share(&self.first, end1) * self.first.radius,
            share(&self.second, end2) * self.second.radius,
        ];
        between.dot(n) - (reach[0] + reach[1])
    }

    /// Returns the widest gap: if the links overlap, minus the least translation that separates
    /// them. `hints` are further candidates, unit vectors.
    pub(crate) fn widest(&self, hints: impl IntoIterator<Item = Vector>) -> Gap {
        let some = self.first.axis.or(self.second.axis).map_or(Vector::X, perpendicular);
        let mut best = Gap { width: self.gap(some), normal: some };
        self.directions(&mut |n| best = self.wider(best, n));
        let both_flat = [self.first.flat, self.second.flat].iter().all(|flat| flat.contains(&true));
        if both_flat {
            for end1 in (0..2).filter(|&end| self.first.flat[end]) {
                for end2 in (0..2).filter(|&end| self.second.flat[end]) {
                    let ways = self.first.outward(end1).zip(self.second.outward(end2));
                    let bisector = ways.and_then(|(way1, way2)| unit(way1 - way2));
                    if let Some(n) = bisector {
                        best = self.climbed(best, Gap { width: self.gap(n), normal: n });
                    }
                }
            }
        }
        for n in hints {
            let from = Gap { width: self.gap(n), normal: n };
            best = if both_flat { self.climbed(best, from) } else { self.wider(best, n) };
        }
        if both_flat { self.climbed(best, best) } else { best }
    }

    /// Returns the widest gap among `n`, `n` made perpendicular to either axis or both, and the
    /// axes.
    ///
    /// This restores what `n` lost to rounding where barrels or flat caps decide.
    pub(crate) fn refined(&self, n: Vector) -> Gap {
        let [a, b] = [self.first.axis, self.second.axis];
        let mut best = Gap { width: self.gap(n), normal: n };
        let across = |axis: Option<Vector>| axis.and_then(|axis| unit_across(n, axis));
        let both = a.zip(b).and_then(|(a, b)| unit_across(a.cross(b), a));
        for n in [across(a), across(b), both, both.map(|n| -n)].into_iter().flatten() {
            best = self.wider(best, n);
        }
        for n in [a, b].into_iter().flatten() {
            best = self.wider(self.wider(best, n), -n);
        }
        best
    }

    /// Returns `best` or the gap along `n`, whichever is wider: the first of equals.
    fn wider(&self, best: Gap, n: Vector) -> Gap {
        let width = self.gap(n);
        if width > best.width { Gap { width, normal: n } } else { best }
    }

    /// Passes the unit normals of the table, except its last row, and their opposites to
    /// `consider`.
    fn directions(&self, consider: &mut impl FnMut(Vector)) {
        let mut both_ways = |n: Option<Vector>| {
            if let Some(n) = n {
                consider(n);
                consider(-n);
            }
        };
        let [a, b] = [self.first.axis, self.second.axis];
        both_ways(a.zip(b).and_then(|(a, b)| unit_across(a.cross(b), a)));
        for (one, other) in [(&self.first, &self.second), (&self.second, &self.first)] {
            both_ways(one.axis);
            for end in 0..2 {
                let centre = other.centre(end);
                // If the centre is on the axis, all directions across are equally good. A flat end
                // has no half ball. If the axes are parallel, this is also the direction from axis
                // to axis.
                let lateral = one.axis.map(|axis| {
                    unit_across(centre - one.start, axis).unwrap_or_else(|| perpendicular(axis))
                });
                both_ways(lateral);
                for mine in 0..2 {
                    let offset = centre - one.centre(mine);
                    match one.outward(mine).filter(|_| one.flat[mine]) {
                        None if !other.flat[end] => both_ways(unit(offset)),
                        Some(axis) if !other.flat[end] => {
                            let side =
                                unit_across(offset, axis).unwrap_or_else(|| perpendicular(axis));
                            both_ways(unit(offset - side * one.radius));
                            both_ways(unit(offset + side * one.radius));
                        }
                        _ => {}
                    }
                }
            }
            for mine in (0..2).filter(|&mine| one.flat[mine]) {
                let offset = other.start - one.centre(mine);
                let faced = one.outward(mine).zip(other.axis);
                both_ways(faced.and_then(|(way, edge)| across_rim(way, one.radius, offset, edge)));
            }
        }
    }

    /// Returns `best` or the gap to which Newton's steps from `from` lead, whichever is wider.
    fn climbed(&self, best: Gap, from: Gap) -> Gap {
        let mut at = from;
        for _ in 0..STEPS {
            let Some(step) = self.step(at.normal) else { break };
            let shorter = (0..HALVINGS).scan(1.0, |share, _| {
                let now = *share;
                *share *= 0.5;
                Some(now)
            });
            let next =
                shorter.filter_map(|share| unit(at.normal + step * share)).find_map(|normal| {
                    let width = self.gap(normal);
                    (width > at.width).then_some(Gap { width, normal })
                });
            let Some(next) = next else { break };
            at = next;
        }
        if at.width > best.width { at } else { best }
    }

    /// Returns Newton's step on the unit sphere towards a wider gap, perpendicular to `n`.
    fn step(&self, n: Vector) -> Option<Vector> {
        let (end1, end2) = (self.first.end_toward(n), self.second.end_toward(-n));
        let (t1, t2) = n.any_orthonormal_pair();
        let mut gradient = self.second.centre(end2) - self.first.centre(end1);
        let (mut h11, mut h12, mut h22) = (0.0, 0.0, 0.0);
        for (body, end) in [(&self.first, end1), (&self.second, end2)] {
            match body.axis.filter(|_| body.flat[end]) {
                // The curvature of a ball is that of the sphere: together only the second
                // derivative of `gap` remains.
                None => {
                    gradient -= n * body.radius;
                    (h11, h22) = (h11 - body.radius, h22 - body.radius);
                }
                Some(axis) => {
                    let across = n - axis * axis.dot(n);
                    let share = across.length();
                    let u = unit(across)?;
                    gradient -= u * body.radius;
                    let w = axis.cross(u);
                    let (w1, w2, curved) = (w.dot(t1), w.dot(t2), body.radius / share);
                    h11 -= curved * w1 * w1;
                    h12 -= curved * w1 * w2;
                    h22 -= curved * w2 * w2;
                }
            }
        }
        let height = gradient.dot(n);
        (h11, h22) = (h11 - height, h22 - height);
        let (g1, g2) = (gradient.dot(t1), gradient.dot(t2));
        // The larger eigenvalue must be negative, by enough that the step stays on this side of the
        // sphere.
        let (mean, half) = (0.5 * (h11 + h22), (0.25 * (h11 - h22).powi(2) + h12 * h12).sqrt());
        let shift = (mean + half + g1.hypot(g2)).max(0.0);
        let (h11, h22) = (h11 - shift, h22 - shift);
        let determinant = h11 * h22 - h12 * h12;
        let (s1, s2) = ((h12 * g2 - h22 * g1) / determinant, (h12 * g1 - h11 * g2) / determinant);
        let step = t1 * s1 + t2 * s2;
        (step.is_finite() && step != Vector::ZERO).then_some(step)
    }
}

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
