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
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::fmt::Write;
use std::path::Path;
use std::time::Duration;

/// Triangles of the mesh that is divided.
const SMALLEST: usize = 10_000;

const ENGINES: [&str; 4] =
    ["exhaustive f32", "exhaustive f64", "search, warm start", "parry, link by link"];

/// The lines of the plot, all with cylinders, which parry has too: their place in [`ENGINES`],
/// name, colour (Okabe and Ito) and mark.
const PLOTTED: [(usize, &str, RGBColor, Mark); 3] = [
    (3, "parry, link by link", RGBColor(0, 0, 0), Mark::Square),
    (0, "every triangle, f32", RGBColor(213, 94, 0), Mark::Triangle),
    (2, "search, warm start", RGBColor(0, 114, 178), Mark::Disc),
];
/// The place of cylinders among the models.
const CYLINDERS: usize = 2;

#[derive(Clone, Copy)]
enum Mark {
    Disc,
    Square,
    Triangle,
}

/// A row of the table.
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
                        let name = format!("{short}, {}", ENGINES[engine]);
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
         against triangles. *Warm start*: the search has the answers of the same query before. The picture is of \
         cylinders, which parry has too.\n\n\
         ![Time against triangles, for cylinders: parry's line is steep, the line of the search rises slowly.](speed.svg)\n\n\
         | microseconds |",
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
    let lines = PLOTTED.map(|(engine, name, colour, mark)| {
        let of = |series: &&Series| (series.model, series.engine) == (CYLINDERS, engine);
        let series = all.iter().filter(of).flat_map(|series| &series.points);
        // In microseconds.
        let points: Vec<_> =
            series.map(|&(triangles, seconds)| (triangles, seconds * 1e6)).collect();
        (name, colour, mark, points)
    });
    let points = || lines.iter().flat_map(|line| &line.3);
    let (low, high) =
        points().fold((f64::INFINITY, 0.0_f64), |(low, high), p| (low.min(p.1), high.max(p.1)));
    let (few, many) =
        points().fold((f64::INFINITY, 0.0_f64), |(few, many), p| (few.min(p.0), many.max(p.0)));
    let area = SVGBackend::new(path, (900, 520)).into_drawing_area();
    area.fill(&WHITE)?;
    let times = |k: usize| lines[k].3.iter().map(|point| point.1);
    let ratios = times(0).zip(times(2)).map(|(parry, search)| parry / search);
    let (least, most) =
        ratios.fold((f64::INFINITY, 0.0_f64), |(least, most), x| (least.min(x), most.max(x)));
    let title = format!(
        "All distances of 30 cylinders in a ventricle: {} to {} times as fast as parry",
        number(least),
        number(most)
    );
    let mut chart = ChartBuilder::on(&area)
        .caption(title, ("sans-serif", 20))
        .margin(16)
        .x_label_area_size(44)
        .y_label_area_size(76)
        // Room for the names at the lines' ends.
        .build_cartesian_2d(
            (few * 0.8..many * (many / few).powf(0.27)).log_scale(),
            (low * 0.4..high * 2.5).log_scale(),
        )?;
    chart
        .configure_mesh()
        .x_desc("triangles of the mesh")
        .y_desc("microseconds")
        .label_style(("sans-serif", 14))
        .light_line_style(TRANSPARENT)
        .bold_line_style(BLACK.mix(0.15))
        .x_label_formatter(&|x| number(*x))
        .y_label_formatter(&|y| number(*y))
        .draw()?;
    for (name, colour, mark, points) in lines {
        chart.draw_series(LineSeries::new(points.clone(), colour.stroke_width(2)))?;
        for &at in &points {
            let style = colour.filled();
            match mark {
                Mark::Disc => chart.draw_series([Circle::new(at, 4, style)])?,
                Mark::Triangle => chart.draw_series([TriangleMarker::new(at, 6, style)])?,
                Mark::Square => {
                    let square = Rectangle::new([(-4, -4), (4, 4)], style);
                    chart.draw_series([EmptyElement::at(at) + square])?
                }
            };
        }
        if let Some(&end) = points.last() {
            let place = Pos::new(HPos::Left, VPos::Center);
            let style = ("sans-serif", 16).into_font().color(&colour).pos(place);
            chart.draw_series([EmptyElement::at(end) + Text::new(name, (14, 0), style)])?;
        }
    }
    area.present()?;
    Ok(())
}

/// A number with commas between thousands.
fn number(x: f64) -> String {
    let digits = format!("{x:.0}");
    let mut grouped = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            grouped.push(',');
        }
        grouped.push(digit);
    }
    grouped
}
