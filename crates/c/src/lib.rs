//! The C interface of parry-continuum. `include/parry_continuum.h` is generated from these files.
//!
//! Each function converts its arguments, forwards to the library, and writes the answer.
//! The macro `border!` is the only way in: it checks pointers and lengths, and stops panics.
//! All `unsafe` blocks are in `border.rs`.

// Names as C has them; the header states the rules for pointers once, for all functions.
#![allow(non_camel_case_types, clippy::missing_safety_doc, clippy::too_many_arguments)]

#[macro_use]
mod border;
mod answers;
mod error;
mod mesh;
mod motion;
mod pair;
mod robot;
mod scene;
mod structure_end;

pub use answers::*;
pub use error::*;
pub use mesh::*;
pub use motion::*;
pub use pair::*;
pub use robot::*;
pub use scene::*;
pub use structure_end::*;

/// What the header says about threads: handles move from one to another, and several may read one.
const _: () = {
    const fn is_sound<T: Send + Sync>() {}
    is_sound::<pc_mesh>();
    is_sound::<pc_chain>();
    is_sound::<pc_tube>();
    is_sound::<pc_motion>();
    is_sound::<pc_pair>();
    is_sound::<pc_self_query>();
    is_sound::<pc_scene>();
};

/// The version of this interface. It grows whenever a program must be compiled again.
pub const PC_ABI_VERSION: u32 = 1;

/// Returns the `PC_ABI_VERSION` of the library that runs. Compare it with that of the header.
#[unsafe(no_mangle)]
pub extern "C" fn pc_abi_version() -> u32 {
    PC_ABI_VERSION
}

/// Returns the version of the library, such as "0.1.0".
#[unsafe(no_mangle)]
pub extern "C" fn pc_version() -> *const std::ffi::c_char {
    concat!(env!("CARGO_PKG_VERSION"), "\0").as_ptr().cast()
}
