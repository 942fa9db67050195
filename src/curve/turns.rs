//! Upper and lower bounds on the turn of a tube between two of its places.
//!
//! # Upper bound
//! A part of length l and curvature at most k turns by at most `k l`. A chain turns at its joints
//! only, by the angles between its links.
//!
//! Two frames at one place may be treated as one although their directions differ by `q <= 2^-16`
//! (`frames`). The segments on either side may then have either direction. Their curve is the
//! assumed one plus a cubic that changes the direction at an end by q. The cubic's second
//! derivative changes evenly from `4 q / l` to `-2 q / l`, so it adds `5/3 q` of turn, or `10/3 q`
//! for both ends. `4 q` per segment covers this and the effect of the cubic's slope.
//!
//! # Lower bound
//! A curve between two places turns by at least as much as
//!
//! 1. any polygon through some of its points in order (used for samples);
//! 2. its directions at some places in order (used for functions).
//!
//! If points may be off by e, the direction of a chord of length l is uncertain by
//! `asin(2 e / l) <= 4 e / l`. Chords are therefore made longer, and a chord that is uncertain by
//! more than 1 is ignored. Samples outside of the two places are ignored. The turn of a chain is
//! exact: the direction of a link holds anywhere on it.
//!
//! # Rounding
//! An angle between two directions errs by less than `16 u`: unit vectors err by at most `4 u`,
//! their sine and cosine by `8 u`. The sum of n angles errs by less than `16 n u`, plus `n^2 u` for
//! its additions.

use super::Tube;
use super::centreline::Curve;
use super::frames::ONE_DIRECTION;
use crate::distance::Scalar;
use crate::robot::{LEVEL, direction, length};
use parry3d_f64::math::{Real, Vector};

/// Extra turn of a segment between frames if directions were merged: four times their largest
/// difference.
const HIDDEN: Real = 4.0 * ONE_DIRECTION;

/// Most directions per section of a function. Below this limit consecutive directions turn by at
/// most 1 / 64 rad.
const MAX_DIRECTIONS: u32 = 4096;

/// Chords of uncertain samples are extended until their direction is uncertain by at most this and
/// by at most the share [`MAX_LOSS`] of the turn along them, or until the curve may turn by more
/// than [`MAX_TURN`] along them.
const MIN_DOUBT: Real = 1.0 / 1024.0;
const MAX_TURN: Real = 0.25;

/// Each chord loses up to twice its doubt. Doubt and turn change in proportion to 1 / length and to
/// length, so few samples more make the lost share small.
const MAX_LOSS: Real = 1.0 / 128.0;

/// The turns of a tube. The memory is reused.
#[derive(Clone, Debug, Default)]
pub(crate) struct TubeTurns {
    /// Upper bound on the turn up to the start of each section.
    before: Vec<Real>,
    /// Upper bound on the turn up to each tick, for uneven sections.
    at: Vec<Real>,
    headings: Vec<Heading>,
    has_joints: bool,
    slack: Real,
}

/// A direction of the tube.
#[derive(Clone, Copy, Debug)]
struct Heading {
    /// Start of the part of the tube that has the direction, as an arc length.
    from: Real,
    /// End of that part. The direction of a link holds anywhere on it, so its part ends where it
    /// begins.
    to: Real,
    /// Lower bound on the turn up to this direction.
    turned: Real,
}

/// A place where a tube bends too sharply for queries that assume a thin tube.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum TooSharp {
    /// A joint whose links overlap over more than half of the shorter one.
    Joint { joint: usize, angle: Real, radius: Real, length: Real },
    /// A bend within the tube's own radius.
    Bend { arc_length: Real, curvature: Real, radius: Real },
}

impl Tube {
    /// Measures how far the tube turns.
    ///
    /// # Errors
    /// A joint or a bend is too sharp.
    pub(crate) fn measure_turns(&self, turns: &mut TubeTurns) -> Result<(), TooSharp> {
        turns.before.clear();
        turns.at.clear();
        turns.headings.clear();
        turns.has_joints = false;
        let samples = match &self.curve {
            Curve::Samples(samples) => Some(samples),
            Curve::Function(_) => None,
        };
        turns.at.resize(samples.map_or(0, |samples| samples.points.len()), 0.0);
        let hidden = if self.merged > 0.0 { HIDDEN } else { 0.0 };
        let (mut most, mut last) = (0.0, None::<(Vector, Real)>);
        let mut turned = 0.0;
        for (number, section) in self.sections.iter().enumerate() {
            let before = number.checked_sub(1).map(|before| &self.sections[before]);
            if section.is_even && section.curvature * section.radius >= 1.0 {
                let (curvature, radius) = (section.curvature, section.radius);
                return Err(TooSharp::Bend { arc_length: section.start, curvature, radius });
            }
            // Links have their own end points; sections of a curve share them.
            let is_link = samples.is_some()
                && section.stretch == 1.0
                && before.is_none_or(|before| before.last != section.first);
            if is_link {
                let ends = [section.first, section.last].map(|tick| self.point(section, tick));
                let axis = direction(ends[1] - ends[0]);
                if let (Some((before, _)), Some(shorter)) = (last, before) {
                    turns.has_joints = true;
                    let angle = angle_between(before, axis);
                    let wider = shorter.radius.max(section.radius);
                    let radius = shorter.radius.min(section.radius);
                    let length = (shorter.end - shorter.start).min(section.end - section.start);
                    let (sine, cosine) = (before.cross(axis).length(), before.dot(axis));
                    let is_folded = 1.0 + cosine <= 16.0 * Real::UNIT_ROUNDOFF;
                    // As for a chain (`query::robots::robot_with_itself`).
                    let length_at_least = length * (1.0 + LEVEL);
                    let is_wide = 2.0 * wider * sine > length_at_least * (1.0 + cosine);
                    let is_thin = cosine > 0.0 && 2.0 * radius * sine <= length_at_least * cosine;
                    if is_wide && !is_thin || is_folded {
                        return Err(TooSharp::Joint { joint: number, angle, radius, length });
                    }
                    most += angle;
                }
                (last, turned) = (Some((axis, 0.0)), most);
                turns.before.push(most);
                turns.headings.push(Heading { from: section.end, to: section.start, turned });
                continue;
            }
            turns.before.push(most);
            let mut head = |direction: Vector, doubt: Real, from: Real, to: Real| {
                if let Some((before, other)) = last {
                    turned += (angle_between(before, direction) - doubt - other).max(0.0);
                }
                last = Some((direction, doubt));
                turns.headings.push(Heading { from, to, turned });
            };
            if let Some(samples) = samples {
                let (mut start, mut off, mut bend): (usize, Real, Real) =
                    (section.first as usize, 0.0, 0.0);
                for tick in section.first..section.last {
                    let [from, to] = [tick, tick + 1].map(|tick| tick as usize);
                    let bound = self.bound(section, [tick, tick + 1]);
                    off = off.max(bound.off + self.merged);
                    let arcs = [samples.arcs[start], samples.arcs[to]];
                    let chord = samples.points[to] - samples.points[start];
                    let doubt = if off > 0.0 { 4.0 * off / length(chord) } else { 0.0 };
                    bend += bound.curvature * (arcs[1] - samples.arcs[from]);
                    // A straight part has no turn to lose.
                    let is_known = doubt <= MIN_DOUBT && (bend <= 0.0 || doubt <= MAX_LOSS * bend);
                    let is_long = is_known || bend > MAX_TURN;
                    if is_long || tick + 1 == section.last {
                        if doubt <= 1.0 {
                            head(direction(chord), doubt, arcs[0], arcs[1]);
                        }
                        (start, off, bend) = (to, 0.0, 0.0);
                    }
                    if section.is_even {
                        continue;
                    }
                    if bound.curvature * section.radius >= 1.0 {
                        let (arc_length, curvature) = (samples.arcs[from], bound.curvature);
                        return Err(TooSharp::Bend {
                            arc_length,
                            curvature,
                            radius: section.radius,
                        });
                    }
                    turns.at[from] = most;
                    let length = samples.arcs[to] - samples.arcs[from];
                    most += bound.curvature * length * section.stretch;
                    // Once per input segment, which may be laid in parts.
                    if tick == section.first || samples.segments[from] != samples.segments[from - 1]
                    {
                        most += hidden;
                    }
                    turns.at[to] = most;
                }
            } else {
                let turn = section.curvature * (section.end - section.start);
                // The conversion saturates.
                let count = ((64.0 * turn).ceil() as u32).clamp(1, MAX_DIRECTIONS);
                for k in 0..=count {
                    let share = Real::from(k) / Real::from(count);
                    let arc = section.start + (section.end - section.start) * share;
                    head(self.at_share(section, share).direction, 0.0, arc, arc);
                }
            }
            if section.is_even {
                most += section.curvature * (section.end - section.start) * section.stretch;
            }
        }
        let count = (turns.headings.len() + turns.before.len() + turns.at.len()) as Real;
        // Parallel legs of a chain may open by as much as runs level.
        let level = if turns.has_joints { LEVEL } else { 0.0 };
        turns.slack = (16.0 + count) * count * Real::UNIT_ROUNDOFF + level;
        Ok(())
    }

    /// Returns an upper bound on the turn up to a tick of a section.
    pub(crate) fn turned_at_most(&self, turns: &TubeTurns, number: u32, tick: u32) -> Real {
        let section = &self.sections[number as usize];
        if !section.is_even {
            return turns.at[tick as usize];
        }
        let along = self.arc(section, tick) - section.start;
        turns.before[number as usize] + section.curvature * along * section.stretch
    }
}

impl TubeTurns {
    /// Returns whether the tube is a chain of links, which turns at joints.
    pub(crate) fn has_joints(&self) -> bool {
        self.has_joints
    }

    /// Returns whether a turn may reach `angle`, within rounding.
    pub(crate) fn may_reach(&self, turn: Real, angle: Real) -> bool {
        turn >= angle - self.slack
    }

    /// Returns two arc lengths, one on either side of what turns between `from` and `to`. Every
    /// place before the first and every place behind the second have a turn of at least `angle`
    /// between them, within rounding.
    ///
    /// The margin is divided equally between the two sides. `None` if the tube is not known to turn
    /// by `angle` between `from` and `to`.
    pub(crate) fn room(&self, [from, to]: [Real; 2], angle: Real) -> Option<[Real; 2]> {
        let headings = &self.headings;
        let first = headings.partition_point(|heading| heading.from < from);
        let last = headings.partition_point(|heading| heading.to <= to).checked_sub(1)?;
        if first >= last {
            return None;
        }
        let [start, end] = [first, last].map(|heading| headings[heading].turned);
        let buffer = end - start - (angle - self.slack);
        if buffer.is_nan() || buffer < 0.0 {
            return None;
        }
        let before =
            headings[..last].partition_point(|heading| heading.turned <= start + 0.5 * buffer);
        let behind =
            headings[..last].partition_point(|heading| heading.turned < end - 0.5 * buffer);
        Some([headings[before.saturating_sub(1).max(first)].from, headings[behind].to])
    }
}

fn angle_between(one: Vector, other: Vector) -> Real {
    libm::atan2(one.cross(other).length(), one.dot(other))
}
