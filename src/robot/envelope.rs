//! Capsules around runs of a chain's links, so that a query can pass over many links at once.
//!
//! The runs are those of halving the chain again and again. In the order of the list a run stands before its
//! halves, and knows how many entries to pass over to leave it.

use super::ModifiedCylinder;
use super::scale::to_unit;
use parry3d_f64::math::{Real, Vector};

/// An entry of the list.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Run {
    /// Two or more links.
    Links {
        /// Holds them all.
        envelope: Envelope,
        /// How many entries follow that belong to this run.
        inner: usize,
    },
    /// One link, by its number.
    Link(usize),
}

/// A capsule.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Envelope {
    pub start: Vector,
    pub end: Vector,
    pub radius: Real,
}

/// The list of runs of a chain.
pub(super) fn runs(links: &[ModifiedCylinder]) -> Vec<Run> {
    let mut runs = Vec::with_capacity(2 * links.len());
    append(links, 0, &mut runs);
    runs
}

fn append(links: &[ModifiedCylinder], first: usize, runs: &mut Vec<Run>) {
    let [start, .., end] = links else {
        runs.extend((!links.is_empty()).then_some(Run::Link(first)));
        return;
    };
    let place = runs.len();
    let envelope = Envelope::around(start.start(), end.end(), links);
    runs.push(Run::Links { envelope, inner: 0 });
    let (low, high) = links.split_at(links.len() / 2);
    append(low, first, runs);
    append(high, first + low.len(), runs);
    let inner = runs.len() - place - 1;
    runs[place] = Run::Links { envelope, inner };
}

impl Envelope {
    /// With the axis from `start` to `end`. A capsule is convex, so it holds a link if it holds the balls around
    /// the link's ends.
    fn around(start: Vector, end: Vector, links: &[ModifiedCylinder]) -> Self {
        let balls =
            || links.iter().flat_map(|link| [link.start(), link.end()].map(|point| (point, link.radius())));
        let reach = balls()
            .fold(0.0, |reach: Real, (point, radius)| reach.max(point.abs().max_element()).max(radius));
        // Near one, because the squares of tiny lengths vanish.
        let scale = to_unit(reach);
        let (from, to) = (start * scale, end * scale);
        let radius = balls().fold(0.0, |largest: Real, (point, radius)| {
            largest.max(distance_to_segment(point * scale, from, to) + radius * scale)
        });
        // What the roundings may have taken away.
        Self {
            start,
            end,
            radius: ((radius + 16.0 * Real::EPSILON * (reach * scale + radius)) / scale).next_up(),
        }
    }
}

/// The distance of a point from a segment, but for rounding.
pub(crate) fn distance_to_segment(point: Vector, start: Vector, end: Vector) -> Real {
    let axis = end - start;
    let along = (point - start).dot(axis) / axis.length_squared();
    // 0 / 0 where the segment is a point: the comparisons turn it into 0.
    let along = if along > 0.0 { along.min(1.0) } else { 0.0 };
    (point - start - axis * along).length()
}
