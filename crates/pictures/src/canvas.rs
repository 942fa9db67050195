//! A picture as an array of pixels, with the little drawing that its legend needs, and PNG.

use crate::lettering::{Stroke, strokes};
use std::io;
use std::path::Path;

/// Red, green, blue; linear, 0 to 1.
pub type Colour = [f32; 3];

/// The colour that a web page calls `#rrggbb`.
pub const fn hex(code: u32) -> Colour {
    [linear(code >> 16 & 255), linear(code >> 8 & 255), linear(code & 255)]
}

/// Decodes the gamma of a screen, near enough, in a constant: sRGB is close to x^2.2 = x^2 x^0.2.
const fn linear(level: u32) -> f32 {
    let x = level as f32 / 255.0;
    // x^0.2 by Newton's method on y^5 = x.
    let mut y = 1.0;
    let mut round = 0;
    while round < 40 && x > 0.0 {
        y = 0.8 * y + 0.2 * x / (y * y * y * y);
        round += 1;
    }
    x * x * y
}

/// The colour between two others.
pub fn mix(a: Colour, b: Colour, t: f32) -> Colour {
    std::array::from_fn(|i| a[i] + (b[i] - a[i]) * t)
}

/// Where the ink of text goes, relative to the point given.
#[derive(Clone, Copy)]
pub enum Align {
    Left,
    Centre,
    Right,
}

/// The picture.
pub struct Canvas {
    pub width: usize,
    pub height: usize,
    pub pixels: Vec<Colour>,
}

impl Canvas {
    /// A canvas whose colour at each pixel `paint` gives.
    pub fn new(width: usize, height: usize, paint: impl Fn(usize, usize) -> Colour) -> Self {
        let pixels = (0..width * height).map(|i| paint(i % width, i / width)).collect();
        Self { width, height, pixels }
    }

    fn blend(&mut self, x: usize, y: usize, colour: Colour, opacity: f32) {
        let pixel = &mut self.pixels[y * self.width + x];
        *pixel = mix(*pixel, colour, opacity);
    }

    /// Paints every pixel within reach of a shape: `distance` is its signed distance, in pixels,
    /// within the box.
    fn fill(
        &mut self,
        [x0, y0, x1, y1]: [f32; 4],
        colour: Colour,
        opacity: f32,
        distance: impl Fn(f32, f32) -> f32,
    ) {
        let clip = |v: f32, limit: usize| (v.max(0.0) as usize).min(limit);
        for y in clip(y0 - 1.0, self.height)..clip(y1 + 2.0, self.height) {
            for x in clip(x0 - 1.0, self.width)..clip(x1 + 2.0, self.width) {
                let cover = (0.5 - distance(x as f32 + 0.5, y as f32 + 0.5)).clamp(0.0, 1.0);
                if cover > 0.0 {
                    self.blend(x, y, colour, cover * opacity);
                }
            }
        }
    }

    /// Draws polylines with round ends, as one shape.
    pub fn stroke(&mut self, lines: &[Stroke], width: f32, colour: Colour, opacity: f32) {
        let mut bounds = [f32::MAX, f32::MAX, f32::MIN, f32::MIN];
        for &[x, y] in lines.iter().flatten() {
            let reach = 0.5 * width;
            bounds = [
                bounds[0].min(x - reach),
                bounds[1].min(y - reach),
                bounds[2].max(x + reach),
                bounds[3].max(y + reach),
            ];
        }
        self.fill(bounds, colour, opacity, |x, y| {
            let pieces = lines.iter().flat_map(|line| line.windows(2));
            pieces.map(|piece| to_segment([x, y], piece[0], piece[1])).fold(f32::MAX, f32::min)
                - 0.5 * width
        });
    }

    /// Fills a rectangle with rounded corners.
    pub fn panel(&mut self, [x0, y0, x1, y1]: [f32; 4], corner: f32, colour: Colour, opacity: f32) {
        self.fill([x0, y0, x1, y1], colour, opacity, |x, y| {
            rounded([x, y], [x0, y0, x1, y1], corner)
        });
    }

    /// Draws the outline of a rectangle with rounded corners.
    pub fn frame(&mut self, [x0, y0, x1, y1]: [f32; 4], corner: f32, width: f32, colour: Colour) {
        let rim = 0.5 * width;
        self.fill([x0 - rim, y0 - rim, x1 + rim, y1 + rim], colour, 1.0, |x, y| {
            rounded([x, y], [x0, y0, x1, y1], corner).abs() - rim
        });
    }

    /// Writes a line of text with its base line at `y` and capitals of the given height.
    pub fn text(
        &mut self,
        text: &str,
        [x, y]: [f32; 2],
        align: Align,
        height: f32,
        colour: Colour,
    ) {
        let (lines, width) = strokes(text, height);
        let left = match align {
            Align::Left => x,
            Align::Centre => x - 0.5 * width,
            Align::Right => x - width,
        };
        for line in lines {
            let placed: Stroke = line.into_iter().map(|p| [left + p[0], y + p[1]]).collect();
            self.stroke(&[placed], 0.135 * height, colour, 1.0);
        }
    }

    /// Copies another picture in, within a rectangle with rounded corners.
    pub fn paste(&mut self, picture: &Canvas, [left, top]: [usize; 2], corner: f32) {
        let bounds = [0.0, 0.0, picture.width as f32, picture.height as f32];
        for y in 0..picture.height.min(self.height.saturating_sub(top)) {
            for x in 0..picture.width.min(self.width.saturating_sub(left)) {
                let cover = (0.5 - rounded([x as f32 + 0.5, y as f32 + 0.5], bounds, corner))
                    .clamp(0.0, 1.0);
                self.blend(left + x, top + y, picture.pixels[y * picture.width + x], cover);
            }
        }
    }

    /// Writes the picture as PNG.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn save(&self, path: &Path) -> io::Result<()> {
        std::fs::write(path, self.png()?)
    }

    /// The picture as a PNG file.
    ///
    /// # Errors
    /// The picture has no pixels.
    pub fn png(&self) -> io::Result<Vec<u8>> {
        let mut file = Vec::new();
        let mut encoder = png::Encoder::new(&mut file, self.width as u32, self.height as u32);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
        let encode = |value: &f32| (value.clamp(0.0, 1.0).powf(1.0 / 2.2) * 255.0 + 0.5) as u8;
        let bytes: Vec<u8> = self.pixels.iter().flatten().map(encode).collect();
        let mut writer = encoder.write_header().map_err(io::Error::other)?;
        writer.write_image_data(&bytes).map_err(io::Error::other)?;
        writer.finish().map_err(io::Error::other)?;
        Ok(file)
    }
}

/// Signed distance to a rectangle with rounded corners.
fn rounded([x, y]: [f32; 2], [x0, y0, x1, y1]: [f32; 4], corner: f32) -> f32 {
    let across = (x - 0.5 * (x0 + x1)).abs() - 0.5 * (x1 - x0) + corner;
    let down = (y - 0.5 * (y0 + y1)).abs() - 0.5 * (y1 - y0) + corner;
    across.max(0.0).hypot(down.max(0.0)) + across.max(down).min(0.0) - corner
}

/// Distance from a point to a segment.
fn to_segment(p: [f32; 2], a: [f32; 2], b: [f32; 2]) -> f32 {
    let (along, to) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let square = along[0] * along[0] + along[1] * along[1];
    let t = if square > 0.0 {
        ((to[0] * along[0] + to[1] * along[1]) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (to[0] - t * along[0]).hypot(to[1] - t * along[1])
}
