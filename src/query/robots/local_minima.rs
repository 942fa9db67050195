//! Which pairs of links are places where two robots are near: one for each pair of approaching stretches.
//!
//! The pairs within the margin are cells of a grid, link by link. A pair is a place if no neighbour of it, one link on along
//! either robot or both, is nearer. Neighbours that are as near, such as those that overlap, count as one place, at the
//! lowest links; it is none if a neighbour of any of them is nearer.

use crate::answer::RobotProximity;

/// What a search for local minima keeps from one to the next.
#[derive(Clone, Debug, Default)]
pub(super) struct LocalMinima {
    found: Vec<RobotProximity>,
    /// The cell that a cell's group goes by.
    leader: Vec<usize>,
    /// Whether a neighbour of the group is nearer.
    descends: Vec<bool>,
}

impl LocalMinima {
    pub fn start(&mut self) {
        self.found.clear();
    }

    pub fn push(&mut self, pair: RobotProximity) {
        self.found.push(pair);
    }

    /// Appends the places among the pairs to `out`, in the order of their links.
    pub fn finish(&mut self, out: &mut Vec<RobotProximity>) {
        let Self { found, leader, descends } = self;
        found.sort_unstable_by_key(|pair| pair.links);
        leader.clear();
        leader.extend(0..found.len());
        descends.clear();
        descends.resize(found.len(), false);
        // Of two neighbours one comes first in the order of the links: looking at those that follow is enough.
        for cell in 0..found.len() {
            let [i, j] = found[cell].links;
            let below = j.wrapping_sub(1);
            for links in [[i, j + 1], [i + 1, below], [i + 1, j], [i + 1, j + 1]] {
                let Ok(other) = found.binary_search_by_key(&links, |pair| pair.links) else { continue };
                let [one, two] = [cell, other].map(|cell| root(leader, cell));
                let [here, there] = [found[cell].distance, found[other].distance];
                if here < there {
                    descends[two] = true;
                } else if there < here {
                    descends[one] = true;
                } else if one != two {
                    // The lowest links lead.
                    let [low, high] = [one.min(two), one.max(two)];
                    leader[high] = low;
                    descends[low] |= descends[high];
                }
            }
        }
        let places = (0..found.len()).filter(|&cell| leader[cell] == cell && !descends[cell]);
        out.extend(places.map(|cell| found[cell]));
    }
}

fn root(leader: &mut [usize], mut cell: usize) -> usize {
    while leader[cell] != cell {
        leader[cell] = leader[leader[cell]];
        cell = leader[cell];
    }
    cell
}
