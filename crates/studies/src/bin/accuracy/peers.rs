//! parry's answers beside this crate's.

use continuum_studies::accuracy::measure::{Problem, scaled};
use continuum_studies::accuracy::problems::Extreme;
use continuum_studies::accuracy::reference::{distance, median_and_worst};
use continuum_testing::Case;
use continuum_testing::precision::vector;
use parry_continuum::parry::math::{Pose, Rot3, Vector};
use parry_continuum::parry::query;
use parry_continuum::parry::shape::{Capsule, Cylinder, Triangle};
use std::fmt::Write;
use std::panic::catch_unwind;

/// A way to answer a case after its lengths are multiplied by a factor.
type Program = fn(&Case, f64) -> f64;
const PROGRAMS: [(&str, Program); 2] = [("this crate", distance::<f64>), ("parry", parry)];
const UNITS: [(&str, f64); 2] = [("as given", 1.0), ("x 1e-3", 1e-3)];

/// parry's distance between a triangle and a capsule or a cylinder; NaN where it gives none.
pub fn parry_distance(
    triangle: [Vector; 3],
    [start, end]: [Vector; 2],
    radius: f64,
    flat: bool,
) -> f64 {
    let [a, b, c] = triangle;
    let triangle = Triangle::new(a, b, c);
    let world = Pose::identity();
    let answer = if flat {
        // parry's cylinder stands on the y axis.
        let turn = (end - start)
            .try_normalize()
            .map_or(Rot3::IDENTITY, |axis| Rot3::from_rotation_arc(Vector::Y, axis));
        let pose = Pose::from_parts(start + (end - start) * 0.5, turn);
        query::distance(
            &world,
            &triangle,
            &pose,
            &Cylinder::new((end - start).length() * 0.5, radius),
        )
    } else {
        query::distance(&world, &triangle, &world, &Capsule::new(start, end, radius))
    };
    answer.map_or(f64::NAN, |answer| answer.distance)
}

/// parry's distance between the triangle and the link of a case.
fn parry(case: &Case, factor: f64) -> f64 {
    let point = |p: [f64; 3]| Vector::from(p) * factor;
    let ends = [point(case.p0), point(case.p1)];
    parry_distance(case.tri.map(point), ends, case.r * factor, case.flat() == [true; 2])
}

/// What parry makes of the extreme problems.
pub struct Peer {
    /// For each category, for capsules and cylinders.
    answers: Vec<(Extreme, bool, Answer)>,
}

/// One answer of parry.
struct Answer {
    /// In units of u x extent, infinite where there was no answer.
    error: f64,
    /// More clearance than there is, by over 1e-9 of the extent.
    is_over: bool,
}

impl Peer {
    /// Asks parry about every problem; a panic counts as no answer.
    pub fn ask(problems: &[Problem<f64>]) -> Self {
        let hook = std::panic::take_hook();
        std::panic::set_hook(Box::new(|_| {}));
        let mut answers = Vec::new();
        for problem in problems {
            let input = &problem.input;
            let ends = [vector(input.start), vector(input.end)];
            for (kernel, flat) in [(10, false), (12, true)] {
                let Some(proof) = problem.proofs[kernel] else { continue };
                let ask = || parry_distance(input.triangle.map(vector), ends, input.radius, flat);
                let distance = scaled(catch_unwind(ask).unwrap_or(f64::NAN), -problem.exponent);
                let over = distance - proof.middle.rounded();
                let is_over = over > 1e-9 * problem.near_one.extents()[kernel];
                answers.push((
                    problem.extreme,
                    flat,
                    Answer { error: proof.error(distance), is_over },
                ));
            }
        }
        std::panic::set_hook(hook);
        Self { answers }
    }

    fn of(&self, extreme: Extreme, flat: bool) -> Option<(f64, f64, usize, usize)> {
        let here =
            |(category, caps, _): &&(Extreme, bool, Answer)| *category == extreme && *caps == flat;
        let answers: Vec<_> = self.answers.iter().filter(here).map(|(.., answer)| answer).collect();
        let (median, worst) =
            median_and_worst(answers.iter().map(|answer| answer.error).collect())?;
        Some((median, worst, answers.iter().filter(|answer| answer.is_over).count(), answers.len()))
    }

    /// Median and worst error of a line of the file.
    pub fn cells(&self, extreme: Extreme, kernels: &[usize]) -> String {
        let flat = match kernels {
            [10] => false,
            [12] => true,
            _ => return "-,-".into(),
        };
        self.of(extreme, flat).map_or("-,-".into(), |(median, worst, ..)| {
            format!("{},{}", digit(median), digit(worst))
        })
    }

    /// A row for each category.
    pub fn table(&self) -> String {
        let mut text = String::from(
            "| category | problems | capsule: median | worst | over-estimates | cylinder: median | worst | \
             over-estimates |\n|---|---|---|---|---|---|---|---|\n",
        );
        for (extreme, name, _) in Extreme::ALL {
            let row = [false, true].map(|flat| self.of(extreme, flat));
            if let [Some(capsule), Some(cylinder)] = row {
                write!(text, "| {name} | {} |", capsule.3).ok();
                for (median, worst, over, _) in [capsule, cylinder] {
                    write!(text, " {} | {} | {over} |", digit(median), digit(worst)).ok();
                }
                text.push('\n');
            }
        }
        text
    }
}

/// Whether the page shows a row of that table: what a robot in its scene meets. The file has all.
pub fn is_shown(cells: &[&str]) -> bool {
    ["generic", "parallel", "near parallel", "contact", "crossing", "needle", "sliver", "offset"]
        .contains(&cells[0])
}

pub fn comparison(cases: &[Case]) -> String {
    let alike = |case: &&Case, flat| case.is_link() && case.flat() == [flat; 2];
    let capsules: Vec<_> = cases.iter().filter(|case| alike(case, false)).collect();
    let cylinders: Vec<_> = cases.iter().filter(|case| alike(case, true)).collect();
    let mut text = String::from(
        "| link | cases | lengths | program | median | worst | off by > 1e-6 | over-estimates | largest, of the distance |\n\
         |---|---|---|---|---|---|---|---|---|\n",
    );
    for (name, cases) in [("capsule", &capsules), ("cylinder", &cylinders)] {
        for (unit, factor) in UNITS {
            for (program, answer) in PROGRAMS {
                let total = Total::of(cases, answer, factor);
                writeln!(text, "| {name} | {} | {unit} | {program} | {total} |", cases.len()).ok();
            }
        }
    }
    text
}

/// Median and worst error of parry on some cases of a kind, in units of u x extent.
pub fn on_cases(cases: &[&Case]) -> String {
    let is_asked =
        |case: &&&Case| ["triangle_capsule", "triangle_cylinder"].contains(&case.kind.as_str());
    let unit = f64::EPSILON / 2.0;
    let error = |case: &&Case| {
        let error = (parry(case, 1.0) - case.distance()).abs() / (unit * case.scale);
        if error.is_nan() { f64::INFINITY } else { error }
    };
    median_and_worst(cases.iter().filter(is_asked).map(error).collect())
        .map_or("-,-".into(), |(median, worst)| format!("{},{}", digit(median), digit(worst)))
}

/// How a program does on some cases.
struct Total {
    median: f64,
    worst: f64,
    /// Errors beyond 1e-6 of the extent.
    off: usize,
    /// Over-estimates beyond 1e-9 of the extent.
    over: usize,
    /// The largest over-estimate relative to the distance.
    largest: f64,
}

impl Total {
    fn of(cases: &[&Case], answer: Program, factor: f64) -> Self {
        let signed: Vec<_> = cases
            .iter()
            .map(|case| (answer(case, factor) / factor - case.distance()) / case.scale)
            .collect();
        let (median, worst) =
            median_and_worst(signed.iter().map(|error| error.abs()).collect()).unwrap_or_default();
        let relative =
            signed.iter().zip(cases).filter(|(_, case)| case.distance() >= 1e-3 * case.scale);
        Self {
            median,
            worst,
            off: signed.iter().filter(|error| error.abs() > 1e-6).count(),
            over: signed.iter().filter(|&&error| error > 1e-9).count(),
            largest: relative
                .map(|(error, case)| error * case.scale / case.distance())
                .fold(0.0, f64::max),
        }
    }
}

impl std::fmt::Display for Total {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        let Self { median, worst, off, over, largest } = self;
        let [median, worst, largest] = [*median, *worst, *largest].map(digit);
        write!(f, "{median} | {worst} | {off} | {over} | {largest}")
    }
}

/// One digit and the power of ten.
fn digit(value: f64) -> String {
    if value == 0.0 {
        "0".into()
    } else if value.is_infinite() {
        "no answer".into()
    } else {
        format!("{value:.0e}")
    }
}
