//! Segments and discs to compare segment-disc routes on: random ones, and every kind that is known to be hard.

use crate::double_double::Dd;
use crate::random::Random;

/// A segment and a disc.
#[derive(Clone, Copy, Debug)]
pub struct Problem {
    pub ends: [[f64; 3]; 2],
    pub centre: [f64; 3],
    pub normal: [f64; 3],
    pub radius: f64,
}

/// The kinds of problem, in the order in which [`problem`] deals them.
pub const KINDS: [&str; 14] = [
    "random",
    "lattice",
    "parallel, over the disc",
    "parallel, outside",
    "parallel, tangent",
    "nearly parallel",
    "nearly parallel and nearly tangent (cusp)",
    "through the axis",
    "along the normal",
    "touching the rim",
    "radius 1e-9 to 1e7",
    "1e3 to 1e6 away from the origin",
    "segment up to 1e6 long",
    "a point, or radius 0",
];

/// The `index`-th problem.
pub fn problem(random: &mut Random, index: usize) -> Problem {
    let kind = index % KINDS.len();
    // In the disc's own frame: normal z, centre 0.
    let radius = random.between(0.05, 2.0);
    let tilt = 10.0_f64.powf(random.between(-16.0, -0.5));
    let along = |random: &mut Random, y: f64, z: f64, tilt: f64| {
        let (low, high) = (random.between(-3.0, 0.5), random.between(-0.5, 3.0));
        [[low, y, z + low * tilt], [high, y, z + high * tilt]]
    };
    let height = random.between(0.0, 2.0);
    let mut problem = Problem {
        ends: [random.point(3.0), random.point(3.0)],
        centre: [0.0; 3],
        normal: [0.0, 0.0, 1.0],
        radius,
    };
    match kind {
        1 => {
            let mut whole = |size: u32| f64::from(random.below(2 * size + 1)) - f64::from(size);
            problem.ends = [[whole(3), whole(3), whole(3)], [whole(3), whole(3), whole(3)]];
            problem.normal = [whole(2), whole(2), whole(2)];
            problem.radius = f64::from(random.below(7)) * 0.5;
            if problem.normal == [0.0; 3] {
                problem.normal = [0.0, 0.0, 1.0];
            }
            return problem;
        }
        2 => {
            let y = random.between(0.0, radius);
            problem.ends = along(random, y, height, 0.0);
        }
        3 => {
            let y = random.between(radius, 3.0 * radius);
            problem.ends = along(random, y, height, 0.0);
        }
        4 => problem.ends = along(random, radius, height, 0.0),
        5 => {
            let y = random.between(0.0, 2.0 * radius);
            problem.ends = along(random, y, height, tilt);
        }
        6 => {
            let off = 10.0_f64.powf(random.between(-16.0, -0.5));
            let y = radius * (1.0 + if random.below(2) == 0 { off } else { -off });
            problem.ends = along(random, y, height * tilt, tilt);
        }
        7 => {
            let z = random.between(-2.0, 2.0);
            let p = random.point(3.0);
            let share = random.unit();
            // A point of the axis divides the segment.
            problem.ends = [p, [0, 1, 2].map(|i| if i == 2 { z } else { 0.0 } - p[i] * share)];
        }
        8 => {
            let [x, y, _] = random.point(2.0);
            problem.ends = [[x, y, random.between(-2.0, 2.0)], [x, y, random.between(-2.0, 2.0)]];
        }
        9 => {
            let (sin, cos) = random.between(0.0, std::f64::consts::TAU).sin_cos();
            let rim = [radius * cos, radius * sin, 0.0];
            let way = random.point(2.0);
            problem.ends = [[0, 1, 2].map(|i| rim[i] + way[i]), [0, 1, 2].map(|i| rim[i] - way[i] * 0.7)];
        }
        10 => problem.radius = 10.0_f64.powf(random.between(-9.0, 7.0)),
        12 => {
            let far = 10.0_f64.powf(random.between(0.0, 6.0));
            problem.ends[1] = problem.ends[1].map(|x| x * far);
        }
        13 => {
            if random.below(2) == 0 {
                problem.ends[1] = problem.ends[0];
            } else {
                problem.radius = 0.0;
            }
        }
        _ => {}
    }
    // Half of them stay on the axes, where parallel is exactly parallel.
    if random.below(2) == 0 {
        let turn = random.rotation();
        let turned = |p: [f64; 3]| turn.map(|row| row[0] * p[0] + row[1] * p[1] + row[2] * p[2]);
        problem.ends = problem.ends.map(turned);
        problem.normal = turned(problem.normal);
    }
    let far = if kind == 11 { 10.0_f64.powf(random.between(3.0, 6.0)) } else { 1.0 };
    let away = random.point(far);
    let moved = |p: [f64; 3]| [0, 1, 2].map(|i| p[i] + away[i]);
    problem.ends = problem.ends.map(moved);
    problem.centre = moved(problem.centre);
    problem
}

impl Problem {
    /// The problem as single precision sees it.
    pub fn rounded(&self) -> Self {
        let round = |p: [f64; 3]| p.map(|x| f64::from(x as f32));
        Self {
            ends: self.ends.map(round),
            centre: round(self.centre),
            normal: round(self.normal),
            radius: f64::from(self.radius as f32),
        }
    }

    /// The largest difference of two coordinates, or the radius.
    pub fn extent(&self) -> f64 {
        let points = [self.ends[0], self.ends[1], self.centre];
        let span = |axis: usize| {
            let values = points.map(|p| p[axis]);
            values.iter().fold(f64::MIN, |a, &b| a.max(b)) - values.iter().fold(f64::MAX, |a, &b| a.min(b))
        };
        span(0).max(span(1)).max(span(2)).max(self.radius)
    }

    /// The distance to about 30 digits: bisection of the derivative of the squared distance, which is convex.
    pub fn distance(&self) -> f64 {
        let sub = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|i| Dd::from(a[i]) - Dd::from(b[i]));
        let dot = |a: [Dd; 3], b: [Dd; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let start = sub(self.ends[0], self.centre);
        let edge = sub(self.ends[1], self.ends[0]);
        let normal = self.normal.map(Dd::from);
        let length = dot(normal, normal).sqrt();
        let normal = normal.map(|x| x / length);
        let radius = Dd::from(self.radius);
        let zero = Dd::from(0.0);
        let slope = dot(edge, normal);
        // Height, distance from the axis, and the derivative's sign times that distance.
        let look = |t: f64| {
            let p = [0, 1, 2].map(|i| start[i] + edge[i] * Dd::from(t));
            let height = dot(p, normal);
            let radial = [0, 1, 2].map(|i| p[i] - normal[i] * height);
            let rho = dot(radial, radial).sqrt();
            let beyond = rho - radius;
            if beyond > zero {
                (height, beyond, rho * height * slope + beyond * dot(radial, edge))
            } else {
                (height, zero, height * slope)
            }
        };
        // Bisection in steps that a double holds exactly.
        let (mut low, mut step) = (0.0, 1.0);
        if look(0.0).2 >= zero {
            step = 0.0;
        } else if look(1.0).2 <= zero {
            (low, step) = (1.0, 0.0);
        }
        for _ in 0..60 {
            step *= 0.5;
            if look(low + step).2 <= zero {
                low += step;
            }
        }
        let (height, beyond, _) = look(low);
        (height * height + beyond * beyond).sqrt().to_f64()
    }
}
