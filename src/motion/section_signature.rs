//! The properties of a robot that must stay constant during a motion, and bounds on its drift from
//! the middle of an interval of time.

use super::CarriedMotion;
use crate::curve::{CapPersistence, Drift, Tube};
use crate::robot::{RobotError, length};
use parry3d_f64::math::Real;

/// The sections of the shapes so far: their radii, and which of their ends are always flat. `None`
/// for an end whose cap is not yet known or does not matter.
#[derive(Clone, Debug, Default)]
pub(crate) struct SectionSignature(Vec<(Real, [Option<bool>; 2])>);

impl SectionSignature {
    pub(crate) fn clear(&mut self) {
        self.0.clear();
    }

    /// Records the first shape and compares every later shape with it.
    ///
    /// # Errors
    /// The shape at `t` has different sections.
    pub(crate) fn check(&mut self, t: Real, tube: &Tube) -> Result<(), RobotError> {
        let found = tube.sections().iter().map(|section| {
            // Two kinds of end are not compared: a face that may lose its direction may be round in
            // other shapes, and a section without length has no face.
            let lasts = |end: usize| match section.faces[end].map(|face| face.persistence) {
                Some(CapPersistence::Never) => None,
                _ if section.fades => None,
                None if section.start == section.end => None,
                persistence => Some(persistence == Some(CapPersistence::Always)),
            };
            (section.radius, [lasts(0), lasts(1)])
        });
        if self.0.is_empty() {
            self.0.extend(found);
            return Ok(());
        }
        let is_same = |one: Option<bool>, other: Option<bool>| {
            one.is_none() || other.is_none() || one == other
        };
        let mut count = 0;
        for ((radius, ends), known) in found.zip(&mut self.0) {
            if radius != known.0 || !(0..2).all(|end| is_same(ends[end], known.1[end])) {
                return Err(RobotError::SectionsChange { t });
            }
            known.1 = [0, 1].map(|end| known.1[end].or(ends[end]));
            count += 1;
        }
        if count != self.0.len() || tube.sections().len() != count {
            return Err(RobotError::SectionsChange { t });
        }
        Ok(())
    }
}

/// A direction that turns faster than this, in rad, is taken to change at one instant: no shorter
/// interval can follow it.
const FASTEST_TURN: Real = (1_u64 << 24) as Real;

/// An interval of time around a shape.
///
/// Ends and limits belong to one robot, so only speeds relative to its frame matter for distances.
pub(crate) struct MotionDrift<'a> {
    pub motion: &'a CarriedMotion<'a>,
    /// The time of the shape.
    pub t: Real,
    /// An upper bound on the angular speed of the robot's frame, seen from the frame in which
    /// distances are bounded.
    pub turning: Real,
}

impl Drift for MotionDrift<'_> {
    fn moves(&self, section: usize, end: usize) -> Real {
        // An invalid speed bounds nothing here; `check_speed` refuses it elsewhere.
        let speed = self.motion.stated(section, [end as Real; 2]).point;
        self.motion.half * if speed >= 0.0 { speed } else { Real::INFINITY }
    }

    /// Uses the displacements of both ends if they are known, otherwise their speeds.
    fn stretches(&self, section: usize) -> Real {
        let by_speed = self.moves(section, 0) + self.moves(section, 1);
        let [from, to] = self.motion.times;
        let sides = [[from, self.t], [self.t, to]].map(|times| {
            let bound = self.motion.motion.displacement(section, [0.0, 1.0], times)?;
            let change = length(bound.ways[1] - bound.ways[0]) + 2.0 * bound.off;
            (change >= 0.0).then_some(change)
        });
        match sides {
            [Some(before), Some(after)] => before.max(after).min(by_speed),
            _ => by_speed,
        }
    }

    fn turns(&self, section: usize) -> Real {
        let turn = self.motion.stated(section, [0.0, 1.0]).turn + self.turning;
        self.motion.half * if turn >= 0.0 { turn } else { Real::INFINITY }
    }

    fn can_follow(&self, turn: Real) -> bool {
        turn <= FASTEST_TURN * self.motion.half
    }
}
