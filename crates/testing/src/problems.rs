//! Random problems of the kinds that break distance code.
//!
//! A problem is a triangle and a link. Every pair of the narrow phase uses parts of it: the axis as
//! a segment, its ends as points, its caps as discs.

use crate::Random;
use parry_continuum::parry::math::Vector;

/// A triangle and a link, in `f64`.
#[derive(Clone, Copy, Debug)]
pub struct Problem {
    pub family: Family,
    pub triangle: [Vector; 3],
    pub start: Vector,
    pub end: Vector,
    pub radius: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Family {
    /// Unrelated shapes.
    Generic,
    /// Small integers: parallels, ties and zeros.
    Lattice,
    /// An edge nearly parallel to the axis.
    EdgeAlongAxis,
    /// The triangle nearly parallel to the caps.
    FaceAlongCap,
    /// An edge nearly parallel to the caps and nearly tangent to a rim.
    EdgeTangentToRim,
    /// The triangle nearly touching the link.
    Touching,
    /// The triangle's closest point nearly in the plane of a cap.
    AtCapPlane,
    /// Three nearly collinear vertices, the link above the interior.
    CapSliver,
    /// One vertex far away.
    Needle,
    /// Triangle and link of very different sizes.
    SizeRatio,
    /// Far from the origin.
    Offset,
    /// The triangle's plane cuts a cap or the axis.
    Piercing,
    /// No area, no radius, repeated or collinear points.
    Degenerate,
}

impl Family {
    pub const ALL: [Self; 13] = [
        Self::Generic,
        Self::Lattice,
        Self::EdgeAlongAxis,
        Self::FaceAlongCap,
        Self::EdgeTangentToRim,
        Self::Touching,
        Self::AtCapPlane,
        Self::CapSliver,
        Self::Needle,
        Self::SizeRatio,
        Self::Offset,
        Self::Piercing,
        Self::Degenerate,
    ];
}

impl Random {
    /// Returns a number of random sign, log-uniform between two powers of ten.
    pub fn tiny(&mut self, low: f64, high: f64) -> f64 {
        let sign = if self.below(2) == 0 { 1.0 } else { -1.0 };
        sign * self.magnitude(low, high)
    }

    /// Returns a number log-uniform between two powers of ten.
    pub fn magnitude(&mut self, low: f64, high: f64) -> f64 {
        10.0_f64.powf(self.between(low, high))
    }

    fn lattice_point(&mut self) -> Vector {
        Vector::new(self.integer(), self.integer(), self.integer())
    }

    fn integer(&mut self) -> f64 {
        f64::from(self.below(7)) - 3.0
    }

    /// Returns a unit vector perpendicular to another.
    pub fn perpendicular_to(&mut self, unit: Vector) -> Vector {
        loop {
            let direction = self.direction();
            let rest = direction - unit * direction.dot(unit);
            if rest.length() > 0.1 {
                return rest.normalize();
            }
        }
    }

    /// Returns a problem of the family. `finest` is the power of ten of the smallest useful
    /// deviations, about -17 for `f64` and -8 for `f32`.
    pub fn problem(&mut self, family: Family, finest: f64) -> Problem {
        let mut problem = Problem {
            family,
            triangle: [self.point() * 2.0, self.point() * 2.0, self.point() * 2.0],
            start: self.point(),
            end: self.point(),
            radius: self.magnitude(-2.0, 0.3),
        };
        let Problem { start, end, radius, .. } = problem;
        let axis = (end - start).normalize();
        let (u, across) = (self.perpendicular_to(axis), self.direction());
        let v = axis.cross(u);
        let small = self.tiny(finest, -1.0);
        let apart = self.tiny(finest, 0.0);
        match family {
            Family::Generic => {}
            Family::Lattice => {
                problem.triangle = [0; 3].map(|_| self.lattice_point());
                problem.start = self.lattice_point();
                problem.end = self.lattice_point();
                problem.radius = f64::from(self.below(5)) * 0.5;
            }
            Family::EdgeAlongAxis => {
                let from = start + u * self.between(-1.0, 3.0) + axis * self.between(-2.0, 2.0);
                problem.triangle[0] = from;
                problem.triangle[1] = from + (axis + across * small) * self.between(-3.0, 3.0);
            }
            Family::FaceAlongCap => {
                let height =
                    axis * if self.below(2) == 0 { apart } else { self.between(-1.0, 1.0) };
                problem.triangle = [0; 3].map(|_| {
                    let flat = u * self.between(-2.0, 2.0) + v * self.between(-2.0, 2.0);
                    let tilted = flat + across * (small * flat.dot(across));
                    end + height + tilted * (radius * 1.5)
                });
            }
            Family::EdgeTangentToRim => {
                let rim = end + u * (radius * (1.0 + apart)) + axis * self.tiny(finest, 0.5);
                let along = v + axis * small + u * self.tiny(finest, -1.0);
                problem.triangle[0] = rim + along * self.between(-2.0, 1.0);
                problem.triangle[1] = rim + along * self.between(0.0, 2.0);
                problem.triangle[2] =
                    rim + u * self.between(-1.0, 3.0) + axis * self.between(-0.5, 3.0);
            }
            Family::Touching => {
                // A supporting plane of the link (barrel, cap, or rim), and the triangle on or
                // beyond it.
                let (touched, normal) = match self.below(3) {
                    0 => (start + (end - start) * self.unit() + u * radius, u),
                    1 => (end + u * (radius * self.unit()), axis),
                    _ => {
                        let tilt = self.unit();
                        (end + u * radius, (axis * tilt + u * (1.0 - tilt)).normalize())
                    }
                };
                let side = self.perpendicular_to(normal);
                let other = normal.cross(side);
                let beyond = if self.below(3) == 0 { 0.0 } else { 1.0 };
                let size = self.magnitude(-2.0, 1.0);
                problem.triangle = [0.0, 2.1, 4.2].map(|angle: f64| {
                    let (sin, cos) = (angle + self.between(-0.9, 0.9)).sin_cos();
                    touched
                        + (side * sin + other * cos) * (size * self.between(0.1, 1.0))
                        + normal * (apart + beyond * size * self.unit())
                });
                if self.below(2) == 0 {
                    problem.triangle[0] = touched + normal * apart;
                }
            }
            Family::AtCapPlane => {
                let at = end + u * (radius * self.between(0.0, 3.0)) + axis * small;
                let far = |random: &mut Self| {
                    let outward = u * random.between(0.0, 2.0) + v * random.between(-1.0, 1.0);
                    at + outward + axis * random.between(-1.0, 1.0)
                };
                problem.triangle = [at, far(self), far(self)];
                if self.below(2) == 0 {
                    // The closest point inside an edge.
                    problem.triangle[1] = at + (at - problem.triangle[1]) * self.unit();
                    problem.triangle[0] = far(self);
                }
            }
            Family::CapSliver => {
                let (a, b) = (problem.triangle[0], problem.triangle[1]);
                let along = (b - a).normalize();
                let (across, height) =
                    (self.perpendicular_to(along), self.magnitude(finest.max(-13.0), -1.0));
                let (length, at) = ((b - a).length(), self.between(0.2, 0.8));
                problem.triangle[2] = a + (b - a) * at + across * (length * height);
                // Above the interior, or near it.
                let (inner, normal) = (self.unit(), along.cross(across));
                let foot = (a + (b - a) * (at + self.between(-0.1, 0.1)))
                    .lerp(problem.triangle[2], inner * 0.9 + 0.05);
                problem.start = foot + normal * self.between(0.3, 2.0);
                problem.end = problem.start
                    + normal * self.between(0.0, 2.0)
                    + self.direction() * if self.below(2) == 0 { small } else { 0.5 };
                problem.radius = radius * 0.2;
            }
            Family::Needle => {
                let far = self.magnitude(0.5, 6.0);
                let which = self.below(3) as usize;
                problem.triangle[which] *= far;
            }
            Family::SizeRatio => {
                let ratio = self.magnitude(-9.0, 7.0);
                let about = if self.below(2) == 0 { end + u * radius } else { problem.triangle[0] };
                problem.triangle = problem.triangle.map(|vertex| about + (vertex - about) * ratio);
            }
            Family::Offset => {
                let offset = self.direction() * self.magnitude(0.0, 6.0_f64.min(-finest * 0.5));
                problem.triangle = problem.triangle.map(|vertex| vertex + offset);
                problem.start += offset;
                problem.end += offset;
            }
            Family::Piercing => {
                let at = match self.below(3) {
                    0 => start + (end - start) * self.unit(),
                    1 => end + u * (radius * self.between(-1.0, 1.0)),
                    _ => end + u * (radius * self.between(-1.0, 1.0)) + axis * small,
                };
                let other = self.perpendicular_to(across);
                let third = across.cross(other);
                let size = self.magnitude(-1.0, 1.0);
                problem.triangle = [0.0, 2.1, 4.2].map(|angle: f64| {
                    let (sin, cos) = (angle + self.between(-0.9, 0.9)).sin_cos();
                    at + (other * sin + third * cos) * (size * self.between(0.1, 1.0))
                });
            }
            Family::Degenerate => {
                let [a, b, _] = problem.triangle;
                match self.below(6) {
                    0 => problem.triangle[2] = a + (b - a) * self.between(-1.0, 2.0),
                    1 => problem.triangle[2] = b,
                    2 => problem.triangle = [a; 3],
                    3 => problem.radius = 0.0,
                    4 => problem.end = start,
                    _ => problem.start = a,
                }
            }
        }
        problem
    }
}

impl Problem {
    /// Returns the five points: triangle, start, end.
    pub fn points(&self) -> [Vector; 5] {
        let [a, b, c] = self.triangle;
        [a, b, c, self.start, self.end]
    }

    /// Returns the problem with every number mapped.
    pub fn map(&self, number: impl Fn(f64) -> f64) -> Self {
        let point = |v: Vector| Vector::from_array(v.to_array().map(&number));
        Self {
            triangle: self.triangle.map(point),
            start: point(self.start),
            end: point(self.end),
            radius: number(self.radius),
            ..*self
        }
    }
}
