//! Which parts of a robot are compared: this crate's rule beside the planners' rule, which compares
//! parts more than three radii apart along the robot. Writes the table of `docs/book/robots.md`,
//! and the picture `docs/self.svg` of the two distances of a robot from itself.
//!
//! ```text
//! cargo run --release -p continuum-studies --bin own_parts
//! ```

use clap::Parser;
use continuum_demo::{command, ctr};
use continuum_studies::quote;
use continuum_testing::Random;
use parry_continuum::Chain;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::proximity::SelfQuery;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Count what two rules of self-collision miss and what they forbid.
#[derive(Parser)]
struct Options {
    /// How many shapes of each robot
    #[arg(long, value_name = "COUNT", default_value_t = 2000)]
    shapes: u64,
    /// Where book/robots.md is, and where the picture goes
    #[arg(long, value_name = "DIRECTORY", default_value = "docs")]
    out: PathBuf,
}

/// How many samples a link has.
const SAMPLES: usize = 4;

struct Shape {
    points: Vec<Vector>,
    radii: Vec<f64>,
}

/// Three sections of 60 mm with one bend each, up to nine tenths of the tightest that the radius
/// allows.
fn tendon_robot(random: &mut Random) -> Shape {
    const RADIUS: f64 = 5.0;
    let (mut frame, mut points) = (Pose::IDENTITY, vec![Vector::ZERO]);
    for _ in 0..3 {
        let (share, plane) = (random.unit(), random.between(0.0, TAU));
        let curvature = share * share * share * 0.9 / RADIUS;
        let bend = Vector::new(-plane.sin(), plane.cos(), 0.0) * curvature;
        for _ in 0..30 {
            // Along an arc: half of the turn, the chord, and the other half.
            let step = 2.0;
            let angle = step * curvature;
            let chord = if angle > 0.0 { 2.0 / curvature * (0.5 * angle).sin() } else { step };
            let half = Pose::new(Vector::ZERO, bend * (0.5 * step));
            frame = frame * half * Pose::from_translation(Vector::Z * chord) * half;
            points.push(frame.translation);
        }
    }
    Shape { radii: vec![RADIUS; points.len() - 1], points }
}

/// The robot of the ventricle, its tubes turned and extended anyhow.
fn tubes(random: &mut Random) -> Shape {
    let robot = ctr::three_tubes();
    let share = |random: &mut Random, length: f64| length * random.between(0.3, 1.0);
    let extensions = robot.sections.iter().map(|section| share(random, section.length)).collect();
    let angles = robot.sections.iter().map(|_| random.between(0.0, TAU)).collect();
    let centreline = robot.centreline(&ctr::Joints { extensions, angles }, 60);
    Shape { points: centreline.points, radii: centreline.radii }
}

/// 20 links of 20 mm. Each joint bends by up to 80 degrees in any direction.
fn snake(random: &mut Random) -> Shape {
    let (mut frame, mut points) = (Pose::IDENTITY, vec![Vector::ZERO]);
    for _ in 0..20 {
        let plane = random.between(0.0, TAU);
        let bend =
            Vector::new(plane.cos(), plane.sin(), 0.0) * random.between(0.0, 80.0_f64.to_radians());
        frame = frame * Pose::new(Vector::ZERO, bend) * Pose::from_translation(Vector::Z * 20.0);
        points.push(frame.translation);
    }
    Shape { radii: vec![9.0; 20], points }
}

/// Samples of the centreline, with the arc length and the radius of each.
struct Samples {
    points: Vec<Vector>,
    arc_lengths: Vec<f64>,
    radii: Vec<f64>,
}

impl Samples {
    fn of(shape: &Shape) -> Self {
        let mut all = Self { points: Vec::new(), arc_lengths: Vec::new(), radii: Vec::new() };
        let mut before = 0.0;
        for (ends, &radius) in shape.points.windows(2).zip(&shape.radii) {
            let way = ends[1] - ends[0];
            // Both ends, so that each link has its own radius there.
            for k in 0..=SAMPLES {
                let share = k as f64 / SAMPLES as f64;
                all.points.push(ends[0] + way * share);
                all.arc_lengths.push(before + way.length() * share);
                all.radii.push(radius);
            }
            before += way.length();
        }
        all
    }

    /// How far two places are apart, less both radii.
    fn apart(&self, i: usize, j: usize) -> f64 {
        (self.points[i] - self.points[j]).length() - self.radii[i] - self.radii[j]
    }

    /// The nearest local minimum: of all pairs of places that come no nearer when either moves
    /// along the robot, except pairs from which the distance falls until both places coincide.
    fn truth(&self, most: f64) -> f64 {
        const AROUND: usize = 2;
        let count = self.points.len();
        let mut least = f64::INFINITY;
        for i in 0..count {
            for j in i + 1..count {
                let here = self.apart(i, j);
                if here >= least || here > most {
                    continue;
                }
                let near = |at: usize| at.saturating_sub(AROUND)..(at + AROUND + 1).min(count);
                let is_least = near(i).all(|k| near(j).all(|l| k < l && self.apart(k, l) >= here));
                if is_least {
                    least = here;
                }
            }
        }
        least
    }

    /// The nearest of all pairs more than three radii and some more apart along the robot.
    fn by_arc_length(&self, more: f64) -> f64 {
        let count = self.points.len();
        let pairs = (0..count).flat_map(|i| (i + 1..count).map(move |j| (i, j)));
        let far = pairs.filter(|&(i, j)| {
            self.arc_lengths[j] - self.arc_lengths[i]
                > 3.0 * self.radii[i].max(self.radii[j]) + more
        });
        far.fold(f64::INFINITY, |least, (i, j)| least.min(self.apart(i, j)))
    }

    /// How far the nearest two samples may be farther apart than the nearest two places: half a
    /// step along each.
    fn step(&self) -> f64 {
        self.arc_lengths.windows(2).fold(0.0, |most, ends| f64::max(most, ends[1] - ends[0]))
    }
}

#[derive(Default)]
struct Counts {
    near: u32,
    clear: u32,
    missed: [u32; 3],
    forbidden: [u32; 3],
    unclear: u32,
}

type Robot = (&'static str, f64, fn(&mut Random) -> Shape);

const ROBOTS: [Robot; 3] =
    [("tendons", 5.0, tendon_robot), ("tubes", 1.25, tubes), ("snake", 9.0, snake)];

fn counted(my: &Options, shape: fn(&mut Random) -> Shape, margin: f64) -> Result<Counts, String> {
    let (mut random, mut counts, mut query) = (Random::new(7), Counts::default(), SelfQuery::new());
    for _ in 0..my.shapes {
        let shape = shape(&mut random);
        let samples = Samples::of(&shape);
        // Two places may be half a step off on either side, across their distance of about two
        // radii. A proven contact or clearance needs more than that.
        let step = samples.step();
        let radius = shape.radii.iter().fold(f64::INFINITY, |least, &r| least.min(r));
        let off = 0.25 * step * step / radius;
        let truth = samples.truth(margin + off);
        if truth > margin - off && truth <= margin + off {
            counts.unclear += 1;
            continue;
        }
        let robot =
            Chain::capsules(&shape.points, &shape.radii).map_err(|error| error.to_string())?;
        let ours = !query.clears(&robot, margin).map_err(|error| error.to_string())?;
        let [arcs, longer] = [0.0, margin].map(|more| samples.by_arc_length(more) <= margin);
        let is_near = truth <= margin;
        *(if is_near { &mut counts.near } else { &mut counts.clear }) += 1;
        for (rule, says) in [ours, arcs, longer].into_iter().enumerate() {
            counts.missed[rule] += u32::from(is_near && !says);
            counts.forbidden[rule] += u32::from(!is_near && says);
        }
    }
    Ok(counts)
}

fn table(my: &Options) -> Result<String, String> {
    let mut page = format!(
        "{} random shapes of each robot (`{}`), each searched among samples. *Tendons*: 3 sections of 60 mm, radius 5 mm. *Tubes*: \
         concentric, radius 1.25 to 0.5 mm. *Snake*: 20 links of 20 mm, radius 9 mm. A shape is near itself if the distance of two places, \
         less both radii, is a local minimum and within the margin. Shapes that the samples leave unclear do not count. The \
         planner's rule takes all pairs of samples more than 3 radii apart along the robot, or more than 3 radii and the \
         margin.\n\n\
         | robot | margin, mm | near itself | clear | unclear | `SelfQuery::clears` misses | forbids | 3 radii: misses | forbids | 3 radii and the margin: misses | forbids |\n\
         |---|---|---|---|---|---|---|---|---|---|---|\n",
        my.shapes,
        command::line("-p continuum-studies --bin own_parts")
    );
    for (name, radius, shape) in ROBOTS {
        for margin in [0.0, 0.5 * radius, radius] {
            let Counts { near, clear, missed, forbidden, unclear } = counted(my, shape, margin)?;
            let _ = writeln!(
                page,
                "| {name} | {margin} | {near} | {clear} | {unclear} | {} | {} | {} | {} | {} | {} |",
                missed[0], forbidden[0], missed[1], forbidden[1], missed[2], forbidden[2]
            );
        }
    }
    Ok(page)
}

fn main() -> ExitCode {
    command::run(|my: &Options| {
        let table = table(my)?;
        print!("{table}");
        quote::in_page(&table, "own_parts", &my.out.join("book/robots.md"))?;
        let picture = my.out.join("self.svg");
        draw(&picture).map_err(|error| format!("cannot draw {} ({error})", picture.display()))
    })
}

/// The robots of the picture: a name, and the arcs of the centreline, each a length and a turn.
const DRAWN: [(&str, &[[f64; 2]]); 3] = [
    ("a gentle bend", &[[60.0, 1.5]]),
    ("a sharp bend", &[[20.0, 0.0], [17.0, 2.7], [20.0, 0.0]]),
    ("a hairpin", &[[30.0, 0.0], [25.2, std::f64::consts::PI], [30.0, 0.0]]),
];
const DRAWN_RADIUS: f64 = 2.0;
/// Every fourth joint is a corner of the drawn line: shorter pieces show the pixels.
const DRAWN_STEP: usize = 4;
/// The arc length of the picture.
const APART: f64 = 20.0;

/// Draws where robots are nearest to themselves, by local minima and by arc length.
fn draw(path: &Path) -> Result<(), Box<dyn std::error::Error>> {
    // Per millimetre: places are rounded to whole pixels.
    const PIXELS: f64 = 12.0;
    let area = SVGBackend::new(path, (1920, 900)).into_drawing_area();
    area.fill(&WHITE)?;
    let title = format!(
        "How far is a robot from itself? Where it comes back (blue), or {APART} mm further along it (orange)"
    );
    let area = area.titled(&title, ("sans-serif", 40))?;
    for (panel, (name, arcs)) in area.split_evenly((1, 3)).iter().zip(DRAWN) {
        let robot = bent(arcs)?;
        let middle = robot.links().iter().map(|link| link.start()).sum::<Vector>()
            / robot.links().len() as f64;
        let at = |point: Vector| {
            let place = (point - middle) * PIXELS;
            (320 + place.x.round() as i32, 340 - place.y.round() as i32)
        };
        let line: Vec<_> = std::iter::once(robot.links()[0].start())
            .chain(
                robot
                    .links()
                    .iter()
                    .skip(DRAWN_STEP - 1)
                    .step_by(DRAWN_STEP)
                    .map(|link| link.end()),
            )
            .map(at)
            .collect();
        let width = (2.0 * DRAWN_RADIUS * PIXELS) as u32;
        panel.draw(&PathElement::new(line.clone(), RGBColor(205, 210, 215).stroke_width(width)))?;
        panel.draw(&PathElement::new(line, RGBColor(120, 130, 140).stroke_width(2)))?;
        let mut query = SelfQuery::new();
        let minimum = query.minimum(&robot)?;
        let beyond = query.minimum_beyond(&robot, APART)?;
        let rows = [
            (
                "local minima",
                minimum.map(|it| (it.distance, it.witness)),
                RGBColor(0, 114, 178),
                18,
            ),
            ("by arc length", beyond.map(|it| (it.upper, it.witness)), RGBColor(213, 94, 0), 6),
        ];
        let centred = |size: i32, colour: &RGBColor| {
            let style = ("sans-serif", size).into_font().color(colour);
            style.pos(Pos::new(HPos::Center, VPos::Center))
        };
        panel.draw(&Text::new(name, (320, 640), centred(36, &BLACK)))?;
        for (row, (rule, found, colour, thick)) in rows.into_iter().enumerate() {
            let text = match found {
                Some((distance, _)) => format!("{rule}: {distance:.1} mm"),
                None => format!("{rule}: none"),
            };
            panel.draw(&Text::new(text, (320, 700 + 50 * row as i32), centred(34, &colour)))?;
            if let Some((_, witness)) = found {
                let ends = vec![at(witness.on_first), at(witness.on_second)];
                panel.draw(&PathElement::new(ends, colour.stroke_width(thick)))?;
            }
        }
    }
    area.present()?;
    Ok(())
}

/// A robot in a plane of arcs of the given lengths and turns.
fn bent(arcs: &[[f64; 2]]) -> Result<Chain, parry_continuum::RobotError> {
    const STEPS: u32 = 60;
    let (mut points, mut direction) = (vec![Vector::ZERO], 0.0_f64);
    for [length, turn] in arcs {
        for _ in 0..STEPS {
            let half = 0.5 * turn / f64::from(STEPS);
            direction += half;
            let step = Vector::new(direction.cos(), direction.sin(), 0.0);
            points.push(points[points.len() - 1] + step * (length / f64::from(STEPS)));
            direction += half;
        }
    }
    let radii = vec![DRAWN_RADIUS; points.len() - 1];
    Chain::from_centreline(&points, &radii)
}
