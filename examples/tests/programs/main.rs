//! The example programs as a user meets them: bad input gives one line and an error code, good
//! input a picture.

mod all;

use continuum_testing::programs;
use std::path::PathBuf;

/// An example program, which is built first: in the workspace's root, as these tests are.
fn example(name: &str) -> PathBuf {
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/..");
    programs::example(root, name, if cfg!(feature = "gpu") { "gpu" } else { "" })
}

/// The output of an example that succeeds.
fn succeed(name: &str, arguments: &[&str]) -> String {
    programs::succeed(example(name), arguments)
}

/// An example must refuse these arguments with one line that says this.
fn refuse(name: &str, arguments: &[&str], expected: &str) {
    programs::refuse(example(name), arguments, expected);
}
