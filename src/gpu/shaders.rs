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

/// A kernel: its entry point's name, and its text but for what `real` is and how many coefficients a polynomial has.
#[derive(Clone, Copy, Debug)]
pub struct Kernel {
    pub name: &'static str,
    pub text: &'static str,
}

/// The coefficients of the quartic of segment-disc.
pub const QUARTIC: u32 = 5;

impl Kernel {
    /// The whole text.
    pub fn source(&self, real: &str, coefficients: u32) -> String {
        format!("{real}const COEFFICIENTS = {coefficients}u;\n{}", self.text)
    }
}

macro_rules! kernel {
    ($name:literal: $($file:literal),*) => { Kernel { name: $name, text: text!($($file),*) } };
}

/// The narrow phase from link to triangle, which every kernel of a query needs, with the kernel's own files.
macro_rules! query_kernel {
    ($name:literal) => { query_kernel!($name, "segment_disc") };
    ($name:literal, $($segment_disc:literal),*) => {
        kernel!($name: "vec3", "closest", "segment_segment", "face", "segment_triangle", "point_disc", "line_disc",
            $($segment_disc,)* "plane_disc", "triangle_disc", "point_modified_cylinder", "bounds",
            "triangle_modified_cylinder", "query", $name)
    };
}

macro_rules! pairs_kernel {
    ($($segment_disc:literal),*) => {
        kernel!("pairs": "vec3", "closest", "segment_segment", "face", "point_triangle", "segment_triangle",
            "point_disc", "line_disc", $($segment_disc,)* "plane_disc", "triangle_disc", "point_modified_cylinder",
            "bounds", "triangle_modified_cylinder", "pairs")
    };
}

pub const PREPARE: Kernel = kernel!("prepare": "vec3", "face", "prepare");
pub const SAMPLE: Kernel = query_kernel!("sample");
pub const NEAREST: Kernel = query_kernel!("nearest");
/// As [`NEAREST`], with the discs by the paper's quartic.
pub const NEAREST_BY_QUARTIC: Kernel =
    query_kernel!("nearest", "roots", "closed_form", "companion", "segment_disc_quartic");
pub const REDUCE: Kernel = query_kernel!("reduce");
pub const COLLECT: Kernel = query_kernel!("collect");
pub const SELF_TEST: Kernel = kernel!("self_test": "self_test");
pub const PAIRS: Kernel = pairs_kernel!("segment_disc", "segment_disc_pair");
/// As [`PAIRS`], with the discs by the paper's quartic.
pub const PAIRS_BY_QUARTIC: Kernel =
    pairs_kernel!("roots", "closed_form", "companion", "segment_disc_quartic", "segment_disc_pair");
pub const FORMS: Kernel = kernel!("forms": "vec3", "forms");

/// A kernel that finds roots by the method of this name, with the method's own files.
macro_rules! roots_kernel {
    ($method:literal: $($file:literal),*) => {
        Kernel {
            name: "find_roots",
            text: concat!(
                text!("vec3", "roots", $($file,)* $method),
                "fn approximate(monic: ptr<function, Coefficients>, degree: u32) {\n    ",
                $method,
                "(monic, degree);\n}\n",
                text!("find_roots")
            ),
        }
    };
}

/// In the order of `Finder`.
pub const FIND_ROOTS: [Kernel; 4] = [
    roots_kernel!("closed_form":),
    roots_kernel!("bairstow": "division", "direction"),
    roots_kernel!("companion":),
    roots_kernel!("jenkins_traub": "division", "direction"),
];

/// Every kernel.
#[allow(dead_code, reason = "the tests go through all of them")]
pub const KERNELS: &[&Kernel] = &[
    &PREPARE,
    &SAMPLE,
    &NEAREST,
    &NEAREST_BY_QUARTIC,
    &REDUCE,
    &COLLECT,
    &SELF_TEST,
    &PAIRS,
    &PAIRS_BY_QUARTIC,
    &FORMS,
    &FIND_ROOTS[0],
    &FIND_ROOTS[1],
    &FIND_ROOTS[2],
    &FIND_ROOTS[3],
];
