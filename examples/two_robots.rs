//! Two concentric tube robots in one brain ventricle: which is tightest, and where?
//!
//! `cargo run --example two_robots` sends a robot through either frontal horn. At every
//! step one scene is asked: whether each robot keeps its margin from the wall and from the other
//! one, and where the slack (distance less margin) is least. At the end there are the time per
//! question, and a picture of the last step at which all is clear, with the closest points.
//! `--mesh` takes real anatomy instead (in millimetres, or with `--scale`); `--base` and `--axis`
//! place the first robot in it, and the second stands `--beside` it.

use clap::Parser;
use continuum_demo::anatomy::{Anatomy, no_goal};
use continuum_demo::canvas::{Align, Canvas, Colour, hex};
use continuum_demo::ctr::{Centreline, Joints, Robot, three_tubes};
use continuum_demo::figure::{ring, ruler};
use continuum_demo::lettering::strokes;
use continuum_demo::picture::{Camera, Picture, SKY, Solid};
use continuum_demo::{command, steer, timing, ventricle};
use parry_continuum::Chain;
use parry_continuum::parry::math::{Pose, Real, Rot3, Vector};
use parry_continuum::parry::shape::{SharedShape, TriMesh};
use parry_continuum::proximity::{
    Between, BvhSearch, RobotPair, Scene, StructureProximity, Tightest,
};
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;

/// Send two concentric tube robots into one brain ventricle, and tell at every step where the slack
/// is least.
#[derive(Parser)]
struct Options {
    #[command(flatten)]
    anatomy: Anatomy,

    /// The margin that the robots keep from the wall, in millimetres
    #[arg(long, value_name = "MM", default_value_t = 0.3, value_parser = command::length, allow_negative_numbers = true)]
    margin: Real,

    /// The margin that the robots keep from one another, in millimetres
    #[arg(long, value_name = "MM", default_value_t = 1.0, value_parser = command::length, allow_negative_numbers = true)]
    between: Real,

    /// How far the second robot stands from the first in a mesh from a file, in millimetres
    #[arg(long, value_name = "MM", default_value_t = 4.0, value_parser = command::length, allow_negative_numbers = true)]
    beside: Real,

    /// How many steps the way in has
    #[arg(long, value_name = "COUNT", default_value_t = 20, value_parser = command::whole(1..=100_000))]
    steps: u32,

    /// Where to save the picture: a directory, or a file that ends in .png
    #[arg(long, value_name = "PATH", default_value = "target/two_robots.png")]
    out: PathBuf,
}

const LINKS: usize = 30;
const COLOURS: [Colour; 2] = [hex(0x2f6db3), hex(0xd9822b)];
const INK: Colour = hex(0x22303c);
const SIZE: [usize; 2] = [1400, 1000];
/// The height of the title and the notes above the scene.
const HEAD: usize = 156;

fn main() -> ExitCode {
    command::run(steer)
}

fn text(error: impl std::fmt::Display) -> String {
    error.to_string()
}

fn steer(options: &Options) -> Result<(), String> {
    let out = command::picture_path(&options.out, "two_robots.png")?;
    let mesh = options.anatomy.load()?;
    let mut search = BvhSearch::new(&mesh).map_err(text)?;
    let first = options.anatomy.pose(&mesh)?;
    let bases = [first, beside(options, &first)];
    let robot = three_tubes();
    let mut goal = |base: &Pose| {
        steer::find_goal(&robot, &mut search, base).map_err(|none| no_goal(&none, base))
    };
    let goals = if options.anatomy.is_planned() {
        [ventricle::goal(), goal(&bases[1])?]
    } else {
        [goal(&bases[0])?, goal(&bases[1])?]
    };

    let mut scene = Scene::new();
    scene.add(options.anatomy.name(), search, Some(options.margin)).map_err(text)?;
    scene.set_robot_margin(Some(options.between)).map_err(text)?;
    println!("step  clear  least slack: distance less margin");
    let mut last_clear = None;
    for step in 1..=options.steps {
        let share = Real::from(step) / Real::from(options.steps);
        let chains = chains(&robot, &goals, share)?;
        let robots = [(&chains[0], bases[0]), (&chains[1], bases[1])];
        let clears = scene.clears(&robots).map_err(text)?;
        last_clear = if clears { Some(step) } else { last_clear };
        if let Some(tightest) = scene.tightest(&robots).map_err(text)? {
            println!(
                "{step:4}  {:<5}  {}",
                if clears { "yes" } else { "no" },
                told(&scene, &tightest)
            );
        }
    }

    // What is drawn is the last step at which all is clear.
    let drawn = last_clear.unwrap_or(options.steps);
    let chains = chains(&robot, &goals, Real::from(drawn) / Real::from(options.steps))?;
    let robots = [(&chains[0], bases[0]), (&chains[1], bases[1])];
    let tightest =
        scene.tightest(&robots).map_err(text)?.ok_or("there is nothing to be near to")?;
    let mut walls = Vec::new();
    scene.per_structure(&robots, &mut walls).map_err(text)?;
    print_times(&mut scene, &robots)?;

    let canvas = draw(options, &mesh, &robots, &walls, &scene, &tightest)?;
    canvas.save(&out).map_err(|error| command::unwritable(&out, error))?;
    println!("\npicture of step {drawn}: {}", out.display());
    Ok(())
}

/// Where the second robot stands: in the other frontal horn, or beside the first.
fn beside(options: &Options, first: &Pose) -> Pose {
    let axis = first.rotation * Vector::Z;
    if options.anatomy.is_planned() {
        let mirrored = Vector::new(-axis.x, axis.y, axis.z);
        let base = first.translation;
        let base = Vector::new(-base.x, base.y, base.z);
        return Pose::from_parts(base, Rot3::from_rotation_arc(Vector::Z, mirrored));
    }
    Pose::from_translation(axis.any_orthonormal_vector() * options.beside) * *first
}

/// Both robots on their way in.
fn chains(robot: &Robot, goals: &[Joints; 2], share: Real) -> Result<[Chain; 2], String> {
    let chain = |goal: &Joints| {
        let Centreline { points, radii } = robot.centreline(&robot.on_the_way(goal, share), LINKS);
        Chain::from_centreline(&points, &radii).map_err(text)
    };
    Ok([chain(&goals[0])?, chain(&goals[1])?])
}

/// Who is tightest, in words.
fn told(scene: &Scene, tightest: &Tightest) -> String {
    let slack = tightest.slack;
    match &tightest.between {
        Between::Structure(StructureProximity { structure, robot, nearest, .. }) => format!(
            "{slack:7.3} mm: link {} of robot {robot} and triangle {} of {}",
            nearest.link,
            nearest.witness.triangle,
            scene.name(*structure as usize).unwrap_or("a structure"),
        ),
        Between::Robots { robots: [a, b], nearest } => {
            let [i, j] = nearest.links;
            format!("{slack:7.3} mm: link {i} of robot {a} and link {j} of robot {b}")
        }
        _ => format!("{slack:7.3} mm"),
    }
}

fn print_times(scene: &mut Scene, robots: &[(&Chain, Pose); 2]) -> Result<(), String> {
    let [(a, pose_a), (b, pose_b)] = robots;
    let mut asked = scene.clone();
    let mut pair = RobotPair::new();
    let medians = timing::medians::<String>(
        &mut [
            &mut || scene.tightest(robots).map(drop).map_err(text),
            &mut || asked.clears(robots).map(drop).map_err(text),
            &mut || pair.minimum(a, pose_a, b, pose_b).map(drop).map_err(text),
        ],
        Duration::from_millis(500),
    )?;
    println!("\ntime per question (median, taken in turns)");
    for (name, time) in ["the least slack of all", "whether all is clear", "robot against robot"]
        .iter()
        .zip(medians)
    {
        println!("  {name:<24} {:>8.1} us", time.as_secs_f64() * 1e6);
    }
    Ok(())
}

/// Both robots, their closest points, the closest points of the tighter one and the wall, and a
/// ring around the place of least slack.
fn draw(
    options: &Options,
    mesh: &TriMesh,
    robots: &[(&Chain, Pose); 2],
    walls: &[StructureProximity],
    scene: &Scene,
    tightest: &Tightest,
) -> Result<Canvas, String> {
    let [(a, pose_a), (b, pose_b)] = robots;
    let nearest = RobotPair::new().minimum(a, pose_a, b, pose_b).map_err(text)?;
    let mut solids = Vec::new();
    for ((chain, pose), colour) in robots.iter().zip(COLOURS) {
        let links = chain.links().iter();
        solids.extend(links.map(|link| Solid::new(SharedShape::new(*link), *pose, colour, true)));
    }
    let thick = a.links().iter().map(|link| link.radius()).fold(0.0, Real::max);
    let mut join = |from: Vector, to: Vector| {
        for end in [from, to] {
            let ball = SharedShape::ball(0.16 * thick);
            solids.push(Solid::new(ball, Pose::from_translation(end), INK, false));
        }
        if let Some(way) = (to - from).try_normalize() {
            let middle =
                Pose::from_parts(from.midpoint(to), Rot3::from_rotation_arc(Vector::Y, way));
            let line = SharedShape::cylinder(0.5 * (to - from).length(), 0.06 * thick);
            solids.push(Solid::new(line, middle, INK, false));
        }
    };
    join(nearest.witness.on_first, nearest.witness.on_second);
    for wall in walls {
        join(wall.nearest.witness.on_robot, wall.nearest.witness.on_mesh);
    }
    let mut picture = Picture::new(Some(mesh), solids);
    picture.skin.veil = 0.15;
    let [width, height] = [SIZE[0], SIZE[1] - HEAD];
    let towards = Vector::new(0.1, -1.0, -0.15);
    let ends = robots.iter().flat_map(|(chain, pose)| {
        chain.links().iter().flat_map(move |link| [pose * link.start(), pose * link.end()])
    });
    let ends: Vec<_> = ends.collect();
    let camera = Camera::framing(&ends, towards, Vector::Z, width as Real / height as Real, 0.25);
    let mut canvas = Canvas::new(SIZE[0], SIZE[1], |_, _| SKY[0]);
    canvas.paste(&picture.render(&camera, width, height), [0, HEAD], 0.0);
    let on_canvas = |place: Vector| {
        let [x, y] = camera.place(place, [width, height]);
        [x, y + HEAD as f32]
    };
    // The distance and the margin beside each pair of closest points: of both robots below the
    // points, of a robot and the wall above them.
    let between = nearest.witness.on_first.midpoint(nearest.witness.on_second);
    let text = format!("{:.2} mm apart, margin {} mm", nearest.distance, options.between);
    let mut labels = vec![(between, 77.0, text)];
    for wall in walls {
        let witness = &wall.nearest.witness;
        let text =
            format!("{:.2} mm from the wall, margin {} mm", wall.nearest.distance, options.margin);
        labels.push((witness.on_robot.midpoint(witness.on_mesh), -32.0, text));
    }
    for (place, below, text) in labels {
        let ([x, y], half) = (on_canvas(place), 0.5 * strokes(&text, 19.0).1 + 14.0);
        let y = y + below;
        canvas.panel([x - half, y - 29.0, x + half, y + 13.0], 8.0, SKY[0], 0.85);
        canvas.text(&text, [x, y], Align::Centre, 19.0, INK);
    }
    let place = match &tightest.between {
        Between::Robots { .. } => between,
        Between::Structure(wall) => {
            wall.nearest.witness.on_robot.midpoint(wall.nearest.witness.on_mesh)
        }
        _ => return Err("the place of least slack is of an unknown kind".into()),
    };
    ring(&mut canvas, on_canvas(place), 28.0);
    for (number, (chain, pose)) in robots.iter().enumerate() {
        let [x, y] = on_canvas(pose * chain.links()[0].start());
        canvas.text(&format!("robot {number}"), [x, y - 56.0], Align::Centre, 21.0, INK);
    }
    canvas.text(
        "Two concentric tube robots in one ventricle",
        [40.0, 62.0],
        Align::Left,
        30.0,
        INK,
    );
    let note = format!("least slack (distance less margin): {}", told(scene, tightest).trim());
    canvas.text(&note, [40.0, 100.0], Align::Left, 17.0, INK);
    let note = "the ring is where the least slack is";
    canvas.text(note, [40.0, 132.0], Align::Left, 17.0, INK);
    let middle = ends.iter().sum::<Vector>() / ends.len() as Real;
    ruler(&mut canvas, &camera, middle, [width, height], [40.0, SIZE[1] as f32 - 40.0]);
    Ok(canvas)
}
