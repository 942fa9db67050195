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
//! **Rounding.** `ROUNDING (reach + 2 extent)` is subtracted from `d`, and `m` is multiplied by `1
//! + ROUNDING`. The link then reaches at most `extent`, and the link now `extent + m`: the sum is
//! `2 extent`, and the factor `1 + ROUNDING` covers the rest.
//!
//! # Look-ahead
//! [`LookAhead`] decides how much farther than its bound a query searches, so that later queries
//! can reuse its lower bounds. A slightly wider search costs slightly more. The width follows from
//! the robot's displacement since the last query. The controller compares the measured cost of
//! queries with and without look-ahead. If look-ahead does not pay, it pauses; each failure doubles
//! the pause.
//!
//! - *baseline cost*: nodes and leaves that a query without look-ahead visits, as a running mean.
//! - *trial*: a run of consecutive queries with look-ahead.
//! - *rest*: queries until look-ahead is tried again; 1, 3, 7, .. after consecutive failures.

use super::outline::{PlacedOutline, ROUNDING, ReferenceOutline};
use crate::pair::PlacedRobot;
use parry3d_f64::math::Real;
use std::mem::take;
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
    /// The bound of the capsule around all links, if `clears` proved one.
    capsule: Option<LinkLowerBound>,
    /// The bound of each link of the current robot, set by `refresh`; empty if unknown.
    now: Vec<Real>,
    look_ahead: LookAhead,
    /// Whether the last call of `look_ahead` returned a radius. Until that call this is of the
    /// query before.
    has_looked_ahead: bool,
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
    /// Forgets everything: fields that are not named here start anew, the lists keep memory alone.
    pub(crate) fn forget(&mut self) {
        let Self { links, now, .. } = self;
        links.clear();
        now.clear();
        *self = Self { links: take(links), now: take(now), ..Self::default() };
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
        let extra = self.look_ahead.next(robot, reach);
        let extra = extra.filter(|&extra| extra < most && bound + extra < Real::INFINITY);
        self.has_looked_ahead = extra.is_some();
        extra
    }

    /// Clears the cached bounds if they exclude fewer than 1/4 of the `count` links, and counts a
    /// failure of the look-ahead. Only if the query before looked ahead: other bounds are no
    /// evidence about it.
    pub(crate) fn drop_if_useless(&mut self, count: usize, bound: Real) {
        if self.has_looked_ahead
            && MIN_SKIPPED_SHARE * self.count_open(0..count, bound)
                > (MIN_SKIPPED_SHARE - 1) * count
        {
            self.links.clear();
            self.look_ahead.record_failure();
        }
    }

    /// Records how many nodes and leaves this query visited for `links` links.
    pub(crate) fn record_cost(&mut self, visited: u64, links: usize) {
        if self.has_looked_ahead {
            if !self.look_ahead.record_trial_cost(visited + (links / LINKS_PER_NODE) as u64) {
                self.links.clear();
            }
        } else if self.now.is_empty() {
            self.look_ahead.record_baseline_cost(visited);
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
        self.look_ahead.record_success();
    }

    /// Records that a search with look-ahead met the mesh, and clears the bounds.
    pub(crate) fn record_miss(&mut self) {
        self.links.clear();
        self.capsule = None;
        self.look_ahead.shrink();
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

/// How many queries the look-ahead covers at first. Each search that meets the mesh halves the
/// number.
const QUERIES: Real = 8.0;
/// Queries of one trial.
const QUERIES_PER_TRIAL: u32 = 16;
/// After this many successful trials one query measures the baseline cost again.
const TRIALS_PER_BASELINE: u32 = 16;
/// The longest rest after a search that met the mesh, and after one that did not pay. The second is
/// longer, because a failed trial costs as much as several queries.
const REST_AFTER_MEETING: u32 = 63;
const REST_WITHOUT_PAY: u32 = 255;

/// Decides whether, and how far, a query looks ahead.
#[derive(Clone)]
struct LookAhead {
    /// The robot at the last query, as one link from its base to its tip.
    before: Option<PlacedOutline>,
    /// How many queries the next look-ahead covers.
    queries: Real,
    /// Queries left of this rest, and the length of the last rest since look-ahead paid.
    rest: u32,
    last_rest: u32,
    /// The baseline cost, if one was measured.
    baseline_cost: Option<u64>,
    /// The cost of this trial without its first query, the number of its queries, and the number of
    /// successful trials.
    trial_cost: u64,
    tried: u32,
    trials: u32,
}

impl Default for LookAhead {
    fn default() -> Self {
        Self {
            before: None,
            queries: QUERIES,
            rest: 0,
            last_rest: 0,
            baseline_cost: None,
            trial_cost: 0,
            tried: 0,
            trials: 0,
        }
    }
}

impl LookAhead {
    /// Returns the look-ahead for a query about this robot, or none during a rest. `reach` is the
    /// largest coordinate of the mesh.
    pub(crate) fn next(&mut self, robot: PlacedRobot, reach: Real) -> Option<Real> {
        let now = PlacedOutline::of_whole(robot);
        let before = self.before.replace(now)?;
        if self.rest > 0 {
            self.rest -= 1;
            return None;
        }
        // Rounding alone must not use up the look-ahead.
        let rounding = ROUNDING * (reach + 2.0 * now.extent());
        Some(self.queries * ReferenceOutline::new(before, reach).moved_to(&now) + 4.0 * rounding)
    }

    /// Records the cost of a query without look-ahead.
    fn record_baseline_cost(&mut self, cost: u64) {
        self.baseline_cost =
            Some(self.baseline_cost.map_or(cost, |before| (3 * before + cost) / 4));
    }

    /// Records the cost of a query with look-ahead. Returns false if the next query should search
    /// without look-ahead and without the cached bounds.
    ///
    /// `tried` counts the queries of this trial, this one included. The first of them fills the
    /// bounds for the others, so its cost does not count; after a successful trial this is the last
    /// query of that trial. The trial fails once the other `tried - 1` queries together cost more
    /// than `tried` queries at the baseline cost.
    fn record_trial_cost(&mut self, cost: u64) -> bool {
        if self.tried > 0 {
            self.trial_cost += cost;
        }
        self.tried += 1;
        if self.baseline_cost.is_some_and(|plain| self.trial_cost > plain * u64::from(self.tried)) {
            self.record_failure();
            return false;
        }
        if self.tried > QUERIES_PER_TRIAL {
            self.record_success();
            (self.trial_cost, self.tried, self.trials) = (0, 1, self.trials + 1);
        }
        if self.trials == TRIALS_PER_BASELINE {
            (self.rest, self.tried, self.trials) = (1, 0, 0);
            return false;
        }
        true
    }

    /// Records that the last look-ahead paid.
    fn record_success(&mut self) {
        self.last_rest = 0;
    }

    /// Records that look-ahead does not pay.
    fn record_failure(&mut self) {
        (self.trial_cost, self.tried, self.trials) = (0, 0, 0);
        self.extend_rest(REST_WITHOUT_PAY);
    }

    /// Records that a search of `clears` met the mesh within its look-ahead: halves the look-ahead
    /// and rests.
    pub(crate) fn shrink(&mut self) {
        self.queries = (0.5 * self.queries).max(1.0);
        self.extend_rest(REST_AFTER_MEETING);
    }

    fn extend_rest(&mut self, longest: u32) {
        self.last_rest = (2 * self.last_rest + 1).min(longest);
        self.rest = self.last_rest;
    }
}

/// The shape that `clears` proved farther than the margin from the mesh.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum ClearedBy {
    /// Every link by itself.
    Links,
    /// The capsule around all links.
    Capsule,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::Chain;
    use parry3d_f64::math::{Pose, Vector};

    /// Counts the queries with look-ahead, out of `queries`. The first of a run costs `first`, each
    /// other one `later`, and one without look-ahead 100.
    fn queries_that_look_ahead(queries: u32, first: u64, later: u64) -> u32 {
        let (mut look_ahead, mut is_first, mut count) = (LookAhead::default(), true, 0);
        look_ahead.record_baseline_cost(100);
        for _ in 0..queries {
            if look_ahead.rest > 0 {
                look_ahead.rest -= 1;
                look_ahead.record_baseline_cost(100);
                is_first = true;
            } else {
                count += 1;
                look_ahead.record_trial_cost(if is_first { first } else { later });
                is_first = false;
            }
        }
        count
    }

    #[test]
    fn queries_look_ahead_where_it_costs_less() {
        // All except the few that re-measure the baseline cost.
        for later in [0, 20, 90] {
            let count = queries_that_look_ahead(10_000, 400, later);
            assert!((9_900..10_000).contains(&count), "{count} where another costs {later}");
        }
        // Hardly any: one trial in 256 queries.
        for (later, most) in [(500, 2), (200, 3), (130, 6)] {
            let count = queries_that_look_ahead(25_600, 400, later);
            assert!((100..110 * most).contains(&count), "{count} where another costs {later}");
        }
    }

    /// Forgotten bounds answer no later query, and a pause of the look-ahead ends.
    #[test]
    fn forgotten_bounds_are_unknown() {
        let points = [Vector::ZERO, Vector::X, Vector::X * 2.0];
        let robot = Chain::capsules(&points, &[0.1; 2]).unwrap();
        let robot = PlacedRobot::new(&robot, &Pose::IDENTITY).unwrap();
        let mut bounds = LinkLowerBounds::default();
        bounds.look_ahead.record_failure();
        bounds.set_all(robot, 3.0, ClearedBy::Capsule, 1.0);
        assert!(bounds.all_exceed(robot, 2.0));
        bounds.set(robot, 0..2, 3.0, Some(7), 1.0);
        bounds.refresh(robot);
        assert_eq!(bounds.count_open(0..2, 2.0), 0);
        bounds.forget();
        assert!(!bounds.all_exceed(robot, 2.0));
        assert_eq!(bounds.count_open(0..2, 2.0), 2);
        bounds.refresh(robot);
        assert_eq!(bounds.count_open(0..2, 2.0), 2);
        assert_eq!((bounds.approximate_nearest(0), bounds.look_ahead.rest), (None, 0));
    }
}
