//! Links of two nodes that are tiny beside the way between them, told apart in double precision.
//!
//! # Definitions
//! - `n`: the unit vector along the way between the axes of the nodes' capsules, from the first robot to the second.
//! - `top1[i]`: an upper bound on `<n, x>` over link `i` of the first robot.
//! - `top2[j]`: an upper bound on `<-n, x>` over link `j` of the second robot.
//!
//! # Why
//! Single precision errs by up to 2^-16 of the frame ([`balls`](super::balls)). Of two robots that are 10^7 times their size
//! apart, that is more than either is long: no two links differ, and all would be measured.
//!
//! # Claim
//! Two links are at least `-(top1[i] + top2[j])` apart, whatever `n` is. So a pair is left out if that exceeds the limit.
//! The bound misses the distance of links at most `s` across the way and `D` apart by about `s^2 / D`: little for tiny nodes.
//!
//! # Rounding
//! All coordinates are at most 2. Those of an end err by 2 u each, `n` by 4 u of its length, and the sum of three products by
//! 6 u more. Both heights together err by less than 64 u, and a distance at a flat cap may be measured too short by
//! 64 u: the [`SLACK`] of capsules.

use super::balls::{SWEPT, Sweep};
use super::outline::{Outline, SLACK, SearchFrame};
use crate::distance::lanes::set_bits;
use parry3d_f64::math::Real;

/// Nodes are tiny if single precision errs by more than about 1 / 256 of both.
const TINY: Real = 1.0 / 256.0;

/// How far links reach along the way between two nodes.
pub(super) struct Heights {
    /// Of the first robot's links along `n`, and of the second's along `-n`.
    tops: [[Real; SWEPT]; 2],
    /// The largest of each.
    highest: [Real; 2],
}

impl Heights {
    /// Those of two nodes, if both are tiny and a way leads from one to the other.
    pub fn of_tiny(sweep: &Sweep, outlines: &[Outline; 2], frame: &SearchFrame) -> Option<Self> {
        if outlines.iter().any(|outline| outline.size() > TINY) {
            return None;
        }
        let n = outlines[0].way_to(&outlines[1])?;
        let tops = [(0, n), (1, -n)].map(|(robot, way): (usize, _)| {
            // A link that has not been placed is never left out.
            let mut tops = [Real::INFINITY; SWEPT];
            for (top, link) in tops.iter_mut().zip(sweep.links[robot].clone()) {
                if let Some(([start, end], radius, _)) = sweep.balls[robot].link(link) {
                    let [start, end] = [start, end].map(|end| frame.point(*end).dot(way));
                    *top = start.max(end) + frame.length(*radius);
                }
            }
            tops
        });
        let highest = [0, 1].map(|robot: usize| {
            let tops = &tops[robot][..sweep.links[robot].len()];
            tops.iter().copied().fold(Real::NEG_INFINITY, Real::max)
        });
        Some(Self { tops, highest })
    }

    /// How far any two of the links are apart at least, in the frame.
    pub fn at_least(&self) -> Real {
        -(self.highest[0] + self.highest[1]) - SLACK
    }

    /// Leaves of the pairs those that may be no farther apart than a limit in the frame. Returns how many there are.
    pub fn keep_near(&self, limit: Real, near: &mut [u64]) -> u32 {
        let [tops, others] = &self.tops;
        let mut count = 0;
        for (row, top) in near.iter_mut().zip(tops) {
            let reach = limit + SLACK + top;
            for lane in set_bits(*row) {
                if -others[lane] > reach {
                    *row &= !(1 << lane);
                }
            }
            count += row.count_ones();
        }
        count
    }

    /// The two links that are asked for and whose heights are nearest: the first of equals.
    pub fn nearest(&self, sweep: &Sweep) -> Option<[usize; 2]> {
        let [tops, others] = &self.tops;
        let [first, second] = &sweep.links;
        let (mut most, mut found) = (Real::NEG_INFINITY, None);
        for (row, link) in first.clone().enumerate() {
            for other in sweep.asked_from[row].max(second.start)..second.end {
                let top = tops[row] + others[other - second.start];
                if top > most {
                    (most, found) = (top, Some([link, other]));
                }
            }
        }
        found
    }
}
