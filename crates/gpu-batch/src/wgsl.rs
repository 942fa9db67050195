//! Functions for kernels.
//!
//! `real` is `f32` or `f64`, and one text serves both. Beyond the arithmetic of WGSL, [`prelude`]
//! has
//!
//! | | |
//! |---|---|
//! | `UNIT_ROUNDOFF` | the largest relative error of one rounding: 2^-24 or 2^-53 |
//! | `SMALLEST_NORMAL` | what is smaller a device may take for 0, and its inverse may overflow |
//! | `over(a, b)` | a / b for a positive b, 0 for any other |
//! | `cbrt_estimate(x)` | the cube root of the magnitude within 5 %: a start value, never an answer |
//! | `power_of_two_to_unity(x)` | a power of two that brings x near 1, or at least its square into range |
//! | `from_below(x)`, `from_above(x)` | an `f32` that is not above, or not below, a number from 0 up that `f32` has room for |
//!
//! In double precision keep to `+`, `-`, `*`, `/`, `sqrt`, `abs`, `min`, `max`, `clamp`, `dot` and
//! `cross`: drivers compute the rest in single precision, if at all. A device may compute as if no
//! NaN and no infinity arose: give both arms of a `select` finite numbers.

use crate::Precision;
use std::fmt::Display;

/// Added to a third of a number's bits, gives the bits of its cube root within 5 %: two thirds of
/// the exponent's bias, less what centres the error.
const CBRT_BITS: u32 = 0x2a51_0554;

/// The definition of `real`, and the functions of all kernels.
pub fn prelude(precision: Precision) -> String {
    let (real, unit, smallest, text) = match precision {
        Precision::F32 => (
            "f32",
            f64::from(f32::EPSILON),
            f32::MIN_POSITIVE.into(),
            include_str!("shaders/scalar_f32.wgsl"),
        ),
        Precision::F64 => {
            ("f64", f64::EPSILON, f64::MIN_POSITIVE, include_str!("shaders/scalar_f64.wgsl"))
        }
    };
    format!("alias real = {real};\n")
        + &constant("UNIT_ROUNDOFF", format_args!("real({:e})", unit / 2.0))
        + &constant("SMALLEST_NORMAL", format_args!("real({smallest:e})"))
        + &constant("CBRT_BITS", format_args!("{CBRT_BITS}u"))
        + text
        + include_str!("shaders/over.wgsl")
}

/// The declaration of a constant that Rust defines too.
pub fn constant(name: &str, value: impl Display) -> String {
    format!("const {name} = {value};\n")
}
