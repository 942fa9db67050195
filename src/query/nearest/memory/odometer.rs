//! How far a robot's links have moved in all, from question to question.
//!
//! The *step* of a question is at least as far as any point of a link now is from all points of the
//! same link at the question before. The odometer reads the sum of all steps. So if the links kept
//! `apart` from something still when it read R, they keep `apart` - (R' - R) at least when it reads
//! R'.
//!
//! A step follows the rule of
//! [`ReferenceOutline::moved_to`](super::placed_outline::ReferenceOutline::moved_to): the ends of
//! the axis move by s at most, a radius grows by g at most, and a flat cap of radius r turns with
//! its axis by 2 r x (1 + 2 x) at most, for x up to 1/2 as there, and beyond because that is more
//! than 2 r. The largest of each over all links makes a step no less than that of any link,
//! s + 2 (r x) (1 + 2 x) + g, and leaves three roots for all of them. Other caps and another number
//! of links are no step: the odometer begins anew.
//!
//! Rounding. Relatively a step errs by less than [`ROUNDING`], and x by 3 u, which is 18 u of the
//! radius: both are added. Sums are rounded upwards, so that no difference of two readings is less
//! than the steps between them. Squares vanish where what is measured is below 2^-537 of the
//! extent: 2^400 such steps are next to nothing beside [`ends_err`](Odometer::error_from_ends).

use super::placed_outline::{PlacedOutline, ROUNDING};
use crate::distance::Scalar;
use crate::pair::PlacedRobot;
use parry3d_f64::math::{Real, Vector};

/// The way of links that are asked about again and again.
#[derive(Clone, Debug, Default)]
pub(crate) struct Odometer {
    /// At the last question, from the tip to the base.
    links: Vec<PlacedOutline>,
    /// The largest coordinate of links and pose then.
    extent: Real,
    /// How much farther than both ends of its axis any point of a link can move: the rim of a flat
    /// cap.
    lever: Real,
    step: Real,
    reading: Real,
}

impl Odometer {
    /// Counts the way to where a robot is now. False where that can't be told, and the odometer
    /// begins anew.
    pub(crate) fn advance(&mut self, robot: PlacedRobot) -> bool {
        let translation = robot.placed(Vector::ZERO).abs().max_element();
        let extent = PlacedOutline::around_all(robot).extent().max(translation);
        let before = std::mem::replace(&mut self.extent, extent);
        if self.links.len() == robot.links().len() {
            self.step = self.step_to(robot, before.max(extent));
        } else {
            self.links.clear();
            self.links.extend(PlacedOutline::of_all(robot));
            // What caps add is told by the next step.
            (self.step, self.lever) = (Real::INFINITY, Real::INFINITY);
        }
        self.reading = (self.reading + self.step).next_up();
        let is_known = self.reading < Real::INFINITY;
        if !is_known {
            (self.reading, self.step) = (0.0, Real::INFINITY);
        }
        is_known
    }

    /// How far the links move at the most to where they are now; infinite where that can't be told.
    /// No coordinate is larger than `extent`.
    fn step_to(&mut self, robot: PlacedRobot, extent: Real) -> Real {
        let scale = extent.power_of_two_to_unity();
        let squared = |way: Vector| (way * scale).length_squared();
        let mut is_known = true;
        let [mut shift, mut turn, mut rim, mut lever, mut grown, mut radius]: [Real; 6] = [0.0; 6];
        for (then, now) in self.links.iter_mut().zip(PlacedOutline::of_all(robot)) {
            is_known &= then.flat == now.flat;
            let [start, end] =
                [squared(now.ends[0] - then.ends[0]), squared(now.ends[1] - then.ends[1])];
            shift = larger(larger(start, end), shift);
            grown = larger(now.radius - then.radius, grown);
            radius = larger(now.radius, radius);
            if now.flat != [false; 2] {
                let (was, along) = (then.along(), now.along());
                let x = 0.25 * squared(along - was) / squared(was);
                is_known &= !x.is_nan();
                let square = (now.radius * scale) * (now.radius * scale);
                turn = larger(x, turn);
                rim = larger(square * x, rim);
                lever = larger(square / squared(along), lever);
            }
            *then = now;
        }
        self.lever = 1.0 + 4.0 * lever.sqrt();
        let turned = 2.0 * rim.sqrt() * (1.0 + 2.0 * turn.sqrt());
        let step = (shift.sqrt() + turned) / scale + grown;
        if is_known { step + ROUNDING * (step + radius) } else { Real::INFINITY }
    }

    /// The last step; infinite where it can't be told.
    pub(crate) fn last_step(&self) -> Real {
        self.step
    }

    /// The sum of all steps.
    pub(crate) fn reading(&self) -> Real {
        self.reading
    }

    /// The largest coordinate of the links and of the robot's pose.
    pub(crate) fn extent(&self) -> Real {
        self.extent
    }

    /// How far any point of a link can be from where it is, if the ends of all axes err by `error`.
    ///
    /// A flat cap of radius r turns with its axis of length l, by less than 4 `error` / l, and its
    /// rim by r times that.
    pub(crate) fn error_from_ends(&self, error: Real) -> Real {
        error * self.lever
    }
}

/// The larger of two, as one instruction; the second if the first is not a number.
#[inline(always)]
fn larger(one: Real, other: Real) -> Real {
    if one > other { one } else { other }
}
