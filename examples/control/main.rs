//! Lets a concentric tube robot follow a target into the wall of a brain ventricle, and keeps it
//! 0.5 mm away.
//!
//! `cargo run -p control` simulates a loop of 1 kHz twice: once the joints follow
//! the target as well as they can, and the robot touches; once each contact within 3 mm is one
//! linear inequality in the joint speeds, and it does not. At the end there are the clearances, how
//! long a tick takes, and a plot. `--latency` measures over 100,000 ticks.

mod barrier;
mod kinematics;
mod plot;

use clap::Parser;
use continuum_demo::{command, ventricle};
use kinematics::Kinematics;
use parry_continuum::Chain;
use parry_continuum::parry::math::{Real, Vector};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{BvhSearch, Proximity};
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::{Duration, Instant};

/// Steer a concentric tube robot towards the wall of a ventricle under a virtual fixture.
#[derive(Parser)]
struct Options {
    /// How many ticks of a millisecond to simulate
    #[arg(long, value_name = "COUNT", default_value_t = 4000, value_parser = command::whole(100..=1_000_000))]
    ticks: u32,

    /// Measure how long a tick takes, over 100,000 of them
    #[arg(long)]
    latency: bool,

    /// Where to save the plot: a directory, or a file that ends in .png
    #[arg(long, value_name = "PATH", default_value = "target/control.png")]
    out: PathBuf,
}

/// A tick, in seconds.
const TICK: Real = 1e-3;
/// How near a contact must be to count, and how near none may come, in millimetres.
const NEAR: Real = 3.0;
const MARGIN: Real = 0.5;
/// How fast the robot may use up the room that is left, per second.
const APPROACH: Real = 15.0;
/// How fast the tip makes up for its error, per second.
const FOLLOW: Real = 10.0;

/// What a run has seen: at each tick the clearance and the distance of the tip from the target, and
/// the times of kinematics, robot and query.
pub struct Run {
    pub clearance: Vec<Real>,
    pub tip_error: Vec<Real>,
    times: [Vec<Duration>; 3],
}

fn main() -> ExitCode {
    command::run(control)
}

fn text(error: impl std::fmt::Display) -> String {
    error.to_string()
}

fn control(options: &Options) -> Result<(), String> {
    let out = command::picture_path(&options.out, "control.png")?;
    let ticks = if options.latency { 100_000 } else { options.ticks };
    let (vertices, indices) = ventricle::mesh(6_000);
    let mesh = TriMesh::new(vertices, indices).map_err(text)?;
    let search = BvhSearch::new(&mesh).map_err(text)?;
    let free = run(search.clone(), ticks, false)?;
    let kept = run(search, ticks, true)?;
    for (name, run) in [("without the fixture", &free), ("with the fixture", &kept)] {
        let least = run.clearance.iter().copied().fold(Real::INFINITY, Real::min);
        let error = run.tip_error.iter().copied().fold(0.0, Real::max);
        println!(
            "{name:>20}: never nearer than {least:.3} mm, the tip at most {error:.2} mm off the target"
        );
    }
    println!("\nmicroseconds a tick, {ticks} ticks of the second run");
    for (name, times) in ["kinematics", "robot", "query"].into_iter().zip(&kept.times) {
        let mut times: Vec<_> = times.iter().map(|time| time.as_secs_f64() * 1e6).collect();
        times.sort_by(Real::total_cmp);
        let last = times.len() - 1;
        let [median, rare, worst] = [times[last / 2], times[last - last / 1000], times[last]];
        println!("  {name:<10}  p50 {median:8.1}   p99.9 {rare:8.1}   largest {worst:8.1}");
    }
    plot::draw(&free, &kept, MARGIN, TICK).save(&out).map_err(|error| {
        format!("cannot write {} ({error}); choose another --out", out.display())
    })?;
    println!("\nplot: {}", out.display());
    Ok(())
}

/// Where the tip shall be: away from its start and back, farther than the wall allows.
fn target(start: Vector, time: Real) -> Vector {
    const AWAY: Vector = Vector::new(9.0, 0.0, 0.0);
    start + AWAY * (0.5 - 0.5 * (time * std::f64::consts::TAU / 4.0).cos())
}

/// A loop of `ticks`, with the fixture or without.
fn run(mut search: BvhSearch, ticks: u32, with_fixture: bool) -> Result<Run, String> {
    let mut kinematics = Kinematics::new();
    let mut robot =
        Chain::from_centreline(kinematics.points(), kinematics.radii()).map_err(text)?;
    let pose = ventricle::entry();
    let (mut contacts, mut limits) = (Vec::new(), Vec::new());
    let start = kinematics.tip();
    let mut run = Run { clearance: Vec::new(), tip_error: Vec::new(), times: Default::default() };
    let name = if with_fixture { "with the fixture" } else { "without the fixture" };
    let bar = command::progress(ticks, "ticks")?.with_message(name);
    for tick in 0..ticks {
        // Outside of what is timed, and rarely.
        if tick % 512 == 0 {
            bar.set_position(tick.into());
        }
        let time = Real::from(tick) * TICK;
        let [begin, moved, filled];
        begin = Instant::now();
        kinematics.update();
        moved = Instant::now();
        robot.set_centreline(kinematics.points(), kinematics.radii()).map_err(text)?;
        filled = Instant::now();
        search.contacts_within(&robot, &pose, NEAR, 0.0, &mut contacts).map_err(text)?;
        let answered = Instant::now();
        for (times, time) in
            run.times.iter_mut().zip([moved - begin, filled - moved, answered - filled])
        {
            times.push(time);
        }

        let wanted = (target(start, time + TICK) - target(start, time)) / TICK
            + (target(start, time) - kinematics.tip()) * FOLLOW;
        limits.clear();
        if with_fixture {
            limits.extend(contacts.iter().filter_map(|contact| {
                let rates = kinematics.rates(&robot, &pose, contact)?;
                let room = contact.depth - MARGIN;
                Some(barrier::Limit { rates, least: -APPROACH * room })
            }));
        }
        let speeds = barrier::speeds(&kinematics.tip_jacobian(), wanted, &limits)?;
        kinematics.step(&speeds, TICK);

        let nearest = contacts.iter().map(|contact| contact.distance).fold(NEAR, Real::min);
        run.clearance.push(nearest);
        run.tip_error.push((target(start, time) - kinematics.tip()).length());
    }
    bar.finish_and_clear();
    Ok(run)
}
