//! Whether a robot keeps a margin.
//!
//! What the last query proved may still hold for a robot that has moved a little. If not, a search
//! for a little more than the margin helps the next queries too, where robots move little. A robot
//! that is new is asked about first where it seems to pass through the wall.

use super::cleared_by::ClearedBy;
use super::dual_traversal::{DualTraversal, PairStack};
use super::memory::LinkLowerBounds;
use super::side_grid::SideGrid;
use crate::pair::{Best, PlacedRobot};
use crate::search::hierarchy::{MeshSearch, Scratch};
use parry3d_f64::math::Real;

/// What a query about a margin leaves for the next.
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

    /// Forgets what only holds as long as the mesh is still.
    pub(crate) fn forget_distances(&mut self) {
        self.lower_bounds.forget();
    }
}

/// A search for anything at most a margin from a robot.
pub(crate) struct ClearsSearch<'a> {
    pub search: MeshSearch<'a>,
    /// They tell where to look first for a robot that passes through the wall.
    pub sides: Option<&'a SideGrid>,
    pub robot: PlacedRobot<'a>,
    pub memory: &'a mut ClearsMemory,
}

impl ClearsSearch<'_> {
    /// Whether every link keeps more than the margin away.
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

    /// What of the robot is known to keep more than `margin` away. None where some link does not.
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
