//! How much farther than asked a search is to look, so that its answer speaks for the next queries
//! too.
//!
//! A search for a little more costs little more. How much more pays follows from how far the robot
//! moves from one query to the next. Where it does not pay, queries search for what they are asked
//! alone, and a wider search is tried later, ever more rarely. Whether it pays is seen from what
//! queries with it and one without it have cost.

use super::placed_outline::{PlacedOutline, ROUNDING, ReferenceOutline};
use crate::pair::PlacedRobot;
use parry3d_f64::math::Real;

/// How many queries a wider search is to speak for at the most.
const QUERIES: Real = 8.0;
/// So many queries with a wider search are a trial, and after so many trials that paid it is found
/// out again what one without it costs.
const TRIAL: u32 = 16;
const TRIALS: u32 = 16;
/// A search that met something is tried again after so many queries at the latest, one that did not
/// pay after so many: it takes as long as several others.
const REST_AFTER_MEETING: u32 = 63;
const REST_WITHOUT_PAY: u32 = 255;

#[derive(Clone)]
pub(crate) struct LookAhead {
    /// The robot of the last query, as one link from its base to its tip.
    before: Option<PlacedOutline>,
    /// How many queries the next wider search is to speak for.
    queries: Real,
    /// How many queries are not to try one, and how many it was after the last that did not pay.
    rest: u32,
    last_rest: u32,
    /// What a query without a wider search has cost of late.
    plain_cost: Option<u64>,
    /// What the queries of this trial have cost after its first, how many they are with it, and
    /// how many trials have paid.
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
    /// By how much a query about this robot is to widen its search. `reach` is the largest
    /// coordinate of the mesh. None where it is better not to.
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

    /// Notes what a query without a wider search has cost.
    pub(crate) fn record_plain_cost(&mut self, cost: u64) {
        self.plain_cost = Some(self.plain_cost.map_or(cost, |before| (3 * before + cost) / 4));
    }

    /// Notes what a query with a wider search has cost. False if the next one is better off without
    /// it, and without what it has found.
    ///
    /// The first of a row pays for the others. These must not cost more than as many queries
    /// without it, and one.
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

    /// Notes that the last wider search paid.
    pub(crate) fn record_success(&mut self) {
        self.last_rest = 0;
    }

    /// Notes that wider searches do not pay.
    pub(crate) fn record_failure(&mut self) {
        (self.trial_cost, self.tried, self.trials) = (0, 0, 0);
        self.extend_rest(REST_WITHOUT_PAY);
    }

    /// Notes that the last wider search met what a search less wide may not meet.
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

    /// How many of so many queries go with a wider search, if the first of a row costs `first` and
    /// another `later` where one without costs 100.
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
        // All but the few that tell what one without them costs.
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
