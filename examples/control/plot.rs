//! Clearance and tip error over time, as a picture.

use crate::Run;
use continuum_demo::canvas::{Align, Canvas, Colour, hex};
use continuum_demo::ticks::ticks;
use parry_continuum::parry::math::Real;

const SIZE: [usize; 2] = [1200, 820];
const INK: Colour = hex(0x22_2b_38);
const GRID: Colour = hex(0xd5_da_e1);
const FREE: Colour = hex(0xc4_4e_2c);
const KEPT: Colour = hex(0x1f_6f_8b);

pub fn draw(free: &Run, kept: &Run, margin: Real, tick: Real) -> Canvas {
    let mut canvas = Canvas::new(SIZE[0], SIZE[1], |_, _| hex(0xff_ff_ff));
    canvas.text("A tip that is sent into the wall, and back", [70.0, 46.0], Align::Left, 22.0, INK);
    for (x, name, colour) in
        [(700.0, "without the fixture", FREE), (960.0, "with the fixture", KEPT)]
    {
        let points = (0..=32).map(|k| [x - 44.0 + k as f32, 40.0]).collect::<Vec<_>>();
        draw_curve(&mut canvas, &points, 3.0, colour);
        canvas.text(name, [x, 46.0], Align::Left, 15.0, INK);
    }
    panel(
        &mut canvas,
        80.0,
        "clearance, mm",
        [&free.clearance, &kept.clearance],
        Some(margin),
        tick,
    );
    panel(
        &mut canvas,
        450.0,
        "tip from target, mm",
        [&free.tip_error, &kept.tip_error],
        None,
        tick,
    );
    let note = "At the end both tips are where they began. The robot has more joints than a tip needs: those that the fixture \
                turned stay turned.";
    canvas.text(note, [70.0, SIZE[1] as f32 - 24.0], Align::Left, 13.0, INK);
    canvas
}

/// The free run is dashed, so that it differs without colours too.
fn draw_curve(canvas: &mut Canvas, points: &[[f32; 2]], width: f32, colour: Colour) {
    for (place, piece) in points.windows(2).enumerate() {
        if colour == KEPT || place % 12 < 8 {
            canvas.stroke(&[piece.to_vec()], width, colour, 1.0);
        }
    }
}

fn panel(
    canvas: &mut Canvas,
    top: f32,
    title: &str,
    curves: [&[Real]; 2],
    limit: Option<Real>,
    tick: Real,
) {
    let [left, right, bottom] = [70.0, SIZE[0] as f32 - 40.0, top + 300.0];
    let high =
        curves.iter().flat_map(|curve| curve.iter()).copied().fold(limit.unwrap_or(0.0), Real::max);
    let seconds = curves[0].len() as Real * tick;
    let levels = ticks(if high > 0.0 { high } else { 1.0 });
    let end = levels[levels.len() - 1];
    let y = |value: Real| bottom - (value / end) as f32 * (bottom - top - 30.0);
    let x = |share: Real| left + share as f32 * (right - left);
    canvas.text(title, [left, top + 8.0], Align::Left, 15.0, INK);
    for level in levels {
        canvas.stroke(&[vec![[left, y(level)], [right, y(level)]]], 1.0, GRID, 1.0);
        canvas.text(&format!("{level}"), [left - 8.0, y(level) + 5.0], Align::Right, 13.0, INK);
    }
    for time in ticks(seconds).into_iter().filter(|time| *time <= seconds) {
        canvas.text(
            &format!("{time} s"),
            [x(time / seconds), bottom + 22.0],
            Align::Centre,
            13.0,
            INK,
        );
    }
    if let Some(limit) = limit {
        canvas.stroke(&[vec![[left, y(limit)], [right, y(limit)]]], 1.5, INK, 0.7);
    }
    for (curve, colour) in curves.into_iter().zip([FREE, KEPT]) {
        let last = (curve.len() - 1).max(1) as Real;
        let every = (curve.len() / 1000).max(1);
        let points = curve.iter().enumerate().step_by(every);
        let points: Vec<_> =
            points.map(|(place, &value)| [x(place as Real / last), y(value)]).collect();
        draw_curve(canvas, &points, 2.0, colour);
    }
    if let Some(limit) = limit {
        // Below the line, where no curve of a robot that keeps the margin goes.
        let [x, y] = [left + 12.0, y(limit)];
        canvas.panel([x - 4.0, y + 4.0, x + 62.0, y + 25.0], 4.0, hex(0xff_ff_ff), 0.85);
        canvas.text("margin", [x, y + 19.0], Align::Left, 13.0, INK);
    }
}
