//! A canvas that `plotters` draws into, for PNG. Each of its pixels is [`FINE`] by [`FINE`].

use continuum_pictures::canvas::{Canvas, Colour, hex};
use continuum_pictures::lettering::strokes;
use plotters_backend::text_anchor::{HPos, VPos};
use plotters_backend::{
    BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingBackend, DrawingErrorKind,
};
use std::convert::Infallible;

/// Pixels along each side of a pixel of the plot.
const FINE: f32 = 2.0;
/// The height of capitals as a share of the size of a font.
const CAPITALS: f32 = 0.68;

pub struct Pixels<'a>(pub &'a mut Canvas);

type Drawn = Result<(), DrawingErrorKind<Infallible>>;

impl Pixels<'_> {
    /// A white canvas for a plot of this size.
    pub fn canvas((width, height): (u32, u32)) -> Canvas {
        let [width, height] = [width, height].map(|side| side as usize * FINE as usize);
        Canvas::new(width, height, |_, _| [1.0; 3])
    }

    fn line(&mut self, points: &[[f32; 2]], width: f32, colour: BackendColor) {
        // Piece by piece: the cost of a shape is the product of its area and its pieces.
        for piece in points.windows(2) {
            self.0.stroke(&[piece.to_vec()], width, ink(colour), colour.alpha as f32);
        }
    }
}

impl DrawingBackend for Pixels<'_> {
    type ErrorType = Infallible;

    fn get_size(&self) -> (u32, u32) {
        let side = |pixels: usize| pixels as u32 / FINE as u32;
        (side(self.0.width), side(self.0.height))
    }

    fn ensure_prepared(&mut self) -> Drawn {
        Ok(())
    }

    fn present(&mut self) -> Drawn {
        Ok(())
    }

    fn draw_pixel(&mut self, point: BackendCoord, colour: BackendColor) -> Drawn {
        let [x, y] = fine(point);
        self.0.panel([x, y, x + FINE, y + FINE], 0.0, ink(colour), colour.alpha as f32);
        Ok(())
    }

    fn draw_line<S: BackendStyle>(
        &mut self,
        from: BackendCoord,
        to: BackendCoord,
        style: &S,
    ) -> Drawn {
        self.line(&[from, to].map(fine), style.stroke_width() as f32 * FINE, style.color());
        Ok(())
    }

    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        path: I,
        style: &S,
    ) -> Drawn {
        let points: Vec<_> = path.into_iter().map(fine).collect();
        self.line(&points, style.stroke_width() as f32 * FINE, style.color());
        Ok(())
    }

    fn draw_rect<S: BackendStyle>(
        &mut self,
        upper_left: BackendCoord,
        bottom_right: BackendCoord,
        style: &S,
        fill: bool,
    ) -> Drawn {
        let ([x0, y0], [x1, y1]) = (fine(upper_left), fine(bottom_right));
        let colour = style.color();
        if fill {
            self.0.panel([x0, y0, x1, y1], 0.0, ink(colour), colour.alpha as f32);
        } else {
            let width = style.stroke_width() as f32 * FINE;
            self.line(&[[x0, y0], [x1, y0], [x1, y1], [x0, y1], [x0, y0]], width, colour);
        }
        Ok(())
    }

    fn draw_circle<S: BackendStyle>(
        &mut self,
        centre: BackendCoord,
        radius: u32,
        style: &S,
        fill: bool,
    ) -> Drawn {
        let ([x, y], radius) = (fine(centre), radius as f32 * FINE);
        let width = if fill { 2.0 * radius } else { style.stroke_width() as f32 * FINE };
        let rim = if fill { 0.0 } else { radius };
        let angles = (0..=48).map(|k| std::f32::consts::TAU * k as f32 / 48.0);
        let points = angles.map(|angle| [x + rim * angle.cos(), y + rim * angle.sin()]);
        self.line(&points.collect::<Vec<_>>(), width, style.color());
        Ok(())
    }

    fn draw_text<S: BackendTextStyle>(
        &mut self,
        text: &str,
        style: &S,
        position: BackendCoord,
    ) -> Drawn {
        let size = style.size() as f32 * FINE;
        let (strokes, width) = strokes(text, CAPITALS * size);
        // The shares of the SVG backend.
        let left = match style.anchor().h_pos {
            HPos::Left => 0.0,
            HPos::Center => -0.5 * width,
            HPos::Right => -width,
        };
        let base = match style.anchor().v_pos {
            VPos::Top => 0.76 * size,
            VPos::Center => 0.5 * CAPITALS * size,
            VPos::Bottom => -0.26 * size,
        };
        // Where a step to the right and one down lead.
        let axes = [(1, 0), (0, 1)].map(|(x, y)| style.transform().transform(x, y));
        let [right, down] = axes.map(|(x, y)| [x as f32, y as f32]);
        let [x, y] = fine(position);
        for stroke in strokes {
            let place = |[u, v]: [f32; 2]| {
                let [u, v] = [u + left, v + base];
                [x + u * right[0] + v * down[0], y + u * right[1] + v * down[1]]
            };
            let points: Vec<_> = stroke.into_iter().map(place).collect();
            self.line(&points, 0.135 * CAPITALS * size, style.color());
        }
        Ok(())
    }

    fn estimate_text_size<S: BackendTextStyle>(
        &self,
        text: &str,
        style: &S,
    ) -> Result<(u32, u32), DrawingErrorKind<Infallible>> {
        let size = style.size() as f32;
        Ok((strokes(text, CAPITALS * size).1.ceil() as u32, size.ceil() as u32))
    }
}

fn fine((x, y): BackendCoord) -> [f32; 2] {
    [x, y].map(|at| at as f32 * FINE)
}

fn ink(colour: BackendColor) -> Colour {
    let (red, green, blue) = colour.rgb;
    hex(u32::from_be_bytes([0, red, green, blue]))
}
