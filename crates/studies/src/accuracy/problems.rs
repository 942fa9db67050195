//! Seeded problems at the extremes: a triangle and a link, from which every pair takes its part.
//!
//! Only operations that IEEE 754 rounds correctly make them, so they are the same on every machine.

use continuum_testing::Random;
use continuum_testing::kernels::Input;
use continuum_testing::problems::{Family, Problem};
use parry_continuum::parry::math::Vector;

/// What is driven to its extreme.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Extreme {
    Generic,
    Parallel,
    NearParallel,
    CapTransition,
    TangentRim,
    Contact,
    Crossing,
    Needle,
    Sliver,
    ZeroArea,
    SmallTriangle,
    LargeTriangle,
    RadiusZero,
    ShortLink,
    LongLink,
    Offset,
    Scale,
    Subnormal,
}

/// A problem, and the power of two that all its lengths are to be multiplied by.
pub struct Sample {
    pub extreme: Extreme,
    /// How far the extreme is driven: a power of ten, or 0 where there is no such thing.
    pub power: i32,
    pub input: Input<f64>,
    pub exponent: i32,
}

impl Extreme {
    /// Every category with its name and its description.
    pub const ALL: [(Self, &str, &str); 18] = [
        (Self::Generic, "generic", "no relation"),
        (
            Self::Parallel,
            "parallel",
            "an edge or the face exactly parallel to the axis or to a cap",
        ),
        (Self::NearParallel, "near parallel", "the same, tilted by 10^-k"),
        (
            Self::CapTransition,
            "cap transition",
            "the nearest axis point 10^-k before or after an end",
        ),
        (Self::TangentRim, "tangent rim", "an edge tangent to a rim, up to 10^-k"),
        (Self::Contact, "contact", "a gap or an overlap of 10^-k"),
        (Self::Crossing, "crossing", "the triangle cuts the axis or a cap"),
        (Self::Needle, "needle", "one edge 10^-k of the others"),
        (Self::Sliver, "sliver", "an obtuse triangle whose height is 10^-k of its length"),
        (Self::ZeroArea, "zero area", "three points on a line, two of them or all the same"),
        (Self::SmallTriangle, "small triangle", "the triangle shrunk to 10^-k"),
        (Self::LargeTriangle, "large triangle", "the triangle blown up by 10^k"),
        (Self::RadiusZero, "radius 0", "any of the above with a wire"),
        (Self::ShortLink, "short link", "a length of 10^-k radii"),
        (Self::LongLink, "long link", "a length of 10^k radii"),
        (Self::Offset, "offset", "10^k away from the origin"),
        (Self::Scale, "scale", "times 2^-300 to 2^300, in f32 2^-90 to 2^90"),
        (
            Self::Subnormal,
            "subnormal",
            "integers from -40 to 40 times the smallest number there is",
        ),
    ];

    /// The largest power of ten of the category, for numbers with this many digits.
    pub fn powers(self, digits: i32) -> i32 {
        match self {
            Self::NearParallel | Self::CapTransition | Self::TangentRim | Self::Contact => digits,
            Self::Needle | Self::Sliver | Self::SmallTriangle | Self::LargeTriangle => 12,
            Self::LongLink | Self::Offset => 12,
            Self::ShortLink => 16,
            _ => 0,
        }
    }
}

/// Where the exponents of a precision end.
#[derive(Clone, Copy)]
pub struct Range {
    /// Decimal digits, rounded up.
    pub digits: i32,
    /// The largest scale of [`Extreme::Scale`], as a power of two.
    pub scale: i32,
    /// The smallest number, as a power of two.
    pub smallest: i32,
}

/// All problems for a precision: `each` for every power of ten, and eight times as many where there
/// is none.
pub fn samples(range: Range, each: usize) -> Vec<Sample> {
    let mut random = Random::new(13);
    let mut samples = Vec::new();
    for (extreme, ..) in Extreme::ALL {
        let last = extreme.powers(range.digits);
        let (powers, count) = if last == 0 { (0..=0, 8 * each) } else { (1..=last, each) };
        for power in powers {
            samples.extend(
                (0..count).map(|number| sample(&mut random, extreme, power, range, number)),
            );
        }
    }
    samples
}

/// 10^power, correctly rounded.
pub fn ten_to(power: i32) -> f64 {
    format!("1e{power}").parse().unwrap_or(f64::NAN)
}

fn sample(
    random: &mut Random,
    extreme: Extreme,
    power: i32,
    range: Range,
    number: usize,
) -> Sample {
    let mut exponent = 0;
    let problem = match extreme {
        Extreme::Scale => {
            // The seven scales in turn, of problems that go the round of the others.
            let step = number as i32 % 7 - 3;
            exponent = range.scale * step / 3;
            let (other, ..) = Extreme::ALL[number % 11];
            let power = 1 + random.below(12) as i32;
            problem(random, other, power.min(range.digits))
        }
        Extreme::Subnormal => {
            exponent = range.smallest;
            let mut integer = || f64::from(random.below(81)) - 40.0;
            let mut point = || Vector::new(integer(), integer(), integer());
            let triangle = [point(), point(), point()];
            let (start, end) = (point(), point());
            let radius = f64::from(random.below(41));
            Problem { family: Family::Lattice, triangle, start, end, radius }
        }
        _ => problem(random, extreme, power),
    };
    Sample { extreme, power, input: Input::from(&problem), exponent }
}

/// A unit vector between two perpendicular ones: half a turn by an angle that is no rational part
/// of one.
fn turned(u: Vector, v: Vector, by: f64) -> Vector {
    (u * (1.0 - by * by) + v * (2.0 * by)) / (1.0 + by * by)
}

fn problem(random: &mut Random, extreme: Extreme, power: i32) -> Problem {
    let either = |random: &mut Random| if random.below(2) == 0 { 1.0 } else { -1.0 };
    let tenth = ten_to(-power);
    let small = tenth * random.between(1.0, 2.0) * either(random);
    let (start, end) = (random.point(), random.point());
    let radius = random.between(0.05, 1.0);
    let axis = (end - start).normalize();
    let u = random.perpendicular_to(axis);
    let v = axis.cross(u);
    let mut problem = Problem {
        family: Family::Generic,
        triangle: [random.point() * 2.0, random.point() * 2.0, random.point() * 2.0],
        start,
        end,
        radius,
    };
    match extreme {
        Extreme::Generic | Extreme::Scale | Extreme::Subnormal => {}
        Extreme::Parallel => parallel(random, &mut problem),
        Extreme::NearParallel => {
            let across = random.direction();
            match random.below(3) {
                0 => {
                    let from =
                        start + u * random.between(-1.0, 3.0) + axis * random.between(-2.0, 2.0);
                    problem.triangle[0] = from;
                    problem.triangle[1] =
                        from + (axis + across * small) * random.between(-3.0, 3.0);
                }
                1 => {
                    let height = axis * random.between(-1.0, 1.0);
                    problem.triangle = [0; 3].map(|_| {
                        let flat = u * random.between(-2.0, 2.0) + v * random.between(-2.0, 2.0);
                        end + height + (flat + across * (small * flat.dot(across))) * (1.5 * radius)
                    });
                }
                _ => {
                    let from =
                        end + u * random.between(-1.5, 1.5) + axis * random.between(-0.5, 1.0);
                    problem.triangle[0] = from;
                    problem.triangle[1] = from + (v + across * small) * random.between(-3.0, 3.0);
                    problem.triangle[2] = from + axis * random.between(0.0, 2.0) + u;
                }
            }
        }
        Extreme::CapTransition => {
            let at = end + u * (radius * random.between(0.0, 2.0)) + axis * small;
            let far = |random: &mut Random| {
                let outward = u * random.between(0.0, 2.0) + v * random.between(-1.0, 1.0);
                at + outward + axis * random.between(-1.0, 1.0)
            };
            problem.triangle = [at, far(random), far(random)];
            if random.below(2) == 0 {
                // The closest point inside an edge.
                problem.triangle[1] = at + (at - problem.triangle[1]) * random.unit();
                problem.triangle[0] = far(random);
            }
        }
        Extreme::TangentRim => {
            let other = tenth * random.between(-1.0, 1.0);
            let (gap, tilt) =
                [(small, other), (small, 0.0), (other, small)][random.below(3) as usize];
            let rim = end + u * (radius * (1.0 + gap)) + axis * (tilt * random.between(-1.0, 1.0));
            let along = v + axis * tilt;
            problem.triangle = [
                rim + along * random.between(-2.0, 1.0),
                rim + along * random.between(0.0, 2.0),
                rim + u * random.between(-1.0, 3.0) + axis * random.between(-0.5, 3.0),
            ];
        }
        Extreme::Contact => {
            // A supporting plane of the link (barrel, cap or rim), and the triangle on or beyond
            // it.
            let (touched, normal) = match random.below(3) {
                0 => (start + (end - start) * random.unit() + u * radius, u),
                1 => (end + u * (radius * random.unit()), axis),
                _ => {
                    let tilt = random.unit();
                    (end + u * radius, (axis * tilt + u * (1.0 - tilt)).normalize())
                }
            };
            let side = random.perpendicular_to(normal);
            let other = normal.cross(side);
            let (lift, size) = (f64::from(random.below(2)), ten_to(random.below(3) as i32 - 1));
            let first = random.unit() - 0.5;
            problem.triangle = [first, first + 1.7, first - 1.7].map(|by| {
                let around = turned(side, other, by) * random.between(0.1, 1.0);
                touched + (around + normal * (lift * random.unit())) * size + normal * small
            });
            if random.below(2) == 0 {
                problem.triangle[0] = touched + normal * small;
            }
        }
        Extreme::Crossing => {
            let at = match random.below(2) {
                0 => start + (end - start) * random.unit(),
                _ => end + u * (radius * random.between(-1.0, 1.0)),
            };
            let normal = random.direction();
            let side = random.perpendicular_to(normal);
            let (other, size) = (normal.cross(side), ten_to(random.below(2) as i32));
            problem.triangle = [0.0, 1.7, -1.7]
                .map(|by| at + turned(side, other, by) * (size * random.between(0.1, 1.0)));
        }
        Extreme::Needle => {
            let which = random.below(3) as usize;
            let [p, q] = [1, 2].map(|k| problem.triangle[(which + k) % 3]);
            problem.triangle[(which + 1) % 3] = q + (p - q) * tenth;
        }
        Extreme::Sliver => {
            let [a, b, _] = problem.triangle;
            let across = random.perpendicular_to((b - a).normalize());
            let at = random.between(0.2, 0.8);
            problem.triangle[2] = a + (b - a) * at + across * ((b - a).length() * tenth);
            if random.below(2) == 0 {
                // Above the interior, give or take.
                let normal = (b - a).normalize().cross(across);
                let foot = a + (b - a) * (at + random.between(-0.1, 0.1));
                problem.start = foot.lerp(problem.triangle[2], random.between(0.05, 0.95))
                    + normal * random.between(0.3, 2.0);
                problem.end =
                    problem.start + normal * random.between(0.1, 2.0) + random.direction() * 0.1;
                problem.radius *= 0.2;
            }
        }
        Extreme::ZeroArea => zero_area(random, &mut problem),
        Extreme::SmallTriangle | Extreme::LargeTriangle => {
            let ratio = if extreme == Extreme::SmallTriangle { tenth } else { ten_to(power) };
            let about = if random.below(2) == 0 { end + u * radius } else { problem.triangle[0] };
            problem.triangle = problem.triangle.map(|vertex| about + (vertex - about) * ratio);
        }
        Extreme::RadiusZero => {
            let (other, ..) = Extreme::ALL[random.below(10) as usize];
            let power = 1 + random.below(12) as i32;
            problem = self::problem(random, other, power);
            problem.radius = 0.0;
        }
        Extreme::ShortLink => {
            // From the origin no digit of the length is rounded away.
            problem.start = if random.below(2) == 0 { start } else { Vector::ZERO };
            problem.end = problem.start + axis * (radius * tenth);
        }
        Extreme::LongLink => {
            let length = radius * ten_to(power);
            problem.end = start + axis * length;
            let at = [0.0, length, length * random.unit()][random.below(3) as usize];
            problem.triangle = problem.triangle.map(|vertex| start + axis * at + vertex);
        }
        Extreme::Offset => {
            let offset = random.direction() * ten_to(power);
            problem.triangle = problem.triangle.map(|vertex| vertex + offset);
            problem.start += offset;
            problem.end += offset;
        }
    }
    problem
}

/// Small integers along perpendicular integer directions: parallel to the last bit, in any
/// precision.
fn parallel(random: &mut Random, problem: &mut Problem) {
    const TURNS: [[[f64; 3]; 3]; 2] = [
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        [[1.0, 2.0, 2.0], [2.0, 1.0, -2.0], [2.0, -2.0, 1.0]],
    ];
    let [axis, u, v] = TURNS[random.below(2) as usize].map(Vector::from_array);
    let height = f64::from(random.below(7)) - 3.0;
    let mut step = |reach: u32| f64::from(random.below(2 * reach + 1)) - f64::from(reach);
    problem.start = Vector::new(step(3), step(3), step(3));
    problem.end = problem.start + axis * (4.0 + step(3));
    let start = problem.start;
    problem.triangle = [0; 3].map(|_| start + axis * height + u * step(4) + v * step(4));
    match random.below(3) {
        // The face parallel to the caps; an edge parallel to the axis; only an edge parallel to the
        // caps.
        0 => {}
        1 => problem.triangle[1] = problem.triangle[0] + axis * (f64::from(random.below(9)) - 4.0),
        _ => problem.triangle[2] += axis * (f64::from(random.below(4)) + 1.0),
    }
    problem.radius = 0.5 * f64::from(1 + random.below(8));
}

fn zero_area(random: &mut Random, problem: &mut Problem) {
    let [a, b, _] = problem.triangle;
    match random.below(4) {
        // On a line up to rounding; exactly; two the same; all the same.
        0 => problem.triangle[2] = a + (b - a) * random.between(-1.0, 2.0),
        1 => {
            let mut integer = || f64::from(random.below(9)) - 4.0;
            let (from, step) = (
                Vector::new(integer(), integer(), integer()),
                Vector::new(integer(), integer(), integer()),
            );
            problem.triangle = [from, from + step, from - step * integer()];
        }
        2 => problem.triangle[2] = if random.below(2) == 0 { a } else { b },
        _ => problem.triangle = [a; 3],
    }
}
