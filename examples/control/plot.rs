//! Clearance and tip error over time, as a picture.

use crate::Run;
use continuum_demo::canvas::{Align, Canvas, Colour, hex};
use parry_continuum::parry::math::Real;

const SIZE: [usize; 2] = [1200, 820];
const INK: Colour = hex(0x22_2b_38);
const GRID: Colour = hex(0xd5_da_e1);
const FREE: Colour = hex(0xc4_4e_2c);
const KEPT: Colour = hex(0x1f_6f_8b);

pub fn draw(free: &Run, kept: &Run, margin: Real, tick: Real) -> Canvas {
    let mut canvas = Canvas::new(SIZE[0], SIZE[1], |_, _| hex(0xff_ff_ff));
    canvas.text("A tip that is sent into the wall", [70.0, 46.0], Align::Left, 22.0, INK);
    canvas.text("as it likes", [820.0, 46.0], Align::Left, 15.0, FREE);
    canvas.text("with the fixture", [960.0, 46.0], Align::Left, 15.0, KEPT);
    panel(&mut canvas, 80.0, "clearance, mm", [&free.clearance, &kept.clearance], Some(margin), tick);
    panel(&mut canvas, 450.0, "tip from target, mm", [&free.tip_error, &kept.tip_error], None, tick);
    canvas
}

fn panel(canvas: &mut Canvas, top: f32, title: &str, curves: [&[Real]; 2], limit: Option<Real>, tick: Real) {
    let [left, right, bottom] = [70.0, SIZE[0] as f32 - 40.0, top + 300.0];
    let high = curves.iter().flat_map(|curve| curve.iter()).copied().fold(limit.unwrap_or(0.0), Real::max);
    let seconds = curves[0].len() as Real * tick;
    let y = |value: Real| bottom - (value / high) as f32 * (bottom - top - 30.0);
    let x = |share: Real| left + share as f32 * (right - left);
    canvas.text(title, [left, top + 8.0], Align::Left, 15.0, INK);
    for step in 0..=4 {
        let share = Real::from(step) / 4.0;
        canvas.stroke(&[vec![[left, y(share * high)], [right, y(share * high)]]], 1.0, GRID, 1.0);
        let value = format!("{:.1}", share * high);
        canvas.text(&value, [left - 8.0, y(share * high) + 5.0], Align::Right, 13.0, INK);
        let time = format!("{:.1} s", share * seconds);
        canvas.text(&time, [x(share), bottom + 22.0], Align::Centre, 13.0, INK);
    }
    if let Some(limit) = limit {
        canvas.stroke(&[vec![[left, y(limit)], [right, y(limit)]]], 1.5, INK, 0.7);
        canvas.text("margin", [right, y(limit) - 6.0], Align::Right, 13.0, INK);
    }
    for (curve, colour) in curves.into_iter().zip([FREE, KEPT]) {
        let last = (curve.len() - 1).max(1) as Real;
        let every = (curve.len() / 1000).max(1);
        let points = curve.iter().enumerate().step_by(every);
        let points: Vec<_> = points.map(|(place, &value)| [x(place as Real / last), y(value)]).collect();
        points.windows(2).for_each(|piece| canvas.stroke(&[piece.to_vec()], 2.0, colour, 1.0));
    }
}
