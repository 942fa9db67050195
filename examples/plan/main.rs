//! Plans the way of a concentric tube robot into a brain ventricle, every moment of it proven.
//!
//! `cargo run --example plan` grows a ventricle and looks for a way from the burr hole
//! through the foramen of Monro into the third ventricle, in the space of the robot's joints. The
//! ventricle has a vein with a margin of its own, and an endoscope that rests. Whether an edge
//! keeps all margins is proven by one call, `Scene::clears_motion`; the same planner is then run
//! with edges that are checked by steps, and what these accept is looked at again. `--picture`
//! draws the shapes of the way, `--clearance` how near it comes to the wall over time. `--mesh`
//! takes real anatomy instead (in millimetres, or with `--scale`); `--base` and `--axis` place the
//! robot in it.

mod draw;
mod edges;
mod others;
mod over_time;
mod planner;

use clap::Parser;
use continuum_demo::anatomy::{Anatomy, no_goal};
use continuum_demo::canvas::Canvas;
use continuum_demo::ctr::{Robot, three_tubes};
use continuum_demo::{command, steer, ventricle};
use edges::{Check, Costs, DRAWN_IN, Edges, Place, Resting, place, text};
use over_time::OverTime;
use parry_continuum::parry::math::{Pose, Real};
use parry_continuum::proximity::{BvhSearch, Decision, Scene};
use planner::{MOST_EDGES, Plan, plan, shorten};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Plan the way of a concentric tube robot into a brain ventricle, every moment of it proven.
#[derive(Parser)]
struct Options {
    #[command(flatten)]
    anatomy: Anatomy,

    /// The room that the robot keeps from the wall, in millimetres
    #[arg(long, value_name = "MM", default_value_t = 0.5, value_parser = command::length, allow_negative_numbers = true)]
    margin: Real,

    /// The room that the robot keeps from the vein in the generated ventricle, in millimetres
    #[arg(long, value_name = "MM", default_value_t = 1.0, value_parser = command::length, allow_negative_numbers = true)]
    vein: Real,

    /// The seed of the random numbers
    #[arg(long, value_name = "NUMBER", default_value_t = 1)]
    seed: u64,

    /// How many plans to make in each way, with other random numbers each; the first is shown
    #[arg(long, value_name = "COUNT", default_value_t = 100, value_parser = command::whole(1..=10_000))]
    plans: u32,

    /// Draw the shapes of the way into this file, or as plan.png into this directory
    #[arg(long, value_name = "PATH")]
    picture: Option<PathBuf>,

    /// Draw how near the way comes to the wall over time into this file, or as clearance.png into
    /// this directory
    #[arg(long, value_name = "PATH")]
    clearance: Option<PathBuf>,
}

fn main() -> ExitCode {
    command::run(run)
}

fn run(options: &Options) -> Result<(), String> {
    let mesh = options.anatomy.load()?;
    let mut search = BvhSearch::new(&mesh).map_err(text)?;
    let file = |path: &Option<PathBuf>, name: &str| {
        path.as_ref().map(|path| command::picture_path(path, name)).transpose()
    };
    let picture = file(&options.picture, "plan.png")?;
    let clearance = file(&options.clearance, "clearance.png")?;
    let robot = three_tubes();
    let base = options.anatomy.pose(&mesh)?;
    let goal = if options.anatomy.is_planned() {
        ventricle::goal()
    } else {
        steer::find_goal(&robot, &mut search, &base).map_err(|none| no_goal(&none, &base))?
    };
    let goal = place(&goal);
    let ends = [DRAWN_IN, goal];
    let mut scene = others::scene(&search, options.margin)?;
    let mut endoscope = None;
    if options.anatomy.is_planned() {
        others::add_vein(&mut scene, options.vein)?;
        endoscope = Some(others::endoscope()?);
    }
    let all = Obstacles { search: &search, scene: &scene, other: endoscope.as_ref() };
    check_ends(options, &robot, &base, &all, &ends)?;

    println!(
        "edges by         drawn   clear    edges  accepted  shapes an edge  kinematics  queries  a plan  touch  failed"
    );
    let mut proven = None;
    for check in [Check::Proof, Check::Steps(0.5), Check::Steps(0.1)] {
        let mut edges = new_edges(options, &robot, &base, &all, check);
        let bar = command::progress(options.plans, "plans")?;
        let mut sums = Sums::default();
        for number in 0..u64::from(options.plans) {
            let found = plan(&mut edges, ends, options.seed.wrapping_add(number))?;
            bar.set_message(format!("{} edges", edges.costs.edges));
            bar.inc(1);
            sums.add(&found, touching(&mut edges, &found.accepted)?);
            if check == Check::Proof {
                proven = proven.or(found.path);
            }
        }
        bar.finish_and_clear();
        sums.print(check, options.plans, &edges.costs);
    }
    let path = proven.ok_or(format!(
        "no way found with {MOST_EDGES} edges that keeps {} mm; try another --seed or a smaller --margin",
        options.margin
    ))?;

    let mut edges = new_edges(options, &robot, &base, &all, Check::Proof);
    let found = path.len() - 1;
    let path = shorten(&mut edges, path, options.seed)?;
    let costs = std::mem::take(&mut edges.costs);
    for pair in path.windows(2) {
        if !edges.is_clear(&pair[0], &pair[1])? {
            return Err(
                "a shortened edge is not clear; please report it with the command that you ran"
                    .into(),
            );
        }
    }
    println!(
        "\nthe way: {found} edges, {} after {} shortcuts were tried; it keeps {} mm, which {} shapes prove",
        path.len() - 1,
        costs.edges,
        options.margin,
        edges.costs.shapes
    );
    if endoscope.is_some() {
        println!(
            "it also keeps {} mm from the vein, and {} mm from the endoscope",
            options.vein, options.margin
        );
    }
    if let Some(file) = picture {
        save(&draw::draw(&mesh, &options.anatomy.name(), &mut edges, &path)?, &file, "--picture")?;
    }
    if let Some(file) = clearance {
        let found = OverTime::new(&mut edges, &path)?;
        let [proven, seen] = found.least();
        println!(
            "no shape of the way is nearer than {proven:.3} mm; steps of 0.5 mm come to {seen:.3} mm"
        );
        save(&found.draw(options.margin), &file, "--clearance")?;
    }
    Ok(())
}

/// # Errors
/// The file cannot be written; `option` chooses another.
fn save(canvas: &Canvas, file: &Path, option: &str) -> Result<(), String> {
    canvas.save(file).map_err(|error| {
        format!("cannot write {} ({error}); choose another {option}", file.display())
    })?;
    println!("picture: {}", file.display());
    Ok(())
}

/// What the robot keeps away from.
struct Obstacles<'a> {
    search: &'a BvhSearch,
    scene: &'a Scene,
    other: Option<&'a Resting>,
}

fn new_edges<'a>(
    options: &Options,
    robot: &'a Robot,
    base: &Pose,
    all: &Obstacles<'a>,
    check: Check,
) -> Edges<'a> {
    Edges {
        robot,
        base: *base,
        margin: options.margin,
        check,
        search: all.search.clone(),
        scene: all.scene.clone(),
        other: all.other,
        costs: Costs::default(),
    }
}

/// # Errors
/// The robot does not keep the margin where it starts, or where it shall go.
fn check_ends(
    options: &Options,
    robot: &Robot,
    base: &Pose,
    all: &Obstacles,
    ends: &[Place; 2],
) -> Result<(), String> {
    let mut edges = new_edges(options, robot, base, all, Check::Proof);
    for (end, name) in ends.iter().zip(["at its base", "at its goal"]) {
        if edges.clear_places(vec![*end])?.is_empty() {
            return Err(format!(
                "the robot does not keep {} mm {name}; try a smaller --margin, or move it with --base and --axis",
                options.margin
            ));
        }
    }
    Ok(())
}

/// How many edges violate a margin.
fn touching(edges: &mut Edges, accepted: &[[Place; 2]]) -> Result<usize, String> {
    let mut count = 0;
    for [from, to] in accepted {
        let motion = edges.motion(from, to)?;
        count += usize::from(edges.decide(&motion)? == Decision::Contact);
    }
    Ok(count)
}

/// What all plans of a check come to.
#[derive(Default)]
struct Sums {
    drawn: usize,
    clear: usize,
    accepted: usize,
    touch: usize,
    failed: usize,
}

impl Sums {
    fn add(&mut self, found: &Plan, touch: usize) {
        self.drawn += found.drawn;
        self.clear += found.clear;
        self.accepted += found.accepted.len();
        self.touch += touch;
        self.failed += usize::from(found.path.is_none());
    }

    fn print(&self, check: Check, plans: u32, costs: &Costs) {
        let name = match check {
            Check::Proof => "proof".into(),
            Check::Steps(step) => format!("steps of {step} mm"),
        };
        let seconds = costs.all.as_secs_f64();
        let kinematics = 100.0 * costs.kinematics.as_secs_f64() / seconds;
        println!(
            "{name:<15} {:6} {:7} {:8} {:9} {:15.1} {kinematics:9.0} % {:6.0} % {:4.1} ms {:6} {:7}",
            self.drawn,
            self.clear,
            costs.edges,
            self.accepted,
            costs.shapes as f64 / costs.edges as f64,
            100.0 - kinematics,
            1e3 * seconds / f64::from(plans),
            self.touch,
            self.failed
        );
    }
}
