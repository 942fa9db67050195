//! The centreline: samples, or a function of arc length.

use super::curve_bound::CurveBound;
use super::section::Section;
use crate::distance::Scalar;
use crate::robot::direction;
use parry3d_f64::math::{Real, Vector};
use std::sync::Arc;

/// Maps an arc length to the curve's point and direction.
type Function = dyn Fn(Real) -> (Vector, Vector) + Send + Sync;

/// Ticks per section of a function: finer than any tolerance that double precision resolves.
pub(super) const TICKS: u32 = 1 << 20;

/// Points on a centreline.
#[derive(Clone, Default)]
pub(super) struct Samples {
    pub points: Vec<Vector>,
    /// The length of the polyline up to each point.
    pub arcs: Vec<Real>,
    /// For each point the input segment that begins there.
    pub segments: Vec<u32>,
    /// For each point the bounds on the curve from there to the next; empty if all sections are
    /// even.
    pub bounds: Vec<CurveBound>,
}

impl Samples {
    /// Removes all points and keeps the memory.
    pub(super) fn clear(&mut self) {
        self.points.clear();
        self.arcs.clear();
        self.segments.clear();
        self.bounds.clear();
    }

    /// Reserves capacity for `points` points in total.
    pub(super) fn reserve(&mut self, points: usize) {
        self.points.reserve(points.saturating_sub(self.points.len()));
        self.arcs.reserve(points.saturating_sub(self.arcs.len()));
        self.segments.reserve(points.saturating_sub(self.segments.len()));
        self.bounds.reserve(points.saturating_sub(self.bounds.len()));
    }

    /// Returns the length of the polyline.
    pub(super) fn length(&self) -> Real {
        self.arcs.last().copied().unwrap_or(0.0)
    }

    /// Appends a point; `segment` is the input segment that leads to it.
    pub(super) fn push(&mut self, segment: u32, NextPoint { point, length, bound }: NextPoint) {
        self.arcs.push(self.length() + length);
        self.points.push(point);
        self.segments.push(segment);
        self.bounds.push(bound);
    }
}

/// A point to append to a curve.
pub(super) struct NextPoint {
    pub point: Vector,
    /// The arc length from the previous point.
    pub length: Real,
    /// The bounds on the curve between the two points.
    pub bound: CurveBound,
}

/// A centreline in the robot's frame.
pub(super) enum Curve {
    Samples(Samples),
    Function(Arc<Function>),
}

/// The place of a section near a point: on a segment of its polyline, or a point of its function.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Foot {
    pub between: [Vector; 2],
    /// The position between the two points, from 0 to 1.
    pub share: Real,
    pub arc: Real,
    /// Upper bound on the distance of the curve from the place.
    pub off: Real,
}

/// A place of a curve.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlaceOnCurve {
    pub point: Vector,
    /// Upper bound on the error of the point.
    pub off: Real,
    /// The unit tangent.
    pub direction: Vector,
    /// Upper bound on the error of the direction, rad.
    pub tilt: Real,
}

impl Clone for Curve {
    fn clone(&self) -> Self {
        match self {
            Self::Samples(samples) => Self::Samples(samples.clone()),
            Self::Function(curve) => Self::Function(Arc::clone(curve)),
        }
    }

    /// Reuses the memory.
    fn clone_from(&mut self, source: &Self) {
        match (&mut *self, source) {
            (Self::Samples(samples), Self::Samples(source)) => {
                samples.points.clone_from(&source.points);
                samples.arcs.clone_from(&source.arcs);
                samples.segments.clone_from(&source.segments);
                samples.bounds.clone_from(&source.bounds);
            }
            _ => *self = source.clone(),
        }
    }
}

impl Default for Curve {
    fn default() -> Self {
        Self::Samples(Samples::default())
    }
}

impl Curve {
    /// Returns the memory of the samples.
    pub(super) fn into_samples(self) -> Samples {
        match self {
            Self::Samples(samples) => samples,
            Self::Function(_) => Samples::default(),
        }
    }

    /// Returns the bounds on the curve between two ticks of a section.
    pub(super) fn bound(&self, section: &Section, [from, to]: [u32; 2]) -> CurveBound {
        match self {
            Self::Samples(Samples { bounds, .. }) if !section.is_even => {
                let own = &bounds[from as usize..to as usize];
                own.iter().fold(CurveBound::default(), |most, &bound| most.max(bound))
            }
            _ => CurveBound { curvature: section.curvature, off: 0.0 },
        }
    }

    /// Returns the input segment at an arc length of a section; `None` if the curve is a function.
    pub(super) fn segment(&self, section: &Section, arc: Real) -> Option<u32> {
        let Self::Samples(Samples { segments, .. }) = self else { return None };
        let from = self.tick(section, arc).saturating_sub(1).max(section.first);
        segments.get(from as usize).copied()
    }

    pub(super) fn point(&self, section: &Section, tick: u32) -> Vector {
        match self {
            Self::Samples(Samples { points, .. }) => points[tick as usize],
            Self::Function(curve) => curve(arc_of(section, tick)).0,
        }
    }

    pub(super) fn arc(&self, section: &Section, tick: u32) -> Real {
        match self {
            Self::Samples(Samples { arcs, .. }) => arcs[tick as usize],
            Self::Function(_) => arc_of(section, tick),
        }
    }

    /// Returns the first tick at an arc length or behind it.
    pub(super) fn tick(&self, section: &Section, arc: Real) -> u32 {
        match self {
            Self::Samples(Samples { arcs, .. }) => {
                let within = &arcs[section.first as usize..=section.last as usize];
                (section.first + within.partition_point(|&before| before < arc) as u32)
                    .min(section.last)
            }
            Self::Function(_) => {
                let share = (arc - section.start) / (section.end - section.start);
                // The conversion saturates.
                ((share * Real::from(TICKS)).ceil() as u32).min(TICKS)
            }
        }
    }

    /// Returns a tick's place as a share of the section's length: 0 and 1 at its ends.
    pub(super) fn share(&self, section: &Section, tick: u32) -> Real {
        match self {
            _ if tick <= section.first => 0.0,
            _ if tick >= section.last => 1.0,
            Self::Samples(Samples { arcs, .. }) => {
                (arcs[tick as usize] - section.start) / (section.end - section.start)
            }
            Self::Function(_) => Real::from(tick) / Real::from(TICKS),
        }
    }

    /// Returns the last tick at or before the first share, and the first tick at or behind the
    /// second share.
    pub(super) fn ticks_around(&self, section: &Section, shares: [Real; 2]) -> [u32; 2] {
        match self {
            Self::Samples(_) => {
                // Binary search by share. Ticks that satisfy `is_before` come first.
                let count = |is_before: &dyn Fn(Real) -> bool| {
                    let (mut low, mut high) = (section.first, section.last);
                    while low < high {
                        let tick = low + (high - low) / 2;
                        if is_before(self.share(section, tick)) {
                            low = tick + 1
                        } else {
                            high = tick
                        }
                    }
                    low
                };
                let behind = count(&|share| share <= shares[0]);
                let from = if self.share(section, behind) <= shares[0] {
                    behind
                } else {
                    behind.saturating_sub(1)
                };
                let to = count(&|share| share < shares[1]);
                [from.min(section.last - 1), to.max(section.first + 1)]
            }
            Self::Function(_) => {
                // The conversion saturates.
                let [from, to] = shares.map(|share| share * Real::from(TICKS));
                [(from.floor() as u32).min(TICKS - 1), (to.ceil() as u32).clamp(1, TICKS)]
            }
        }
    }

    /// Returns the place at a share of the section; for samples, at that share of the segment.
    ///
    /// A curve of curvature at most k and length l between two samples is at most
    /// `k l^2 u (1 - u) / 2` from the segment at its share u.
    pub(super) fn at_share(&self, section: &Section, share: Real) -> PlaceOnCurve {
        match self {
            Self::Samples(Samples { points, arcs, .. }) => {
                let [from, to] = self.ticks_around(section, [share; 2]);
                // At a sample: the segment before or behind it.
                let (from, to) = (from as usize, (to as usize).max(from as usize + 1));
                let (a, b) = (points[from], points[to]);
                let [before, behind] = [from, to].map(|tick| self.share(section, tick as u32));
                let along = (share - before) / (behind - before);
                // The tilt has three parts: the turn of the curve, the rounding of the segment's
                // ends, and their stated error.
                let length = arcs[to] - arcs[from];
                let rounding = 32.0 * Real::UNIT_ROUNDOFF * a.abs().max(b.abs()).max_element();
                // A length that vanishes in the sum of lengths determines no direction.
                let rounded = if length > 0.0 { rounding / length } else { Real::INFINITY };
                let bound = self.bound(section, [from as u32, to as u32]);
                let apart = if length > 0.0 { 2.0 * bound.off / length } else { Real::INFINITY };
                let tilt = bound.curvature * length * section.stretch + rounded + apart;
                let off = beside_chord(&bound, length * section.stretch, along);
                PlaceOnCurve { point: a + (b - a) * along, off, direction: direction(b - a), tilt }
            }
            Self::Function(curve) => {
                let (point, tangent) = curve(section.start + (section.end - section.start) * share);
                PlaceOnCurve { point, off: 0.0, direction: direction(tangent), tilt: 0.0 }
            }
        }
    }

    /// Returns a place of the section near `point`, searched from a nearby arc length. It is always
    /// on the section, but not always the nearest.
    pub(super) fn foot(&self, section: &Section, arc: Real, point: Vector) -> Foot {
        match self {
            Self::Samples(Samples { points, arcs, .. }) => {
                let (first, last) = (section.first as usize, section.last as usize);
                let from = (self.tick(section, arc) as usize).clamp(first, last);
                let (foot, tick) = foot_on_samples(&points[..=last], arcs, first, from, point);
                let bound = self.bound(section, [tick as u32, tick as u32 + 1]);
                let length = (arcs[tick + 1] - arcs[tick]) * section.stretch;
                Foot { off: beside_chord(&bound, length, foot.share), ..foot }
            }
            Self::Function(curve) => foot_on_function(curve.as_ref(), section, arc, point),
        }
    }
}

fn arc_of(section: &Section, tick: u32) -> Real {
    let share = Real::from(tick) / Real::from(TICKS);
    section.start + (section.end - section.start) * share
}

/// Upper bound on the distance of a curve of length `length` from a share of its chord.
fn beside_chord(bound: &CurveBound, length: Real, share: Real) -> Real {
    0.5 * bound.curvature * length * length * (share * (1.0 - share)).max(0.0) + bound.off
}

/// Searches the samples from index `first`, starting at index `from`. Returns the place and the
/// sample before it.
fn foot_on_samples(
    points: &[Vector],
    arcs: &[Real],
    first: usize,
    from: usize,
    point: Vector,
) -> (Foot, usize) {
    let last = points.len() - 1;
    let squared = |k: usize| (point - points[k]).length_squared();
    let mut nearest = from;
    // First leaps along the tangent, then single steps.
    for _ in 0..3 {
        let end = (nearest + 1).min(last);
        let step = points[end] - points[end - 1];
        let leap = (point - points[nearest]).dot(step) / step.length_squared();
        // The conversion saturates; NaN becomes 0.
        let to = ((nearest as Real + leap.round()) as usize).max(first).min(last);
        if squared(to) >= squared(nearest) {
            break;
        }
        nearest = to;
    }
    let mut least = squared(nearest);
    while nearest < last && squared(nearest + 1) < least {
        nearest += 1;
        least = squared(nearest);
    }
    while nearest > first && squared(nearest - 1) < least {
        nearest -= 1;
        least = squared(nearest);
    }
    let on_segment = |k: usize| {
        let (a, b) = (points[k], points[k + 1]);
        let share = (point - a).dot(b - a) / (b - a).length_squared();
        let share = if share > 0.0 { share.min(1.0) } else { 0.0 };
        let squared = (point - a - (b - a) * share).length_squared();
        let arc = arcs[k] + (arcs[k + 1] - arcs[k]) * share;
        (squared, (Foot { between: [a, b], share, arc, off: 0.0 }, k))
    };
    if nearest == first {
        return on_segment(first).1;
    }
    let before = on_segment(nearest - 1);
    if nearest == last {
        return before.1;
    }
    let behind = on_segment(nearest);
    if behind.0 < before.0 { behind.1 } else { before.1 }
}

/// Takes steps along the tangent while they reduce the distance.
fn foot_on_function(curve: &Function, section: &Section, from: Real, point: Vector) -> Foot {
    let mut arc = from.max(section.start).min(section.end);
    let (mut place, mut direction) = curve(arc);
    let mut squared = (point - place).length_squared();
    for _ in 0..4 {
        // The direction may have any length.
        let along = (point - place).dot(direction) / direction.length();
        let next = (arc + along).max(section.start).min(section.end);
        let (there, ahead) = curve(next);
        let nearer = (point - there).length_squared();
        if nearer.is_nan() || nearer >= squared {
            break;
        }
        (arc, place, direction, squared) = (next, there, ahead, nearer);
    }
    Foot { between: [place, place], share: 0.0, arc, off: 0.0 }
}
