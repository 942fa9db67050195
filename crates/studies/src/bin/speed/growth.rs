//! Time against the number of triangles, links and threads: the paper's Figure 9 on the CPU, with
//! culling.

use crate::Effort;
use crate::exhaustive::on_one_thread;
use continuum_demo::subdivide::{in_four, shuffled};
use continuum_demo::timing::{cylinders, medians, parry};
use continuum_demo::ventricle;
use continuum_studies::models::models;
use parry_continuum::Chain;
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{BvhSearch, Exhaustive, Proximity, SearchPrecision};
use plotters::element::DashedPathElement;
use plotters::prelude::*;
use std::fmt::Write;
use std::path::Path;
use std::time::Duration;

/// Triangles of the mesh that is divided.
const SMALLEST: usize = 10_000;

/// Each with a dash of its own: the length of a stroke and of a gap. One stroke is longer than the
/// picture.
const ENGINES: [(&str, [i32; 2]); 4] = [
    ("exhaustive f32", [9, 4]),
    ("exhaustive f64", [2, 4]),
    ("search, again", [10_000, 1]),
    ("parry, link by link", [16, 6]),
];

/// Each model with a colour of its own, which colour-blind readers tell apart (Okabe and Ito).
const COLOURS: [RGBColor; 3] =
    [RGBColor(230, 159, 0), RGBColor(0, 158, 115), RGBColor(0, 114, 178)];

/// A line of the plot.
struct Series {
    name: String,
    /// By the order of the models and of [`ENGINES`].
    model: usize,
    engine: usize,
    /// Triangles and seconds a query.
    points: Vec<(f64, f64)>,
}

/// The chapter of the page; the plot goes to `out`.
pub fn chapter(effort: Effort, out: &Path) -> Result<String, String> {
    let models = models().map_err(|error| error.to_string())?;
    let enough = effort.enough / 10;
    let mut all: Vec<Series> = Vec::new();
    let mut threads = String::new();
    let mut mesh = ventricle::mesh(SMALLEST);
    for step in 0..=effort.largest {
        let (vertices, indices) = shuffled(mesh.clone(), 1);
        let tri_mesh = TriMesh::new(vertices, indices).map_err(|error| error.to_string())?;
        for (model, (short, robot)) in models.iter().enumerate() {
            let job = || -> Result<Vec<f64>, String> {
                let mut times = vec![
                    time(&mut exhaustive::<f32>(&tri_mesh)?, robot, enough)?,
                    time(&mut exhaustive::<f64>(&tri_mesh)?, robot, enough)?,
                    time(
                        &mut BvhSearch::new(&tri_mesh).map_err(|error| error.to_string())?,
                        robot,
                        enough,
                    )?,
                ];
                if *short == "cylinders" {
                    times.push(time_parry(&tri_mesh, robot, enough)?);
                }
                Ok(times)
            };
            for (engine, time) in on_one_thread(job)??.into_iter().enumerate() {
                let point = (tri_mesh.num_triangles() as f64, time);
                match all.iter_mut().find(|series| (series.model, series.engine) == (model, engine))
                {
                    Some(series) => series.points.push(point),
                    None => {
                        let name = format!("{short}, {}", ENGINES[engine].0);
                        all.push(Series { name, model, engine, points: vec![point] });
                    }
                }
            }
        }
        if step == effort.largest {
            threads = scaling(&tri_mesh, &models[1].1, enough)?;
        } else {
            mesh = in_four(mesh);
        }
    }
    plot(&all, &out.join("speed.svg"))?;
    Ok(table(&all)? + &threads)
}

fn exhaustive<T: SearchPrecision>(mesh: &TriMesh) -> Result<Exhaustive<T>, String> {
    Exhaustive::new(mesh).map_err(|error| error.to_string())
}

fn time(engine: &mut dyn Proximity, robot: &Chain, enough: Duration) -> Result<f64, String> {
    let mut out = Vec::new();
    let base = ventricle::entry();
    let mut query = || engine.per_link(robot, &base, &mut out).map_err(|error| error.to_string());
    query()?;
    Ok(medians::<String>(&mut [&mut query], enough)?[0].as_secs_f64())
}

/// The peer: parry's `distance(Cylinder, TriMesh)` for each link.
fn time_parry(mesh: &TriMesh, robot: &Chain, enough: Duration) -> Result<f64, String> {
    let (links, base) = (cylinders(robot), ventricle::entry());
    let mut query = || parry(mesh, &links, &base).map(drop).map_err(|error| error.to_string());
    query()?;
    Ok(medians::<String>(&mut [&mut query], enough)?[0].as_secs_f64())
}

/// Links and threads: how the time of an exhaustive query in single precision grows and shrinks.
fn scaling(mesh: &TriMesh, robot: &Chain, enough: Duration) -> Result<String, String> {
    let links = robot.links().len();
    let points: Vec<_> = robot.links().iter().map(|link| link.start()).collect();
    let radii: Vec<_> = robot.links().iter().map(|link| link.radius()).collect();
    let half = Chain::from_centreline(&points[..=links / 2], &radii[..links / 2])
        .map_err(|error| error.to_string())?;
    let one = on_one_thread(|| -> Result<_, String> {
        let mut engine = exhaustive::<f32>(mesh)?;
        Ok((time(&mut engine, robot, enough)?, time(&mut engine, &half, enough)?))
    })??;
    let all = time(&mut exhaustive::<f32>(mesh)?, robot, enough)?;
    let cores = rayon::current_num_threads();
    Ok(format!(
        "\nAt {} triangles, exhaustive in f32: half of the links take {:.2} of the time of all; {cores} threads are {:.2} \
         times as fast as one.\n",
        mesh.num_triangles(),
        one.1 / one.0,
        one.0 / all
    ))
}

fn table(all: &[Series]) -> Result<String, String> {
    let mut page = String::from(
        "## Growth\n\n\
         A ventricle divided in four again and again and shuffled, 30 links, one thread: time of a per-link query \
         against triangles. The search has the answers of the same query before.\n\n\
         ![Time against triangles](speed.svg)\n\n| microseconds |",
    );
    let write_all = |page: &mut String| -> std::fmt::Result {
        for (triangles, _) in &all[0].points {
            write!(page, " {triangles} |")?;
        }
        write!(page, "\n|---|{}\n", "---|".repeat(all[0].points.len()))?;
        for series in all {
            write!(page, "| {} |", series.name)?;
            for (_, seconds) in &series.points {
                write!(page, " {:.1} |", seconds * 1e6)?;
            }
            writeln!(page)?;
        }
        Ok(())
    };
    write_all(&mut page).map_err(|error| error.to_string())?;
    Ok(page)
}

fn plot(all: &[Series], path: &Path) -> Result<(), String> {
    draw(all, path)
        .map_err(|error| format!("cannot draw {} ({error}); choose another --out", path.display()))
}

fn draw(all: &[Series], path: &Path) -> Result<(), Box<dyn std::error::Error>> {
    if let Some(directory) = path.parent() {
        std::fs::create_dir_all(directory)?;
    }
    // In microseconds.
    let scaled =
        |series: &Series| -> Vec<_> { series.points.iter().map(|p| (p.0, p.1 * 1e6)).collect() };
    let points = || all.iter().flat_map(scaled);
    let (low, high) =
        points().fold((f64::INFINITY, 0.0_f64), |(low, high), p| (low.min(p.1), high.max(p.1)));
    let (few, many) =
        points().fold((f64::INFINITY, 0.0_f64), |(few, many), p| (few.min(p.0), many.max(p.0)));
    let area = SVGBackend::new(path, (900, 560)).into_drawing_area();
    area.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(&area)
        .margin(16)
        .x_label_area_size(40)
        .y_label_area_size(70)
        .build_cartesian_2d(
            (few * 0.9..many * 1.1).log_scale(),
            (low * 0.5..high * 2.0).log_scale(),
        )?;
    chart
        .configure_mesh()
        .x_desc("triangles")
        .y_desc("microseconds a query of 30 links")
        .x_label_formatter(&|x| format!("{x:.0}"))
        .y_label_formatter(&|y| format!("{y:.0}"))
        .draw()?;
    for series in all {
        let (colour, [stroke, gap]) = (COLOURS[series.model], ENGINES[series.engine].1);
        let style = colour.stroke_width(2);
        chart
            .draw_series(DashedLineSeries::new(scaled(series), stroke, gap, style))?
            .label(&series.name)
            .legend(move |(x, y)| {
                DashedPathElement::new([(x, y), (x + 40, y)], stroke, gap, style)
            });
        chart.draw_series(
            scaled(series).into_iter().map(|at| Circle::new(at, 3, colour.filled())),
        )?;
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperLeft)
        .legend_area_size(48)
        .background_style(WHITE.mix(0.8))
        .draw()?;
    area.present()?;
    Ok(())
}
