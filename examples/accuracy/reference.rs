//! The errors of the narrow phase on the reference cases, as tables.
//!
//! This example writes them, `tests/accuracy.rs` computes them again. The kernels use only operations
//! that IEEE 754 rounds correctly, so these tables are the same on every machine. Both programs have the
//! reference cases in a module `common`.

use crate::common::Case;
use crate::common::precision::Precision;
use parry_continuum::distance::*;
use std::fmt::Write;

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

/// All tables of this crate's own errors.
pub fn tables(cases: &[Case]) -> String {
    const HEAD: &str = "| cases | f64 median | f64 worst | f32 cases | f32 median | f32 worst |\n|---|---|---|---|---|---|---|\n";
    let mut text = format!("| pair {HEAD}");
    let of_kind = |kind| cases.iter().filter(move |case| case.kind == kind).collect::<Vec<_>>();
    for (kind, name) in KINDS {
        text += &row(name, &of_kind(kind));
    }
    text += &row("**all**", &cases.iter().collect::<Vec<_>>());
    for (kind, name) in KINDS {
        let cases = of_kind(kind);
        write!(text, "\n### {}{}\n\n| category {HEAD}", name[..1].to_uppercase(), &name[1..]).ok();
        for category in categories(&cases) {
            let some: Vec<_> = cases.iter().copied().filter(|case| case.cat == category).collect();
            text += &row(&category.replace('_', " "), &some);
        }
    }
    text
}

fn row(name: &str, cases: &[&Case]) -> String {
    let single: Vec<_> = cases.iter().copied().filter(|case| case.f32).collect();
    format!("| {name} | {} | {} |\n", errors::<f64>(cases), errors::<f32>(&single))
}

/// Number of cases, median and worst error in units of u x extent.
fn errors<T: Precision>(cases: &[&Case]) -> String {
    let error = |case: &&Case| (distance::<T>(case, 1.0) - case.distance()).abs() / (T::UNIT * case.scale);
    match median_and_worst(cases.iter().map(error).collect()) {
        Some((median, worst)) => format!("{} | {median:.2} | {worst:.2}", cases.len()),
        None => "0 | - | -".into(),
    }
}
