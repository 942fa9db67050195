//! How fast on the GPU: batches, moving anatomy and single queries against the engines on the CPU,
//! exhaustive and by search.
//! Writes `docs/GPU_SPEED.md`. The paper's Figure 9 and Tables II to V on the GPU go to
//! `docs/internals/gpu_studies.md`, unless `--without-studies` leaves them out.
//!
//! ```text
//! cargo run --release -p continuum-studies --features gpu --bin gpu_speed -- --tflops 66.9,33.5
//! ```
//!
//! The program needs nothing but itself: built here, it can be carried to the machine with the GPU.
//! It writes each chapter as soon as it is measured. Meshes grow to ten million triangles, which
//! takes minutes and 16 GB; `--largest 100000 --robots 10000` is a rehearsal.

mod chains;
mod engines;
mod forms;
mod meshes;
mod moving;
mod roots;
mod search;
mod sections;
mod timed;

use clap::Parser;
use continuum_demo::command;
use continuum_studies::models::models;
use parry_continuum::gpu::{DeviceError, Gpu, GpuError, Precision};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::{Duration, Instant};

#[derive(Parser)]
struct Options {
    /// Where to write GPU_SPEED.md and, below internals, gpu_studies.md with its long tables
    #[arg(long, value_name = "DIRECTORY", default_value = "docs")]
    out: PathBuf,

    /// Triangles of the largest mesh
    #[arg(long, value_name = "COUNT", default_value_t = 10_000_000, value_parser = command::whole(1000..=20_000_000))]
    largest: u32,

    /// Triangles of the largest mesh whose every pair is computed in full
    #[arg(long, value_name = "COUNT", default_value_t = 1_000_000)]
    every_pair: u32,

    /// Robots of the largest batch, on the mesh of 82,000 triangles; the others take up to 100,000
    #[arg(long, value_name = "COUNT", default_value_t = 1_000_000, value_parser = command::whole(1..=10_000_000))]
    robots: u32,

    /// Polynomials of each degree, and problems of Tables II and III
    #[arg(long, value_name = "COUNT", default_value_t = 1_000_000, value_parser = command::whole(1..=10_000_000))]
    problems: u32,

    /// Leave out the paper's studies
    #[arg(long)]
    without_studies: bool,

    /// Seconds for each group of jobs that take turns
    #[arg(long, value_name = "SECONDS", default_value_t = 1.0)]
    enough: f64,

    /// The GPU's peak in single and double precision, for the paper's index: 1 / (seconds x
    /// TFLOPS)
    #[arg(long, value_name = "F32,F64", value_parser = peaks)]
    tflops: Option<[f64; 2]>,
}

fn peaks(text: &str) -> Result<[f64; 2], String> {
    let numbers: Result<Vec<f64>, _> =
        text.split(',').map(|number| number.trim().parse()).collect();
    match numbers.as_deref() {
        Ok(&[single, double]) if single > 0.0 && double > 0.0 => Ok([single, double]),
        _ => Err("write two numbers, for example 66.9,33.5".into()),
    }
}

/// A precision of the GPU, with its name.
pub struct Opened {
    pub name: &'static str,
    pub gpu: Gpu,
    pub tflops: Option<f64>,
}

fn main() -> ExitCode {
    command::run(measure)
}

fn measure(options: &Options) -> Result<(), String> {
    command::directory(&options.out)?;
    let begin = Instant::now();
    let mut opened = Vec::new();
    let mut missing = None;
    for (place, (name, precision)) in
        [("f32", Precision::F32), ("f64", Precision::F64)].into_iter().enumerate()
    {
        match Gpu::open(precision) {
            Ok(gpu) => {
                opened.push(Opened { name, gpu, tflops: options.tflops.map(|peaks| peaks[place]) })
            }
            // Single precision alone is worth measuring.
            Err(GpuError::Device(
                error @ (DeviceError::NoDoublePrecision { .. }
                | DeviceError::WrongArithmetic { .. }),
            )) if !opened.is_empty() => {
                missing = Some(error.to_string());
            }
            Err(error) => return Err(error.to_string()),
        }
    }
    let path = options.out.join("GPU_SPEED.md");
    if opened[0].gpu.adapter().is_software && path.exists() {
        return Err(format!(
            "{} is a GPU in software; {} keeps what a real one did. For a rehearsal choose another --out",
            opened[0].gpu.adapter(),
            path.display()
        ));
    }
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let adapter = opened[0].gpu.adapter();
    let command = command::line("-p continuum-studies --features gpu --bin gpu_speed");
    let written = format!(
        "Written by `{command}` on {adapter}; the engines on the \
         CPU beside it ran on {cores} cores. Times are medians. Jobs that are compared take turns in one run; before that they \
         run as long untimed, because a GPU at rest starts slowly."
    );
    let mut remarks = String::new();
    if adapter.is_software {
        remarks.push_str("\nThis is a GPU in software: its times tell nothing of a GPU.\n");
    }
    if let Some(missing) = missing {
        remarks.push_str(&format!("\n{missing}.\n"));
    }
    let enough = Duration::from_secs_f64(options.enough.clamp(0.0, 60.0));
    let add = |page: &mut Page, name: &str, chapter: String| {
        println!("{:6.1} s: {name}", begin.elapsed().as_secs_f64());
        page.add(&chapter)
    };
    let mut defects = Vec::new();
    let mut page = Page::new(
        path,
        format!(
            "# Speed on the GPU\n\n\
             {written} A time is that of the whole call, with transfers and what the CPU measures again.\n{remarks}"
        ),
    );
    let robots = options.robots as usize;
    let search = search::chapter(&opened[0], options.largest, robots, enough, &mut defects)?;
    add(&mut page, "search", search)?;
    let sections = sections::chapter(&opened[0], options.largest, robots, enough, &mut defects)?;
    add(&mut page, "sections", sections)?;
    let meshes = meshes::meshes(options.largest)?;
    let models = models().map_err(text)?;
    let [_, (_, robot), _] = &models;
    add(&mut page, "moving", moving::chapter(&opened, &meshes, robot, enough)?)?;
    add(&mut page, "engines", engines::chapter(&opened, &meshes, robot, enough)?)?;
    println!("{}", page.path.display());
    if !options.without_studies {
        let internals = options.out.join("internals");
        let mut studies = Page::new(
            internals.join("gpu_studies.md"),
            format!(
                "# The paper's studies on the GPU\n\n\
                 {written} Device: the GPU's own clock, from the first kernel to the last. End to end: the whole call, with \
                 transfers and what the CPU measures again.\n{remarks}"
            ),
        );
        let chains =
            chains::chapter(&opened, &meshes, options.every_pair, &models, enough, &internals)?;
        add(&mut studies, "chains", chains)?;
        let problems = options.problems as usize;
        add(&mut studies, "forms", forms::chapter(&opened, problems, enough)?)?;
        add(&mut studies, "roots", roots::chapter(&opened, problems, enough / 4, &internals)?)?;
        println!("{}", studies.path.display());
    }
    match defects.as_slice() {
        [] => Ok(()),
        defects => Err(format!("the GPU's answers differ from the CPU's: {}", defects.join("; "))),
    }
}

/// A page that is written anew with each chapter, so that a failure loses only what comes after it.
struct Page {
    path: PathBuf,
    text: String,
}

impl Page {
    fn new(path: PathBuf, head: String) -> Self {
        Self { path, text: head }
    }

    fn add(&mut self, chapter: &str) -> Result<(), String> {
        self.text.push('\n');
        self.text.push_str(chapter);
        let directory = self.path.parent().unwrap_or(Path::new("."));
        let written =
            fs::create_dir_all(directory).and_then(|()| fs::write(&self.path, &self.text));
        written.map_err(|error| {
            format!("cannot write {} ({error}); choose another --out", self.path.display())
        })
    }
}

/// An error as a line.
pub fn text(error: impl std::fmt::Display) -> String {
    error.to_string()
}
