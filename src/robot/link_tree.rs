//! A binary tree over a chain's links with a capsule around each node, so that a query can leave
//! out many links at once.
//!
//! The tree halves the chain again and again and stands in depth-first order: behind a node come
//! its children, and each node knows how many entries to skip to leave its subtree.

use super::ModifiedCylinder;
use crate::distance::Scalar;
use parry3d_f64::math::{Real, Vector};

/// A node of the tree.
#[derive(Clone, Copy, Debug)]
pub(crate) enum LinkNode {
    /// Two or more links.
    Inner {
        /// Holds them all.
        bound: BoundingCapsule,
        /// How many nodes follow that belong to the subtree.
        below: usize,
    },
    /// One link, by its number.
    Leaf(usize),
}

impl LinkNode {
    /// How many links it stands for.
    pub(crate) fn links(&self) -> usize {
        match self {
            // A binary tree has one more leaf than it has nodes with children.
            Self::Inner { below, .. } => below / 2 + 1,
            Self::Leaf(_) => 1,
        }
    }
}

/// A capsule around links.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BoundingCapsule {
    pub start: Vector,
    pub end: Vector,
    pub radius: Real,
}

/// Writes the tree over `links` to `nodes`, whose memory is used again.
pub(super) fn build(links: &[ModifiedCylinder], nodes: &mut Vec<LinkNode>) {
    nodes.clear();
    append(links, 0, nodes);
}

fn append(links: &[ModifiedCylinder], first: usize, nodes: &mut Vec<LinkNode>) {
    let [start, .., end] = links else {
        nodes.extend((!links.is_empty()).then_some(LinkNode::Leaf(first)));
        return;
    };
    let place = nodes.len();
    let bound = BoundingCapsule::around(start.start(), end.end(), links);
    nodes.push(LinkNode::Inner { bound, below: 0 });
    let (low, high) = links.split_at(links.len() / 2);
    append(low, first, nodes);
    append(high, first + low.len(), nodes);
    let below = nodes.len() - place - 1;
    nodes[place] = LinkNode::Inner { bound, below };
}

/// Where the leaf of a link stands in the tree over so many links.
pub(crate) fn place_of_leaf(mut link: usize, mut links: usize) -> usize {
    let mut place = 0;
    while links > 1 {
        let low = links / 2;
        if link < low {
            (place, links) = (place + 1, low);
        } else {
            // Over the node and the 2 low - 1 nodes of its first half.
            (place, link, links) = (place + 2 * low, link - low, links - low);
        }
    }
    place
}

impl BoundingCapsule {
    /// With the axis from `start` to `end`. A capsule is convex, so it holds a link if it holds the
    /// balls around the link's ends.
    fn around(start: Vector, end: Vector, links: &[ModifiedCylinder]) -> Self {
        let balls = || {
            links
                .iter()
                .flat_map(|link| [link.start(), link.end()].map(|point| (point, link.radius())))
        };
        let reach = balls().fold(0.0, |reach: Real, (point, radius)| {
            reach.max(point.abs().max_element()).max(radius)
        });
        // Near one, because the squares of tiny lengths vanish.
        let scale = reach.power_of_two_to_unity();
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_leaf_is_where_it_is_said_to_be() {
        for count in 1..70 {
            let point = |k: usize| Vector::X * k as Real;
            let link = |k| ModifiedCylinder::capsule(point(k), point(k + 1), 0.1).unwrap();
            let (links, mut nodes): (Vec<_>, _) = ((0..count).map(link).collect(), Vec::new());
            build(&links, &mut nodes);
            for link in 0..count {
                let place = place_of_leaf(link, count);
                assert!(
                    matches!(nodes[place], LinkNode::Leaf(found) if found == link),
                    "{link} of {count}"
                );
            }
        }
    }
}
