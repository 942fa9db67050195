//! An upper bound on how far the links of a robot have moved, summed over all queries.
//!
//! # Definitions
//! - *step*: an upper bound on the distance of any point of a link now from the same link at the
//!   query before.
//! - *reading* R: the sum of all steps.
//!
//! **Claim.** If the links were at least `apart` from a resting shape at reading R, they are at
//! least `apart - (R' - R)` from it at reading R'.
//!
//! **Proof.** Triangle inequality, step by step.
//!
//! # The step
//! The bound of a single link, `s + 2 r x (1 + 2 x) + g`, is proven in `query/nearest/outline.rs`
//! (`ReferenceOutline::moved_to`). Here s bounds the displacement of the ends of the axis, and g is
//! the growth of the radius. A flat cap of radius r turns with its axis by at most `2 r x (1 + 2
//! x)` for `x <= 1/2`. For larger x that expression exceeds `2 r`, which bounds every turn.
//!
//! The maximum of each term over all links gives one step: `s + 2 (r x) (1 + 2 x) + g`. It is at
//! least the step of each link, and takes three square roots for all links together. If the caps or
//! the number of links change, the step is unknown and the odometer starts again at 0.
//!
//! # Rounding
//! - A step errs relatively by less than [`MOVED_ROUNDING`], and x by `3 u`. The derivative of
//!   `2 r x (1 + 2 x)` is at most `6 r`, so that is `18 u` of the radius. Both are added.
//! - Sums are rounded upwards. So no difference of two readings is less than the steps between
//!   them.
//! - A square vanishes if its root is below 2^-537 of the extent. Even 2^400 such steps are
//!   negligible beside [`error_from_ends`](Odometer::error_from_ends).

use crate::distance::Scalar;
use crate::pair::PlacedRobot;
use crate::query::nearest::{MOVED_ROUNDING, PlacedOutline};
use parry3d_f64::math::{Real, Vector};

/// The summed displacement of links that are queried again and again.
#[derive(Clone, Debug, Default)]
pub(crate) struct Odometer {
    /// The links at the last query, from the tip to the base.
    links: Vec<PlacedOutline>,
    /// The largest coordinate of the links and the pose at the last query.
    extent: Real,
    /// How far a point of a link can move if the ends of its axis move by 1; more than 1 at the rim
    /// of a flat cap.
    lever: Real,
    step: Real,
    reading: Real,
}

impl Odometer {
    /// Accumulates the displacement since the last query. Returns false if the displacement is
    /// unknown; the odometer then starts again at 0.
    pub(crate) fn advance(&mut self, robot: PlacedRobot) -> bool {
        let translation = robot.placed(Vector::ZERO).abs().max_element();
        let extent = PlacedOutline::around_all(robot).extent().max(translation);
        let before = std::mem::replace(&mut self.extent, extent);
        if self.links.len() == robot.links().len() {
            self.step = self.step_to(robot, before.max(extent));
        } else {
            self.links.clear();
            self.links.extend(PlacedOutline::of_all(robot).map(|(_, link)| link));
            // The next step computes the lever.
            (self.step, self.lever) = (Real::INFINITY, Real::INFINITY);
        }
        self.reading = (self.reading + self.step).next_up();
        let is_known = self.reading < Real::INFINITY;
        if !is_known {
            (self.reading, self.step) = (0.0, Real::INFINITY);
        }
        is_known
    }

    /// Returns an upper bound on the displacement of the links to their current placement; infinite
    /// if unknown. No coordinate is larger than `extent`.
    fn step_to(&mut self, robot: PlacedRobot, extent: Real) -> Real {
        let scale = extent.power_of_two_to_unity();
        let squared = |way: Vector| (way * scale).length_squared();
        let mut is_known = true;
        let [mut shift, mut turn, mut rim, mut lever, mut grown, mut radius]: [Real; 6] = [0.0; 6];
        for (then, (_, now)) in self.links.iter_mut().zip(PlacedOutline::of_all(robot)) {
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
        if is_known { step + MOVED_ROUNDING * (step + radius) } else { Real::INFINITY }
    }

    /// Returns the last step; infinite if unknown.
    pub(crate) fn last_step(&self) -> Real {
        self.step
    }

    /// Returns the sum of all steps.
    pub(crate) fn reading(&self) -> Real {
        self.reading
    }

    /// Returns the largest coordinate of the links and of the robot's pose.
    pub(crate) fn extent(&self) -> Real {
        self.extent
    }

    /// Returns how far any point of a link can be off if the ends of all axes err by `error`.
    ///
    /// A flat cap of radius r turns with its axis of length l by less than `4 error / l`. Its rim
    /// moves by r times that angle.
    pub(crate) fn error_from_ends(&self, error: Real) -> Real {
        error * self.lever
    }
}

/// The larger of two, as one instruction; `other` if `one` is NaN.
#[inline(always)]
fn larger(one: Real, other: Real) -> Real {
    if one > other { one } else { other }
}
