//! The command as a user meets it: answers that one can see, files, exit statuses, and errors of
//! one line in the words of the options.

mod answers;
mod files;
mod labels;
mod margin;
mod mistakes;
mod openings;
mod readme;

use continuum_programs as programs;

const COMMAND: &str = env!("CARGO_BIN_EXE_clearance");

/// The output of a command that succeeds.
fn succeed(arguments: &[&str]) -> String {
    programs::succeed(COMMAND, arguments)
}

/// The command must refuse these arguments with one line that contains `expected`, and status 2.
fn refuse(arguments: &[&str], expected: &str) {
    assert_eq!(programs::refuse(COMMAND, arguments, expected), Some(2), "{arguments:?}");
}

/// The exit status, the output and the errors of a command.
fn run(arguments: &[&str]) -> (Option<i32>, String, String) {
    programs::run(COMMAND, arguments)
}

/// What is printed as a warning.
fn warnings(error: &str) -> Vec<&str> {
    error.lines().filter_map(|line| line.strip_prefix("warning: ")).collect()
}

/// The least distance in the last line.
fn minimum(arguments: &[&str]) -> f64 {
    let out = succeed(arguments);
    let last = out.lines().last().and_then(|line| line.strip_prefix("minimum "));
    let number = last.and_then(|line| line.split([' ', ':']).next());
    number.unwrap_or_else(|| panic!("{out}")).parse().unwrap()
}
