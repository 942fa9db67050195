//! What the example programs share as commands: errors of one line, and where pictures go.

use clap::Parser;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Runs a program on its options. Help goes to standard output; an error is one line on standard error and a
/// non-zero exit.
pub fn run<Options: Parser>(program: impl Fn(&Options) -> Result<(), String>) -> ExitCode {
    let options = match Options::try_parse() {
        Ok(options) => options,
        Err(error) if !error.use_stderr() => {
            print!("{error}");
            return ExitCode::SUCCESS;
        }
        Err(error) => {
            // The first paragraph names the option and what is wrong with it.
            let text = error.to_string();
            let lines: Vec<_> = text.lines().take_while(|line| !line.is_empty()).map(str::trim).collect();
            eprintln!("{} (--help lists the options)", lines.join(" "));
            return ExitCode::from(2);
        }
    };
    match program(&options) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("error: {message}");
            ExitCode::FAILURE
        }
    }
}

/// The command that runs this program as it was run; `program` is how cargo finds it.
pub fn line(program: &str) -> String {
    let mut line = format!("cargo run --release {program}");
    for (index, word) in std::env::args().skip(1).enumerate() {
        line += if index == 0 { " -- " } else { " " };
        line += &word;
    }
    line
}

/// The file that `--out` means: itself if it ends in .png, otherwise `name` in that directory, which is made.
///
/// # Errors
/// The directory cannot be made.
pub fn picture_path(out: &Path, name: &str) -> Result<PathBuf, String> {
    let is_file = out.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png"));
    let path = if is_file { out.to_path_buf() } else { out.join(name) };
    if let Some(directory) = path.parent() {
        std::fs::create_dir_all(directory).map_err(|error| {
            format!("cannot make {} ({error}); choose another --out", directory.display())
        })?;
    }
    Ok(path)
}
