//! Lower bounds on the distances of the links after the robot has moved, without a search.
//!
//! # Definitions
//! - `d`: a lower bound on the distance of a link from the mesh, at an earlier query.
//! - `m`: an upper bound on the distance of any point of the link now from the link then
//!   ([`ReferenceOutline::moved_to`]).
//! - `reach`: the largest coordinate of the mesh.
//!
//! # Correctness
//! **Claim.** The link is now at least `d - m` from the mesh.
//!
//! **Proof.** Each point p of the link now has a point q of the link then with `|p - q| <= m`. Each
//! point of the mesh is at least `d` from q, and so at least `d - m` from p.
//!
//! The claim holds for any link, so the robot may be another one with as many links. It also holds
//! for the capsule around all links. The capsule answers for a robot far from the wall in one step.
//!
//! **Rounding.** `ROUNDING (reach + 2 extent)` is subtracted from `d`, and `m` is multiplied by
//! `1 + ROUNDING`. The factor 2 is for the link then and now. The link now reaches at most
//! `extent + m`; the factor `1 + ROUNDING` covers m.

use super::look_ahead::LookAhead;
use super::placed_outline::{PlacedOutline, ROUNDING, ReferenceOutline};
use crate::pair::PlacedRobot;
use crate::query::nearest::cleared_by::ClearedBy;
use parry3d_f64::math::Real;
use std::ops::Range;

/// Cached bounds must skip at least one link in four; otherwise they are cleared.
const MIN_SKIPPED_SHARE: usize = 4;

/// Links per visited node in the cost model: bounding this many links takes about as long as a
/// visit.
const LINKS_PER_NODE: usize = 4;

/// Lower bounds on the distances of the links of a robot.
#[derive(Clone, Default)]
pub(crate) struct LinkLowerBounds {
    /// The bound of each link at its reference placement; empty if unknown.
    links: Vec<LinkLowerBound>,
    /// The bound of the capsule around all links, if one is known.
    capsule: Option<LinkLowerBound>,
    /// The bound of each link of the current robot, set by `refresh`; empty if unknown.
    now: Vec<Real>,
    widening: LookAhead,
    /// Whether the last call of `look_ahead` returned a radius.
    is_new: bool,
}

/// A link at its reference placement, and a lower bound on its distance, rounding subtracted.
#[derive(Clone, Copy)]
struct LinkLowerBound {
    link: ReferenceOutline,
    apart: Real,
    /// A triangle at about this distance, if one was met.
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

    /// Returns true if every link is proven farther than `margin` from the mesh.
    pub(crate) fn all_exceed(&self, robot: PlacedRobot, margin: Real) -> bool {
        if let Some(capsule) = &self.capsule {
            return capsule.at(&PlacedOutline::around_all(robot)) > margin;
        }
        if self.links.is_empty() || self.links.len() != robot.links().len() {
            return false;
        }
        // The tip moves most, so it fails first.
        self.links
            .iter()
            .rev()
            .zip(PlacedOutline::of_all(robot))
            .all(|(kept, link)| kept.at(&link) > margin)
    }

    /// Computes the bound of each link at its current placement.
    pub(crate) fn refresh(&mut self, robot: PlacedRobot) {
        self.now.clear();
        if self.links.len() == robot.links().len() {
            let known = self.links.iter().rev().zip(PlacedOutline::of_all(robot));
            self.now.extend(known.map(|(kept, link)| kept.at(&link)));
            self.now.reverse();
        }
    }

    /// Counts the links whose bound, as computed by `refresh`, does not exceed `bound`.
    pub(crate) fn count_open(&self, links: Range<usize>, bound: Real) -> usize {
        let count = links.len();
        let kept = self.now.get(links).unwrap_or_default();
        count - kept.iter().filter(|&&kept| kept > bound).count()
    }

    /// Returns the extra search radius for this query, or none if looking ahead does not pay.
    ///
    /// None as well if the extra radius would be `most` or more. `reach` is the largest coordinate
    /// of the mesh.
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

    /// Clears the cached bounds if the last query looked ahead and its bounds exclude fewer than
    /// 1/4 of the `count` links.
    pub(crate) fn drop_if_useless(&mut self, count: usize, bound: Real) {
        if self.is_new
            && MIN_SKIPPED_SHARE * self.count_open(0..count, bound)
                > (MIN_SKIPPED_SHARE - 1) * count
        {
            self.links.clear();
            self.widening.record_failure();
        }
    }

    /// Records how many nodes and leaves this query visited for `links` links.
    pub(crate) fn record_cost(&mut self, visited: u64, links: usize) {
        if self.is_new {
            if !self.widening.record_wide_cost(visited + (links / LINKS_PER_NODE) as u64) {
                self.links.clear();
            }
        } else if self.now.is_empty() {
            self.widening.record_plain_cost(visited);
        } else {
            // This query used earlier bounds, so its cost is no baseline. Clearing them makes the
            // next one so.
            self.links.clear();
        }
    }

    /// Returns a triangle at about the distance of the link, if one was met.
    pub(crate) fn approximate_nearest(&self, link: usize) -> Option<u32> {
        self.links.get(link)?.triangle
    }

    /// Sets the lower bound of `links` to `apart`, at their current placement.
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

    /// Sets the lower bound of all links, or of the capsule around them, to `apart`.
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

    /// Records that a search with look-ahead met the mesh, and clears the bounds.
    pub(crate) fn record_miss(&mut self) {
        self.links.clear();
        self.capsule = None;
        self.widening.shrink();
    }
}

impl LinkLowerBound {
    /// `reach` is the largest coordinate of the mesh. `2 extent` is for the link then and later
    /// (see the module).
    fn new(link: PlacedOutline, apart: Real, triangle: Option<u32>, reach: Real) -> Self {
        let apart = apart - ROUNDING * (reach + 2.0 * link.extent());
        Self { link: ReferenceOutline::new(link, reach), apart, triangle }
    }

    /// Returns a lower bound on the distance of the link at its placement `now`. NaN if its caps
    /// differ.
    #[inline(always)] // in the loop over all links
    fn at(&self, now: &PlacedOutline) -> Real {
        self.apart - (1.0 + ROUNDING) * self.link.moved_to(now)
    }
}
