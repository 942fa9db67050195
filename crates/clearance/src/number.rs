//! Numbers for readers: a few significant digits, and the unit if it is known.

use parry_continuum::parry::math::Vector;

/// Returns a number with this many significant digits, in scientific form if it is very large or
/// very small.
pub fn digits(x: f64, significant: i32) -> String {
    let magnitude = x.abs().log10().floor();
    if x == 0.0 {
        "0".into()
    } else if (-5.0..7.0).contains(&magnitude) {
        let decimals = (significant - 1 - magnitude as i32).max(0) as usize;
        format!("{x:.decimals$}")
    } else {
        let decimals = (significant - 1).max(0) as usize;
        format!("{x:.decimals$e}")
    }
}

/// Returns a number with at most six significant digits, without zeros at its end.
pub fn short(x: f64) -> String {
    let text = digits(x, 6);
    match text.contains('.') && !text.contains('e') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

/// Returns a length with its unit, if that is known.
pub fn length(x: f64, significant: i32, unit: Option<&str>) -> String {
    with_unit(&digits(x, significant), unit)
}

/// Returns a number as the user wrote it, with its unit, if that is known.
pub fn as_written(x: f64, unit: Option<&str>) -> String {
    with_unit(&all_digits(x), unit)
}

/// Numbers from here on are written with an exponent: they have too many digits otherwise.
const LARGE: f64 = 1e16;
/// As [`LARGE`], for numbers near 0.
const SMALL: f64 = 1e-5;

/// Returns the shortest text that is read back as the same number.
pub fn all_digits(x: f64) -> String {
    let is_plain = x == 0.0 || !x.is_finite() || (SMALL..LARGE).contains(&x.abs());
    if is_plain { x.to_string() } else { format!("{x:e}") }
}

/// Returns a number with this many decimals.
pub fn fixed(x: f64, decimals: usize) -> String {
    if x.abs() < LARGE { format!("{x:.decimals$}") } else { format!("{x:.decimals$e}") }
}

/// Returns a point whose coordinates have this many decimals.
pub fn place(point: Vector, decimals: usize) -> String {
    format!("[{}]", point.to_array().map(|x| fixed(x, decimals)).join(", "))
}

fn with_unit(number: &str, unit: Option<&str>) -> String {
    unit.map_or_else(|| number.to_owned(), |unit| format!("{number} {unit}"))
}
