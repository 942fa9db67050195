//! The centreline: samples, or a function of arc length.

use super::Section;
use parry3d_f64::math::{Real, Vector};
use std::sync::Arc;

/// A point and the direction of the curve there, by arc length.
type Function = dyn Fn(Real) -> (Vector, Vector) + Send + Sync;

/// How many ticks a section of a function has: more than any tolerance asks for that double precision can tell.
pub(super) const TICKS: u32 = 1 << 20;

/// A centreline in the robot's frame.
#[derive(Clone)]
pub(super) enum Curve {
    Samples {
        points: Vec<Vector>,
        /// The length of the polyline up to each point.
        arcs: Vec<Real>,
    },
    Function(Arc<Function>),
}

/// Where a section is near a point: on the line between two points of its polyline, or at a point of its curve.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Foot {
    pub between: [Vector; 2],
    /// From the one to the other.
    pub share: Real,
    pub arc: Real,
}

impl Default for Curve {
    fn default() -> Self {
        Self::Samples { points: Vec::new(), arcs: Vec::new() }
    }
}

impl Curve {
    /// The memory of samples.
    pub(super) fn into_samples(self) -> (Vec<Vector>, Vec<Real>) {
        match self {
            Self::Samples { points, arcs } => (points, arcs),
            Self::Function(_) => (Vec::new(), Vec::new()),
        }
    }

    pub(super) fn point(&self, section: &Section, tick: u32) -> Vector {
        match self {
            Self::Samples { points, .. } => points[tick as usize],
            Self::Function(curve) => curve(arc_of(section, tick)).0,
        }
    }

    pub(super) fn arc(&self, section: &Section, tick: u32) -> Real {
        match self {
            Self::Samples { arcs, .. } => arcs[tick as usize],
            Self::Function(_) => arc_of(section, tick),
        }
    }

    /// The first tick at an arc length or behind it.
    pub(super) fn tick(&self, section: &Section, arc: Real) -> u32 {
        match self {
            Self::Samples { arcs, .. } => {
                let within = &arcs[section.first as usize..=section.last as usize];
                (section.first + within.partition_point(|&before| before < arc) as u32).min(section.last)
            }
            Self::Function(_) => {
                let share = (arc - section.start) / (section.end - section.start);
                // A number out of range becomes the nearest that is in it.
                ((share * Real::from(TICKS)).ceil() as u32).min(TICKS)
            }
        }
    }

    /// A place of the section near `point`, found from an arc length nearby: not always the nearest, but always on the
    /// section.
    pub(super) fn foot(&self, section: &Section, arc: Real, point: Vector) -> Foot {
        match self {
            Self::Samples { points, arcs } => {
                let (first, last) = (section.first as usize, section.last as usize);
                let from = (self.tick(section, arc) as usize).clamp(first, last);
                foot_on_samples(&points[..=last], arcs, first, from, point)
            }
            Self::Function(curve) => foot_on_function(curve.as_ref(), section, arc, point),
        }
    }
}

fn arc_of(section: &Section, tick: u32) -> Real {
    let share = Real::from(tick) / Real::from(TICKS);
    section.start + (section.end - section.start) * share
}

/// Along the samples `first..`, from sample `from`.
fn foot_on_samples(points: &[Vector], arcs: &[Real], first: usize, from: usize, point: Vector) -> Foot {
    let last = points.len() - 1;
    let squared = |k: usize| (point - points[k]).length_squared();
    let mut nearest = from;
    // Leaps along the tangent, then step by step.
    for _ in 0..3 {
        let end = (nearest + 1).min(last);
        let step = points[end] - points[end - 1];
        let leap = (point - points[nearest]).dot(step) / step.length_squared();
        // A number out of range becomes the nearest that is in it, and NaN becomes 0.
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
        (squared, Foot { between: [a, b], share, arc: arcs[k] + (arcs[k + 1] - arcs[k]) * share })
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

/// By steps along the tangent, as long as they bring the curve nearer.
fn foot_on_function(curve: &Function, section: &Section, from: Real, point: Vector) -> Foot {
    let mut arc = from.max(section.start).min(section.end);
    let (mut place, mut direction) = curve(arc);
    let mut squared = (point - place).length_squared();
    for _ in 0..4 {
        let along = (point - place).dot(direction);
        let next = (arc + along).max(section.start).min(section.end);
        let (there, ahead) = curve(next);
        let nearer = (point - there).length_squared();
        if nearer.is_nan() || nearer >= squared {
            break;
        }
        (arc, place, direction, squared) = (next, there, ahead, nearer);
    }
    Foot { between: [place, place], share: 0.0, arc }
}
