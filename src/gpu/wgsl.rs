//! The shaders' text: pieces for kernels of one's own (see [`BatchKernel`](super::BatchKernel)), and what this crate
//! compiles.
//!
//! What the host knows too, constants and records, is declared once, in Rust, and precedes the text. A function has the
//! name of its twin in `distance` or `proximity` (with the name of the twin's file before it where that is needed) and
//! does the same in the same order. `real` is `f32` or `f64`.

use super::Precision;
use super::layout::{
    ANSWER_HEAD, BATCH_THREADS, CAPACITY, FACE_VECTORS, FAR, Head, LinkRecord, MOST_LINKS, Round, SAMPLES,
    SLOT, THREADS,
};
use super::record::Record;
use crate::distance::{CBRT_BITS_F32, Scalar};
use std::fmt::Display;

macro_rules! shared {
    ($($file:literal),* $(,)?) => { concat!($(include_str!(concat!("shaders/shared/", $file, ".wgsl"))),*) };
}

macro_rules! kernel {
    ($file:literal) => {
        include_str!(concat!("shaders/kernels/", $file, ".wgsl"))
    };
}

/// Vectors, and division that no divisor spoils.
pub const VECTORS: &str = shared!("vec3");

/// The narrow phase from point and segment to link and triangle, [`VECTORS`] included, but for a route from a segment to
/// a disc, such as [`CONVEX`].
pub const NARROW_PHASE: &str = shared!(
    "vec3",
    "closest",
    "segment_segment",
    "face",
    "point_triangle",
    "segment_triangle",
    "point_disc",
    "segment_disc",
    "plane_disc",
    "triangle_disc",
    "point_modified_cylinder",
    "bounds",
    "triangle_modified_cylinder",
);

/// This crate's route from a segment to a disc.
pub const CONVEX: &str = shared!("convex");

/// Answers two numbers with their quotient and the square root of the first.
pub(super) const SELF_TEST: &str = kernel!("self_test");

/// A kernel as it is compiled, in one precision.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Shader {
    /// The name of the entry point.
    pub entry_point: &'static str,
    /// The whole text.
    pub text: String,
}

/// All that [`Gpu::open`](super::Gpu::open) compiles, for whoever checks or translates it without a GPU.
pub fn kernels(precision: Precision) -> Vec<Shader> {
    vec![
        Shader::prepare(precision),
        Shader::sample(precision),
        Shader::nearest(precision, CONVEX),
        Shader::reduce(precision),
        Shader::collect(precision),
        Shader::batch(precision, SELF_TEST, 2, 2),
    ]
}

/// What [`GpuExhaustive::compute_every_pair`](super::GpuExhaustive::compute_every_pair) compiles for a route.
pub fn every_pair(precision: Precision, route: &str) -> Shader {
    Shader::nearest(precision, route)
}

impl Shader {
    /// Computes what is known of each triangle, whenever the vertices move.
    pub(super) fn prepare(precision: Precision) -> Self {
        let text = scalar(precision)
            + &constants(&[("THREADS", THREADS), ("FACE_VECTORS", FACE_VECTORS)])
            + shared!("vec3", "face", "face_record")
            + kernel!("prepare");
        Self { entry_point: "prepare", text }
    }

    pub(super) fn sample(precision: Precision) -> Self {
        Self::of_query("sample", kernel!("sample"), precision, CONVEX)
    }

    /// `route` is that from a segment to a disc.
    pub(super) fn nearest(precision: Precision, route: &str) -> Self {
        Self::of_query("nearest", kernel!("nearest"), precision, route)
    }

    pub(super) fn reduce(precision: Precision) -> Self {
        Self::of_query("reduce", kernel!("reduce"), precision, CONVEX)
    }

    pub(super) fn collect(precision: Precision) -> Self {
        Self::of_query("collect", kernel!("collect"), precision, CONVEX)
    }

    fn of_query(entry_point: &'static str, kernel: &str, precision: Precision, route: &str) -> Self {
        let sizes = [
            ("THREADS", THREADS),
            ("MOST_LINKS", MOST_LINKS),
            ("SAMPLES", SAMPLES),
            ("CAPACITY", CAPACITY),
            ("SLOT", SLOT),
            ("FACE_VECTORS", FACE_VECTORS),
        ];
        let text = scalar(precision)
            + &constants(&sizes)
            + &constant("FAR", format_args!("{FAR:e}f"))
            + &Round::wgsl()
            + &LinkRecord::wgsl()
            + NARROW_PHASE
            + route
            + shared!("face_record", "query")
            + kernel;
        Self { entry_point, text }
    }

    /// Runs `fn solve(problem: u32, answer: u32)` of a text over many problems of so many numbers, with answers of so
    /// many.
    pub(super) fn batch(precision: Precision, text: &str, problem: u32, answer: u32) -> Self {
        let sizes = [
            ("THREADS", BATCH_THREADS),
            ("PROBLEM", problem),
            ("ANSWER", ANSWER_HEAD + answer),
            ("ANSWER_HEAD", ANSWER_HEAD),
        ];
        let text = scalar(precision) + &constants(&sizes) + &Head::wgsl() + text + kernel!("batch");
        Self { entry_point: "batch", text }
    }
}

/// What `real` is, and what follows from that.
fn scalar(precision: Precision) -> String {
    match precision {
        Precision::F32 => scalar_of::<f32>("f32", f32::MIN_POSITIVE.into()) + shared!("scalar_f32"),
        Precision::F64 => scalar_of::<f64>("f64", f64::MIN_POSITIVE) + shared!("scalar_f64"),
    }
}

fn scalar_of<T: Scalar>(real: &str, smallest_normal: f64) -> String {
    format!("alias real = {real};\n")
        + &constant("UNIT_ROUNDOFF", format_args!("real({:e})", T::UNIT_ROUNDOFF))
        // A device may take what is smaller for 0, and its inverse may overflow.
        + &constant("SMALLEST_NORMAL", format_args!("real({smallest_normal:e})"))
        + &constant("FACE_PASSES", format_args!("{}u", T::FACE_PASSES))
        + &constant("HALLEY_STEPS", format_args!("{}u", T::HALLEY_STEPS))
        + &constant("CBRT_BITS", format_args!("{CBRT_BITS_F32}u"))
}

fn constants(values: &[(&str, u32)]) -> String {
    values.iter().map(|(name, value)| constant(name, format_args!("{value}u"))).collect()
}

fn constant(name: &str, value: impl Display) -> String {
    format!("const {name} = {value};\n")
}
