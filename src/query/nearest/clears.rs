//! Decides whether a robot keeps a margin.
//!
//! # Algorithm
//! 1. **Reuse.** If every lower bound of the last query, less the displacement since, exceeds the
//!    margin: true.
//! 2. **Look ahead.** If it pays, search with `margin + look_ahead`. A robot that clears that
//!    radius yields lower bounds for later queries.
//! 3. **Search** with the margin itself. The first pair is the link that probably passes through
//!    the wall, if the side grid finds one.
//!
//! Each search runs in single precision, or in double precision if single does not resolve the
//! robot, or else link by link. The answer is the same.

use super::cleared_by::ClearedBy;
use super::dual_traversal::{DualTraversal, PairStack};
use super::memory::LinkLowerBounds;
use super::side_grid::SideGrid;
use crate::pair::{Best, PlacedRobot};
use crate::search::hierarchy::{MeshSearch, Scratch};
use parry3d_f64::math::Real;

/// State that warm-starts the next query.
#[derive(Clone, Default)]
pub(crate) struct ClearsMemory {
    single: PairStack<f32>,
    double: PairStack<f64>,
    lower_bounds: LinkLowerBounds,
}

impl ClearsMemory {
    pub(crate) fn forget(&mut self) {
        self.single.forget();
        self.double.forget();
        self.forget_distances();
    }

    /// Forgets the lower bounds, which hold only while the mesh is at rest.
    pub(crate) fn forget_distances(&mut self) {
        self.lower_bounds.forget();
    }
}

/// A search for any triangle at most a margin from a robot.
pub(crate) struct ClearsSearch<'a> {
    pub search: MeshSearch<'a>,
    /// Predicts which link passes through the wall, so that this link is searched first.
    pub sides: Option<&'a SideGrid>,
    pub robot: PlacedRobot<'a>,
    pub memory: &'a mut ClearsMemory,
}

impl ClearsSearch<'_> {
    /// Returns true if every link is farther than `margin` from the mesh.
    pub(crate) fn clears(&mut self, margin: Real) -> bool {
        let (robot, reach) = (self.robot, self.search.hierarchy.reach);
        if self.memory.lower_bounds.all_exceed(robot, margin) {
            return true;
        }
        if let Some(wider) =
            self.memory.lower_bounds.look_ahead(robot, margin, Real::INFINITY, reach)
        {
            if let Some(known) = self.cleared_by(margin + wider) {
                self.memory.lower_bounds.set_all(robot, margin + wider, known, reach);
                return true;
            }
            self.memory.lower_bounds.record_miss();
        }
        self.cleared_by(margin).is_some()
    }

    /// Returns which part of the robot is proven farther than `margin` from the mesh. None if some
    /// link is not.
    pub(crate) fn cleared_by(&mut self, margin: Real) -> Option<ClearedBy> {
        let robot = self.robot;
        let MeshSearch { level, hierarchy, scratch, .. } = &mut self.search;
        let (level, mesh) = (*level, &hierarchy.mesh);
        let Scratch { work, .. } = &mut **scratch;
        let ClearsMemory { single, double, .. } = &mut *self.memory;
        let first = self.sides.and_then(|sides| sides.likely_crossing(robot));
        let search = DualTraversal {
            level,
            tree: hierarchy.single(),
            robot,
            margin,
            first,
            pairs: single,
            work,
        };
        let mut answer = search.clears_all(mesh);
        let mut is_capsule_clear = single.clears_capsule();
        if answer.is_none() {
            let tree = hierarchy.double(level);
            let search = DualTraversal { level, tree, robot, margin, first, pairs: double, work };
            answer = search.clears_all(mesh);
            is_capsule_clear = double.clears_capsule();
        }
        if let Some(keeps_away) = answer {
            let known = if is_capsule_clear { ClearedBy::Capsule } else { ClearedBy::Links };
            return keeps_away.then_some(known);
        }
        let mut is_away =
            |link| self.search.nearest(&link, Best::within(margin), [None; 2]).nearest().is_none();
        robot.placed_links().all(&mut is_away).then_some(ClearedBy::Links)
    }
}
