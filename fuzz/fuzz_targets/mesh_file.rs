#![no_main]

#[path = "../bodies/mod.rs"]
mod bodies;
#[path = "../../examples/scene"]
mod scene {
    #![allow(dead_code, reason = "only files are read here")]
    pub mod mesh_file;
    pub mod surface;
}

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| bodies::mesh_file(bytes));
