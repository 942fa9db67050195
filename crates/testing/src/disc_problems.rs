//! Segments and discs to compare the solvers of segment-disc: ordinary ones, and every kind that is
//! known to be hard.

use crate::Random;
use crate::precision::Precision;
use parry_continuum::distance::{Closest, DoubleDouble, Scalar, Vec3};
use parry_continuum::parry::math::{Pose, Vector};

/// A solver for a segment and a disc: [`segment_disc`](parry_continuum::distance::segment_disc), or
/// one to compare with it.
pub type Route<T> = fn([Vec3<T>; 2], Vec3<T>, Vec3<T>, T) -> Closest<T>;

/// A segment and a disc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiscProblem {
    pub ends: [Vector; 2],
    pub centre: Vector,
    pub normal: Vector,
    pub radius: f64,
}

/// The kind of difficulty of a problem.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Unrelated, with similar sizes.
    Random,
    /// Small integers: parallels, ties and zeros.
    Lattice,
    /// Parallel to the plane, and over the disc, outside it, or tangent to its rim.
    ParallelOver,
    ParallelOutside,
    ParallelTangent,
    NearlyParallel,
    /// Nearly parallel and nearly tangent: the derivative bends like a cube root.
    Cusp,
    /// Same as above, and the segment ends there.
    EndAtCusp,
    /// Tangent to the rim, at any tilt.
    GrazingRim,
    /// Through a point of the rim, or nearly.
    ThroughRim,
    /// Ending on the rim, or nearly.
    EndOnRim,
    /// Nearly parallel to the plane and nearly through the disc's axis.
    NearAxis,
    ThroughAxis,
    AlongNormal,
    /// Nearly along the normal, beside the rim.
    BesideBarrel,
    /// Sizes and angles of all magnitudes.
    AnySize,
    /// A disc 1e-9 to 1e7 times as large as the segment.
    AnyRadius,
    /// At a distance of 1e3 to 1e6 from the origin.
    Offset,
    /// A segment 1 to 1e6 times as long as the rest.
    Long,
    /// A segment of length 0, or a disc of radius 0.
    Point,
}

impl Kind {
    pub const ALL: [Self; 20] = [
        Self::Random,
        Self::Lattice,
        Self::ParallelOver,
        Self::ParallelOutside,
        Self::ParallelTangent,
        Self::NearlyParallel,
        Self::Cusp,
        Self::EndAtCusp,
        Self::GrazingRim,
        Self::ThroughRim,
        Self::EndOnRim,
        Self::NearAxis,
        Self::ThroughAxis,
        Self::AlongNormal,
        Self::BesideBarrel,
        Self::AnySize,
        Self::AnyRadius,
        Self::Offset,
        Self::Long,
        Self::Point,
    ];
}

/// Returns a number of random sign, log-uniform between two powers of ten.
fn small(random: &mut Random, low: f64, high: f64) -> f64 {
    let size = 10.0_f64.powf(random.between(low, high));
    if random.below(2) == 0 { size } else { -size }
}

/// Returns a small number, sometimes exactly 0.
fn tiny(random: &mut Random) -> f64 {
    if random.below(8) == 0 { 0.0 } else { small(random, -17.0, -0.5) }
}

/// Returns a segment through `at`, which is inside it, beyond it or one of its ends.
fn through(at: Vector, direction: Vector, random: &mut Random) -> [Vector; 2] {
    [at + direction * random.between(-3.0, 0.5), at + direction * random.between(-0.5, 3.0)]
}

impl DiscProblem {
    /// Returns a problem of this kind.
    pub fn new(random: &mut Random, kind: Kind) -> Self {
        let offset = if kind == Kind::Offset { small(random, 3.0, 6.0) } else { 1.0 };
        let local = Self::local(random, kind);
        if kind == Kind::Lattice {
            return local;
        }
        // Half of the problems stay on the axes, where parallel is exactly parallel.
        let pose = random.pose(1.0);
        let turn = if random.below(2) == 0 { Pose::IDENTITY.rotation } else { pose.rotation };
        let away = pose.translation * offset;
        Self {
            ends: local.ends.map(|end| turn * end + away),
            centre: local.centre + away,
            normal: turn * local.normal,
            radius: local.radius,
        }
    }

    /// Returns a problem with the disc around the origin in the xy plane, except for the lattice.
    fn local(random: &mut Random, kind: Kind) -> Self {
        let radius = random.between(0.05, 2.0);
        let height = random.between(0.0, 2.0);
        let tilt = tiny(random);
        let (sin, cos) = random.between(0.0, std::f64::consts::TAU).sin_cos();
        let mut problem = Self {
            ends: [random.point() * 3.0, random.point() * 3.0],
            centre: Vector::ZERO,
            normal: Vector::Z,
            radius,
        };
        let flat = |y: f64, z: f64| Vector::new(0.0, y, z);
        match kind {
            Kind::Random | Kind::Offset => {}
            Kind::Lattice => {
                let mut whole = |size: u32| f64::from(random.below(2 * size + 1)) - f64::from(size);
                let mut point = |size: u32| Vector::new(whole(size), whole(size), whole(size));
                problem.ends = [point(3), point(3)];
                problem.normal = point(2);
                problem.radius = f64::from(random.below(7)) * 0.5;
                if problem.normal == Vector::ZERO {
                    problem.normal = Vector::Z;
                }
            }
            Kind::ParallelOver => {
                let y = random.between(0.0, radius);
                problem.ends = through(flat(y, height), Vector::X, random);
            }
            Kind::ParallelOutside => {
                let y = random.between(radius, 3.0 * radius);
                problem.ends = through(flat(y, height), Vector::X, random);
            }
            Kind::ParallelTangent => {
                problem.ends = through(flat(radius, height), Vector::X, random)
            }
            Kind::NearlyParallel => {
                let y = random.between(0.0, 2.0 * radius);
                problem.ends = through(flat(y, height), Vector::new(1.0, 0.0, tilt), random);
            }
            Kind::Cusp | Kind::EndAtCusp => {
                let at = flat(radius * (1.0 + tiny(random)), height * tilt);
                problem.ends = through(at, Vector::new(1.0, tiny(random) * tilt, tilt), random);
                if kind == Kind::EndAtCusp {
                    problem.ends[0] = at + Vector::X * tiny(random);
                }
            }
            Kind::GrazingRim => {
                let at = Vector::new(0.0, radius * (1.0 + tiny(random)), tiny(random));
                problem.ends = through(at, Vector::new(cos, tiny(random), sin), random);
            }
            Kind::ThroughRim => {
                let at =
                    Vector::new(radius * cos, radius * sin, 0.0) + random.point() * tiny(random);
                let way = random.point();
                problem.ends = [at + way * 2.0, at - way * random.between(0.0, 1.5)];
            }
            Kind::EndOnRim => {
                let at =
                    Vector::new(radius * cos, radius * sin, 0.0) + random.point() * tiny(random);
                problem.ends[0] = at;
                if random.below(2) == 0 {
                    problem.ends[1] = at + Vector::new(-sin, cos, tilt) * random.between(-2.0, 2.0);
                }
            }
            Kind::NearAxis => {
                let at = Vector::new(0.0, tiny(random), height * random.between(-1.0, 1.0));
                problem.ends = through(at, Vector::new(1.0, tiny(random), tilt), random);
            }
            Kind::ThroughAxis => {
                let at = Vector::Z * random.between(-2.0, 2.0);
                problem.ends[1] = at - problem.ends[0] * random.unit();
            }
            Kind::AlongNormal => {
                let [foot, _] = problem.ends;
                problem.ends[1] = foot.with_z(random.between(-2.0, 2.0));
            }
            Kind::BesideBarrel => {
                let at = Vector::new(radius * (1.0 + tiny(random)), 0.0, random.between(-1.0, 1.0));
                problem.ends = through(at, Vector::new(tiny(random), tiny(random), 1.0), random);
            }
            Kind::AnySize => {
                let at = Vector::new(
                    small(random, -6.0, 6.0),
                    small(random, -6.0, 6.0),
                    small(random, -6.0, 6.0),
                );
                let way = Vector::new(
                    small(random, -6.0, 0.0),
                    small(random, -6.0, 0.0),
                    small(random, -6.0, 0.0),
                );
                problem.ends = through(at, way * small(random, -3.0, 6.0), random);
                problem.radius = small(random, -6.0, 6.0).abs();
            }
            Kind::AnyRadius => problem.radius = small(random, -9.0, 7.0).abs(),
            Kind::Long => problem.ends[1] *= small(random, 0.0, 6.0),
            Kind::Point => {
                if random.below(2) == 0 {
                    problem.ends[1] = problem.ends[0];
                } else {
                    problem.radius = 0.0;
                }
            }
        }
        problem
    }

    /// Returns the problem rounded to single precision.
    pub fn rounded(&self) -> Self {
        let round = |p: Vector| Vector::from_array(p.to_array().map(|x| f64::from(x as f32)));
        Self {
            ends: self.ends.map(round),
            centre: round(self.centre),
            normal: round(self.normal),
            radius: f64::from(self.radius as f32),
        }
    }

    /// Returns the error of a solver in the precision `T`, relative to the extent.
    pub fn error<T: Precision>(&self, route: Route<T>, distance: f64) -> f64 {
        let (centre, normal) = (T::vec3(self.centre), T::vec3(self.normal));
        let found = route(self.ends.map(T::vec3), centre, normal, T::from_f64(self.radius));
        let error = (found.distance.into() - distance).abs() / self.extent();
        if error.is_nan() { f64::INFINITY } else { error }
    }

    /// Returns the largest coordinate difference of two points, or the radius.
    pub fn extent(&self) -> f64 {
        let points = [self.ends[0], self.ends[1], self.centre];
        let [low, high] = [Vector::min, Vector::max]
            .map(|pick| points.into_iter().reduce(pick).unwrap_or_default());
        (high - low).max_element().max(self.radius)
    }

    /// Returns the distance in numbers of type `T`, by bisection of the derivative of the squared
    /// distance, which is convex.
    pub fn distance_in<T: Scalar<Mask = bool> + From<f64>>(&self) -> T {
        let point = |p: Vector| p.to_array().map(T::from);
        let sub = |a: [T; 3], b: [T; 3]| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
        let dot = |a: [T; 3], b: [T; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let (zero, radius) = (T::from(0.0), T::from(self.radius));
        let start = sub(point(self.ends[0]), point(self.centre));
        let edge = sub(point(self.ends[1]), point(self.ends[0]));
        let normal = point(self.normal);
        let length = dot(normal, normal).sqrt();
        let normal = normal.map(|x| x / length);
        let slope = dot(edge, normal);
        // The height, the distance beyond the rim, and the derivative times the distance from the
        // axis.
        let look = |t: f64| {
            let p = [0, 1, 2].map(|i| start[i] + edge[i] * T::from(t));
            let height = dot(p, normal);
            let radial = [0, 1, 2].map(|i| p[i] - normal[i] * height);
            let rho = dot(radial, radial).sqrt();
            let beyond = rho - radius;
            if zero.lt(beyond) {
                (height, beyond, rho * height * slope + beyond * dot(radial, edge))
            } else {
                (height, zero, height * slope)
            }
        };
        // Steps that an `f64` represents exactly.
        let mut at = 0.0;
        if look(0.0).2.lt(zero) {
            if look(1.0).2.le(zero) {
                at = 1.0;
            } else {
                for halvings in 1..=60 {
                    let next = at + 0.5_f64.powi(halvings);
                    if look(next).2.le(zero) {
                        at = next;
                    }
                }
            }
        }
        let (height, beyond, _) = look(at);
        (height * height + beyond * beyond).sqrt()
    }

    /// Returns the distance, correct to the last digit.
    pub fn distance(&self) -> f64 {
        self.distance_in::<DoubleDouble>().rounded()
    }
}

/// Returns `of_each` problems of each kind, rounded to the precision `T`, with their distances.
pub fn problems<T: Precision>(of_each: usize) -> Vec<(Kind, DiscProblem, f64)> {
    let mut random = Random::new(7);
    let mut all = Vec::new();
    for kind in Kind::ALL {
        let before = all.len();
        while all.len() < before + of_each {
            let mut problem = DiscProblem::new(&mut random, kind);
            if T::UNIT > f64::UNIT {
                problem = problem.rounded();
            }
            if problem.extent() > 0.0 && problem.normal != Vector::ZERO {
                all.push((kind, problem, problem.distance()));
            }
        }
    }
    all
}

/// Returns the largest error of a solver, in units of roundoff.
pub fn worst<T: Precision>(route: Route<T>, problems: &[(Kind, DiscProblem, f64)]) -> f64 {
    let errors = problems.iter().map(|(_, problem, distance)| problem.error(route, *distance));
    errors.fold(0.0, f64::max) / T::UNIT
}
