//! The text of the shaders.
//!
//! Rust declares the constants and records that the host shares; their text precedes the shaders. A
//! function has the name of its twin in `distance` or `proximity`, with the name of the twin's file
//! before it where needed. It does the same in the same order. `real` is `f32` or `f64`.

use super::layout::{
    CAPACITY, FACE_VECTORS, LinkRecord, MOST_LINKS, Round, SAMPLES, SLOT, THREADS, UNBOUNDED,
};
use crate::distance::Scalar;
use gpu_batch::wgsl::{constant, prelude};
use gpu_batch::{Precision, Record, Shader};

macro_rules! shared {
    ($($file:literal),* $(,)?) => { concat!($(include_str!(concat!("shaders/shared/", $file, ".wgsl"))),*) };
}

macro_rules! kernel {
    ($file:literal) => {
        include_str!(concat!("shaders/kernels/", $file, ".wgsl"))
    };
}

const NARROW_PHASE: &str = shared!(
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

/// The kernel that computes the record of each triangle, after the vertices have moved.
pub(super) fn prepare(precision: Precision) -> Shader {
    let text = prelude(precision)
        + &passes(precision)
        + &constants(&[("THREADS", THREADS), ("FACE_VECTORS", FACE_VECTORS)])
        + shared!("vec3", "face", "face_record")
        + kernel!("prepare");
    Shader::new("prepare", text)
}

pub(super) fn sample(precision: Precision) -> Shader {
    of_query("sample", kernel!("sample"), precision, CONVEX)
}

/// `route` computes the distance from a segment to a disc.
pub(super) fn nearest(precision: Precision, route: &str) -> Shader {
    of_query("nearest", kernel!("nearest"), precision, route)
}

pub(super) fn reduce(precision: Precision) -> Shader {
    of_query("reduce", kernel!("reduce"), precision, CONVEX)
}

pub(super) fn collect(precision: Precision) -> Shader {
    of_query("collect", kernel!("collect"), precision, CONVEX)
}

fn of_query(entry_point: &'static str, kernel: &str, precision: Precision, route: &str) -> Shader {
    let sizes = [
        ("THREADS", THREADS),
        ("MOST_LINKS", MOST_LINKS),
        ("SAMPLES", SAMPLES),
        ("CAPACITY", CAPACITY),
        ("SLOT", SLOT),
        ("FACE_VECTORS", FACE_VECTORS),
    ];
    let text = prelude(precision)
        + &constants(&sizes)
        + &constant("UNBOUNDED", format_args!("{UNBOUNDED:e}f"))
        + &Round::wgsl()
        + &LinkRecord::wgsl()
        + &narrow_phase(precision)
        + route
        + shared!("face_record", "query")
        + kernel;
    Shader::new(entry_point, text)
}

/// The narrow phase, from point and segment to link and triangle. It lacks a route from a segment
/// to a disc, such as [`CONVEX`].
pub fn narrow_phase(precision: Precision) -> String {
    passes(precision) + NARROW_PHASE
}

/// The numbers of refinement steps of the narrow phase.
fn passes(precision: Precision) -> String {
    let [face, halley] = match precision {
        Precision::F32 => [f32::FACE_PASSES, f32::HALLEY_STEPS],
        Precision::F64 => [f64::FACE_PASSES, f64::HALLEY_STEPS],
    };
    constants(&[("FACE_PASSES", face as u32), ("HALLEY_STEPS", halley as u32)])
}

fn constants(values: &[(&str, u32)]) -> String {
    values.iter().map(|(name, value)| constant(name, format_args!("{value}u"))).collect()
}
