//! Lower bounds on the distances of the links after the robot has moved, without a search.
//!
//! # Definitions
//! - `d`: a lower bound on the distance of a link from the mesh, at an earlier query.
//! - `m`: an upper bound on the distance of any point of the link now from the link then
//!   ([`ReferenceOutline::moved_to`]).
//! - `mesh_reach`: the largest coordinate of the mesh.
//! - `extent`: the largest coordinate of a link.
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
//! **Rounding.** With c = [`MOVED_ROUNDING`], `c (mesh_reach + 2 extent)` is subtracted from `d`,
//! and `m` is multiplied by `1 + c`. The link then reaches at most `extent`, and the link now
//! `extent + m`: the sum is `2 extent + m`, and the factor `1 + c` covers the share of m.
//!
//! [`LookAhead`] decides how much farther than its bound a query searches, so that later queries
//! can reuse its lower bounds.

use super::look_ahead::{LookAhead, Outcome};
use super::outline::{MOVED_ROUNDING, PlacedOutline, ReferenceOutline};
use crate::pair::PlacedRobot;
use parry3d_f64::math::Real;
use std::mem::take;
use std::ops::Range;

/// Cached bounds must skip at least one link in four; otherwise they are cleared.
const MIN_SKIPPED_SHARE: usize = 4;

/// Lower bounds on the distances of the links of a robot.
#[derive(Clone, Default)]
pub(crate) struct LinkLowerBounds {
    /// The bound of each link at its reference placement, in the order of the links; empty if
    /// unknown.
    links: Vec<LinkLowerBound>,
    /// The bound of the capsule around all links, if `clears` proved one.
    capsule: Option<LinkLowerBound>,
    /// The bound of each link of the current robot, set by `refresh`; empty if unknown.
    now: Vec<Real>,
    look_ahead: LookAhead,
}

/// A link at its reference placement, and a lower bound on its distance, rounding subtracted.
#[derive(Clone, Copy)]
struct LinkLowerBound {
    outline: ReferenceOutline,
    at_least: Real,
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
        PlacedOutline::of_all(robot).all(|(link, outline)| self.links[link].at(&outline) > margin)
    }

    /// Computes the bound of each link at its current placement.
    pub(crate) fn refresh(&mut self, robot: PlacedRobot) {
        self.now.clear();
        if self.links.len() == robot.links().len() {
            self.now.resize(self.links.len(), 0.0);
            for (link, outline) in PlacedOutline::of_all(robot) {
                self.now[link] = self.links[link].at(&outline);
            }
        }
    }

    /// Counts the links whose bound, as computed by `refresh`, does not exceed `bound`.
    pub(crate) fn count_open(&self, links: Range<usize>, bound: Real) -> usize {
        let count = links.len();
        let lower = self.now.get(links).unwrap_or_default();
        count - lower.iter().filter(|&&lower| lower > bound).count()
    }

    /// Returns the extra search radius for this query, or none if looking ahead does not pay.
    ///
    /// None as well if the extra radius would be `most` or more. `mesh_reach` is the largest
    /// coordinate of the mesh.
    pub(crate) fn choose_look_ahead(
        &mut self,
        robot: PlacedRobot,
        bound: Real,
        most: Real,
        mesh_reach: Real,
    ) -> Option<Real> {
        self.look_ahead.choose(robot, bound, most, mesh_reach)
    }

    /// Clears the cached bounds if they exclude fewer than 1/4 of the `count` links, and counts a
    /// failure of the look-ahead. Only if the query before looked ahead: other bounds are no
    /// evidence about it.
    pub(crate) fn drop_if_useless(&mut self, count: usize, bound: Real) {
        if self.look_ahead.is_trial()
            && MIN_SKIPPED_SHARE * self.count_open(0..count, bound)
                > (MIN_SKIPPED_SHARE - 1) * count
        {
            self.end_of_query(Outcome::Useless);
        }
    }

    /// Records how many nodes and leaves this query visited for `links` links.
    pub(crate) fn record_cost(&mut self, visited: u64, links: usize) {
        let has_cached_bounds = !self.now.is_empty();
        self.end_of_query(Outcome::Searched { visited, links, has_cached_bounds });
    }

    fn end_of_query(&mut self, outcome: Outcome) {
        if !self.look_ahead.end_of_query(outcome) {
            self.links.clear();
        }
    }

    /// Returns a triangle at about the distance of the link, if one was met.
    pub(crate) fn recorded_triangle(&self, link: usize) -> Option<u32> {
        self.links.get(link)?.triangle
    }

    /// Sets the lower bound of `links` to `at_least`, at their current placement.
    pub(crate) fn set(
        &mut self,
        robot: PlacedRobot,
        links: Range<usize>,
        at_least: Real,
        triangle: Option<u32>,
        mesh_reach: Real,
    ) {
        self.size_for(robot, mesh_reach);
        for link in links {
            let outline = PlacedOutline::of(robot, link);
            let triangle = triangle.or(self.links[link].triangle);
            self.links[link] = LinkLowerBound::new(outline, at_least, triangle, mesh_reach);
        }
    }

    /// Sets the lower bound of all links, or of the capsule around them, to `at_least`.
    pub(crate) fn set_all(
        &mut self,
        robot: PlacedRobot,
        at_least: Real,
        known: ClearedBy,
        mesh_reach: Real,
    ) {
        self.links.clear();
        self.capsule = None;
        let bound = |outline| LinkLowerBound::new(outline, at_least, None, mesh_reach);
        match known {
            ClearedBy::Capsule => self.capsule = Some(bound(PlacedOutline::around_all(robot))),
            ClearedBy::Links => {
                self.size_for(robot, mesh_reach);
                for (link, outline) in PlacedOutline::of_all(robot) {
                    self.links[link] = bound(outline);
                }
            }
        }
        self.end_of_query(Outcome::Cleared);
    }

    /// Makes all bounds unknown if the number of links differs.
    fn size_for(&mut self, robot: PlacedRobot, mesh_reach: Real) {
        let count = robot.links().len();
        if self.links.len() != count {
            let outline = PlacedOutline::of(robot, 0);
            let unknown = LinkLowerBound::new(outline, Real::NEG_INFINITY, None, mesh_reach);
            self.links.clear();
            self.links.resize(count, unknown);
        }
    }

    /// Records that a search with look-ahead met the mesh, and clears the bounds.
    pub(crate) fn record_miss(&mut self) {
        self.capsule = None;
        self.end_of_query(Outcome::Met);
    }
}

impl LinkLowerBound {
    /// `2 extent` is for the link then and later (see the module).
    fn new(
        outline: PlacedOutline,
        at_least: Real,
        triangle: Option<u32>,
        mesh_reach: Real,
    ) -> Self {
        let at_least = at_least - MOVED_ROUNDING * (mesh_reach + 2.0 * outline.extent());
        Self { outline: ReferenceOutline::new(outline, mesh_reach), at_least, triangle }
    }

    /// Returns a lower bound on the distance of the link at its placement `now`. NaN if its caps
    /// differ.
    #[inline(always)] // in the loop over all links
    fn at(&self, now: &PlacedOutline) -> Real {
        self.at_least - (1.0 + MOVED_ROUNDING) * self.outline.moved_to(now)
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

    /// Forgotten bounds answer no later query, and a pause of the look-ahead ends.
    #[test]
    fn forgotten_bounds_are_unknown() {
        let points = [Vector::ZERO, Vector::X, Vector::X * 2.0];
        let robot = Chain::capsules(&points, &[0.1; 2]).unwrap();
        let robot = PlacedRobot::new(&robot, &Pose::IDENTITY).unwrap();
        let mut bounds = LinkLowerBounds::default();
        bounds.end_of_query(Outcome::Useless);
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
        assert_eq!(bounds.recorded_triangle(0), None);
        // No pause is left, so the second query looks ahead.
        let mut choose = || bounds.choose_look_ahead(robot, 1.0, Real::INFINITY, 1.0);
        assert!(choose().is_none() && choose().is_some());
    }
}
