//! A binary tree over a chain's links with a bounding capsule per node. Queries prune subtrees.
//!
//! # Layout
//! The chain is halved recursively; the nodes stand in preorder. A subtree over n links has
//! 2 n - 1 nodes. Its root is followed by the subtree of the first half, then of the second half.
//! `below` is the number of nodes to skip to leave a subtree.

use super::ModifiedCylinder;
use crate::distance::Scalar;
use parry3d_f64::math::{Real, Vector};

/// A node of the tree.
#[derive(Clone, Copy, Debug)]
pub(crate) enum LinkNode {
    /// Two or more links.
    Inner {
        /// Contains all links of the subtree.
        bound: BoundingCapsule,
        /// The number of nodes that follow and belong to the subtree.
        below: usize,
    },
    /// One link, by its number.
    Leaf(usize),
}

impl LinkNode {
    /// Returns the number of links of the subtree.
    pub(crate) fn links(&self) -> usize {
        match self {
            // `below + 1` nodes = 2 n - 1 for n links.
            Self::Inner { below, .. } => below / 2 + 1,
            Self::Leaf(_) => 1,
        }
    }
}

/// A capsule that contains links.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BoundingCapsule {
    pub start: Vector,
    pub end: Vector,
    pub radius: Real,
}

/// Writes the tree over `links` to `nodes`, whose memory is reused.
pub(super) fn build(links: &[ModifiedCylinder], nodes: &mut Vec<LinkNode>) {
    nodes.clear();
    append(links, 0, nodes);
}

/// Appends the subtree over `links`. The first of the links has the index `first`.
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

/// Returns the index of a link's leaf in the tree over `links` links.
pub(crate) fn place_of_leaf(mut link: usize, mut links: usize) -> usize {
    let mut place = 0;
    while links > 1 {
        let low = links / 2;
        if link < low {
            (place, links) = (place + 1, low);
        } else {
            // Skip the node and the 2 low - 1 nodes of its first half.
            (place, link, links) = (place + 2 * low, link - low, links - low);
        }
    }
    place
}

impl BoundingCapsule {
    /// Returns a capsule with the axis from `start` to `end` that contains `links`.
    ///
    /// **Claim.** Containing the balls around each link's two ends is enough.
    /// **Proof.** A link lies in the convex hull of the balls, and a capsule is convex.
    /// **Rounding.** The radius is enlarged by `16 EPSILON (reach + radius)`, an upper bound on the
    /// rounding errors of the distances.
    fn around(start: Vector, end: Vector, links: &[ModifiedCylinder]) -> Self {
        let balls = || {
            links
                .iter()
                .flat_map(|link| [link.start(), link.end()].map(|point| (point, link.radius())))
        };
        let reach = balls().fold(0.0, |reach: Real, (point, radius)| {
            reach.max(point.abs().max_element()).max(radius)
        });
        // Brings lengths near one: the squares of tiny lengths underflow.
        let scale = reach.power_of_two_to_unity();
        let (from, to) = (start * scale, end * scale);
        let radius = balls().fold(0.0, |largest: Real, (point, radius)| {
            largest.max(distance_to_segment(point * scale, from, to) + radius * scale)
        });
        // See **Rounding**.
        Self {
            start,
            end,
            radius: ((radius + 16.0 * Real::EPSILON * (reach * scale + radius)) / scale).next_up(),
        }
    }
}

/// Returns the distance of a point from a segment, without a rounding margin.
pub(crate) fn distance_to_segment(point: Vector, start: Vector, end: Vector) -> Real {
    let (relative, along) = (point - start, end - start);
    (relative - along * share_along(relative, along)).length()
}

/// Returns the share of a segment, from 0 to 1, that is closest to a point. `relative`: the point
/// relative to the segment's start; `along`: its end relative to its start.
pub(crate) fn share_along(relative: Vector, along: Vector) -> Real {
    let share = relative.dot(along) / along.length_squared();
    // Without a length this is 0 / 0; the comparison turns NaN into 0.
    if share > 0.0 { share.min(1.0) } else { 0.0 }
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
