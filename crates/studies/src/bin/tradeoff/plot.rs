//! The picture: error against time, one mark for each combination, and the front.

use crate::front::{Combination, front};
use crate::subject::Model;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::path::Path;

type Log = LogCoord<f64>;
type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<Log, Log>>;
type Drawn = Result<(), Box<dyn std::error::Error>>;

const SIZE: (u32, u32) = (1000, 680);

/// Draws the combinations into an SVG file.
pub fn draw(all: &[Combination], path: &Path) -> Result<(), String> {
    draw_file(all, path)
        .map_err(|error| format!("cannot draw {} ({error}); choose another --out", path.display()))
}

fn draw_file(all: &[Combination], path: &Path) -> Drawn {
    let area = SVGBackend::new(path, SIZE).into_drawing_area();
    area.fill(&WHITE)?;
    // A logarithmic axis has no place for an error of 0.
    let all: Vec<_> = all.iter().filter(|one| one.error > 0.0).cloned().collect();
    if !all.is_empty() {
        marks(&all, &area)?;
    }
    area.present()?;
    Ok(())
}

fn marks(all: &[Combination], area: &DrawingArea<SVGBackend, Shift>) -> Drawn {
    let range = |of: fn(&Combination) -> f64| {
        all.iter()
            .map(of)
            .fold((f64::INFINITY, 0.0_f64), |(low, high), value| (low.min(value), high.max(value)))
    };
    let ((fast, slow), (good, bad)) = (range(|one| one.time * 1e6), range(|one| one.error));
    let mut chart = ChartBuilder::on(area)
        .margin(16)
        .x_label_area_size(44)
        .y_label_area_size(64)
        // Room for the front's labels on the left, and for the legend on the right.
        .build_cartesian_2d(
            (fast * 0.3..slow * 25.0).log_scale(),
            (good * 0.4..bad * 2.0).log_scale(),
        )?;
    chart
        .configure_mesh()
        .x_desc("microseconds a query of the whole robot (median)")
        .y_desc("worst error of the clearance, mm")
        .x_label_formatter(&|x| number(*x))
        .y_label_formatter(&|y| number(*y))
        .light_line_style(WHITE)
        .draw()?;

    let line = front(all);
    let mut corners: Vec<(f64, f64)> = Vec::new();
    for one in &line {
        if let Some(&(_, before)) = corners.last() {
            corners.push((one.time * 1e6, before));
        }
        corners.push((one.time * 1e6, one.error));
    }
    chart
        .draw_series(LineSeries::new(corners, BLACK.stroke_width(1)))?
        .label("front: nothing is both faster and better")
        .legend(|(x, y)| PathElement::new([(x, y), (x + 14, y)], BLACK.stroke_width(1)));
    for one in all {
        mark(&mut chart, (one.time * 1e6, one.error), one.way, colour(one.model))?;
    }
    // A label goes down, line by line, until it is on no other.
    let mut labels: Vec<(i32, i32)> = Vec::new();
    for one in &line {
        let style =
            ("sans-serif", 12).into_font().color(&BLACK).pos(Pos::new(HPos::Right, VPos::Top));
        let label = format!("{}, {} mm", one.model.name().replace(',', ""), one.tolerance);
        let at = (one.time * 1e6, one.error);
        let (x, y) = chart.backend_coord(&at);
        let is_taken = |down: &i32| {
            labels
                .iter()
                .any(|label| (label.0 - x).abs() < 150 && (label.1 - y - down).abs() < LINE)
        };
        let down = (0..).map(|row| 4 + row * LINE).find(|down| !is_taken(down)).unwrap_or(4);
        labels.push((x, y + down));
        chart.draw_series([EmptyElement::at(at) + Text::new(label, (-7, down), style)])?;
    }
    legend(all, &mut chart)?;
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperRight)
        .background_style(WHITE.mix(0.9))
        .border_style(RGBColor(190, 190, 190))
        .draw()?;
    Ok(())
}

/// The height of a label, in pixels.
const LINE: i32 = 13;

/// Every model by its colour, then every way by its mark.
fn legend(all: &[Combination], chart: &mut Chart) -> Drawn {
    let nothing = std::iter::empty::<Circle<(f64, f64), i32>>;
    for model in Model::ALL {
        let colour = colour(model);
        chart
            .draw_series(nothing())?
            .label(model.name())
            .legend(move |(x, y)| Rectangle::new([(x, y - 5), (x + 14, y + 5)], colour.filled()));
    }
    let mut ways: Vec<_> = all.iter().map(|one| one.way).collect();
    ways.dedup();
    ways.sort_unstable();
    ways.dedup();
    for way in ways {
        let series = chart.draw_series(nothing())?.label(way);
        match shape(way) {
            Shape::Disc => series.legend(|(x, y)| Circle::new((x + 7, y), 4, BLACK.filled())),
            Shape::Ring => {
                series.legend(|(x, y)| Circle::new((x + 7, y), 4, BLACK.stroke_width(1)))
            }
            Shape::Triangle => {
                series.legend(|(x, y)| TriangleMarker::new((x + 7, y), 5, BLACK.filled()))
            }
            Shape::Cross => {
                series.legend(|(x, y)| Cross::new((x + 7, y), 4, BLACK.stroke_width(1)))
            }
            Shape::Square => series
                .legend(|(x, y)| Rectangle::new([(x + 4, y - 3), (x + 10, y + 3)], BLACK.filled())),
            Shape::Frame => series.legend(|(x, y)| {
                Rectangle::new([(x + 3, y - 4), (x + 11, y + 4)], BLACK.stroke_width(1))
            }),
            Shape::Diamond => series.legend(|(x, y)| diamond((x + 7, y), BLACK.stroke_width(1))),
        };
    }
    Ok(())
}

#[derive(Clone, Copy)]
enum Shape {
    Disc,
    Ring,
    Triangle,
    Cross,
    Square,
    Frame,
    Diamond,
}

fn shape(way: &str) -> Shape {
    match way {
        "search, again" => Shape::Disc,
        "search, first time" => Shape::Ring,
        "exhaustive, f32" => Shape::Triangle,
        "exhaustive, f64" => Shape::Cross,
        "parry's search" => Shape::Square,
        "GPU, f32" => Shape::Frame,
        _ => Shape::Diamond,
    }
}

/// Colours that people with and without colour blindness can tell apart (Okabe and Ito).
fn colour(model: Model) -> RGBColor {
    match model {
        Model::Tube => RGBColor(213, 94, 0),
        Model::Capsule => RGBColor(230, 159, 0),
        Model::Cylinder => RGBColor(86, 180, 233),
        Model::Modified => RGBColor(0, 158, 115),
        Model::Faced => RGBColor(0, 114, 178),
        Model::ParryCapsule => RGBColor(204, 121, 167),
        Model::ParryCylinder => RGBColor(80, 80, 80),
        Model::Spheres => RGBColor(160, 160, 160),
    }
}

fn mark(chart: &mut Chart, at: (f64, f64), way: &str, colour: RGBColor) -> Drawn {
    // What lies below shows through.
    let colour = colour.mix(0.75);
    match shape(way) {
        Shape::Disc => chart.draw_series([Circle::new(at, 4, colour.filled())])?,
        Shape::Ring => chart.draw_series([Circle::new(at, 4, colour.stroke_width(1))])?,
        Shape::Triangle => chart.draw_series([TriangleMarker::new(at, 5, colour.filled())])?,
        Shape::Cross => chart.draw_series([Cross::new(at, 4, colour.stroke_width(2))])?,
        Shape::Square => {
            let square = Rectangle::new([(-3, -3), (3, 3)], colour.filled());
            chart.draw_series([EmptyElement::at(at) + square])?
        }
        Shape::Frame => {
            let frame = Rectangle::new([(-4, -4), (4, 4)], colour.stroke_width(1));
            chart.draw_series([EmptyElement::at(at) + frame])?
        }
        Shape::Diamond => {
            chart.draw_series([EmptyElement::at(at) + diamond((0, 0), colour.stroke_width(1))])?
        }
    };
    Ok(())
}

/// A square that stands on a corner.
fn diamond((x, y): (i32, i32), style: ShapeStyle) -> PathElement<(i32, i32)> {
    PathElement::new([(x, y - 5), (x + 5, y), (x, y + 5), (x - 5, y), (x, y - 5)], style)
}

/// A number without needless digits.
fn number(x: f64) -> String {
    if x >= 1.0 { format!("{x:.0}") } else { format!("{x}") }
}
