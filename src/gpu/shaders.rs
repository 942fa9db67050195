//! The shaders' text. A kernel's is put together here from the functions that it needs; `naga` checks every one on
//! machines without a GPU, so this file needs nothing but the text.
//!
//! A function has the name of its twin in `distance`, `roots` or `proximity` (with the name of the twin's file before
//! it where that is needed) and does the same in the same order. `real` is `f32` or `f64`.

macro_rules! text {
    ($($file:literal),*) => { concat!($(include_str!(concat!("shaders/", $file, ".wgsl"))),*) };
}

/// What `real` is.
pub const REAL_F32: &str = text!("real_f32");
/// What `real` is.
pub const REAL_F64: &str = text!("real_f64");

/// A kernel: its entry point's name, and its text but for what `real` is.
#[derive(Clone, Copy, Debug)]
pub struct Kernel {
    pub name: &'static str,
    pub text: &'static str,
}

macro_rules! kernel {
    ($name:literal: $($file:literal),*) => { Kernel { name: $name, text: text!($($file),*) } };
}

/// The narrow phase from link to triangle, which every kernel of a query needs, with the kernel's own files.
macro_rules! query_kernel {
    ($name:literal) => {
        kernel!($name: "vec3", "closest", "segment_segment", "face", "segment_triangle", "point_disc", "line_disc",
            "segment_disc", "plane_disc", "triangle_disc", "point_modified_cylinder", "bounds",
            "triangle_modified_cylinder", "query", $name)
    };
}

pub const PREPARE: Kernel = kernel!("prepare": "vec3", "face", "prepare");
pub const SAMPLE: Kernel = query_kernel!("sample");
pub const NEAREST: Kernel = query_kernel!("nearest");
pub const REDUCE: Kernel = query_kernel!("reduce");
pub const COLLECT: Kernel = query_kernel!("collect");
pub const SELF_TEST: Kernel = kernel!("self_test": "self_test");
pub const PAIRS: Kernel = kernel!("pairs": "vec3", "closest", "segment_segment", "face", "point_triangle",
    "segment_triangle", "point_disc", "line_disc", "segment_disc", "plane_disc", "triangle_disc",
    "point_modified_cylinder", "bounds", "triangle_modified_cylinder", "pairs");

/// Every kernel.
#[allow(dead_code, reason = "the tests go through all of them")]
pub const KERNELS: &[&Kernel] = &[&PREPARE, &SAMPLE, &NEAREST, &REDUCE, &COLLECT, &SELF_TEST, &PAIRS];
