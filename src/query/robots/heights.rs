//! Separates links of two nodes that are tiny compared to their distance, in double precision.
//!
//! # Definitions
//! - `n`: the unit vector along the way between the axes of the nodes' capsules, from the first
//!   robot to the second.
//! - `top1[i]`: an upper bound on `<n, x>` over link `i` of the first robot.
//! - `top2[j]`: an upper bound on `<-n, x>` over link `j` of the second robot.
//!
//! # Why
//! Single precision errs by up to 2^-16 of the frame ([`balls`](super::balls)). If two robots are
//! 10^7 times their size apart, the error exceeds their length: no two links differ, and all pairs
//! would be measured.
//!
//! # Claim
//! Two links are at least `-(top1[i] + top2[j])` apart, for every unit vector `n`. A pair is
//! skipped if this bound exceeds the limit. For links at most `s` across the segment and `D` apart
//! the bound is too small by about `s^2 / D`, which is little for tiny nodes.
//!
//! # Rounding
//! All coordinates are at most 2. The coordinates of an end err by 2 u each, `n` by 4 u of its
//! length, and the sum of three products by 6 u more. Both heights together err by less than 64 u.
//! A distance at a flat cap may be measured too small by 64 u. The sum is the [`SLACK`] of
//! capsules.

use super::balls::{SWEPT, Sweep};
use super::pair_frame::{NodeCapsule, PairFrame, SLACK};
use crate::distance::lanes::set_bits;
use parry3d_f64::math::Real;

/// A node is tiny if single precision errs by more than about 1 / 256 of its size.
const TINY: Real = 1.0 / 256.0;

/// The extents of links along the segment between two nodes.
pub(super) struct Heights {
    /// `top1` of the first robot's links, and `top2` of the second's.
    tops: [[Real; SWEPT]; 2],
    /// The largest of each.
    highest: [Real; 2],
}

impl Heights {
    /// Returns the heights of two nodes; `None` if a node is not tiny or the axes meet.
    pub fn of_tiny(sweep: &Sweep, outlines: &[NodeCapsule; 2], frame: &PairFrame) -> Option<Self> {
        if outlines.iter().any(|outline| outline.size() > TINY) {
            return None;
        }
        let n = outlines[0].way_to(&outlines[1])?;
        let tops = [(0, n), (1, -n)].map(|(robot, way): (usize, _)| {
            // A link that is not placed is never skipped.
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

    /// Returns a lower bound on the distance of any two of the links, in the frame.
    pub fn at_least(&self) -> Real {
        -(self.highest[0] + self.highest[1]) - SLACK
    }

    /// Drops the pairs in `near` whose lower bound exceeds `limit` (in the frame). Returns how many
    /// are left.
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

    /// Returns the queried pair with the least lower bound; ties return the first.
    pub fn nearest(&self, sweep: &Sweep) -> Option<[usize; 2]> {
        let [tops, others] = &self.tops;
        let [first, second] = &sweep.links;
        let (mut most, mut found) = (Real::NEG_INFINITY, None);
        for (row, link) in first.clone().enumerate() {
            for other in sweep.queried_from[row].max(second.start)..second.end {
                let top = tops[row] + others[other - second.start];
                if top > most {
                    (most, found) = (top, Some([link, other]));
                }
            }
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::super::balls::Balls;
    use super::*;
    use crate::pair::PlacedRobot;
    use crate::robot::Chain;
    use continuum_testing::Random;
    use fearless_simd::Level;
    use parry3d_f64::math::{Pose, Vector};

    /// For robots 10^5 to 10^9 times their size apart: no pair within the limit is skipped, and few
    /// others are kept. Single precision alone keeps nearly all.
    #[test]
    fn links_of_far_robots_are_told_apart() {
        let mut random = Random::new(7);
        let (mut kept, mut by_balls, mut all) = (0, 0, 0);
        for round in 0..60 {
            let mut robot = || {
                let points: Vec<_> = (0..41)
                    .map(|k| Vector::Z * f64::from(k) * 0.05 + random.point() * 0.1)
                    .collect();
                match round % 2 {
                    0 => Chain::cylinders(&points, &[0.03; 40]).unwrap(),
                    _ => Chain::capsules(&points, &[0.03; 40]).unwrap(),
                }
            };
            let (a, b) = (robot(), robot());
            let away = random.direction() * 10.0_f64.powi(5 + round % 5);
            let poses = [random.pose(1.0), Pose::from_translation(away) * random.pose(1.0)];
            let [Ok(a), Ok(b)] = [PlacedRobot::new(&a, &poses[0]), PlacedRobot::new(&b, &poses[1])]
            else {
                panic!("both poses are rigid")
            };
            let frame = PairFrame::around([&a, &b]);
            let mut balls = [Balls::default(), Balls::default()];
            for (balls, robot) in balls.iter_mut().zip([&a, &b]) {
                balls.start(40);
                balls.place(robot, &frame, 0..40);
            }
            let sweep = Sweep {
                balls: [&balls[0], &balls[1]],
                links: [0..40, 0..40],
                queried_from: &[0; 40],
            };
            let outlines = [&a, &b].map(|robot| frame.outline(robot, 0));
            let heights = Heights::of_tiny(&sweep, &outlines, &frame).expect("they are tiny");
            let distances: Vec<Vec<_>> = a
                .placed_links()
                .map(|one| b.placed_links().map(|two| one.measure_link(&two).distance).collect())
                .collect();
            let least = distances.iter().flatten().copied().fold(Real::INFINITY, Real::min);
            assert!(heights.at_least() <= frame.length(least));
            let [one, two] = heights.nearest(&sweep).expect("all are asked for");
            for limit in [least, distances[one][two], distances[random.below(40) as usize][3]] {
                let mut near = [0; SWEPT];
                let before = sweep.near(Level::new(), frame.length(limit), &mut near);
                let count = heights.keep_near(frame.length(limit), &mut near[..40]);
                for (row, distances) in near.iter().zip(&distances) {
                    for (lane, distance) in distances.iter().enumerate() {
                        assert!(
                            *distance > limit || row & (1 << lane) != 0,
                            "{distance} of {limit}"
                        );
                    }
                }
                if limit == least {
                    (kept, by_balls, all) = (kept + count, by_balls + before, all + 1600);
                }
            }
        }
        assert!(by_balls > all / 2 && kept < all / 50, "{kept} {by_balls} {all}");
    }
}
