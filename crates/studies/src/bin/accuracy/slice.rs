//! The picture of correctness: the error of parry's GJK and of this crate over a slice of
//! configurations.
//!
//! A tube of half a millimetre, in metres, and a triangle beside it: from right to left the gap
//! between them grows smaller, from the bottom up the triangle tilts away from the tube's axis; the
//! tilt is a slope, in metres per metre. Every cell is one query.

use crate::peers::parry_distance;
use continuum_demo::canvas::{Align, Canvas, Colour, hex};
use continuum_demo::colour_map::ColourMap;
use continuum_testing::precision::Precision;
use parry_continuum::ModifiedCylinder;
use parry_continuum::distance::triangle_modified_cylinder;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::proximity::Certificate;
use rayon::prelude::*;

const RADIUS: f64 = 2.5e-4;
const LENGTH: f64 = 1e-2;
/// Cells along each side of a panel, and pixels along each side of a cell.
const CELLS: usize = 256;
const CELL: usize = 3;
/// The gap from 1e-7 m to 1e-2 m, the tilt from 1e-8 to 1.
const GAP: [f64; 2] = [-7.0, -2.0];
const TILT: [f64; 2] = [-8.0, 0.0];
/// The power of ten from which errors have colours.
const LEAST: i32 = -17;

const INK: Colour = hex(0x22303c);
const PALE: Colour = hex(0x66757f);
const PAPER: Colour = hex(0xfafafa);

/// The colours of errors relative to the distance, in steps of half a power of ten.
struct Scale {
    /// How many powers of ten there are above the least.
    decades: u32,
    colours: ColourMap,
}

impl Scale {
    /// Up to the power of ten above the largest error.
    fn new(errors: impl Iterator<Item = f64>) -> Self {
        let largest = errors.fold(0.0, f64::max).log10().ceil();
        Self {
            decades: (largest - f64::from(LEAST)).max(1.0) as u32,
            colours: ColourMap::up_to(1.0),
        }
    }

    fn shade(&self, error: f64) -> Colour {
        let most = f64::from(self.decades);
        let decades = (error.log10() - f64::from(LEAST)).clamp(0.0, most - 1e-9);
        self.colours.colour((decades * 2.0).floor() / (2.0 * most - 1.0))
    }
}

/// The errors of parry and of this crate, relative to the distance, in one cell.
fn errors(column: usize, row: usize) -> [f64; 2] {
    let at = |[low, high]: [f64; 2], cell: usize| {
        10.0_f64.powf(low + (high - low) * (cell as f64 + 0.5) / CELLS as f64)
    };
    let (gap, tilt) = (at(GAP, column), at(TILT, CELLS - 1 - row));
    // In a direction that no coordinate prefers.
    let axis = Vector::new(0.48, 0.6, 0.64);
    let side = Vector::new(0.8, 0.0, -0.6);
    let other = axis.cross(side);
    let (start, end) = (axis * (-0.5 * LENGTH), axis * (0.5 * LENGTH));
    let near = side * (RADIUS + gap);
    let triangle = [
        near - axis * 2e-3 - other * 1e-3,
        near + (axis + side * tilt) * 3e-3 + other * 2e-3,
        near + (axis + side * tilt) * 1e-3 - other * 2.5e-3 + side * (1e-3 * tilt),
    ];
    let Ok(link) = ModifiedCylinder::cylinder(start, end, RADIUS) else { return [f64::NAN; 2] };
    let Ok(proof) = Certificate::between(&link, &Pose::IDENTITY, triangle) else {
        return [f64::NAN; 2];
    };
    let truth = proof.lower.midpoint(proof.upper);
    let [from, to] = [start, end].map(f64::vec3);
    let ours =
        triangle_modified_cylinder(triangle.map(f64::vec3), from, to, RADIUS, [true; 2]).distance;
    [parry_distance(triangle, [start, end], RADIUS, true), ours]
        .map(|distance| (distance - truth).abs() / truth)
}

/// Draws both panels and the legend.
pub fn draw() -> Canvas {
    let cells: Vec<_> =
        (0..CELLS * CELLS).into_par_iter().map(|cell| errors(cell % CELLS, cell / CELLS)).collect();
    let panel = CELLS * CELL;
    let (left, top, between) = (170, 176, 170);
    let mut canvas = Canvas::new(2 * panel + left + between + 60, panel + top + 330, |_, _| PAPER);
    let worst = [0, 1].map(|which| cells.iter().map(|cell| cell[which]).fold(0.0, f64::max));
    let title = format!(
        "In metres, parry errs by up to {:.0e} of the clearance, this crate by {:.0e}",
        worst[0], worst[1]
    );
    canvas.text(&title, [left as f32, 54.0], Align::Left, 27.0, INK);
    let scene = "each point is the distance of a cylinder, 0.5 mm thick and 10 mm long, and a triangle; dark is right, yellow is wrong";
    canvas.text(scene, [left as f32, 92.0], Align::Left, 19.0, PALE);
    let scale = Scale::new(cells.iter().flatten().copied());
    for (which, name) in ["parry (GJK)", "this crate"].into_iter().enumerate() {
        let x = left + which * (panel + between);
        let picture = Canvas::new(panel, panel, |x, y| {
            scale.shade(cells[x / CELL + y / CELL * CELLS][which])
        });
        canvas.paste(&picture, [x, top], 0.0);
        let frame = [x as f32, top as f32, (x + panel) as f32, (top + panel) as f32];
        canvas.frame(frame, 0.0, 2.0, INK);
        let name = format!("{name}: at worst {:.0e} of the clearance", worst[which]);
        canvas.text(&name, [frame[0], frame[1] - 20.0], Align::Left, 22.0, INK);
        ticks(&mut canvas, frame);
    }
    let foot = (top + panel + 150) as f32;
    legend(&mut canvas, &scale, [left as f32, foot], (2 * panel + between) as f32);
    let note = "towards small gaps the rounding of the coordinates becomes a larger share of the clearance";
    canvas.text(note, [left as f32, foot + 118.0], Align::Left, 19.0, PALE);
    canvas
}

/// Powers of ten along the lower and the left side.
fn ticks(canvas: &mut Canvas, [x0, y0, x1, y1]: [f32; 4]) {
    let mark = |canvas: &mut Canvas, from: [f32; 2], to: [f32; 2]| {
        canvas.stroke(&[vec![from, to]], 2.0, INK, 1.0);
    };
    let decades = |[low, high]: [f64; 2]| {
        (low as i32..=high as i32).map(move |k| (k, (f64::from(k) - low) / (high - low)))
    };
    for (power, at) in decades(GAP) {
        let x = x0 + (x1 - x0) * at as f32;
        mark(canvas, [x, y1], [x, y1 + 8.0]);
        canvas.text(&format!("1e{power}"), [x, y1 + 34.0], Align::Centre, 17.0, INK);
    }
    canvas.text(
        "gap of cylinder and level triangle, m",
        [0.5 * (x0 + x1), y1 + 72.0],
        Align::Centre,
        19.0,
        PALE,
    );
    for (power, at) in decades(TILT).step_by(2) {
        let y = y1 - (y1 - y0) * at as f32;
        mark(canvas, [x0, y], [x0 - 8.0, y]);
        canvas.text(&format!("1e{power}"), [x0 - 16.0, y + 8.0], Align::Right, 17.0, INK);
    }
    // Between two ticks.
    let y = 0.5 * (y0 + y1) - (y1 - y0) / 8.0;
    for (line, text) in ["slope of", "the triangle"].into_iter().enumerate() {
        let at = [x0 - 16.0, y - 6.0 + 28.0 * line as f32];
        canvas.text(text, at, Align::Right, 19.0, PALE);
    }
}

/// The colours of the errors.
fn legend(canvas: &mut Canvas, scale: &Scale, [x, y]: [f32; 2], width: f32) {
    canvas.text("error relative to the true clearance", [x, y - 18.0], Align::Left, 19.0, INK);
    let step = width / (2 * scale.decades) as f32;
    for half in 0..2 * scale.decades {
        let error = 10.0_f64.powf(f64::from(half) * 0.5 + 0.25 + f64::from(LEAST));
        let from = x + step * half as f32;
        canvas.panel([from, y, from + step, y + 34.0], 0.0, scale.shade(error), 1.0);
    }
    canvas.frame([x, y, x + width, y + 34.0], 0.0, 2.0, INK);
    for decade in (0..=scale.decades).step_by(2) {
        let at = x + width * decade as f32 / scale.decades as f32;
        canvas.text(
            &format!("1e{}", LEAST + decade as i32),
            [at, y + 64.0],
            Align::Centre,
            17.0,
            INK,
        );
    }
}
