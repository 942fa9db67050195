//! How near a way comes to the wall over time: proven bounds on each part of it, beside what steps
//! see.

use super::edges::{Edges, Place, text};
use continuum_demo::canvas::{Align, Canvas, Colour, hex};
use continuum_demo::joint_motion::JointMotion;
use continuum_demo::ticks::ticks;
use parry_continuum::parry::math::{Pose, Real};
use parry_continuum::{Motion, RobotError, Speed, Tube};

const INK: Colour = hex(0x22303c);
const GRID: Colour = hex(0xd5dae1);
const BOUNDS: Colour = hex(0x1f6f8b);
const STEPS: Colour = hex(0xc44e2c);
const SIZE: [usize; 2] = [1200, 620];

/// The parts of each edge, and how close the bounds of a part are, mm.
const PARTS: u32 = 40;
const TOLERANCE: Real = 0.01;

/// How far the tip moves from one step to the next, mm.
const STEP: Real = 0.5;

/// A part of a motion.
struct Part<'a> {
    motion: &'a JointMotion,
    times: [Real; 2],
}

impl Part<'_> {
    fn time(&self, t: Real) -> Real {
        self.times[0] + t * (self.times[1] - self.times[0])
    }
}

impl Motion for Part<'_> {
    fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
        self.motion.shape(self.time(t), tube)
    }

    fn speed(&self, section: usize, shares: [Real; 2], times: [Real; 2]) -> Speed {
        let Speed { point, turn } = self.motion.speed(section, shares, times.map(|t| self.time(t)));
        // A little more for the rounding of times.
        let apart = (self.times[1] - self.times[0]) * (1.0 + 1e-12);
        Speed { point: point * apart, turn: turn * apart }
    }
}

/// The clearance over a way.
#[derive(Default)]
pub struct OverTime {
    /// For each part, in order, the bounds on the least clearance in it, mm.
    bounds: Vec<[Real; 2]>,
    /// What steps see: when, in edges from the beginning, and how far the wall is.
    steps: Vec<[Real; 2]>,
}

impl OverTime {
    /// Asks about a way.
    pub fn new(edges: &mut Edges, path: &[Place]) -> Result<Self, String> {
        let mut found = Self::default();
        for (number, ends) in path.windows(2).enumerate() {
            let motion = edges.motion(&ends[0], &ends[1])?;
            for k in 0..PARTS {
                let times = [k, k + 1].map(|k| Real::from(k) / Real::from(PARTS));
                let part = Part { motion: &motion, times };
                let least = edges.search.clearance_of_motion(&part, TOLERANCE).map_err(text)?;
                found.bounds.push([least.lower, least.upper]);
            }
            let mut times: Vec<_> = motion.steps(STEP).collect();
            times.sort_by(Real::total_cmp);
            for t in times {
                let tube = motion.tube(t).map_err(text)?;
                let at = edges.search.clearance(&tube, &edges.base, TOLERANCE).map_err(text)?;
                found.steps.push([number as Real + t, at.upper]);
            }
        }
        Ok(found)
    }

    /// The least of both: what is proven, and what the steps see.
    pub fn least(&self) -> [Real; 2] {
        let least = |values: &mut dyn Iterator<Item = Real>| values.fold(Real::INFINITY, Real::min);
        [
            least(&mut self.bounds.iter().map(|bounds| bounds[0])),
            least(&mut self.steps.iter().map(|step| step[1])),
        ]
    }

    /// Draws both, with the margin that is kept.
    pub fn draw(&self, margin: Real) -> Canvas {
        let mut canvas = Canvas::new(SIZE[0], SIZE[1], |_, _| hex(0xffffff));
        let [left, right, top, bottom] =
            [80.0, SIZE[0] as f32 - 40.0, 110.0, SIZE[1] as f32 - 60.0];
        let edges = self.bounds.len() as Real / Real::from(PARTS);
        let uppers = self.bounds.iter().map(|bounds| bounds[1]);
        let levels = ticks(uppers.fold(2.0 * margin, Real::max).max(TOLERANCE));
        let high = levels[levels.len() - 1];
        let x = |time: Real| left + (time / edges) as f32 * (right - left);
        let y = |value: Real| bottom - (value.min(high) / high) as f32 * (bottom - top);
        let mut line = |from: [f32; 2], to: [f32; 2], width: f32, colour: Colour| {
            canvas.stroke(&[vec![from, to]], width, colour, 1.0);
        };
        for &value in &levels {
            line([left, y(value)], [right, y(value)], 1.0, GRID);
        }
        for (k, [lower, upper]) in self.bounds.iter().enumerate() {
            let ends = [k, k + 1].map(|k| x(k as Real / Real::from(PARTS)));
            line([ends[0], y(*lower)], [ends[1], y(*lower)], 2.0, BOUNDS);
            line([ends[0], y(*upper)], [ends[1], y(*upper)], 1.0, BOUNDS);
        }
        for [time, value] in &self.steps {
            let [x, y] = [x(*time), y(*value)];
            line([x, y - 3.0], [x, y + 3.0], 2.0, STEPS);
        }
        line([left, y(margin)], [right, y(margin)], 1.5, INK);
        canvas.text("How near the way comes to the wall, mm", [left, 44.0], Align::Left, 22.0, INK);
        let note = format!(
            "lines: the least of each part, between two proven bounds {TOLERANCE} mm apart"
        );
        canvas.text(&note, [left, 76.0], Align::Left, 15.0, BOUNDS);
        canvas.text(
            &format!("ticks: what steps of {STEP} mm see"),
            [right, 76.0],
            Align::Right,
            15.0,
            STEPS,
        );
        // Below the line, where no way that keeps the margin comes.
        canvas.text("margin", [right, y(margin) + 19.0], Align::Right, 13.0, INK);
        for value in levels {
            canvas.text(
                &format!("{value}"),
                [left - 10.0, y(value) + 5.0],
                Align::Right,
                13.0,
                INK,
            );
        }
        for edge in 0..=edges as u32 {
            canvas.text(
                &format!("{edge}"),
                [x(edge.into()), bottom + 24.0],
                Align::Centre,
                13.0,
                INK,
            );
        }
        canvas.text(
            "edge of the way",
            [0.5 * (left + right), bottom + 46.0],
            Align::Centre,
            13.0,
            INK,
        );
        canvas
    }
}
