//! The least translation that separates two links that overlap.
//!
//! Along the unit vector `n` the second link has to be moved by `depth(n)`, the end of the first in
//! the direction `n` minus the beginning of the second. As for a [link and a
//! triangle](super::separation) the least depth is the distance from the origin to the surface of
//! the difference of the two bodies, which is that of a point inside a smooth piece. The pieces and
//! the normals that can be so, each row both ways round:
//!
//! | link | link | normal |
//! |---|---|---|
//! | flat cap | any | the axis |
//! | barrel | barrel | perpendicular to both axes |
//! | barrel | half ball | from the axis to the ball's centre, perpendicular to the axis |
//! | half ball | half ball | from centre to centre |
//! | rim | half ball | from the rim's nearest or farthest point to the ball's centre |
//! | rim | barrel | perpendicular to the other axis; along that, the rim's shadow is half an ellipse and the axis a point, whose way out is that of [`ellipse`](super::ellipse); the barrel's radius lies along the same normal |
//! | rim | rim | no closed form, see below |
//!
//! Where both ends are round all rows are one: the difference of the axes is a parallelogram, or a
//! segment if they are parallel, and the body is that swollen by `r1 + r2`. With the origin at `d`
//! from it the least way out is `r1 + r2 - d`: along the way from axis to axis, and where the axes
//! cross, `d = 0`, along the parallelogram's normal. Where it is a segment any normal perpendicular
//! to it will do. The rows have them all: on one axis, some direction across.
//!
//! **Two rims** that face each other at `p` and `q`, with the unit axes `a` and `b`, are apart
//! along `n` by
//!
//! ```text
//! gap(n) = (q - p) . n - r1 |n - a (a . n)| - r2 |n - b (b . n)|,
//! ```
//!
//! which is smooth where `n` is along neither axis. With `u` the unit vector along `n - a (a . n)`,
//! and `w` the one perpendicular to `a` and `u`, its gradient has the term `-r1 u` and its second
//! derivative `-r1 w w^T / |n - a (a . n)|`, and the same of `b`. On the unit sphere the second
//! derivative has `-gap` times the identity beside these. So Newton's steps climb from the
//! best normal of the other rows, and from the bisectors of the faces that are turned to one
//! another, each step shortened until the gap grows. A maximum that they miss costs depth and
//! nothing else: whatever the normal, `depth` is that of the normal as it stands, so that the
//! translation separates.

use super::direction::{perpendicular, unit, unit_across};
use super::separation::across_rim;
use parry3d_f64::math::{Real, Vector};

/// Newton's steps a climb, and how often one is halved: it ends earlier where the gap grows no
/// more.
const STEPS: usize = 12;
const HALVINGS: usize = 6;

/// A link where it is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SolidLink {
    pub start: Vector,
    pub end: Vector,
    /// Unit axis; nothing for a ball, whose caps count as round.
    pub axis: Option<Vector>,
    pub radius: Real,
    pub flat: [bool; 2],
}

impl SolidLink {
    pub(crate) fn new(start: Vector, end: Vector, radius: Real, flat: [bool; 2]) -> Self {
        let axis = unit(end - start);
        Self { start, end, axis, radius, flat: flat.map(|flat| flat && axis.is_some()) }
    }

    /// The centre of an end.
    pub(crate) fn centre(&self, end: usize) -> Vector {
        if end == 0 { self.start } else { self.end }
    }

    /// The end that the point furthest along a unit vector belongs to.
    pub(crate) fn end_toward(&self, n: Vector) -> usize {
        usize::from(self.axis.is_some_and(|axis| axis.dot(n) > 0.0))
    }

    /// The way out of an end.
    fn outward(&self, end: usize) -> Option<Vector> {
        self.axis.map(|axis| if end == 0 { -axis } else { axis })
    }

    /// How far the end's surface is beyond its centre, in the direction `n` that leans out over it,
    /// and the point there.
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

/// Two links in one frame, near its origin and of numbers near one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LinkLink {
    pub first: SolidLink,
    pub second: SolidLink,
}

/// A unit vector, and how far the second body begins beyond the end of the first along it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gap {
    pub width: Real,
    pub normal: Vector,
}

impl LinkLink {
    /// How far the second link begins beyond the end of the first along a unit vector.
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

    /// The widest gap: where the links overlap, minus the least translation that separates them.
    /// The hints, which are unit vectors, are considered too.
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

    /// The widest of the gap along `n`, along `n` made perpendicular to either axis or both, and
    /// along the axes: what `n` has lost to rounding, where barrels or flat caps decide.
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

    /// The best gap so far or the one along `n`, whichever is wider: the first of equals.
    fn wider(&self, best: Gap, n: Vector) -> Gap {
        let width = self.gap(n);
        if width > best.width { Gap { width, normal: n } } else { best }
    }

    /// The unit normals of the table but for its last row, and their opposites.
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
                // Where the centre is on the axis all ways out are as long; a flat end is no ball,
                // but on parallel axes the way from one to the other is this one
                // too.
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

    /// The best gap so far or where Newton's steps from `from` lead, whichever is wider.
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

    /// Newton's step on the unit sphere towards a wider gap, across `n`.
    fn step(&self, n: Vector) -> Option<Vector> {
        let (end1, end2) = (self.first.end_toward(n), self.second.end_toward(-n));
        let (t1, t2) = n.any_orthonormal_pair();
        let mut gradient = self.second.centre(end2) - self.first.centre(end1);
        let (mut h11, mut h12, mut h22) = (0.0, 0.0, 0.0);
        for (body, end) in [(&self.first, end1), (&self.second, end2)] {
            match body.axis.filter(|_| body.flat[end]) {
                // A ball bends as the sphere does: together they have no second derivative but that
                // of `gap`.
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
        // The larger eigenvalue must be below 0, by enough that the step stays on this side of the
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
