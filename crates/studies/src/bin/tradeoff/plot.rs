//! The picture: error against time of the front, of tubes and of parry's shapes.

use crate::front::{Combination, front};
use crate::subject::Model;
use plotters::coord::Shift;
use plotters::coord::combinators::WithKeyPoints;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::fs;
use std::path::Path;

type Log = LogCoord<f64>;
type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<WithKeyPoints<Log>, Log>>;
type Drawn = Result<(), Box<dyn std::error::Error>>;

const SIZE: (u32, u32) = (1000, 680);
/// Of a series: what the legend calls it, its colour (Okabe and Ito) and its mark, which tells it
/// from the others in grey too.
type Style = (&'static str, RGBColor, fn((i32, i32), RGBColor) -> Polygon<(i32, i32)>);
const FRONT: Style = ("front: nothing is both faster and more accurate", BLACK, disc);
const TUBE: Style = ("tube, warm start", RGBColor(213, 94, 0), diamond);
const PARRY_CYLINDER: Style = ("parry's Cylinder", RGBColor(0, 114, 178), square);
const PARRY_CAPSULE: Style = ("parry's Capsule", RGBColor(86, 180, 233), triangle);

/// The ways to ask whose times `tradeoff_links.csv` has, in order.
const WAYS: [&str; 4] = ["search, first time", AGAIN, "exhaustive, f32", "exhaustive, f64"];
const AGAIN: &str = "search, again";

/// Draws the combinations into an SVG file.
pub fn draw(all: &[Combination], path: &Path) -> Result<(), String> {
    draw_file(all, path)
        .map_err(|error| format!("cannot draw {} ({error}); choose another --out", path.display()))
}

/// Returns the combinations of `tradeoff_links.csv`.
pub fn from_table(path: &Path) -> Result<Vec<Combination>, String> {
    let rows = fs::read_to_string(path)
        .map_err(|error| format!("cannot read {} ({error})", path.display()))?;
    Ok(rows.lines().skip(1).filter_map(of_row).flatten().collect())
}

/// The combinations of a row, one for each way to ask that was timed.
fn of_row(row: &str) -> Option<Vec<Combination>> {
    let cells: Vec<_> = row.split(',').collect();
    let [name, within, links, times @ .., _, over, under] = &cells[..] else { return None };
    let model = Model::ALL.into_iter().find(|model| model.name() == *name)?;
    let number = |cell: &str| cell.parse::<f64>().ok();
    let (tolerance, links) = (number(within)?, links.parse().ok());
    let error = number(over)?.abs().max(number(under)?.abs());
    let timed = WAYS.into_iter().zip(times).filter_map(|(way, time)| {
        Some(Combination { model, tolerance, links, way, time: number(time)? * 1e-6, error })
    });
    Some(timed.collect())
}

fn draw_file(all: &[Combination], path: &Path) -> Drawn {
    let area = SVGBackend::new(path, SIZE).into_drawing_area();
    area.fill(&WHITE)?;
    // A logarithmic axis has no place for an error of 0.
    let all: Vec<_> = all.iter().filter(|one| one.error > 0.0).cloned().collect();
    let line = front(&all);
    let of = |model: Model, way: Option<&str>| -> Vec<_> {
        let is_of = |one: &&Combination| one.model == model && way.is_none_or(|way| one.way == way);
        all.iter().filter(is_of).map(place).collect()
    };
    let series = [
        (PARRY_CAPSULE, of(Model::ParryCapsule, None)),
        (PARRY_CYLINDER, of(Model::ParryCylinder, None)),
        (TUBE, of(Model::Tube, Some(AGAIN))),
        (FRONT, line.iter().map(place).collect()),
    ];
    if !line.is_empty() {
        marks(&line, &series, &area)?;
    }
    area.present()?;
    Ok(())
}

/// Microseconds and millimetres.
fn place(one: &Combination) -> (f64, f64) {
    (one.time * 1e6, one.error)
}

fn marks(
    line: &[Combination],
    series: &[(Style, Vec<(f64, f64)>); 4],
    area: &DrawingArea<SVGBackend, Shift>,
) -> Drawn {
    let range = |of: fn(&(f64, f64)) -> f64| {
        series
            .iter()
            .flat_map(|(_, points)| points)
            .map(of)
            .fold((f64::INFINITY, 0.0_f64), |(low, high), value| (low.min(value), high.max(value)))
    };
    let ((fast, slow), (good, bad)) = (range(|at| at.0), range(|at| at.1));
    let ticks = (-6..9).flat_map(|power| [1.0, 2.0, 5.0].map(|x| x * 10.0_f64.powi(power)));
    let ticks = ticks.filter(|tick| (fast * 0.35..slow * 1.8).contains(tick)).collect();
    let mut chart = ChartBuilder::on(area)
        .caption("What accuracy costs: the fastest query for each error", ("sans-serif", 22))
        .margin(16)
        .x_label_area_size(48)
        .y_label_area_size(72)
        // Room for the labels on the left, and for the legend below the points.
        .build_cartesian_2d(
            (fast * 0.35..slow * 1.8).log_scale().with_key_points(ticks),
            (good * 0.2..bad * 2.0).log_scale(),
        )?;
    chart
        .configure_mesh()
        .x_desc("microseconds for the clearance of the whole robot (median)")
        .y_desc("worst error of the clearance, mm")
        .label_style(("sans-serif", 14))
        .x_label_formatter(&|x| number(*x))
        .y_label_formatter(&|y| number(*y))
        .disable_mesh()
        .draw()?;
    // The front is a staircase: up to the next error, the faster combination serves.
    let mut corners: Vec<(f64, f64)> = Vec::new();
    for at in line.iter().map(place) {
        if let Some(&(_, before)) = corners.last() {
            corners.push((at.0, before));
        }
        corners.push(at);
    }
    chart.draw_series(LineSeries::new(corners, BLACK.stroke_width(2)))?;
    for &((name, colour, mark), ref points) in series {
        chart
            .draw_series(points.iter().map(|&at| EmptyElement::at(at) + mark((0, 0), colour)))?
            .label(name)
            .legend(move |(x, y)| mark((x + 9, y), colour));
    }
    labels(line, &mut chart)?;
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::LowerLeft)
        .label_font(("sans-serif", 15))
        .background_style(WHITE)
        .border_style(RGBColor(190, 190, 190))
        .draw()?;
    Ok(())
}

/// Names the combinations of the front, on the left of the staircase, where nothing else is.
fn labels(line: &[Combination], chart: &mut Chart) -> Drawn {
    let place_of_text = Pos::new(HPos::Right, VPos::Center);
    let style = ("sans-serif", 14).into_font().color(&BLACK).pos(place_of_text);
    chart.draw_series(line.iter().map(|one| {
        let label = format!("{} within {} mm", one.model.name(), one.tolerance);
        EmptyElement::at(place(one)) + Text::new(label, (-10, 0), style.clone())
    }))?;
    Ok(())
}

fn polygon(
    (x, y): (i32, i32),
    colour: RGBColor,
    corners: u32,
    turn: f64,
    size: f64,
) -> Polygon<(i32, i32)> {
    let corner = |k: u32| {
        let turns = f64::from(k) / f64::from(corners) + turn;
        let (sine, cosine) = (std::f64::consts::TAU * turns).sin_cos();
        (x + (size * sine).round() as i32, y - (size * cosine).round() as i32)
    };
    Polygon::new((0..corners).map(corner).collect::<Vec<_>>(), colour.filled())
}

fn disc(at: (i32, i32), colour: RGBColor) -> Polygon<(i32, i32)> {
    polygon(at, colour, 24, 0.0, 4.0)
}

fn diamond(at: (i32, i32), colour: RGBColor) -> Polygon<(i32, i32)> {
    polygon(at, colour, 4, 0.0, 8.0)
}

fn square(at: (i32, i32), colour: RGBColor) -> Polygon<(i32, i32)> {
    polygon(at, colour, 4, 0.125, 7.0)
}

fn triangle(at: (i32, i32), colour: RGBColor) -> Polygon<(i32, i32)> {
    polygon(at, colour, 3, 0.0, 7.0)
}

/// A number without needless digits.
fn number(x: f64) -> String {
    if x >= 1.0 { format!("{x:.0}") } else { format!("{x}") }
}
