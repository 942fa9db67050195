//! How much farther than its bound a query searches, so that later queries can reuse its lower
//! bounds.
//!
//! A slightly wider search costs slightly more. The width follows from the robot's displacement
//! since the last query. The controller compares the measured cost of queries with and without
//! look-ahead. If look-ahead does not pay, it pauses; each failure doubles the pause.
//!
//! # Definitions
//! - *baseline cost*: nodes and leaves that a query without look-ahead visits, as a running mean.
//! - *trial*: a run of consecutive queries with look-ahead.
//! - *rest*: queries until look-ahead is tried again; 1, 3, 7, .. after consecutive failures.

use super::placed_outline::{PlacedOutline, ROUNDING, ReferenceOutline};
use crate::pair::PlacedRobot;
use parry3d_f64::math::Real;

/// How many queries the look-ahead covers at first. Each search that meets the mesh halves the
/// number.
const QUERIES: Real = 8.0;
/// Queries of one trial. After `TRIALS` successful trials, one query re-measures the baseline cost.
const TRIAL: u32 = 16;
const TRIALS: u32 = 16;
/// The longest rest after a search that met the mesh, and after one that did not pay. The second is
/// longer, because a failed trial costs as much as several queries.
const REST_AFTER_MEETING: u32 = 63;
const REST_WITHOUT_PAY: u32 = 255;

/// Decides whether, and how far, a query looks ahead.
#[derive(Clone)]
pub(crate) struct LookAhead {
    /// The robot at the last query, as one link from its base to its tip.
    before: Option<PlacedOutline>,
    /// How many queries the next look-ahead covers.
    queries: Real,
    /// Queries left of this rest, and the length of the last rest since look-ahead paid.
    rest: u32,
    last_rest: u32,
    /// The baseline cost, if one was measured.
    plain_cost: Option<u64>,
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
            plain_cost: None,
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
        let rounding = ROUNDING * (reach + 2.0 * now.extent());
        Some(self.queries * ReferenceOutline::new(before, reach).moved_to(&now) + 4.0 * rounding)
    }

    /// Records the cost of a query without look-ahead.
    pub(crate) fn record_plain_cost(&mut self, cost: u64) {
        self.plain_cost = Some(self.plain_cost.map_or(cost, |before| (3 * before + cost) / 4));
    }

    /// Records the cost of a query with look-ahead. Returns false if the next query should search
    /// without look-ahead and without the cached bounds.
    ///
    /// The first query of a trial fills the bounds for the others, so its cost does not count. The
    /// trial fails once its n - 1 later queries cost more than n queries at the baseline cost.
    pub(crate) fn record_wide_cost(&mut self, cost: u64) -> bool {
        if self.tried > 0 {
            self.trial_cost += cost;
        }
        self.tried += 1;
        if self.plain_cost.is_some_and(|plain| self.trial_cost > plain * u64::from(self.tried)) {
            self.record_failure();
            return false;
        }
        if self.tried > TRIAL {
            self.record_success();
            (self.trial_cost, self.tried, self.trials) = (0, 1, self.trials + 1);
        }
        if self.trials == TRIALS {
            (self.rest, self.tried, self.trials) = (1, 0, 0);
            return false;
        }
        true
    }

    /// Records that the last look-ahead paid.
    pub(crate) fn record_success(&mut self) {
        self.last_rest = 0;
    }

    /// Records that look-ahead does not pay.
    pub(crate) fn record_failure(&mut self) {
        (self.trial_cost, self.tried, self.trials) = (0, 0, 0);
        self.extend_rest(REST_WITHOUT_PAY);
    }

    /// Records that a search met the mesh within its look-ahead: halves the look-ahead and rests.
    pub(crate) fn shrink(&mut self) {
        self.queries = (0.5 * self.queries).max(1.0);
        self.extend_rest(REST_AFTER_MEETING);
    }

    fn extend_rest(&mut self, longest: u32) {
        self.last_rest = (2 * self.last_rest + 1).min(longest);
        self.rest = self.last_rest;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Counts the queries with look-ahead, out of `queries`. The first of a run costs `first`, each
    /// other one `later`, and one without look-ahead 100.
    fn wider_of(queries: u32, first: u64, later: u64) -> u32 {
        let (mut widening, mut is_first, mut wider) = (LookAhead::default(), true, 0);
        widening.record_plain_cost(100);
        for _ in 0..queries {
            if widening.rest > 0 {
                widening.rest -= 1;
                widening.record_plain_cost(100);
                is_first = true;
            } else {
                wider += 1;
                widening.record_wide_cost(if is_first { first } else { later });
                is_first = false;
            }
        }
        wider
    }

    #[test]
    fn wider_searches_are_made_where_they_cost_less() {
        // All except the few that re-measure the baseline cost.
        for later in [0, 20, 90] {
            let wider = wider_of(10_000, 400, later);
            assert!((9_900..10_000).contains(&wider), "{wider} where another costs {later}");
        }
        // Hardly any: one trial in 256 queries.
        for (later, most) in [(500, 2), (200, 3), (130, 6)] {
            let wider = wider_of(25_600, 400, later);
            assert!((100..110 * most).contains(&wider), "{wider} where another costs {later}");
        }
    }
}
