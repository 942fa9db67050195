//! Look-ahead: a search beyond its bound, so that later queries can reuse its lower bounds. This
//! controller decides whether a query looks ahead, and how far.
//!
//! A slightly wider search costs slightly more. The width follows from the robot's displacement
//! since the last query. The controller compares the measured cost of queries with and without
//! look-ahead. If look-ahead does not pay, it pauses; each failure doubles the pause.
//!
//! # Definitions
//! - *baseline cost*: nodes and leaves that a query without look-ahead visits, as a running mean.
//! - *trial*: a run of consecutive queries with look-ahead.
//! - *pause*: queries until look-ahead is tried again; 1, 3, 7, .. after consecutive failures.
//!
//! # Order of the calls
//! 1. [`LookAhead::choose`] at the start of a search.
//! 2. [`LookAhead::end_of_query`] when its outcome is known. The answer says whether the lower
//!    bounds of the query may stay.
//!
//! A query that its cached bounds answer makes only the second call, if it reports its cost. It
//! belongs to the trial of the queries before.

use super::outline::{MOVED_ROUNDING, PlacedOutline, ReferenceOutline};
use crate::pair::PlacedRobot;
use parry3d_f64::math::Real;

/// Links per visited node in the cost model: bounding this many links takes about as long as a
/// visit.
const LINKS_PER_NODE: usize = 4;
/// How many queries the look-ahead covers at first. Each search that meets the mesh halves the
/// number.
const QUERIES: Real = 8.0;
/// Queries of one trial.
const QUERIES_PER_TRIAL: u32 = 16;
/// After this many successful trials one query measures the baseline cost again.
const TRIALS_PER_BASELINE: u32 = 16;
/// The longest pause after a search that met the mesh.
const PAUSE_AFTER_MEETING: u32 = 63;
/// The longest pause after a trial that did not pay. A failed trial costs as much as several
/// queries.
const PAUSE_WITHOUT_PAY: u32 = 255;

/// Decides whether, and how far, a query looks ahead.
#[derive(Clone)]
pub(super) struct LookAhead {
    /// The robot at the last query, as one link from its base to its tip.
    before: Option<PlacedOutline>,
    /// How many queries the next look-ahead covers.
    queries: Real,
    /// The queries that remain of this pause.
    pause: u32,
    /// The length of the last pause since look-ahead paid.
    last_pause: u32,
    /// The baseline cost, if one was measured.
    baseline_cost: Option<u64>,
    /// The cost of this trial without its first query.
    trial_cost: u64,
    /// The number of queries of this trial.
    queries_tried: u32,
    /// The number of successful trials since the baseline cost was measured.
    trials_won: u32,
    /// Whether the last query that searched looked ahead.
    is_trial: bool,
}

/// How a query ended.
pub(super) enum Outcome {
    /// `minimum` visited these nodes and leaves for these links.
    Searched { visited: u64, links: usize, has_cached_bounds: bool },
    /// The bounds of the look-ahead before excluded too few links.
    Useless,
    /// `clears` proved the wider margin.
    Cleared,
    /// `clears` met the mesh within the wider margin.
    Met,
}

impl Default for LookAhead {
    fn default() -> Self {
        Self {
            before: None,
            queries: QUERIES,
            pause: 0,
            last_pause: 0,
            baseline_cost: None,
            trial_cost: 0,
            queries_tried: 0,
            trials_won: 0,
            is_trial: false,
        }
    }
}

impl LookAhead {
    /// Returns the extra search radius of a query about this robot. None during a pause, and if the
    /// extra radius would be `most` or more. `mesh_reach` is the largest coordinate of the mesh.
    pub(super) fn choose(
        &mut self,
        robot: PlacedRobot,
        bound: Real,
        most: Real,
        mesh_reach: Real,
    ) -> Option<Real> {
        let extra = self.next(robot, mesh_reach);
        let extra = extra.filter(|&extra| extra < most && bound + extra < Real::INFINITY);
        self.is_trial = extra.is_some();
        extra
    }

    /// Whether the last query that searched looked ahead.
    pub(super) fn is_trial(&self) -> bool {
        self.is_trial
    }

    /// Records the outcome of a query. Returns false if the next query should search without the
    /// lower bounds that are known.
    pub(super) fn end_of_query(&mut self, outcome: Outcome) -> bool {
        match outcome {
            Outcome::Searched { visited, links, .. } if self.is_trial => {
                self.record_trial_cost(visited + (links / LINKS_PER_NODE) as u64)
            }
            // This query used earlier bounds, so its cost is no baseline. Without the bounds the
            // cost of the next query is.
            Outcome::Searched { has_cached_bounds: true, .. } => false,
            Outcome::Searched { visited, .. } => {
                self.record_baseline_cost(visited);
                true
            }
            Outcome::Useless => {
                self.fail();
                false
            }
            Outcome::Cleared => {
                self.last_pause = 0;
                true
            }
            Outcome::Met => {
                self.queries = (0.5 * self.queries).max(1.0);
                self.pause_longer(PAUSE_AFTER_MEETING);
                false
            }
        }
    }

    fn next(&mut self, robot: PlacedRobot, mesh_reach: Real) -> Option<Real> {
        let now = PlacedOutline::of_whole(robot);
        let before = self.before.replace(now)?;
        if self.pause > 0 {
            self.pause -= 1;
            return None;
        }
        // Rounding alone must not use up the look-ahead.
        let rounding = MOVED_ROUNDING * (mesh_reach + 2.0 * now.extent());
        let displacement = ReferenceOutline::new(before, mesh_reach).moved_to(&now);
        Some(self.queries * displacement + 4.0 * rounding)
    }

    /// Records the cost of a query without look-ahead.
    fn record_baseline_cost(&mut self, cost: u64) {
        self.baseline_cost =
            Some(self.baseline_cost.map_or(cost, |before| (3 * before + cost) / 4));
    }

    /// Records the cost of a query with look-ahead. Returns false if the next query should search
    /// without look-ahead and without the cached bounds.
    ///
    /// `queries_tried` counts the queries of this trial, this one included. The first of them fills
    /// the bounds for the others, so its cost does not count; after a successful trial this is the
    /// last query of that trial. The trial fails once the other `queries_tried - 1` queries
    /// together cost more than `queries_tried` queries at the baseline cost.
    fn record_trial_cost(&mut self, cost: u64) -> bool {
        if self.queries_tried > 0 {
            self.trial_cost += cost;
        }
        self.queries_tried += 1;
        let affordable = |baseline: u64| baseline * u64::from(self.queries_tried);
        if self.baseline_cost.is_some_and(|baseline| self.trial_cost > affordable(baseline)) {
            self.fail();
            return false;
        }
        if self.queries_tried > QUERIES_PER_TRIAL {
            self.last_pause = 0;
            (self.trial_cost, self.queries_tried) = (0, 1);
            self.trials_won += 1;
        }
        if self.trials_won == TRIALS_PER_BASELINE {
            (self.pause, self.queries_tried, self.trials_won) = (1, 0, 0);
            return false;
        }
        true
    }

    /// Ends a trial that did not pay.
    fn fail(&mut self) {
        (self.trial_cost, self.queries_tried, self.trials_won) = (0, 0, 0);
        self.pause_longer(PAUSE_WITHOUT_PAY);
    }

    fn pause_longer(&mut self, longest: u32) {
        self.last_pause = (2 * self.last_pause + 1).min(longest);
        self.pause = self.last_pause;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Counts the queries with look-ahead, out of `queries`. The first of a run costs `first`, each
    /// other one `later`, and one without look-ahead 100.
    fn queries_that_look_ahead(queries: u32, first: u64, later: u64) -> u32 {
        let (mut look_ahead, mut is_first, mut count) = (LookAhead::default(), true, 0);
        look_ahead.record_baseline_cost(100);
        for _ in 0..queries {
            if look_ahead.pause > 0 {
                look_ahead.pause -= 1;
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

    /// A trial that does not pay pauses longer each time. One that pays ends the pauses.
    #[test]
    fn failures_pause_longer() {
        let mut look_ahead = LookAhead::default();
        for pause in [1, 3, 7, 15] {
            assert!(!look_ahead.end_of_query(Outcome::Useless));
            assert_eq!(look_ahead.pause, pause);
        }
        assert!(look_ahead.end_of_query(Outcome::Cleared));
        assert!(!look_ahead.end_of_query(Outcome::Met));
        assert_eq!((look_ahead.pause, look_ahead.queries), (1, 0.5 * QUERIES));
        // Without a trial, cached bounds make a query's cost no baseline.
        for (has_cached_bounds, expected) in [(true, None), (false, Some(5))] {
            let outcome = Outcome::Searched { visited: 5, links: 8, has_cached_bounds };
            assert_eq!(look_ahead.end_of_query(outcome), !has_cached_bounds);
            assert_eq!(look_ahead.baseline_cost, expected);
        }
        // In a trial it is compared with the baseline.
        look_ahead.is_trial = true;
        for (visited, stays) in [(99, true), (5, true), (9, false)] {
            let outcome = Outcome::Searched { visited, links: 8, has_cached_bounds: true };
            assert_eq!(look_ahead.end_of_query(outcome), stays, "{visited}");
        }
    }
}
