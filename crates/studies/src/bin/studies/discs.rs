//! Table I: the root finders where the paper needs them, in the distance between a segment and a
//! disc.

use super::turns::in_turns;
use continuum_studies::Number;
use continuum_studies::counted::{Counted, Counts, count};
use continuum_studies::long_table;
use continuum_studies::quartic::{QuarticAsPrinted, RecentredQuartic};
use continuum_testing::Random;
use continuum_testing::disc_problems::{DiscProblem, Kind};
use fearless_simd::{Level, dispatch};
use parry_continuum::distance::laboratory::{Convex, DiscSolver, segment_disc_by};
use parry_continuum::distance::{Scalar, Vec3};
use parry_continuum::parry::math::Vector;
use rayon::prelude::*;
use real_polynomial_roots::*;
use std::fmt::Write;
use std::hint::black_box;
use std::path::Path;

/// Problems that are timed, and how often.
const TIMED: usize = 1000;
const TURNS: usize = 41;

/// A problem in the disc's frame, as a route is given it.
#[derive(Clone, Copy)]
struct Local<T> {
    ends: [Vec3<T>; 2],
    normal: Vec3<T>,
    radius: T,
}

impl<T: Number> Local<T> {
    fn new(problem: &DiscProblem) -> Self {
        let point = |p: Vector| Vec3::from(p.to_array().map(T::of));
        Self {
            ends: problem.ends.map(|end| point(end - problem.centre)),
            normal: point(problem.normal.normalize()),
            radius: T::of(problem.radius),
        }
    }
}

/// A route, and its problems.
struct Route<T> {
    name: &'static str,
    distance: fn(&DiscProblem) -> f64,
    all: fn(&[Local<T>]),
    counts: fn(&[Local<T>]) -> Counts,
}

fn route<S, T>(name: &'static str) -> Route<T>
where
    T: Number + Into<f64>,
    S: DiscSolver<T> + DiscSolver<Counted<T>>,
{
    Route {
        name,
        distance: |problem| {
            let point = |p: Vector| Vec3::from(p.to_array().map(T::of));
            let [ends, [centre, normal]] =
                [problem.ends, [problem.centre, problem.normal]].map(|p| p.map(point));
            segment_disc_by::<S, T>(ends, centre, normal, T::of(problem.radius)).distance.into()
        },
        all: |problems| {
            for Local { ends, normal, radius } in problems {
                black_box(<S as DiscSolver<T>>::segment_disc(*ends, *normal, *radius));
            }
        },
        counts: |problems| {
            let counted = |v: Vec3<T>| Vec3::from(<[T; 3]>::from(v).map(Counted));
            count(problems.len(), || {
                for Local { ends, normal, radius } in problems {
                    S::segment_disc(ends.map(counted), counted(*normal), Counted(*radius));
                }
            })
        },
    }
}

fn routes<T: Number + Into<f64>>() -> [Route<T>; 13] {
    [
        route::<Convex, T>("convex, Halley"),
        route::<QuarticAsPrinted<ClosedForm>, T>("(18) as printed, closed form"),
        route::<QuarticAsPrinted<Bairstow>, T>("(18) as printed, Bairstow"),
        route::<QuarticAsPrinted<Companion>, T>("(18) as printed, companion"),
        route::<QuarticAsPrinted<JenkinsTraub>, T>("(18) as printed, Jenkins-Traub"),
        route::<RecentredQuartic<ClosedForm>, T>("recentred, closed form"),
        route::<RecentredQuartic<Bairstow>, T>("recentred, Bairstow"),
        route::<RecentredQuartic<Companion>, T>("recentred, companion"),
        route::<RecentredQuartic<JenkinsTraub>, T>("recentred, Jenkins-Traub"),
        route::<RecentredQuartic<ClosedForm, 1>, T>("recentred, closed form, 1 polish"),
        route::<RecentredQuartic<Bairstow, 1>, T>("recentred, Bairstow, 1 polish"),
        route::<RecentredQuartic<Companion, 1>, T>("recentred, companion, 1 polish"),
        route::<RecentredQuartic<JenkinsTraub, 1>, T>("recentred, Jenkins-Traub, 1 polish"),
    ]
}

/// What a route's answers are worth, and cost.
struct Row {
    name: &'static str,
    /// In units of roundoff times the problem's extent.
    worst: f64,
    /// Shares of the problems.
    above_8: f64,
    gross: f64,
    seconds: f64,
    counts: Counts,
}

fn rows<T: Number + Into<f64>>(
    problems: &[(DiscProblem, f64)],
    sample: &[DiscProblem],
) -> Vec<Row> {
    let local: Vec<Local<T>> = sample.iter().map(Local::new).collect();
    let routes = routes::<T>();
    let mut jobs = routes.each_ref().map(|route| |_: usize| (route.all)(&local));
    let times = in_turns(TURNS, jobs.each_mut().map(|job| job as &mut dyn FnMut(usize)));
    let row = |(route, time): (&Route<T>, f64)| {
        let error = |(problem, exact): &(DiscProblem, f64)| {
            let error = ((route.distance)(problem) - exact).abs() / problem.extent();
            if error.is_nan() { f64::INFINITY } else { error }
        };
        let errors: Vec<f64> = problems.par_iter().map(error).collect();
        let share =
            |limit: f64| errors.iter().filter(|&&e| e > limit).count() as f64 / errors.len() as f64;
        Row {
            name: route.name,
            worst: errors.iter().copied().fold(0.0, f64::max) / <T as Real>::UNIT_ROUNDOFF,
            above_8: share(8.0 * <T as Real>::UNIT_ROUNDOFF),
            gross: share(1e-4),
            seconds: time / local.len() as f64,
            counts: (route.counts)(&local),
        }
    };
    routes.iter().zip(times).map(row).collect()
}

/// Seconds for one problem by the convex route, when the compiler may compute several at once with
/// the widest instructions of the machine.
fn wide<T: Number>(sample: &[DiscProblem]) -> f64 {
    let local: Vec<Local<T>> = sample.iter().map(Local::new).collect();
    let number = |i: usize| {
        move |p: &Local<T>| {
            let [a, b] = p.ends;
            [a.x, a.y, a.z, b.x, b.y, b.z, p.normal.x, p.normal.y, p.normal.z, p.radius][i]
        }
    };
    let rows: [Vec<T>; 10] = std::array::from_fn(|i| local.iter().map(number(i)).collect());
    let mut out = vec![T::ZERO; local.len()];
    let level = Level::new();
    let [time] =
        in_turns(TURNS, [&mut |_| dispatch!(level, simd => in_packs(simd, &rows, &mut out))]);
    black_box(&out);
    time / local.len() as f64
}

#[inline(always)]
fn in_packs<T: Scalar, S>(_: S, rows: &[Vec<T>; 10], out: &mut [T]) {
    let n = out.len();
    let [ax, ay, az, bx, by, bz, nx, ny, nz, r] = rows;
    let (ax, ay, az, bx, by, bz) = (&ax[..n], &ay[..n], &az[..n], &bx[..n], &by[..n], &bz[..n]);
    let (nx, ny, nz, r) = (&nx[..n], &ny[..n], &nz[..n], &r[..n]);
    for i in 0..n {
        let ends = [Vec3::new(ax[i], ay[i], az[i]), Vec3::new(bx[i], by[i], bz[i])];
        out[i] = Convex::segment_disc(ends, Vec3::new(nx[i], ny[i], nz[i]), r[i]).distance;
    }
}

/// The chapter of the page; its long table goes to `out`.
pub fn chapter(count: usize, out: &Path) -> Result<String, String> {
    let mut random = Random::new(1);
    let problems: Vec<_> =
        (0..count).map(|i| DiscProblem::new(&mut random, Kind::ALL[i % Kind::ALL.len()])).collect();
    let with_distance = |problem: DiscProblem| (problem, problem.distance());
    let double: Vec<_> = problems.par_iter().map(|p| with_distance(*p)).collect();
    let single: Vec<_> = problems.par_iter().map(|p| with_distance(p.rounded())).collect();
    let usable = |problems: Vec<(DiscProblem, f64)>| -> Vec<_> {
        problems.into_iter().filter(|(p, _)| p.extent() > 0.0 && p.normal != Vector::ZERO).collect()
    };
    let sample: Vec<_> = (0..TIMED).map(|_| DiscProblem::new(&mut random, Kind::Random)).collect();
    let tables = [rows::<f32>(&usable(single), &sample), rows::<f64>(&usable(double), &sample)];
    let text = |error: std::fmt::Error| error.to_string();
    // A polish does the same for every finder.
    let is_shown =
        |cells: &[&str]| !cells[0].ends_with("polish") || cells[0].contains("closed form");
    let table = table(&tables).map_err(text)?;
    let routes = long_table::write(&table, &out.join("studies_discs.csv"), is_shown)?;
    write_page(count, &tables, [wide::<f32>(&sample), wide::<f64>(&sample)], &routes).map_err(text)
}

/// Every route, in both precisions.
fn table(tables: &[Vec<Row>; 2]) -> Result<String, std::fmt::Error> {
    let mut page = String::from(
        "| route | f32: worst | > 8 | gross | ns | f64: worst | > 8 | gross | ns | operations |\n\
         |---|---|---|---|---|---|---|---|---|---|\n",
    );
    for (single, double) in tables[0].iter().zip(&tables[1]) {
        write!(page, "| {} |", single.name)?;
        for row in [single, double] {
            let (worst, above, gross) = (error(row.worst), share(row.above_8), share(row.gross));
            write!(page, " {worst} | {above} | {gross} | {:.0} |", row.seconds * 1e9)?;
        }
        let Counts { simple, divisions, roots, functions } = double.counts;
        writeln!(page, " {simple:.0} / {divisions:.1} / {roots:.1} / {functions:.1} |")?;
    }
    Ok(page)
}

fn write_page(
    count: usize,
    tables: &[Vec<Row>; 2],
    wide: [f64; 2],
    routes: &str,
) -> Result<String, std::fmt::Error> {
    let mut page = format!(
        "## Table I: root finders as routes to a disc\n\n\
         The distance between a segment and a solid disc, on {count} problems, as many of each of {} kinds, most of them \
         nasty (`crates/testing/src/disc_problems.rs`): parallel, tangent, touching or ending on the rim, near the axis, \
         sizes of any ratio. The reference has twice the digits of f64. The error is in units of u x extent (u = 2^-24 \
         or 2^-53, extent = the largest coordinate difference, or the radius); gross is an error above 1e-4 extent. \
         Nanoseconds on one thread, one problem at a time, on {TIMED} random problems. Operations in f64, on average: \
         additions and multiplications / divisions / square roots / cube roots and cosines.\n\n\
         \"As printed\" takes the real roots of (18) about the segment's middle. \"Recentred\" counts from the foot of \
         the disc's centre and takes the real parts of all roots; a polish is a Newton step on the distance's \
         derivative. [studies_discs.csv](studies_discs.csv) has every finder with and without polish.\n\n",
        Kind::ALL.len()
    );
    page.push_str(routes);
    for ((precision, table), wide) in ["f32", "f64"].into_iter().zip(tables).zip(wide) {
        let convex = &table[0];
        let is_polished = |row: &&Row| row.name == "recentred, closed form, 1 polish";
        let polished = table.iter().find(is_polished).unwrap_or(convex);
        let safe = table[1..].iter().filter(|row| row.above_8 == 0.0);
        let fastest = safe.min_by(|a, b| a.seconds.total_cmp(&b.seconds));
        write!(
            page,
            "\nIn {precision} the convex route takes {:.0} ns, the closed form with a polish {:.2} times as long, and {} \
             With the widest instructions of the machine the convex route takes {:.1} ns, {:.1} times less than that \
             closed form; the root finders branch and cannot follow.\n",
            convex.seconds * 1e9,
            polished.seconds / convex.seconds,
            fastest.map_or("no quartic is as safe.".into(), |row| format!(
                "the fastest quartic that never errs by more than 8 units ({}) {:.2} times as long.",
                row.name,
                row.seconds / convex.seconds
            )),
            wide * 1e9,
            polished.seconds / wide,
        )?;
    }
    let printed = || tables.iter().flat_map(|table| &table[1..5]);
    let finding = if tables.iter().all(|table| table[0].above_8 == 0.0)
        && printed().all(|row| row.gross > 0.0)
    {
        "every quartic as printed is grossly wrong on some of these problems, with any root finder, and the convex route \
         never errs by more than 8 units; so the paper's Table I, which compares finders by complexity and convergence, \
         leaves out what decides"
    } else {
        "not every quartic as printed failed, or the convex route erred by more than 8 units"
    };
    let recentred =
        tables.each_ref().map(|table| table[5..].iter().map(|row| row.worst).fold(0.0, f64::max));
    writeln!(
        page,
        "\nFinding: {finding}. What fails is the equation, not the finder: of the recentred quartic the worst answer of \
         any finder is off by {} units in f32 and {} in f64.",
        error(recentred[0]),
        error(recentred[1])
    )?;
    Ok(page)
}

fn error(units: f64) -> String {
    if units < 100.0 { format!("{units:.1}") } else { format!("{units:.0e}") }
}

fn share(share: f64) -> String {
    match share {
        0.0 => "0".into(),
        s if s < 1e-3 => format!("{:.0e} %", 100.0 * s),
        s => format!("{:.2} %", 100.0 * s),
    }
}
