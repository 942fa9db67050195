//! What each link is known to keep from the mesh when the robot has moved a little, without a
//! search.
//!
//! Once a link kept more than a distance, or exactly it. No point of the link now is farther from
//! all points of the link then than [`ReferenceOutline::moved_to`] tells, so the link keeps what is
//! left. What it keeps does not depend on the robot that it is a part of: any may follow. The same
//! is true of the capsule around all links, which serves for a robot far from the wall at a glance.

use super::look_ahead::LookAhead;
use super::placed_outline::{PlacedOutline, ROUNDING, ReferenceOutline};
use crate::pair::PlacedRobot;
use crate::query::nearest::cleared_by::ClearedBy;
use parry3d_f64::math::Real;
use std::ops::Range;

/// A wider search pays only if it spares the next query the search of one link in so many.
const MIN_SKIPPED_SHARE: usize = 4;

/// To make out what so many links keep takes about as long as to visit a node.
const LINKS_PER_NODE: usize = 4;

/// Distances that the links of a robot kept.
#[derive(Clone, Default)]
pub(crate) struct LinkLowerBounds {
    /// Link by link; none where nothing is known.
    links: Vec<LinkLowerBound>,
    /// The capsule around all links, where it is known to keep away.
    capsule: Option<LinkLowerBound>,
    /// What each link of the robot now asked about keeps by that; none where nothing is known.
    now: Vec<Real>,
    widening: LookAhead,
    /// Whether the last query has widened its search.
    is_new: bool,
}

/// A link where it was, and what it kept at the least, less what rounding can do.
#[derive(Clone, Copy)]
struct LinkLowerBound {
    link: ReferenceOutline,
    apart: Real,
    /// A triangle about as near as that, if one was met.
    triangle: Option<u32>,
}

impl LinkLowerBounds {
    pub(crate) fn forget(&mut self) {
        self.links.clear();
        self.capsule = None;
        self.now.clear();
        self.widening = LookAhead::default();
        self.is_new = false;
    }

    /// Whether every link certainly keeps more than `margin`.
    pub(crate) fn all_exceed(&self, robot: PlacedRobot, margin: Real) -> bool {
        if let Some(capsule) = &self.capsule {
            return capsule.at(&PlacedOutline::around_all(robot)) > margin;
        }
        if self.links.is_empty() || self.links.len() != robot.links().len() {
            return false;
        }
        // The tip moves most, so it comes first.
        self.links
            .iter()
            .rev()
            .zip(PlacedOutline::of_all(robot))
            .all(|(kept, link)| kept.at(&link) > margin)
    }

    /// Makes out what each link keeps.
    pub(crate) fn refresh(&mut self, robot: PlacedRobot) {
        self.now.clear();
        if self.links.len() == robot.links().len() {
            let known = self.links.iter().rev().zip(PlacedOutline::of_all(robot));
            self.now.extend(known.map(|(kept, link)| kept.at(&link)));
            self.now.reverse();
        }
    }

    /// How many of these links do not certainly keep more than `bound`, by what was recalled.
    pub(crate) fn count_open(&self, links: Range<usize>, bound: Real) -> usize {
        let count = links.len();
        let kept = self.now.get(links).unwrap_or_default();
        count - kept.iter().filter(|&&kept| kept > bound).count()
    }

    /// By how much a search for `bound` is to be wider, so that it speaks for the next queries too.
    /// None where it is better not to be, as where it would be `most` or more. `reach` is the
    /// largest coordinate of the mesh.
    pub(crate) fn look_ahead(
        &mut self,
        robot: PlacedRobot,
        bound: Real,
        most: Real,
        reach: Real,
    ) -> Option<Real> {
        let wider = self.widening.next(robot, reach);
        let wider = wider.filter(|&wider| wider < most && bound + wider < Real::INFINITY);
        self.is_new = wider.is_some();
        wider
    }

    /// Notes whether what the last query kept, if anything, is of use to this one about so many
    /// links.
    pub(crate) fn drop_if_useless(&mut self, count: usize, bound: Real) {
        if self.is_new
            && MIN_SKIPPED_SHARE * self.count_open(0..count, bound)
                > (MIN_SKIPPED_SHARE - 1) * count
        {
            self.links.clear();
            self.widening.record_failure();
        }
    }

    /// Notes how many nodes and leaves this query about so many links has visited.
    pub(crate) fn record_cost(&mut self, visited: u64, links: usize) {
        if self.is_new {
            if !self.widening.record_wide_cost(visited + (links / LINKS_PER_NODE) as u64) {
                self.links.clear();
            }
        } else if self.now.is_empty() {
            self.widening.record_plain_cost(visited);
        } else {
            // It still made use of what others had kept.
            self.links.clear();
        }
    }

    /// A triangle about as near to a link as any was, if one was met.
    pub(crate) fn approximate_nearest(&self, link: usize) -> Option<u32> {
        self.links.get(link)?.triangle
    }

    /// Notes that all of these links keep `apart` or more.
    pub(crate) fn set(
        &mut self,
        robot: PlacedRobot,
        links: Range<usize>,
        apart: Real,
        triangle: Option<u32>,
        reach: Real,
    ) {
        let count = robot.links().len();
        if self.links.len() != count {
            let unknown =
                LinkLowerBound::new(PlacedOutline::of(robot, 0), Real::NEG_INFINITY, None, reach);
            self.links.clear();
            self.links.resize(count, unknown);
        }
        for link in links {
            let triangle = triangle.or(self.links[link].triangle);
            self.links[link] =
                LinkLowerBound::new(PlacedOutline::of(robot, link), apart, triangle, reach);
        }
    }

    /// Notes what keeps `apart` or more.
    pub(crate) fn set_all(
        &mut self,
        robot: PlacedRobot,
        apart: Real,
        known: ClearedBy,
        reach: Real,
    ) {
        self.links.clear();
        self.capsule = None;
        match known {
            ClearedBy::Capsule => {
                self.capsule =
                    Some(LinkLowerBound::new(PlacedOutline::around_all(robot), apart, None, reach));
            }
            ClearedBy::Links => {
                self.links.extend(
                    PlacedOutline::of_all(robot)
                        .map(|link| LinkLowerBound::new(link, apart, None, reach)),
                );
                self.links.reverse();
            }
        }
        self.widening.record_success();
    }

    /// Notes that a wider search met something.
    pub(crate) fn record_miss(&mut self) {
        self.links.clear();
        self.capsule = None;
        self.widening.shrink();
    }
}

impl LinkLowerBound {
    /// `reach` is the largest coordinate of the mesh. The link later reaches no farther than now
    /// and what it has moved.
    fn new(link: PlacedOutline, apart: Real, triangle: Option<u32>, reach: Real) -> Self {
        let apart = apart - ROUNDING * (reach + 2.0 * link.extent());
        Self { link: ReferenceOutline::new(link, reach), apart, triangle }
    }

    /// What the link keeps at least when it has become `now`. Not a number where that can't be
    /// told.
    #[inline(always)] // where links are looked at one after another
    fn at(&self, now: &PlacedOutline) -> Real {
        self.apart - (1.0 + ROUNDING) * self.link.moved_to(now)
    }
}
