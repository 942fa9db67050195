//! Distance as colour: dark near contact, bright at a distance. The map is
//! matplotlib's viridis (S. van der Walt and N. Smith, CC0), whose lightness grows evenly, also for
//! readers who are colour-blind.

use crate::canvas::{Align, Canvas, Colour, hex, mix};

/// Every eighth of the map.
const STOPS: [Colour; 9] = [
    hex(0x440154),
    hex(0x472d7b),
    hex(0x3b528b),
    hex(0x2c728e),
    hex(0x21918c),
    hex(0x28ae80),
    hex(0x5ec962),
    hex(0xaddc30),
    hex(0xfde725),
];

/// Distances from 0 to `end`, in colours.
#[derive(Clone, Copy)]
pub struct ColourMap {
    pub end: f64,
    tick: f64,
}

impl ColourMap {
    /// A map from 0 to a round number that is at least `largest`.
    pub fn up_to(largest: f64) -> Self {
        let largest = if largest > 0.0 && largest.is_finite() { largest } else { 1.0 };
        let decade = 10f64.powf(largest.log10().floor());
        let steps = [0.2, 0.25, 0.5, 1.0, 2.0].map(|step| step * decade);
        let tick = steps.into_iter().find(|tick| largest / tick <= 6.0).unwrap_or(decade);
        Self { end: (largest / tick).ceil() * tick, tick }
    }

    pub fn colour(&self, distance: f64) -> Colour {
        let place = (distance / self.end).clamp(0.0, 1.0) as f32 * (STOPS.len() - 1) as f32;
        let stop = (place as usize).min(STOPS.len() - 2);
        mix(STOPS[stop], STOPS[stop + 1], place - stop as f32)
    }

    /// Draws the map as a bar with numbers, its unit in the title. `at` is its left upper corner.
    /// The last number, "5 or more", ends about three heights to the right of the bar.
    pub fn draw(
        &self,
        canvas: &mut Canvas,
        at: [f32; 2],
        [width, height]: [f32; 2],
        title: &str,
        ink: Colour,
    ) {
        let letter = 0.95 * height;
        canvas.text(title, [at[0], at[1] - 0.7 * height], Align::Left, letter, ink);
        for column in 0..width as usize {
            let colour = self.colour(self.end * (column as f64 + 0.5) / f64::from(width));
            let x = at[0] + column as f32;
            canvas.panel([x, at[1], x + 1.0, at[1] + height], 0.0, colour, 1.0);
        }
        canvas.frame([at[0], at[1], at[0] + width, at[1] + height], 0.0, 0.08 * height, ink);
        let count = (self.end / self.tick).round() as usize;
        for tick in 0..=count {
            let x = at[0] + width * tick as f32 / count as f32;
            let foot = at[1] + height;
            canvas.stroke(&[vec![[x, foot], [x, foot + 0.35 * height]]], 0.08 * height, ink, 1.0);
            let digits = (-self.tick.log10()).ceil().max(0.0) as usize;
            let digits = if (self.tick * 10f64.powi(digits as i32)).fract() > 1e-6 {
                digits + 1
            } else {
                digits
            };
            let rest = if tick == count { " or more" } else { "" };
            let number = format!("{:.digits$}{rest}", tick as f64 * self.tick);
            canvas.text(&number, [x, foot + 0.65 * height + letter], Align::Centre, letter, ink);
        }
    }
}
