//! Steers a concentric tube robot into a brain ventricle and prints how far each of its links is
//! from the wall.
//!
//! `cargo run --example ventricle` grows a ventricle and sends the robot through the
//! foramen of Monro into the third ventricle. At every step two engines find the closest points of
//! every link; they must agree. At the end there are a table, the time per query, and a picture.
//! `--tolerance 0.01` also bounds the clearance of the curve itself, and the picture then shows the
//! pieces that it took: long where the wall is far, short where it is near. With `--features gpu`
//! and `--engine gpu` the second engine is the GPU. `--mesh` takes real anatomy instead (in
//! millimetres, or with `--scale`); `--base` and `--axis` place the robot in it, otherwise it
//! starts at the deepest point inside.

use clap::{Parser, ValueEnum};
use continuum_demo::anatomy::{Anatomy, no_goal, show};
use continuum_demo::ctr::{Centreline, Joints, Robot, three_tubes};
use continuum_demo::{command, figure, steer, timing, ventricle};
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{
    BvhSearch, Clearance, Exhaustive, LinkProximity, Proximity, TubePiece,
};
use parry_continuum::{Cap, Chain, RobotError, simplify};
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;

/// Steer a concentric tube robot into a brain ventricle and measure its clearance, link by link.
#[derive(Parser)]
struct Options {
    #[command(flatten)]
    anatomy: Anatomy,

    /// The ends of each link: all round (capsule), all flat (cylinder), or what fits each joint
    /// (fitted)
    #[arg(long, value_enum, default_value_t = Model::Fitted)]
    model: Model,

    /// Take the fewest links within this distance of the curve, in millimetres, and bound the
    /// curve's own clearance as closely [default: 30 links, no bounds]
    #[arg(long, value_name = "MM", value_parser = command::length, allow_negative_numbers = true)]
    tolerance: Option<Real>,

    /// Where the second engine, which looks at every triangle, runs: on the CPU, or on the GPU
    /// (cargo feature `gpu`)
    #[arg(long, value_enum, default_value_t = Engine::Exhaustive)]
    engine: Engine,

    /// How many steps the way in has
    #[arg(long, value_name = "COUNT", default_value_t = 60, value_parser = command::whole(1..=100_000))]
    steps: u32,

    /// Where to save the picture: a directory, or a file that ends in .png
    #[arg(long, value_name = "PATH", default_value = "target/ventricle.png")]
    out: PathBuf,
}

#[derive(Clone, Copy, ValueEnum)]
enum Model {
    Capsule,
    Cylinder,
    Fitted,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Engine {
    Exhaustive,
    Gpu,
}

impl Engine {
    /// The engine for a mesh, and its name in the table of times.
    fn build(self, mesh: &TriMesh) -> Result<(Box<dyn Proximity>, String), String> {
        match self {
            Self::Exhaustive => {
                let engine = Exhaustive::<Real>::new(mesh).map_err(text)?;
                Ok((Box::new(engine), "exhaustive, every triangle".into()))
            }
            #[cfg(feature = "gpu")]
            Self::Gpu => {
                use parry_continuum::gpu::{GpuExhaustive, Precision};
                let engine = GpuExhaustive::new(mesh, Precision::F32).map_err(text)?;
                println!("on the GPU: {}", engine.adapter());
                Ok((Box::new(engine), "exhaustive on the GPU".into()))
            }
            #[cfg(not(feature = "gpu"))]
            Self::Gpu => Err("this program was built without the GPU; run \
                              `cargo run --features gpu --example ventricle -- --engine gpu`"
                .into()),
        }
    }
}

fn main() -> ExitCode {
    command::run(steer)
}

fn text(error: impl std::fmt::Display) -> String {
    error.to_string()
}

fn steer(options: &Options) -> Result<(), String> {
    let out = command::picture_path(&options.out, "ventricle.png")?;
    let mesh = options.anatomy.load()?;
    let mut search = BvhSearch::new(&mesh).map_err(text)?;
    let (mut exhaustive, exhaustive_name) = options.engine.build(&mesh)?;

    let robot = three_tubes();
    let base = options.anatomy.pose(&mesh)?;
    if !steer::is_inside(&mesh, base.translation) {
        eprintln!(
            "note: {} is outside the mesh; --base x,y,z places the robot",
            show(base.translation)
        );
    }
    let goal = if options.anatomy.is_planned() {
        ventricle::goal()
    } else {
        steer::find_goal(&robot, &mut search, &base).map_err(|none| no_goal(&none, &base))?
    };
    println!(
        "{:.1} mm of robot, from {} along {}",
        robot.length(&goal),
        show(base.translation),
        show(base.rotation * Vector::Z)
    );

    // The way in: both engines at every step.
    let scale =
        mesh.local_aabb().extents().length() + mesh.local_aabb().center().abs().max_element();
    let bar = command::progress(options.steps, "steps")?;
    let (mut found, mut checked) = (Vec::new(), Vec::new());
    let (mut chains, mut apart) = (Vec::new(), 0.0);
    for step in 1..=options.steps {
        let share = Real::from(step) / Real::from(options.steps);
        let chain = chain(options, &robot, &robot.on_the_way(&goal, share)).map_err(text)?;
        search.per_link(&chain, &base, &mut found).map_err(text)?;
        exhaustive.per_link(&chain, &base, &mut checked).map_err(text)?;
        apart = disagreement(&found, &checked).max(apart);
        let nearest = found.iter().map(|link| link.distance).fold(Real::INFINITY, Real::min);
        bar.set_message(format!("clearance {nearest:.2} mm"));
        bar.inc(1);
        chains.push(chain);
    }
    bar.finish();
    // Each engine promises 16 units in the last place of the problem's extent.
    if apart > 32.0 * 0.5 * Real::EPSILON * scale {
        return Err(format!(
            "the engines differ by {apart:e} mm; please report it with the command that you ran"
        ));
    }
    println!(
        "{} triangles, {} steps: search and exhaustive engine agree to {apart:.0e} mm\n",
        mesh.num_triangles(),
        options.steps
    );

    let chain = &chains[chains.len() - 1];
    print_table(chain, &found);
    let mut pieces = Vec::new();
    let curve = match options.tolerance {
        Some(tolerance) => {
            let curve = robot.shape(&goal).map_err(text)?;
            let found =
                search.clearance_pieces(&curve, &base, tolerance, &mut pieces).map_err(text)?;
            println!(
                "\nthe curve itself keeps between {:.6} and {:.6} mm; triangle {} is nearest, {:.2} mm along the robot",
                found.lower, found.upper, found.witness.triangle, found.witness.arc_length
            );
            print_pieces(&pieces);
            Some(found)
        }
        None => None,
    };
    print_times(&mesh, &chains, &base, &mut search, (&exhaustive_name, &mut *exhaustive))?;

    let caption = caption(options, &mesh, chain, closest(&found, curve, &pieces));
    let picture = figure::draw(&mesh, chain, &base, &found, &pieces, &caption);
    picture.save(&out).map_err(|error| command::unwritable(&out, error))?;
    println!("\npicture: {}", out.display());
    Ok(())
}

/// The robot at the given joints, with the requested model and number of links.
fn chain(options: &Options, robot: &Robot, joints: &Joints) -> Result<Chain, RobotError> {
    const LINKS: usize = 30;
    const CURVE: usize = 400;
    let (points, radii) = match options.tolerance {
        None => {
            let Centreline { points, radii } = robot.centreline(joints, LINKS);
            (points, radii)
        }
        Some(tolerance) => {
            let curve = robot.centreline(joints, CURVE);
            simplify(&curve.points, &curve.radii, tolerance)?
        }
    };
    match options.model {
        Model::Capsule => Chain::capsules(&points, &radii),
        Model::Cylinder => Chain::cylinders(&points, &radii),
        Model::Fitted => Chain::from_centreline(&points, &radii),
    }
}

/// The largest difference in distance of two engines' answers.
fn disagreement(one: &[LinkProximity], other: &[LinkProximity]) -> Real {
    if one.len() != other.len() {
        return Real::INFINITY;
    }
    one.iter().zip(other).map(|(a, b)| (a.distance - b.distance).abs()).fold(0.0, Real::max)
}

fn print_table(chain: &Chain, answers: &[LinkProximity]) {
    println!(
        "link  radius  caps         distance  triangle  closest point of link         closest point of wall"
    );
    let name = |cap| if cap == Cap::Flat { "flat" } else { "round" };
    let place = |v: Vector| format!("{:9.3} {:9.3} {:9.3}", v.x, v.y, v.z);
    for (link, answer) in chain.links().iter().zip(answers) {
        let [start, end] = link.caps().map(name);
        println!(
            "{:4}  {:6.2}  {start:<5} {end:<5}  {:8.4}  {:8}  {}  {}",
            answer.link,
            link.radius(),
            answer.distance,
            answer.witness.triangle,
            place(answer.witness.on_robot),
            place(answer.witness.on_mesh),
        );
    }
}

/// How finely the curve was divided.
fn print_pieces(pieces: &[TubePiece]) {
    let length = |piece: &TubePiece| piece.arc_lengths[1] - piece.arc_lengths[0];
    let by_length = |a: &&TubePiece, b: &&TubePiece| length(a).total_cmp(&length(b));
    if let (Some(shortest), Some(longest)) =
        (pieces.iter().min_by(by_length), pieces.iter().max_by(by_length))
    {
        println!(
            "that took {} pieces: the shortest is {:.2} mm and begins {:.2} mm along it, the longest {:.2} mm and {:.2} mm",
            pieces.len(),
            length(shortest),
            shortest.arc_lengths[0],
            length(longest),
            longest.arc_lengths[0],
        );
    }
}

/// Times each engine and parry in turns, and prints them.
fn print_times(
    mesh: &TriMesh,
    chains: &[Chain],
    base: &Pose,
    search: &mut BvhSearch,
    (exhaustive_name, exhaustive): (&str, &mut dyn Proximity),
) -> Result<(), String> {
    let chain = &chains[chains.len() - 1];
    let before = &chains[chains.len().saturating_sub(2)];
    let cylinders = timing::cylinders(chain);
    let mut kept = BvhSearch::new(mesh).map_err(text)?;
    let [mut a, mut b, mut c] = [Vec::new(), Vec::new(), Vec::new()];
    let mut turn = false;
    let medians = timing::medians::<String>(
        &mut [
            &mut || {
                search.forget();
                search.per_link(chain, base, &mut a).map_err(text)
            },
            &mut || {
                turn = !turn;
                kept.per_link(if turn { before } else { chain }, base, &mut b).map_err(text)
            },
            &mut || exhaustive.per_link(chain, base, &mut c).map_err(text),
            &mut || timing::parry(mesh, &cylinders, base).map(drop).map_err(text),
        ],
        Duration::from_secs(1),
    )?;
    let [first, again, all, parry] = medians[..] else { return Err("a time is missing".into()) };
    println!("\ntime per query of all {} links (median, taken in turns)", chain.links().len());
    let row = |name: &str, time: Duration| {
        println!(
            "  {name:<46} {:>11.1} µs   {:>8.2} x",
            time.as_secs_f64() * 1e6,
            ratio(parry, time)
        );
    };
    row("parry distance(Cylinder, TriMesh), link by link", parry);
    row("search, first time", first);
    row("search, again after the step before", again);
    row(exhaustive_name, all);
    Ok(())
}

fn ratio(of: Duration, to: Duration) -> f64 {
    of.as_secs_f64() / to.as_secs_f64()
}

/// Where the robot is closest: between the bounds of the curve if they are requested, otherwise by
/// its links.
fn closest(links: &[LinkProximity], curve: Option<Clearance>, pieces: &[TubePiece]) -> String {
    if let Some(curve) = curve {
        let (lower, upper, arc_length) = (curve.lower, curve.upper, curve.witness.arc_length);
        let count = pieces.len();
        return format!(
            "the curve, in {count} pieces: {lower:.4} to {upper:.4} mm, {arc_length:.1} mm along it"
        );
    }
    let Some(closest) = links.iter().min_by(|a, b| a.distance.total_cmp(&b.distance)) else {
        return String::new();
    };
    let (distance, arc_length) = (closest.distance, closest.witness.arc_length);
    format!("closest: {distance:.3} mm from the wall, {arc_length:.1} mm along the robot")
}

fn caption(options: &Options, mesh: &TriMesh, chain: &Chain, closest: String) -> figure::Caption {
    let (one, many) = match options.model {
        Model::Capsule => ("capsule", "capsules"),
        Model::Cylinder => ("cylinder", "cylinders"),
        Model::Fitted => ("link with fitted caps", "links with fitted caps"),
    };
    let count = chain.links().len();
    let links = format!("{count} {}", if count == 1 { one } else { many });
    figure::Caption {
        title: format!("A concentric tube robot in {}", options.anatomy.name()),
        subtitle: format!("{links} against {} triangles", mesh.num_triangles()),
        closest,
    }
}
