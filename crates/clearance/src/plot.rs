//! The plot of the clearance along the robot, as SVG or PNG.
//!
//! # Algorithm
//! 1. Divide the segments into about [`SLICES`] slices with flat ends, and measure each. A slice is
//!    the union of the robot's discs there.
//! 2. Add the minimum, which the caps that fill the bends may have. So the curve passes through it.
//! 3. Draw the distances by arc length, with the minimum and the margin. The parts within the
//!    margin are orange.

use crate::number::{as_written, length, short};
use crate::options::has_ending;
use crate::plot_pixels::Pixels;
use crate::robot::Robot;
use crate::verdict::Verdict;
use parry_continuum::Chain;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::proximity::{BvhSearch, LinkProximity, Proximity};
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::error::Error;
use std::path::Path;

/// About as many slices as the plot has pairs of pixels.
const SLICES: f64 = 400.0;

const SIZE: (u32, u32) = (900, 480);
/// Colours of Okabe and Ito, which differ in brightness too.
const BLUE: RGBColor = RGBColor(0, 114, 178);
const ORANGE: RGBColor = RGBColor(213, 94, 0);

/// What to draw.
pub struct Plot<'a> {
    pub robot: &'a Robot,
    pub pose: &'a Pose,
    pub minimum: &'a LinkProximity,
    pub margin: Option<f64>,
    pub verdict: Option<Verdict>,
    /// The bounds on the clearance of the curve, if they were asked for.
    pub bounds: Option<[f64; 2]>,
}

impl Plot<'_> {
    /// Measures the robot and writes the plot.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn draw(
        &self,
        search: &mut BvhSearch,
        path: &Path,
        unit: Option<&str>,
    ) -> Result<(), String> {
        let curve = self.curve(search).map_err(|error| error.to_string())?;
        let text = |error: Box<dyn Error>| error.to_string();
        if has_ending(path, "png") {
            let mut canvas = Pixels::canvas(SIZE);
            let area = Pixels(&mut canvas).into_drawing_area();
            self.chart(&curve, unit, &area).map_err(text)?;
            drop(area);
            let file = canvas.png().map_err(|error| error.to_string())?;
            return crate::outputs::write("--plot", path, file);
        }
        let mut file = String::new();
        let area = SVGBackend::with_string(&mut file, SIZE).into_drawing_area();
        self.chart(&curve, unit, &area).map_err(text)?;
        drop(area);
        crate::outputs::write("--plot", path, file)
    }

    /// Returns arc lengths and distances, in order (steps 1 and 2).
    fn curve(&self, search: &mut BvhSearch) -> Result<Vec<(f64, f64)>, Box<dyn Error>> {
        let (points, radii) = self.slices();
        let mut slices = Vec::new();
        search.per_link(&Chain::cylinders(&points, &radii)?, self.pose, &mut slices)?;
        let place = |found: &LinkProximity| (found.witness.arc_length, found.distance);
        let mut curve: Vec<_> = slices.iter().chain([self.minimum]).map(place).collect();
        curve.sort_by(|a, b| a.0.total_cmp(&b.0));
        Ok(curve)
    }

    /// Returns the points and radii of the slices.
    fn slices(&self) -> (Vec<Vector>, Vec<f64>) {
        let Robot { points, radii, .. } = self.robot;
        let whole = total(points);
        let (mut ends, mut of_slices) = (vec![points[0]], Vec::new());
        for (segment, &radius) in points.windows(2).zip(radii) {
            let [from, to] = [segment[0], segment[1]];
            let count = (SLICES * (to - from).length() / whole).ceil().max(1.0) as usize;
            let inner = |k| from + (to - from) * (k as f64 / count as f64);
            ends.extend((1..count).map(inner));
            ends.push(to);
            of_slices.resize(of_slices.len() + count, radius);
        }
        (ends, of_slices)
    }

    /// Draws the chart (step 3).
    fn chart<B: DrawingBackend<ErrorType: 'static>>(
        &self,
        curve: &[(f64, f64)],
        unit: Option<&str>,
        area: &DrawingArea<B, Shift>,
    ) -> Result<(), Box<dyn Error>> {
        let at = (self.minimum.witness.arc_length, self.minimum.distance);
        let whole = total(&self.robot.points);
        let highest = curve.iter().map(|place| place.1).fold(self.margin.unwrap_or(0.0), f64::max);
        let high = if highest > 0.0 { 1.1 * highest } else { 1.0 };
        let in_unit = unit.map(|unit| format!(" ({unit})")).unwrap_or_default();

        area.fill(&WHITE)?;
        let closest = format!(
            "closest to the wall {} from the base: {}",
            length(at.0, 3, unit),
            length(at.1, 4, unit)
        );
        let title = match self.verdict {
            Some(verdict) => {
                let margin = as_written(verdict.margin, unit);
                format!("Margin {margin} {}; {closest}", verdict.decision())
            }
            None => format!("The robot is {closest}"),
        };
        let mut chart = ChartBuilder::on(area)
            .caption(title, ("sans-serif", 24))
            .margin(16)
            .x_label_area_size(52)
            .y_label_area_size(72)
            .build_cartesian_2d(0.0..whole, 0.0..high)?;
        chart
            .configure_mesh()
            .x_desc(format!("distance from the base, along the robot{in_unit}"))
            .y_desc(format!("clearance{in_unit}"))
            .x_label_formatter(&|x| short(*x))
            .y_label_formatter(&|y| short(*y))
            .label_style(("sans-serif", 17))
            .axis_desc_style(("sans-serif", 19))
            .max_light_lines(0)
            .bold_line_style(RGBColor(225, 225, 225))
            .draw()?;
        chart.draw_series(LineSeries::new(curve.iter().copied(), BLUE.stroke_width(2)))?;
        if let Some(margin) = self.margin {
            for within in within(curve, margin) {
                chart.draw_series(LineSeries::new(within, ORANGE.stroke_width(4)))?;
            }
        }
        let label = |place: (f64, f64), text: String, colour: RGBColor, is_above: bool| {
            let is_right = place.0 > 0.5 * whole;
            let horizontal = if is_right { HPos::Right } else { HPos::Left };
            let vertical = if is_above { VPos::Bottom } else { VPos::Top };
            let style = ("sans-serif", 17).into_font().color(&colour);
            let across = if is_right { -9 } else { 9 };
            let up = if is_above { -6 } else { 6 };
            EmptyElement::at(place)
                + Text::new(text, (across, up), style.pos(Pos::new(horizontal, vertical)))
        };
        if let Some(margin) = self.margin {
            let dashes = [(0.0, margin), (whole, margin)];
            chart.draw_series(DashedLineSeries::new(dashes, 8, 5, ORANGE.stroke_width(2)))?;
            // On the side of the plot where the minimum is not.
            let side = if at.0 > 0.5 * whole { 0.0 } else { whole };
            let text = format!("margin {}", as_written(margin, unit));
            chart.draw_series([label((side, margin), text, ORANGE, margin < 0.9 * high)])?;
        }
        chart.draw_series([Circle::new(at, 5, BLACK.stroke_width(2))])?;
        let link = format!("link {}: {}", self.minimum.link, length(at.1, 4, unit));
        let text = self.bounds.map_or(link.clone(), |[lower, upper]| {
            format!("{link}; the curve: {} to {}", length(lower, 4, unit), length(upper, 4, unit))
        });
        chart.draw_series([label(at, text, BLACK, at.1 < 0.1 * high)])?;
        area.present()?;
        Ok(())
    }
}

/// Returns the parts of a curve that are at most `margin` high. Their ends are interpolated.
fn within(curve: &[(f64, f64)], margin: f64) -> Vec<Vec<(f64, f64)>> {
    let mut parts: Vec<Vec<(f64, f64)>> = Vec::new();
    let mut was_within = false;
    for (k, &place) in curve.iter().enumerate() {
        let is_within = place.1 <= margin;
        if k > 0 && is_within != was_within {
            let (from, to) = (curve[k - 1], place);
            let share = (margin - from.1) / (to.1 - from.1);
            let crossing = (from.0 + share * (to.0 - from.0), margin);
            if is_within {
                parts.push(vec![crossing]);
            } else if let Some(part) = parts.last_mut() {
                part.push(crossing);
            }
        } else if is_within && parts.is_empty() {
            parts.push(Vec::new());
        }
        if is_within && let Some(part) = parts.last_mut() {
            part.push(place);
        }
        was_within = is_within;
    }
    parts
}

/// Returns the length of a centreline.
fn total(points: &[Vector]) -> f64 {
    points.windows(2).map(|segment| (segment[1] - segment[0]).length()).sum()
}
