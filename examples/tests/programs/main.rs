//! The example programs as a user meets them: bad input gives one line and an error code, good
//! input a picture.

mod all;

use continuum_programs::{self as programs, example};

/// The output of an example that succeeds.
fn succeed(name: &str, arguments: &[&str]) -> String {
    programs::succeed(example(name), arguments)
}

/// An example must refuse these arguments with one line that says this.
fn refuse(name: &str, arguments: &[&str], expected: &str) {
    programs::refuse(example(name), arguments, expected);
}
