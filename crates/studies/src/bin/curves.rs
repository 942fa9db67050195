//! Curves as they come: clean, joined, repeated, unevenly spaced, noisy. How many tubes are
//! accepted, how close their bounds are, and how far from the truth; and how finely tubes are
//! divided beside flat faces. Writes `docs/CURVES.md`, the table of `docs/book/tube.md` and the
//! plot `docs/curves.svg`.
//!
//! ```text
//! cargo run --release -p continuum-studies --bin curves
//! ```

use clap::Parser;
use continuum_demo::{ctr, steer};
use continuum_studies::quote;
use continuum_testing::{Arcs, Random};
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{BvhSearch, Clearance};
use parry_continuum::{RobotError, Tube, TubeSection};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Instant;

/// Measure what becomes of curves as they come: clean, joined, uneven and noisy.
#[derive(Parser)]
struct Options {
    /// How many robots
    #[arg(long, value_name = "COUNT", default_value_t = 200)]
    robots: u64,
    /// Where book/tube.md is, and where CURVES.md and the plot go
    #[arg(long, value_name = "DIRECTORY", default_value = "docs")]
    out: PathBuf,
}

const LENGTH: f64 = 80.0;
const RADIUS: f64 = 0.5;

/// The rows of the robot in the demonstration.
const VENTRICLE: &str = "the ventricle's robot";

/// The rows that the book shows.
const SELECTED: [&str; 5] = [
    "the ventricle's robot, 20 frames",
    "clean",
    "clean, 20 frames",
    "100 samples, noise 0.01",
    "100 samples, noise 0.1",
];

/// The head of CURVES.md.
const HEAD: &str = "\
# Curves from samples, frames and noisy points

Written by `cargo run --release -p continuum-studies --bin curves`. [The book](book/tube.md#from-data-to-bounds) describes the
robots and the columns, and shows some of these rows.

";

/// The head of the second table of CURVES.md.
const BESIDE_FACES: &str = "
## Beside flat faces

A tube beside 200 triangles at its flat base: in the plane of the face, beside its rim or beside the tube, level, tilted or across, at
0.001 to 2. A tenth of the tolerance needs a few more pieces. At 10^6 from the origin, rounding leaves the direction of short pieces
open, and with it more than 10^-6 near the face.

";

/// A robot, and a mesh near it.
struct Scene {
    curve: Centreline,
    sections: Vec<TubeSection>,
    /// Where its bends change or its radius does.
    ends: Vec<f64>,
    mesh: TriMesh,
    truth: f64,
}

/// A point of a centreline and the direction there, by arc length.
type Centreline = Arc<dyn Fn(f64) -> (Vector, Vector) + Send + Sync>;

impl Scene {
    /// The robot beside three specks of a wall 0.5 to 5 mm away.
    fn new(
        random: &mut Random,
        curve: Centreline,
        sections: Vec<TubeSection>,
        ends: Vec<f64>,
    ) -> Self {
        let length: f64 = sections.iter().map(|section| section.length).sum();
        let mut vertices = Vec::new();
        for _ in 0..3 {
            let s = random.between(-0.04 * length, 1.04 * length).clamp(0.0, length);
            let (centre, tangent) = curve(s);
            let across = (tangent.cross(random.direction()).normalize()
                + tangent * random.between(-1.0, 1.0))
            .normalize();
            let at = centre + across * (radius_at(&sections, s) + random.between(0.5, 5.0));
            vertices.extend([at, at + random.direction() * 0.3, at + random.direction() * 0.3]);
        }
        let mesh =
            TriMesh::new(vertices, vec![[0, 1, 2], [3, 4, 5], [6, 7, 8]]).expect("three triangles");
        let given = Arc::clone(&curve);
        let exact = Tube::from_function(&sections, move |s| given(s)).expect("a tube");
        let mut search = BvhSearch::new(&mesh).expect("a mesh");
        let truth = search.clearance(&exact, &Pose::IDENTITY, 1e-6).expect("a clearance").upper;
        Self { curve, sections, ends, mesh, truth }
    }

    fn length(&self) -> f64 {
        self.ends[self.ends.len() - 1]
    }

    fn tangents(&self, places: &[f64]) -> Vec<Vector> {
        places.iter().map(|&s| (self.curve)(s).1).collect()
    }
}

/// The radius at an arc length.
fn radius_at(sections: &[TubeSection], s: f64) -> f64 {
    let mut end = 0.0;
    let here = sections.iter().find(|section| {
        end += section.length;
        s <= end
    });
    here.unwrap_or(&sections[sections.len() - 1]).radius
}

/// Three sections of constant curvature, 80 mm long together.
fn scene(seed: u64) -> Scene {
    let mut random = Random::new(seed + 1);
    let mut arcs = Arcs::from_frame(random.pose(20.0));
    let shares = [random.between(0.2, 0.4), random.between(0.2, 0.4)];
    let lengths = [shares[0], shares[1], 1.0 - shares[0] - shares[1]].map(|share| share * LENGTH);
    let parts = lengths.map(|length| {
        let angle = random.between(0.0, 6.3);
        (length, Vector::new(angle.cos(), angle.sin(), 0.0) * random.between(0.0, 0.05))
    });
    arcs.push(RADIUS, &parts);
    let stretch = arcs.stretches[0];
    let section =
        TubeSection { length: stretch.length, radius: RADIUS, curvature: stretch.curvature };
    let ends = vec![lengths[0], lengths[0] + lengths[1], LENGTH];
    Scene::new(&mut random, Arc::new(move |s| arcs.at(s)), vec![section], ends)
}

/// The concentric tube robot of the ventricle, in any shape.
fn concentric_tubes(seed: u64) -> Scene {
    let robot = ctr::three_tubes();
    let joints = robot.any_joints(&mut steer::Random(seed));
    let sections = robot.sections_out(&joints);
    let mut end = 0.0;
    let ends = sections.iter().map(|section| {
        end += section.length;
        end
    });
    let ends = ends.collect();
    let curve = robot.curve(&joints);
    Scene::new(&mut Random::new(seed + 1), Arc::new(move |s| curve.at(s)), sections, ends)
}

/// What a robot is measured like.
#[derive(Clone, Copy)]
struct Input {
    samples: usize,
    spacing: Spacing,
    /// The standard deviation of the noise of each coordinate.
    noise: f64,
}

#[derive(Clone, Copy, PartialEq)]
enum Spacing {
    Even,
    Random,
    /// Evenly in each section, with a sample at each end.
    Sections,
    /// Each section has end points of its own, off by rounding.
    Joined,
    /// One sample is there twice, so far apart.
    Repeated(f64),
}

/// A normally distributed number.
fn normal(random: &mut Random) -> f64 {
    (-2.0 * (1.0 - random.unit()).ln()).sqrt() * (TAU * random.unit()).cos()
}

/// Arc lengths of the samples, and their points.
fn measure(scene: &Scene, input: Input, random: &mut Random) -> (Vec<f64>, Vec<Vector>) {
    let count = input.samples - 1;
    let length = scene.length();
    let mut places: Vec<f64> = (0..=count).map(|k| length * k as f64 / count as f64).collect();
    if input.spacing == Spacing::Random {
        places[1..count].fill_with(|| length * random.unit());
        places.sort_by(f64::total_cmp);
    }
    if input.spacing == Spacing::Sections {
        places.truncate(1);
        let mut from = 0.0;
        for &end in &scene.ends {
            let own = ((end - from) / length * count as f64).round().max(1.0);
            places.extend((1..=own as usize).map(|k| from + (end - from) * k as f64 / own));
            from = end;
        }
    }
    let mut points: Vec<_> = places
        .iter()
        .map(|&s| {
            (scene.curve)(s).0
                + Vector::new(normal(random), normal(random), normal(random)) * input.noise
        })
        .collect();
    match input.spacing {
        Spacing::Joined => {
            for part in 1..3 {
                let at = part * points.len() / 3;
                places.insert(at, places[at]);
                points.insert(at, points[at] + random.direction() * 1e-14);
            }
        }
        Spacing::Repeated(apart) => {
            let at = 1 + random.below(count as u32 - 1) as usize;
            places.insert(at, places[at]);
            points.insert(at, points[at] + random.direction() * apart);
        }
        Spacing::Even | Spacing::Random | Spacing::Sections => {}
    }
    (places, points)
}

/// A way to make a tube of samples.
#[derive(Clone, Copy)]
enum Way {
    Samples,
    SamplesAndTangents,
    Frames,
    /// Within this of each sample.
    Fit(f64),
}

impl Way {
    fn tube(self, scene: &Scene, places: &[f64], points: &[Vector]) -> Result<Tube, RobotError> {
        let middle = |pair: &[f64]| radius_at(&scene.sections, 0.5 * (pair[0] + pair[1]));
        let radii: Vec<_> = places.windows(2).map(middle).collect();
        match self {
            Self::Samples => Tube::from_samples(points, &radii, None),
            Self::SamplesAndTangents => Tube::from_samples(points, &radii, {
                let tangents = scene.tangents(&[0.0, scene.length()]);
                Some([tangents[0], tangents[1]])
            }),
            Self::Frames => Tube::from_frames(points, &scene.tangents(places), &radii),
            Self::Fit(deviation) => Tube::fit(points, &radii, deviation),
        }
    }

    fn name(self) -> String {
        match self {
            Self::Samples => "`from_samples`".to_owned(),
            Self::SamplesAndTangents => "`from_samples` with end tangents".to_owned(),
            Self::Frames => "`from_frames`".to_owned(),
            Self::Fit(deviation) => format!("`fit` within {deviation}"),
        }
    }
}

/// What a way states.
fn deviation(way: Way) -> f64 {
    if let Way::Fit(deviation) = way { deviation } else { 0.0 }
}

/// What came of all robots.
struct Outcome {
    accepted: usize,
    resolved: usize,
    /// The median distance of the bounds, without the stated uncertainty.
    width: f64,
    /// The median of how far the clearance of the tube itself, without its deviation, is from the
    /// truth.
    off: f64,
    covered: usize,
    /// What the tube and the query took at least, in microseconds.
    times: [f64; 2],
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

fn ask(scenes: &[Scene], input: Input, way: Way, tolerance: f64) -> Outcome {
    let mut answers: Vec<(Clearance, f64)> = Vec::new();
    let (mut times, mut off) = ([Vec::new(), Vec::new()], Vec::new());
    for (seed, scene) in (1_000..).zip(scenes) {
        let (places, points) = measure(scene, input, &mut Random::new(seed));
        let mut search = BvhSearch::new(&scene.mesh).expect("a mesh");
        let clock = Instant::now();
        let Ok(tube) = way.tube(scene, &places, &points) else { continue };
        times[0].push(clock.elapsed().as_secs_f64() * 1e6);
        search.prepare();
        let clock = Instant::now();
        let Ok(found) = search.clearance(&tube, &Pose::IDENTITY, tolerance) else { continue };
        times[1].push(clock.elapsed().as_secs_f64() * 1e6);
        answers.push((found, scene.truth));
        // Of the fitted curve itself, where no face is near.
        let Ok(found) = search.clearance(&tube, &Pose::IDENTITY, 1e-3) else { continue };
        if found.uncertainty <= 2.0 * deviation(way) && found.lower > 0.0 {
            off.push((0.5 * (found.upper + found.lower) - scene.truth).abs());
        }
    }
    let widths = answers
        .iter()
        .map(|(found, _)| (found.upper - found.lower - found.uncertainty).max(0.0))
        .collect();
    Outcome {
        accepted: answers.len(),
        resolved: answers.iter().filter(|(found, _)| found.resolved).count(),
        width: median(widths),
        off: median(off),
        covered: answers
            .iter()
            .filter(|(found, truth)| found.lower <= *truth && *truth <= found.upper + 1e-6)
            .count(),
        times: times.map(|times| times.into_iter().fold(f64::NAN, f64::min)),
    }
}

fn main() -> ExitCode {
    let my = Options::parse();
    let scenes: Vec<_> = (0..my.robots).map(scene).collect();
    let ventricle: Vec<_> = (0..my.robots).map(concentric_tubes).collect();
    let clean = |samples| Input { samples, spacing: Spacing::Even, noise: 0.0 };
    let spaced = |spacing| Input { spacing, ..clean(100) };
    let noisy = |samples, noise| Input { noise, ..clean(samples) };
    let scattered = |noise| Input { spacing: Spacing::Random, ..noisy(100, noise) };
    use Way::{Fit, Frames, Samples, SamplesAndTangents};
    let at_ends = |samples| Input { spacing: Spacing::Sections, ..clean(samples) };
    let mut rows: Vec<(String, Input, Way, f64)> = vec![
        (format!("{VENTRICLE}, 20 frames"), at_ends(20), Frames, 0.01),
        (format!("{VENTRICLE}, 60 frames"), at_ends(60), Frames, 0.001),
        ("clean".into(), clean(100), Samples, 0.1),
        ("clean".into(), clean(100), Samples, 0.01),
        ("clean".into(), clean(100), SamplesAndTangents, 0.01),
        ("clean, 20 frames".into(), clean(20), Frames, 0.01),
        ("clean, 60 frames".into(), clean(60), Frames, 0.001),
        ("clean, 20 frames, at the sections' ends too".into(), at_ends(20), Frames, 0.01),
        ("clean, 60 frames, at the sections' ends too".into(), at_ends(60), Frames, 0.001),
        (
            "three sections with end points of their own".into(),
            spaced(Spacing::Joined),
            Samples,
            0.1,
        ),
        ("at random places".into(), scattered(0.0), Samples, 0.1),
        ("at random places".into(), scattered(0.0), Samples, 0.2),
        ("at random places".into(), scattered(0.0), Fit(0.01), 0.1),
    ];
    for apart in [1e-15, 1e-12, 1e-8, 1e-4, 1e-2] {
        let name = format!("one sample twice, {apart:e} apart");
        rows.push((name.clone(), spaced(Spacing::Repeated(apart)), Samples, 0.1));
        rows.push((name, spaced(Spacing::Repeated(apart)), Fit(0.02), 0.1));
    }
    for noise in [1e-4, 1e-2] {
        let name = format!("at random places, noise {noise}");
        rows.push((name.clone(), scattered(noise), Samples, 0.1));
        rows.push((name, scattered(noise), Fit(5.0 * noise), 0.1));
    }
    for samples in [50, 100, 200, 400, 800] {
        for noise in [0.01, 0.03, 0.1, 0.2, 0.5] {
            let name = format!("{samples} samples, noise {noise}");
            if noise <= 0.2 && samples <= 400 {
                rows.push((name.clone(), noisy(samples, noise), Samples, 0.1));
            }
            rows.push((name, noisy(samples, noise), Fit(5.0 * noise), 0.1));
        }
    }
    let mut table = String::from(
        "| 100 samples unless said otherwise | tube | tolerance | accepted | resolved | bounds apart | off the truth | truth within | µs for the tube, the query, at least |\n\
         |---|---|---|---|---|---|---|---|---|\n",
    );
    let mut selection = table.clone();
    let mut counts = Vec::new();
    for (name, input, way, tolerance) in &rows {
        let Outcome { accepted, resolved, width, off, covered, times } = ask(
            if name.starts_with(VENTRICLE) { &ventricle } else { &scenes },
            *input,
            *way,
            *tolerance,
        );
        let [tube, query] = times;
        let row = format!(
            "| {name} | {} | {tolerance} | {accepted} | {resolved} | {} | {} | {covered} | {}, {} |\n",
            way.name(),
            number(width, 2),
            number(off, 2),
            number(tube, 0),
            number(query, 0)
        );
        table.push_str(&row);
        if SELECTED.contains(&name.as_str()) {
            selection.push_str(&row);
        }
        if input.noise > 0.0 && input.spacing == Spacing::Even {
            counts.push((matches!(way, Fit(_)), input.samples, input.noise, resolved));
        }
    }
    print!("{table}");
    let faces = faces(my.robots);
    print!("{faces}");
    let page = my.out.join("book/tube.md");
    let written =
        fs::write(my.out.join("CURVES.md"), format!("{HEAD}{table}{BESIDE_FACES}{faces}"))
            .map_err(|error| error.to_string())
            .and_then(|()| quote::in_page(&selection, "curves", &page));
    let written = written.and_then(|()| {
        plot(&counts, my.robots, &my.out.join("curves.svg")).map_err(|error| error.to_string())
    });
    match written {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

/// A tube of radius 1 beside triangles that are near its flat base: how finely it is divided, and
/// how long that takes.
fn faces(count: u64) -> String {
    let mut table = String::from(
        "| tube of radius 1 | tolerance | pieces, median | most | resolved | µs, median | most |\n|---|---|---|---|---|---|---|\n",
    );
    for (name, length, bend, far) in [
        ("4 long, bent by 0.2", 4.0, 0.2, 0.0),
        ("0.3 long, bent by 0.9", 0.3, 0.9, 0.0),
        ("5 long, bent by 0.2, 10^6 from the origin", 5.0, 0.2, 1e6),
    ] {
        let mut arcs = Arcs::from_frame(Pose::IDENTITY);
        arcs.push(1.0, &[(length, Vector::X * bend)]);
        let arcs = Arc::new(arcs);
        let section = TubeSection { length, radius: 1.0, curvature: bend };
        let tube = Tube::from_function(&[section], move |s| arcs.at(s)).expect("a tube");
        for tolerance in [1e-4, 1e-5, 1e-6, 1e-7] {
            let (mut pieces, mut times, mut resolved) = (Vec::new(), Vec::new(), 0);
            for seed in 0..count {
                let mut random = Random::new(seed + 1);
                // In the plane of the face, beside its rim or beside it, level, tilted or across.
                let gap = [0.3, 1e-3, 2.0][random.below(3) as usize];
                let angle = random.between(0.0, 6.3);
                let rim = Vector::new(angle.cos(), angle.sin(), 0.0) * random.between(0.0, 1.5);
                let tilt = [0.0, 0.1, 1.0][random.below(3) as usize];
                let corner = |random: &mut Random| {
                    let along = random.point() * Vector::new(2.0, 2.0, tilt);
                    rim + Vector::Z * -gap + along
                };
                let corners = (0..3).map(|_| corner(&mut random)).collect();
                let mesh = TriMesh::new(corners, vec![[0, 1, 2]]).expect("a triangle");
                let pose = Pose::from_translation(Vector::new(far, -far, far));
                let moved = TriMesh::new(
                    mesh.vertices().iter().map(|p| pose * *p).collect(),
                    vec![[0, 1, 2]],
                );
                let mut search = BvhSearch::new(&moved.expect("a triangle")).expect("a mesh");
                let mut all = Vec::new();
                let found = search
                    .clearance_pieces(&tube, &pose, tolerance, &mut all)
                    .expect("a clearance");
                let time = (0..5).map(|_| {
                    search.forget();
                    let clock = Instant::now();
                    search.clearance(&tube, &pose, tolerance).expect("a clearance");
                    clock.elapsed().as_secs_f64() * 1e6
                });
                times.push(time.fold(f64::INFINITY, f64::min));
                pieces.push(all.len() as f64);
                resolved += usize::from(found.resolved);
            }
            let most = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
            let [most_pieces, most_time] = [most(&pieces), most(&times)];
            let _ = writeln!(
                table,
                "| {name} | {tolerance:e} | {} | {most_pieces} | {resolved} of {count} | {:.0} | {most_time:.0} |",
                median(pieces),
                median(times)
            );
        }
    }
    table
}

/// A number as the table shows it, if there is one.
fn number(value: f64, digits: usize) -> String {
    match digits {
        _ if value.is_nan() => "none".into(),
        0 => format!("{value:.0}"),
        _ => format!("{value:.digits$e}"),
    }
}

/// The fewest and the most samples in the plot: with more, `from_samples` is not measured.
const FEWEST: f64 = 50.0;
const MOST: usize = 400;

/// How many robots are resolved, against the number of noisy samples: a line for each noise of
/// `from_samples`, and one for all noises of `fit`, which resolves as many at each.
fn plot(
    resolved: &[(bool, usize, f64, usize)],
    robots: u64,
    path: &Path,
) -> Result<(), Box<dyn std::error::Error>> {
    let area = SVGBackend::new(path, (900, 400)).into_drawing_area();
    area.fill(&WHITE)?;
    // Every tick has twice the samples of the one before; on the right there is room for names.
    let title = "Noisy samples: fit finds the clearance within 0.1 mm, from_samples soon does not";
    let mut chart = ChartBuilder::on(&area)
        .caption(title, ("sans-serif", 20))
        .margin(14)
        .x_label_area_size(44)
        .y_label_area_size(56)
        .build_cartesian_2d(-0.3..3.95, -0.05 * robots as f64..1.1 * robots as f64)?;
    chart
        .configure_mesh()
        .x_desc("samples along 80 mm")
        .y_desc(format!("of {robots} robots: bounds within 0.1 mm"))
        .label_style(("sans-serif", 14))
        .light_line_style(TRANSPARENT)
        .bold_line_style(BLACK.mix(0.15))
        .disable_x_mesh()
        .x_labels(5)
        .y_labels(5)
        .x_label_formatter(&|doubled: &f64| format!("{:.0}", FEWEST * doubled.exp2()))
        .y_label_formatter(&|resolved| format!("{resolved:.0}"))
        .draw()?;
    // At each number of samples the fewest of all its noises.
    let line = |by_fit: bool, noises: &[f64]| {
        let mut line: Vec<(f64, f64)> = Vec::new();
        for &(_, samples, _, count) in resolved.iter().filter(|&&(fit, samples, noise, _)| {
            fit == by_fit && samples <= MOST && noises.contains(&noise)
        }) {
            let (x, y) = ((samples as f64 / FEWEST).log2(), count as f64);
            match line.iter_mut().find(|at| at.0 == x) {
                Some(at) => at.1 = at.1.min(y),
                None => line.push((x, y)),
            }
        }
        line.sort_by(|a, b| a.0.total_cmp(&b.0));
        line
    };
    let (vermilion, blue) = (RGBColor(213, 94, 0), RGBColor(0, 114, 178));
    // Each with its name beside one of its points: which, and on which side.
    let lines = [
        ("fit, noise up to 0.5 mm", BLACK, line(true, &[0.01, 0.03, 0.1, 0.2, 0.5]), 3, HPos::Left),
        ("from_samples, noise 0.01 mm", blue, line(false, &[0.01]), 3, HPos::Left),
        ("from_samples, noise 0.03 mm", vermilion, line(false, &[0.03]), 2, HPos::Right),
        ("from_samples, noise 0.1 mm", RGBColor(100, 100, 100), line(false, &[0.1]), 0, HPos::Left),
    ];
    for (corners, (name, colour, points, named, side)) in lines.into_iter().enumerate() {
        chart.draw_series(LineSeries::new(points.clone(), colour.stroke_width(2)))?;
        chart.draw_series(
            points.iter().map(|&at| EmptyElement::at(at) + mark(corners, colour.filled())),
        )?;
        if let Some(&at) = points.get(named) {
            let style = ("sans-serif", 15).into_font().color(&colour);
            let aside = if matches!(side, HPos::Left) { 12 } else { -12 };
            let style = style.pos(Pos::new(side, VPos::Bottom));
            chart.draw_series([EmptyElement::at(at) + Text::new(name, (aside, -4), style)])?;
        }
    }
    area.present()?;
    Ok(())
}

/// A shape for each line, so that the plot needs no colours: a disc, a square, a triangle, a
/// diamond.
fn mark(number: usize, style: ShapeStyle) -> Polygon<(i32, i32)> {
    let (corners, turn) = [(24, 0.0), (4, 0.125), (3, 0.0), (4, 0.0)][number];
    let corner = |k: i32| {
        let (sine, cosine) = (TAU * (f64::from(k) / f64::from(corners) + turn)).sin_cos();
        ((6.0 * sine).round() as i32, -(6.0 * cosine).round() as i32)
    };
    Polygon::new((0..corners).map(corner).collect::<Vec<_>>(), style)
}
