//! Compares designs of a tendon robot for a brain ventricle: how much of it can the tip reach?
//!
//! `cargo run --example design` draws random shapes of each design, decides which keep a
//! margin from the wall, and counts the cubes of 1 mm that hold their tips. With `--features gpu`
//! and `--engine gpu` the GPU computes and decides the shapes, for studies of
//! `--shapes 100000000`.

use clap::{Parser, ValueEnum};
use continuum_demo::anatomy::Anatomy;
use continuum_demo::command;
use continuum_demo::steer::Random;
#[cfg(feature = "gpu")]
use parry_continuum::gpu::GpuSearch;
use parry_continuum::parry::bounding_volume::Aabb;
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{BvhSearch, ProximityError};
use parry_continuum::{BendingSection, ConstantCurvature};
use rayon::prelude::*;
use std::f64::consts::TAU;
use std::process::ExitCode;
use std::time::{Duration, Instant};

/// Compare designs of a tendon robot: the part of the anatomy that its tip can reach.
#[derive(Parser)]
struct Options {
    #[command(flatten)]
    anatomy: Anatomy,

    /// How many shapes of each design are tried
    #[arg(long, value_name = "COUNT", default_value_t = 100_000, value_parser = command::whole(1..=u32::MAX))]
    shapes: u32,

    /// How far the robot must stay from the wall, in millimetres
    #[arg(long, value_name = "MM", default_value_t = 0.5, value_parser = command::length, allow_negative_numbers = true)]
    margin: Real,

    /// How many links a section has
    #[arg(long, value_name = "COUNT", default_value_t = 10, value_parser = command::whole(1..=1000))]
    links: u32,

    /// Where the shapes are decided (the GPU: cargo feature `gpu`)
    #[arg(long, value_enum, default_value_t = Engine::Cpu)]
    engine: Engine,
}

#[derive(Clone, Copy, ValueEnum)]
enum Engine {
    Cpu,
    Gpu,
}

/// The sections of a robot, base to tip.
type Sections = [BendingSection; 3];

/// Lengths and radii of the sections, in millimetres.
struct Design {
    name: &'static str,
    lengths: [Real; 3],
    radii: [Real; 3],
}

const DESIGNS: [Design; 4] = [
    Design { name: "even", lengths: [15.0, 15.0, 15.0], radii: [1.2, 1.0, 0.8] },
    Design { name: "long base", lengths: [25.0, 12.0, 8.0], radii: [1.2, 1.0, 0.8] },
    Design { name: "long tip", lengths: [8.0, 12.0, 25.0], radii: [1.2, 1.0, 0.8] },
    Design { name: "slender", lengths: [15.0, 15.0, 15.0], radii: [0.9, 0.7, 0.5] },
];

/// The largest curvature of a section, 1 / mm.
const MOST_CURVED: Real = 0.06;
/// Shapes that are decided at once.
const BATCH: usize = 1 << 19;
/// Shapes that one task draws.
const TASK: usize = 1 << 12;

fn main() -> ExitCode {
    command::run(compare)
}

fn text(error: impl std::fmt::Display) -> String {
    error.to_string()
}

/// A search on the CPU or on the GPU.
enum Search {
    Cpu(Box<BvhSearch>),
    #[cfg(feature = "gpu")]
    Gpu(Box<GpuSearch>),
}

impl Search {
    fn build(engine: Engine, mesh: &TriMesh) -> Result<Self, String> {
        match engine {
            Engine::Cpu => {
                let search = BvhSearch::new(mesh).map_err(text)?;
                search.prepare();
                Ok(Self::Cpu(Box::new(search)))
            }
            #[cfg(feature = "gpu")]
            Engine::Gpu => {
                let search = GpuSearch::new(mesh).map_err(text)?;
                println!("on the GPU: {}", search.adapter());
                Ok(Self::Gpu(Box::new(search)))
            }
            #[cfg(not(feature = "gpu"))]
            Engine::Gpu => Err("this program was built without the GPU; run \
                                `cargo run --features gpu --example design -- --engine gpu`"
                .into()),
        }
    }

    fn decide(
        &mut self,
        options: &Options,
        robots: &[Sections],
        base: &Pose,
        clear: &mut Vec<Result<bool, ProximityError>>,
    ) -> Result<(), String> {
        let (links, margin) = (options.links as usize, options.margin);
        match self {
            Self::Cpu(search) => search.clears_sections_batch(robots, links, base, margin, clear),
            #[cfg(feature = "gpu")]
            Self::Gpu(search) => search.clears_sections_batch(robots, links, base, margin, clear),
        }
        .map_err(text)
    }
}

fn compare(options: &Options) -> Result<(), String> {
    let mesh = options.anatomy.load()?;
    let base = options.anatomy.pose(&mesh)?;
    let mut search = Search::build(options.engine, &mesh)?;
    println!(
        "| design | lengths, mm | radii, mm | shapes that keep {} mm | the tip reaches | decisions |",
        options.margin
    );
    println!("|---|---|---|---|---|---|");
    for (number, design) in (0..).zip(&DESIGNS) {
        let bar = command::progress(options.shapes, "shapes")?;
        let (mut reached, mut kept) = (Cubes::new(mesh.local_aabb()), 0_u64);
        let (mut clear, mut deciding) = (Vec::new(), Duration::ZERO);
        let mut done = 0;
        while done < options.shapes as usize {
            let count = BATCH.min(options.shapes as usize - done);
            let robots = draw(design, number << 40 | done as u64, count);
            let begin = Instant::now();
            search.decide(options, &robots, &base, &mut clear)?;
            deciding += begin.elapsed();
            let tips: Vec<_> = robots
                .par_iter()
                .zip(&clear)
                .map(|(robot, clear)| match clear {
                    Ok(true) => tip(robot, &base).map(Some),
                    Ok(false) => Ok(None),
                    Err(error) => Err(text(error)),
                })
                .collect::<Result<_, _>>()?;
            for tip in tips.into_iter().flatten() {
                kept += 1;
                reached.add(tip);
            }
            done += count;
            bar.inc(count as u64);
        }
        bar.finish_and_clear();
        println!(
            "| {} | {} | {} | {:.2} % | {:.2} cm3 | {:.2} million a second |",
            design.name,
            list(design.lengths),
            list(design.radii),
            100.0 * kept as Real / Real::from(options.shapes),
            reached.count() as Real / 1000.0,
            Real::from(options.shapes) / 1e6 / deciding.as_secs_f64()
        );
    }
    Ok(())
}

fn list(numbers: [Real; 3]) -> String {
    numbers.map(|number| number.to_string()).join(", ")
}

/// Random shapes of a design: every bend that the sections can take, with 10 % to all of each
/// section's length.
fn draw(design: &Design, seed: u64, count: usize) -> Vec<Sections> {
    let task = |task: usize| {
        let mut random = Random(seed + (task * TASK) as u64);
        let shapes = TASK.min(count - task * TASK);
        (0..shapes).map(move |_| shape(design, &mut random)).collect::<Vec<_>>()
    };
    (0..count.div_ceil(TASK)).into_par_iter().flat_map_iter(task).collect()
}

fn shape(design: &Design, random: &mut Random) -> Sections {
    [0, 1, 2].map(|section| {
        let length = design.lengths[section] * (0.1 + 0.9 * random.share());
        // Even over the disc of all bends.
        let (curvature, angle) = (MOST_CURVED * random.share().sqrt(), TAU * random.share());
        let bend = [curvature * angle.cos(), curvature * angle.sin()];
        BendingSection { length, radius: design.radii[section], bend }
    })
}

/// The tip of a robot in the frame of the anatomy.
fn tip(robot: &Sections, base: &Pose) -> Result<Vector, String> {
    let robot = ConstantCurvature::new(robot).map_err(text)?;
    Ok(*base * robot.frame(robot.length()).translation)
}

/// The cubes of 1 mm in a box, and which are reached.
struct Cubes {
    low: Vector,
    sizes: [usize; 3],
    is_reached: Vec<bool>,
}

impl Cubes {
    fn new(bounds: Aabb) -> Self {
        let sizes = bounds.extents().to_array().map(|extent| extent.ceil() as usize + 1);
        Self { low: bounds.mins, sizes, is_reached: vec![false; sizes.iter().product()] }
    }

    /// A tip outside the box is in no cube.
    fn add(&mut self, point: Vector) {
        let [x, y, z] = (point - self.low).to_array();
        let [width, depth, height] = self.sizes.map(|size| size as Real);
        let is_inside = [(x, width), (y, depth), (z, height)]
            .into_iter()
            .all(|(place, size)| (0.0..size).contains(&place));
        if is_inside {
            let place = (z as usize * self.sizes[1] + y as usize) * self.sizes[0] + x as usize;
            self.is_reached[place] = true;
        }
    }

    fn count(&self) -> usize {
        self.is_reached.iter().filter(|&&is_reached| is_reached).count()
    }
}
