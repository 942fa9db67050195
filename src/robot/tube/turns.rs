//! How far a tube turns between two of its places: at most, and at least.
//!
//! **At most.** The curvature of each stretch is at most k, so a stretch of length l turns by no
//! more than k l. A chain is straight but for its joints, at which it turns by the angle between
//! its links. Where two frames at one place were taken for one (`frames`), whose directions differ
//! by q <= 2^-16, the segments on either side may have either direction: their curve is the assumed
//! one and a cubic that changes a direction at an end by q. The second derivative of that goes
//! evenly from 4 q / l to -2 q / l, so it adds 5/3 q, and 10/3 q from both ends. 4 q a segment is
//! more than that with what the slope of the cubic does to it.
//!
//! **At least.** A curve between two places turns by no less than any polygon through some of its
//! points in order does, nor than its directions at some places in order. The former serves
//! samples, the latter functions. Points that may be off by e leave the direction of a chord of
//! length l open by asin(2 e / l), at most 4 e / l, so chords are the longer then; one that is open
//! by more than 1 tells nothing. The samples outside of the two places are left out. A chain's turn
//! is known exactly: the directions of two links hold anywhere on them.
//!
//! **Rounding.** An angle between two directions errs by less than 16 u, since they are unit
//! vectors to 4 u and a sine and a cosine of them to 8 u, and so the sum over n of them by less
//! than 16 n u and n^2 u for its own additions.

use super::Tube;
use super::curve::Curve;
use super::frames::ONE_DIRECTION;
use crate::distance::Scalar;
use crate::robot::scale::{direction, length};
use parry3d_f64::math::{Real, Vector};

/// What a segment between frames may turn by beyond what it shows, where directions were taken for
/// one: 4 times as much as these may be apart.
const HIDDEN: Real = 4.0 * ONE_DIRECTION;

/// A function is asked for its direction so often that it turns by 1 / 64 rad from one to the next,
/// or a little less often where that would be more than this.
const MAX_DIRECTIONS: u32 = 4096;

/// Of samples that may be off, so many are left out that a chord's direction is open by no more
/// than this, unless the curve turns by more than [`MAX_TURN`] along it.
const MIN_DOUBT: Real = 1.0 / 1024.0;
const MAX_TURN: Real = 0.25;

/// What a tube's turns are measured in, which is used again.
#[derive(Clone, Debug, Default)]
pub(crate) struct TubeTurns {
    /// By how much it may have turned up to the start of each section.
    before: Vec<Real>,
    /// The same up to each tick, where sections are uneven.
    at: Vec<Real>,
    headings: Vec<Heading>,
    has_joints: bool,
    slack: Real,
}

/// A direction that the tube has.
#[derive(Clone, Copy, Debug)]
struct Heading {
    /// It is known of a part of the tube from this arc length
    from: Real,
    /// to that one. Of a link it is known anywhere, so that its part ends where it begins.
    to: Real,
    /// By how much the tube has turned up to here at least.
    turned: Real,
}

/// Where a tube bends too sharply for a thin one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum TooSharp {
    /// At a joint, so that its links overlap over more than half of the shorter one.
    Joint { joint: usize, angle: Real, radius: Real, length: Real },
    /// Within its own radius.
    Bend { arc_length: Real, curvature: Real, radius: Real },
}

impl Tube {
    /// Measures how far the tube turns.
    ///
    /// # Errors
    /// It bends too sharply somewhere.
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
            // Links have ends of their own, which no curve has.
            let is_link = samples.is_some()
                && section.stretch == 1.0
                && before.is_none_or(|before| before.last != section.first);
            if is_link {
                let ends = [section.first, section.last].map(|tick| self.point(section, tick));
                let axis = direction(ends[1] - ends[0]);
                if let (Some((before, _)), Some(shorter)) = (last, before) {
                    turns.has_joints = true;
                    let angle = angle_between(before, axis);
                    let radius = shorter.radius.max(section.radius);
                    let length = (shorter.end - shorter.start).min(section.end - section.start);
                    let (sine, cosine) = (before.cross(axis).length(), before.dot(axis));
                    let is_folded = 1.0 + cosine <= 16.0 * Real::UNIT_ROUNDOFF;
                    if 2.0 * radius * sine > length * (1.0 + cosine) || is_folded {
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
                let (mut start, mut off): (usize, Real) = (section.first as usize, 0.0);
                for tick in section.first..section.last {
                    let [from, to] = [tick, tick + 1].map(|tick| tick as usize);
                    let bound = self.bound(section, [tick, tick + 1]);
                    off = off.max(bound.off + self.merged);
                    let arcs = [samples.arcs[start], samples.arcs[to]];
                    let chord = samples.points[to] - samples.points[start];
                    let doubt = if off > 0.0 { 4.0 * off / length(chord) } else { 0.0 };
                    let is_long =
                        doubt <= MIN_DOUBT || bound.curvature * (arcs[1] - arcs[0]) > MAX_TURN;
                    if is_long || tick + 1 == section.last {
                        if doubt <= 1.0 {
                            head(direction(chord), doubt, arcs[0], arcs[1]);
                        }
                        (start, off) = (to, 0.0);
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
                    // Once for each segment of the input, which may be laid in parts.
                    if tick == section.first || samples.segments[from] != samples.segments[from - 1]
                    {
                        most += hidden;
                    }
                    turns.at[to] = most;
                }
            } else {
                let turn = section.curvature * (section.end - section.start);
                // A number out of range becomes the nearest that is in it.
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
        turns.slack = (16.0 + count) * count * Real::UNIT_ROUNDOFF;
        Ok(())
    }

    /// By how much it may have turned up to a tick of a section.
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
    /// Whether the tube is a chain of links, which turns at their joints.
    pub(crate) fn has_joints(&self) -> bool {
        self.has_joints
    }

    /// Whether a turn may be one of `angle`, as far as rounding tells.
    pub(crate) fn may_reach(&self, turn: Real, angle: Real) -> bool {
        turn >= angle - self.slack
    }

    /// Two arc lengths such that all places up to the one and all from the other on have a turn of
    /// at least `angle` between them, as far as rounding tells: on either side of what turns
    /// between two places, which keep the same distance from it. None if it is not known that
    /// the tube turns that far between the two.
    pub(crate) fn room(&self, [from, to]: [Real; 2], angle: Real) -> Option<[Real; 2]> {
        let headings = &self.headings;
        let first = headings.partition_point(|heading| heading.from < from);
        let last = headings.partition_point(|heading| heading.to <= to).checked_sub(1)?;
        if first >= last {
            return None;
        }
        let [start, end] = [first, last].map(|heading| headings[heading].turned);
        let spare = end - start - (angle - self.slack);
        if spare.is_nan() || spare < 0.0 {
            return None;
        }
        let before =
            headings[..last].partition_point(|heading| heading.turned <= start + 0.5 * spare);
        let behind = headings[..last].partition_point(|heading| heading.turned < end - 0.5 * spare);
        Some([headings[before.saturating_sub(1).max(first)].from, headings[behind].to])
    }
}

fn angle_between(one: Vector, other: Vector) -> Real {
    libm::atan2(one.cross(other).length(), one.dot(other))
}
