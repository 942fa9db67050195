//! The results of several pairs, each number in its own row.

use super::nearest::Nearest;
use super::pair_lanes::{BATCH, PairLanes, Rows, store};
use crate::distance::lanes::Pack;
use parry3d_f64::math::{Real, Vector};

/// The distances of several pairs and their closest points, on the triangle and on the link, in the
/// mesh's frame.
pub(super) struct NearestRows(Rows<7>);

impl NearestRows {
    pub(super) fn new() -> Self {
        Self([[0.0; BATCH]; 7])
    }

    /// Stores the results of a pack from `lane` on. Returns the distances.
    #[inline(always)]
    pub(super) fn take<L: Pack<Element = f64>>(&mut self, lane: usize, pack: &PairLanes<L>) -> L {
        let distance = pack.closest.distance * pack.pair.unit;
        distance.store(&mut self.0[0][lane..]);
        store(&mut self.0, 1, lane, pack.placed(pack.closest.point1));
        store(&mut self.0, 4, lane, pack.placed(pack.closest.point2));
        distance
    }

    pub(super) fn distance(&self, lane: usize) -> Real {
        self.0[0][lane]
    }

    /// Returns the result of the pair in a lane, whose triangle is `triangle`.
    pub(super) fn nearest(&self, lane: usize, triangle: u32) -> Nearest {
        let point = |row: usize| {
            Vector::new(self.0[row][lane], self.0[row + 1][lane], self.0[row + 2][lane])
        };
        Nearest::new(triangle, self.0[0][lane], point(1), || point(4))
    }
}
