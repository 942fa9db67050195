//! Pushes an elastic concentric tube robot into a brain ventricle, in a rapier world.
//!
//! `cargo run --example rapier_ventricle` lets the three tubes come out along the planned
//! way into the third ventricle, then pushes the base on. Where the robot touches the wall, contact
//! forces bend it. At every step the crate's search finds the clearance of every link. Into
//! `target/rapier_ventricle` (or `--out`) go `steps.csv` and `links.csv` with clearances, forces
//! and the deviation from the kinematic shape, a film as numbered pictures, and a sheet of six
//! moments. Two runs give the same files. `--mesh` takes real anatomy instead (in millimetres, or
//! with `--scale`).

mod film;
mod plan;
mod record;
use clap::Parser;
use continuum_demo::anatomy::{Anatomy, no_goal};
use continuum_demo::ctr::three_tubes;
use continuum_demo::rod::{self, Rod};
use continuum_demo::{command, steer, ventricle};
use film::Studio;
use parry_continuum::Chain;
use parry_continuum::parry::math::{Pose, Real};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{BvhSearch, Proximity};
use plan::Plan;
use rapier3d_f64::prelude::{ColliderBuilder, PhysicsWorld, RigidBodyBuilder, TriMeshFlags};
use record::{Moment, Recorder};
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::{Duration, Instant};

/// Push an elastic concentric tube robot into a brain ventricle, in a rapier world.
#[derive(Parser)]
struct Options {
    #[command(flatten)]
    anatomy: Anatomy,

    /// How far the base is pushed on after the planned way, in millimetres
    #[arg(long, value_name = "MM", default_value_t = 3.5, value_parser = distance)]
    push: Real,

    /// About how many links the robot has
    #[arg(long, value_name = "COUNT", default_value_t = 20, value_parser = command::whole(3..=60))]
    links: u32,

    /// About how many pictures the film has; 0 for none
    #[arg(long, value_name = "COUNT", default_value_t = 40, value_parser = command::whole(0..=10_000))]
    frames: u32,

    /// The directory for everything that is written
    #[arg(long, value_name = "DIRECTORY", default_value = "target/rapier_ventricle")]
    out: PathBuf,
}

fn distance(text: &str) -> Result<Real, String> {
    match text.parse() {
        Ok(length) if (0.0..=100.0).contains(&length) => Ok(length),
        _ => Err("write a length from 0 to 100, for example 5".into()),
    }
}

fn main() -> ExitCode {
    command::run(simulate)
}

fn text(error: impl std::fmt::Display) -> String {
    error.to_string()
}

fn simulate(options: &Options) -> Result<(), String> {
    let cannot = |error| command::unwritable(&options.out, error);
    let mut recorder = Recorder::new(command::directory(&options.out)?).map_err(cannot)?;
    let mesh = options.anatomy.load()?;
    let mut search = BvhSearch::new(&mesh).map_err(text)?;
    let plan = plan(options, &mesh, &mut search)?;

    let thick = plan.robot.sections.iter().map(|section| section.radius).fold(0.0, Real::max);
    let end = plan.at(plan.duration());
    let places = [plan.entry, plan.base(end)]
        .map(|base| plan.shape(end).points.iter().map(|p| base * p).collect());
    let studio = Studio::new(&mesh, &places.map(|places: Vec<_>| places).concat(), thick);

    let mut world = world_around(&mesh, 2.0 * thick)?;
    let mut rod = Rod::new(&mut world, plan.entry);
    let steps = (plan.duration() / world.integration_parameters.dt).round() as usize;
    let picture_every = steps.div_ceil(options.frames.max(40) as usize);
    let (mut clocks, mut film, mut best) = (Clocks::default(), Vec::new(), Summary::default());
    let bar = command::progress(steps as u32, "steps")?;
    for step in 1..=steps {
        let time = step as Real * world.integration_parameters.dt;
        let moment = advance(&mut world, &mut rod, &plan, &mut search, time, &mut clocks)?;
        recorder.write(step, &moment).map_err(cannot)?;
        best.take_note(&moment);
        bar.inc(1);
        if step % picture_every == 0 || step == steps {
            film.push(moment);
        }
    }
    bar.finish_and_clear();
    recorder.finish().map_err(cannot)?;
    best.print(steps, &plan);
    clocks.print();

    // A sheet needs at least 40 moments to choose from, however few pictures are wanted.
    if let Some(every) = film.len().checked_div(options.frames as usize) {
        for (k, moment) in film.iter().step_by(every.max(1)).enumerate() {
            let path = options.out.join(format!("frame_{k:03}.png"));
            studio.frame(moment).save(&path).map_err(cannot)?;
        }
    }
    studio.sheet(&six(film, &plan)).save(&options.out.join("sheet.png")).map_err(cannot)?;
    println!("tables and pictures: {}", options.out.display());
    Ok(())
}

/// Where the robot starts and where its tubes go.
fn plan(options: &Options, mesh: &TriMesh, search: &mut BvhSearch) -> Result<Plan, String> {
    let robot = three_tubes();
    let entry = options.anatomy.pose(mesh)?;
    let goal = if options.anatomy.is_planned() {
        ventricle::goal()
    } else {
        steer::find_goal(&robot, search, &entry).map_err(|none| no_goal(&none, &entry))?
    };
    Ok(Plan::new(robot, goal, entry, options.push, options.links as usize))
}

/// The wall as a fixed body. The robot is inside it, so its inner edges are two-sided.
fn world_around(mesh: &TriMesh, size: Real) -> Result<PhysicsWorld, String> {
    let mut world = rod::world(size).map_err(text)?;
    let (vertices, triangles) = (mesh.vertices().to_vec(), mesh.indices().to_vec());
    let flags = TriMeshFlags::FIX_INTERNAL_EDGES_TWO_SIDED;
    let wall = ColliderBuilder::trimesh_with_flags(vertices, triangles, flags).map_err(text)?;
    world.insert(RigidBodyBuilder::fixed(), wall.friction(0.0));
    Ok(world)
}

/// One step of the plan and of the world, and what came of it.
fn advance(
    world: &mut PhysicsWorld,
    rod: &mut Rod,
    plan: &Plan,
    search: &mut BvhSearch,
    time: Real,
    clocks: &mut Clocks,
) -> Result<Moment, String> {
    let progress = plan.at(time);
    let (rest, base) = (plan.shape(progress), plan.base(progress));
    rod.set_rest_shape(world, &rest).map_err(text)?;
    rod.push(world, base);
    let begin = Instant::now();
    world.step();
    clocks.steps.push(begin.elapsed());

    let (points, mut found) = (rod.points(world), Vec::new());
    let robot = Chain::from_centreline(&points, &rest.radii).map_err(text)?;
    let begin = Instant::now();
    search.per_link(&robot, &Pose::IDENTITY, &mut found).map_err(text)?;
    clocks.queries.push(begin.elapsed());

    let planned: Vec<_> = rest.points.iter().map(|p| base * p).collect();
    let deviations =
        points.iter().zip(&planned).skip(1).map(|(is, planned)| (*is - *planned).length());
    Ok(Moment {
        time,
        out: progress.out,
        pushed: progress.pushed,
        robot,
        found,
        forces: rod.forces(world),
        deviations: deviations.collect(),
        planned,
    })
}

/// Two moments of the way out, its end, and three of the push.
fn six(film: Vec<Moment>, plan: &Plan) -> Vec<Moment> {
    let whole = plan.robot.length(&plan.goal);
    let mut wanted = [0.35, 0.7, 1.0].map(|share| (share * whole, 0.0)).to_vec();
    wanted.extend([0.4, 0.7, 1.0].map(|share| (whole, share * plan.push)));
    let mut film = film.into_iter().peekable();
    let mut chosen = Vec::new();
    for (out, pushed) in wanted {
        let reached = |moment: &Moment| moment.out >= out && moment.pushed >= pushed;
        chosen.extend(film.by_ref().find(reached));
    }
    chosen
}

/// How long the steps and the queries took.
#[derive(Default)]
struct Clocks {
    steps: Vec<Duration>,
    queries: Vec<Duration>,
}

impl Clocks {
    /// Medians, slowest, and their share of a control loop of 1 kHz.
    fn print(&mut self) {
        println!("\ntime                        median     slowest   share of a 1 kHz loop");
        for (name, times) in
            [("rapier's step", &mut self.steps), ("clearance of all links", &mut self.queries)]
        {
            times.sort();
            let at =
                |share: f64| times.get((share * (times.len().max(1) - 1) as f64) as usize).copied();
            let [median, slowest] =
                [0.5, 1.0].map(|share| at(share).unwrap_or_default().as_secs_f64());
            println!(
                "  {name:<22} {:>8.1} µs {:>8.1} µs   {:>6.1} %",
                median * 1e6,
                slowest * 1e6,
                median * 1e5
            );
        }
    }
}

/// The extremes of a run.
#[derive(Default)]
struct Summary {
    first_touch: Option<Real>,
    force: Real,
    deviation: Real,
    free_deviation: Real,
}

impl Summary {
    fn take_note(&mut self, moment: &Moment) {
        if moment.force() > 0.0 && self.first_touch.is_none() {
            self.first_touch = Some(moment.time);
        }
        let largest = moment.deviations.iter().copied().fold(0.0, Real::max);
        if self.first_touch.is_none() {
            self.free_deviation = self.free_deviation.max(largest);
        }
        self.force = self.force.max(moment.force());
        self.deviation = self.deviation.max(largest);
    }

    fn print(&self, steps: usize, plan: &Plan) {
        println!(
            "{steps} steps: {:.1} mm of robot came out, then its base was pushed by {:.1} mm",
            plan.robot.length(&plan.goal),
            plan.push
        );
        println!(
            "until it touched, it was within {:.3} mm of the kinematic shape",
            self.free_deviation
        );
        match self.first_touch {
            Some(time) => println!(
                "it touched the wall after {time:.2} s, with up to {:.0} mN, and was bent away by up to {:.2} mm",
                self.force, self.deviation
            ),
            None => println!("it never touched the wall"),
        }
    }
}
