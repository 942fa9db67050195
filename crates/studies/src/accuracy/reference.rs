//! The errors of the narrow phase on the reference cases, as tables.
//!
//! The kernels use only operations that IEEE 754 rounds correctly, so these tables are the same on
//! every machine.

use continuum_testing::Case;
use continuum_testing::precision::Precision;
use parry_continuum::distance::*;

/// The kinds of pairs, in the order of the tables.
pub const KINDS: [(&str, &str); 9] = [
    ("segment_segment", "segment and segment"),
    ("point_triangle", "point and triangle"),
    ("segment_triangle", "segment and triangle"),
    ("point_disc", "point and disc"),
    ("segment_disc", "segment and disc"),
    ("triangle_disc", "triangle and disc"),
    ("triangle_capsule", "triangle and capsule"),
    ("triangle_cylinder", "triangle and cylinder"),
    ("triangle_modified_cylinder", "triangle and modified cylinder"),
];

/// The distance of a case by this crate, all its lengths multiplied by `factor`.
pub fn distance<T: Precision>(case: &Case, factor: f64) -> f64 {
    let length = |x: f64| T::from_f64(x * factor);
    let point = |p: [f64; 3]| Vec3::from(p.map(length));
    let (triangle, radius) = (case.tri.map(point), length(case.r));
    let normal = Vec3::from(case.n.map(T::from_f64));
    let segment = || [point(case.s0), point(case.s1)];
    let [start, end] = [point(case.p0), point(case.p1)];
    let closest = match case.kind.as_str() {
        "segment_segment" => segment_segment(segment(), [point(case.u0), point(case.u1)]),
        "point_triangle" => point_triangle(point(case.p), triangle),
        "segment_triangle" => segment_triangle(segment(), triangle),
        "point_disc" => point_disc(point(case.p), point(case.c), normal, radius),
        "segment_disc" => segment_disc(segment(), point(case.c), normal, radius),
        "triangle_disc" => triangle_disc(triangle, point(case.c), normal, radius),
        "triangle_capsule" => triangle_capsule(triangle, start, end, radius),
        _ => triangle_modified_cylinder(triangle, start, end, radius, case.flat()),
    };
    closest.distance.into()
}

/// The median (of two in the middle the smaller) and the largest.
pub fn median_and_worst(mut values: Vec<f64>) -> Option<(f64, f64)> {
    values.sort_by(f64::total_cmp);
    Some((*values.get(values.len().checked_sub(1)? / 2)?, *values.last()?))
}

/// The categories of some cases, in alphabetical order.
pub fn categories<'a>(cases: &[&'a Case]) -> Vec<&'a str> {
    let mut names: Vec<_> = cases.iter().map(|case| case.cat.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    names
}

/// This crate's own errors, by pair.
pub fn table(cases: &[Case]) -> String {
    let mut text = String::from(
        "| pair | cases | f64 median | f64 worst | f32 cases | f32 median | f32 worst |\n|---|---|---|---|---|---|---|\n",
    );
    for (kind, name) in KINDS {
        text += &row(name, &of_kind(cases, kind));
    }
    text + &row("**all**", &cases.iter().collect::<Vec<_>>())
}

/// This crate's worst errors in a scene of 100 mm, by pair.
pub fn in_millimetres(cases: &[Case]) -> String {
    let mut text = String::from("| pair | f64: error below | f32: error below |\n|---|---|---|\n");
    for (kind, name) in KINDS {
        let cases = of_kind(cases, kind);
        let single: Vec<_> = cases.iter().copied().filter(|case| case.f32).collect();
        let [double, single] =
            [worst_share::<f64>(&cases), worst_share::<f32>(&single)].map(at_hundred);
        text += &format!("| {name} | {double} mm | {single} mm |\n");
    }
    text
}

/// The largest error as a share of the extent.
fn worst_share<T: Precision>(cases: &[&Case]) -> f64 {
    let share = |case: &&Case| (distance::<T>(case, 1.0) - case.distance()).abs() / case.scale;
    cases.iter().map(share).fold(0.0, f64::max)
}

/// A share of 100, rounded up to one digit.
fn at_hundred(share: f64) -> String {
    let error = 100.0 * share;
    let digit = 10.0_f64.powf(error.log10().floor());
    format!("{:.0e}", (error / digit).ceil() * digit)
}

/// The head of [`lines`].
pub const HEAD: &str = "pair,category,cases,f64 median,f64 worst,f32 cases,f32 median,f32 worst,parry median,parry worst";

/// One line for each pair and category. `peer` writes the columns of parry.
pub fn lines(cases: &[Case], mut peer: impl FnMut(&[&Case]) -> String) -> Vec<String> {
    let mut lines = Vec::new();
    for (kind, name) in KINDS {
        let cases = of_kind(cases, kind);
        for category in categories(&cases) {
            let some: Vec<_> = cases.iter().copied().filter(|case| case.cat == category).collect();
            let errors = errors_in_both(&some).replace(" | ", ",");
            lines.push(format!("{name},{},{errors},{}", category.replace('_', " "), peer(&some)));
        }
    }
    lines
}

fn of_kind<'a>(cases: &'a [Case], kind: &str) -> Vec<&'a Case> {
    cases.iter().filter(|case| case.kind == kind).collect()
}

fn row(name: &str, cases: &[&Case]) -> String {
    format!("| {name} | {} |\n", errors_in_both(cases))
}

fn errors_in_both(cases: &[&Case]) -> String {
    let single: Vec<_> = cases.iter().copied().filter(|case| case.f32).collect();
    format!("{} | {}", errors::<f64>(cases), errors::<f32>(&single))
}

/// Number of cases, median and worst error in units of u x extent.
fn errors<T: Precision>(cases: &[&Case]) -> String {
    let error =
        |case: &&Case| (distance::<T>(case, 1.0) - case.distance()).abs() / (T::UNIT * case.scale);
    match median_and_worst(cases.iter().map(error).collect()) {
        Some((median, worst)) => format!("{} | {median:.2} | {worst:.2}", cases.len()),
        None => "0 | - | -".into(),
    }
}
