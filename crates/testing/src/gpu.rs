//! The GPU of this machine, opened once for all tests of a program.
//!
//! On a machine without a GPU these tests print that they are skipped, and pass. They fail there if
//! `PARRY_CONTINUUM_REQUIRE_GPU` is set.

use parry_continuum::gpu::{DeviceError, Gpu, GpuError, GpuSearch, Precision};
use parry_continuum::parry::shape::TriMesh;
use std::io::Write;
use std::sync::OnceLock;

/// The precisions and their names in messages.
pub const PRECISIONS: [(&str, Precision); 2] =
    [("GPU f32", Precision::F32), ("GPU f64", Precision::F64)];

/// Returns the GPU in this precision; `None` if there is none and none is required.
pub fn open(precision: Precision) -> Option<&'static Gpu> {
    static SINGLE: OnceLock<Option<Gpu>> = OnceLock::new();
    static DOUBLE: OnceLock<Option<Gpu>> = OnceLock::new();
    let opened = if precision == Precision::F32 { &SINGLE } else { &DOUBLE };
    let open = || match Gpu::open(precision) {
        Ok(gpu) => {
            println!("{precision:?}: {}", gpu.adapter());
            Some(gpu)
        }
        Err(GpuError::Device(
            error @ (DeviceError::NoAdapter { .. } | DeviceError::NoDoublePrecision { .. }),
        )) => {
            assert!(!is_required(), "{error}");
            None
        }
        Err(error) => panic!("{error}"),
    };
    let opened = opened.get_or_init(open).as_ref();
    if opened.is_none() {
        print_skipped();
    }
    opened
}

/// Prints the name of the running test, and that it is skipped for want of a GPU.
///
/// It writes to the error stream directly, because the test harness hides what tests that pass
/// print.
pub fn print_skipped() {
    let thread = std::thread::current();
    let test = thread.name().unwrap_or("a test");
    // A closed error stream fails no test.
    let _ = writeln!(std::io::stderr(), "{test}: skipped, because this machine has no GPU");
}

/// Returns the search on the GPU, for queries of any size; `None` if there is no GPU and none is
/// required.
pub fn search(mesh: &TriMesh) -> Option<GpuSearch> {
    let mut search = GpuSearch::on(open(Precision::F32)?, mesh).expect("a mesh for the GPU");
    search.set_min_links(Some(0));
    Some(search)
}

pub fn is_required() -> bool {
    std::env::var_os("PARRY_CONTINUUM_REQUIRE_GPU").is_some()
}
