//! Shared by the example programs: errors of one line, numbers, progress, and paths of pictures.

use clap::Parser;
use indicatif::{ProgressBar, ProgressStyle};
use std::fs;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

/// Runs a program on its options. Help goes to standard output; an error is one line on standard
/// error and a non-zero exit.
pub fn run<Options: Parser>(program: impl Fn(&Options) -> Result<(), String>) -> ExitCode {
    let options = match Options::try_parse() {
        Ok(options) => options,
        Err(error) if !error.use_stderr() => {
            print!("{error}");
            return ExitCode::SUCCESS;
        }
        Err(error) => {
            eprintln!("{} (--help lists the options)", in_one_line(&error.to_string()));
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

/// An error of clap: its first paragraph names the option and what is wrong with it, and a tip may
/// name the option that was meant.
fn in_one_line(text: &str) -> String {
    let mut lines = text.lines().map(str::trim);
    let paragraph: Vec<_> = lines.by_ref().take_while(|line| !line.is_empty()).collect();
    let tip = lines.find_map(|line| line.strip_prefix("tip: ")).map(|tip| format!("; {tip}"));
    paragraph.join(" ") + &tip.unwrap_or_default()
}

/// Reads a whole number in a range.
pub fn whole(
    range: RangeInclusive<u32>,
) -> impl Fn(&str) -> Result<u32, String> + Clone + Send + Sync {
    move |text| {
        let number = text.parse().ok().filter(|number| range.contains(number));
        number.ok_or_else(|| match (range.start(), *range.end()) {
            (start, u32::MAX) => format!("write a whole number of at least {start}"),
            (start, end) => format!("write a whole number from {start} to {end}"),
        })
    }
}

/// Reads a length of at least 0.
pub fn length(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(length) if length >= 0.0 && f64::is_finite(length) => Ok(length),
        _ => Err("write a length of at least 0, for example 0.5".into()),
    }
}

/// A bar that shows how many of `count` things are done, with room for a message before it. It
/// shows on a terminal alone.
///
/// # Errors
/// The name of the things cannot be a part of the bar.
pub fn progress(count: u32, things: &str) -> Result<ProgressBar, String> {
    let template = format!("{{msg:>30}} {{wide_bar}} {{pos}} of {{len}} {things}");
    let style = ProgressStyle::with_template(&template).map_err(|error| error.to_string())?;
    Ok(ProgressBar::new(count.into()).with_style(style.progress_chars("━╸ ")))
}

/// The stage of a program that takes minutes.
pub struct Stages(Instant);

impl Stages {
    pub fn begin() -> Self {
        Self(Instant::now())
    }

    /// Prints the next stage and the elapsed seconds on the standard error.
    pub fn next(&self, name: &str) {
        eprintln!("{:5.0} s  {name}", self.0.elapsed().as_secs_f64());
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

/// The file that `--out` means: itself if it ends in .png, otherwise `name` in that directory,
/// which is made. Call it before the work: it tries whether the file can be written.
///
/// # Errors
/// The path ends in another extension and is no directory, or nothing can be written there.
pub fn picture_path(out: &Path, name: &str) -> Result<PathBuf, String> {
    let is_file = out.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png"));
    let path = match (is_file, out.parent()) {
        (true, Some(parent)) => {
            make(parent)?;
            out.to_path_buf()
        }
        _ => directory(out)?.join(name),
    };
    let existed = path.exists();
    let tried = fs::OpenOptions::new().append(true).create(true).open(&path);
    tried.map_err(|error| unwritable(&path, error))?;
    if !existed {
        fs::remove_file(&path).map_err(|error| unwritable(&path, error))?;
    }
    Ok(path)
}

/// The directory that `--out` means, made where it is missing.
///
/// # Errors
/// It has a file's name and is not there, or it cannot be made.
pub fn directory(out: &Path) -> Result<&Path, String> {
    if let Some(extension) = out.extension().filter(|_| !out.is_dir()) {
        return Err(format!(
            "{} would be a directory, though it ends in .{}; pictures are saved as .png, tables beside them: choose \
             another --out",
            out.display(),
            extension.display()
        ));
    }
    make(out)?;
    Ok(out)
}

fn make(directory: &Path) -> Result<(), String> {
    fs::create_dir_all(directory).map_err(|error| {
        format!("cannot make {} ({error}); choose another --out", directory.display())
    })
}

/// What to say when a file of `--out` cannot be written.
pub fn unwritable(path: &Path, error: impl std::fmt::Display) -> String {
    format!("cannot write {} ({error}); choose another --out", path.display())
}
