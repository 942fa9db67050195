//! Proximity by a bounding volume hierarchy.

use super::coarse::CoarseLink;
use super::descent::{Descent, Stack, Visits};
use super::probe::{Probe, check_vertices, place};
use super::search::Found;
use super::tree::Tree;
use super::{LinkProximity, MeshError, Proximity, ProximityError};
use crate::Chain;
use crate::distance::lanes::Lane;
use fearless_simd::{Level, dispatch};
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::shape::TriMesh;

/// Proximity queries by a bounding volume hierarchy: the work per link grows with the logarithm of the number of
/// triangles.
///
/// The engine keeps the mesh and a hierarchy of its own, 16 boxes and 16 triangles wide, in single precision;
/// what rounding leaves in question is measured in double precision, so the answers are those of
/// [`Exhaustive`](super::Exhaustive). It remembers the last answers, which bound the next query: any robot and
/// pose may follow, and small motions are answered fastest. [`BvhSearch::forget`] makes it cold again.
pub struct BvhSearch {
    level: Level,
    vertices: Vec<Vector>,
    indices: Vec<[u32; 3]>,
    /// The largest coordinate of the mesh.
    reach: Real,
    tree: Tree,
    visits: Visits,
    /// The closest triangle of each link at the last query, where there was one.
    last: Vec<u32>,
    probes: Vec<Probe>,
    stack: Stack,
}

impl BvhSearch {
    /// An engine for `mesh`, whose vertices and triangles are copied.
    ///
    /// # Errors
    /// The mesh has no triangles, or a vertex is not finite or out of range.
    pub fn new(mesh: &TriMesh) -> Result<Self, MeshError> {
        if mesh.indices().is_empty() {
            return Err(MeshError::Empty);
        }
        let reach = check_vertices(mesh.vertices())?;
        Ok(Self {
            level: Level::new(),
            vertices: mesh.vertices().to_vec(),
            indices: mesh.indices().to_vec(),
            reach,
            tree: Tree::new(mesh.vertices(), mesh.indices()),
            visits: Visits::default(),
            last: Vec::new(),
            probes: Vec::new(),
            stack: Vec::new(),
        })
    }

    /// Forgets the last answers, so that the next query starts without bounds.
    pub fn forget(&mut self) {
        self.last.clear();
    }

    /// How much was computed since the engine was built.
    pub fn visits(&self) -> Visits {
        self.visits
    }

    /// The triangle nearest to the probe of a link among those strictly nearer than `bound` (or, if it is to
    /// `stop_at_first`, any of those).
    fn nearest(
        &mut self,
        link: usize,
        bound: Real,
        stop_at_first: bool,
        start: [Option<u32>; 2],
    ) -> Option<Found> {
        let probe = &self.probes[link];
        let Some(link) = CoarseLink::new(probe, &self.tree.frame) else {
            return self.nearest_of_all(probe, bound);
        };
        let mut descent = Descent {
            tree: &self.tree,
            vertices: &self.vertices,
            indices: &self.indices,
            probe,
            link: &link,
            bound,
            stop_at_first,
            found: None,
            visits: self.visits,
        };
        dispatch!(self.level, simd => descent.run::<<f32 as Lane>::Pack<_>>(simd, &mut self.stack, start));
        self.visits = descent.visits;
        descent.found
    }

    /// Looks at every triangle: for a link that lies too far out for single precision.
    fn nearest_of_all(&self, probe: &Probe, mut bound: Real) -> Option<Found> {
        let mut found = None;
        for (triangle, corners) in (0..).zip(&self.indices) {
            let vertices = corners.map(|index| self.vertices[index as usize]);
            if let Some(closest) = probe.nearer_than(bound, vertices) {
                bound = closest.distance;
                found = Some(Found { triangle, closest });
            }
        }
        found
    }
}

impl Proximity for BvhSearch {
    fn per_link(
        &mut self,
        robot: &Chain,
        pose: &Pose,
        out: &mut Vec<LinkProximity>,
    ) -> Result<(), ProximityError> {
        out.clear();
        place(robot.links(), pose, self.reach, &mut self.probes)?;
        for link in 0..self.probes.len() {
            let before = out.last().map(|answer: &LinkProximity| answer.triangle);
            let start = [self.last.get(link).copied(), before];
            // Without a bound some triangle is always the nearest.
            if let Some(found) = self.nearest(link, Real::INFINITY, false, start) {
                out.push(self.probes[link].report(link, &found));
            }
        }
        self.last.clear();
        self.last.extend(out.iter().map(|answer| answer.triangle));
        Ok(())
    }

    fn minimum(&mut self, robot: &Chain, pose: &Pose) -> Result<LinkProximity, ProximityError> {
        place(robot.links(), pose, self.reach, &mut self.probes)?;
        let corners = self.indices[0].map(|index| self.vertices[index as usize]);
        let mut best = (0, Found { triangle: 0, closest: self.probes[0].closest(corners) });
        for link in 0..self.probes.len() {
            let start = [self.last.get(link).copied(), None];
            if let Some(found) = self.nearest(link, best.1.closest.distance, false, start) {
                best = (link, found);
            }
        }
        Ok(self.probes[best.0].report(best.0, &best.1))
    }

    fn clears(&mut self, robot: &Chain, pose: &Pose, margin: Real) -> Result<bool, ProximityError> {
        if margin.is_nan() || margin < 0.0 {
            return Err(ProximityError::BadMargin { margin });
        }
        place(robot.links(), pose, self.reach, &mut self.probes)?;
        Ok((0..self.probes.len()).all(|link| {
            // The next number, because the search wants triangles strictly nearer than its bound.
            let bound = self.probes[link].scaled(margin).next_up();
            self.nearest(link, bound, true, [None; 2]).is_none()
        }))
    }

    fn set_vertices(&mut self, vertices: &[Vector]) -> Result<(), MeshError> {
        let expected = self.vertices.len();
        if vertices.len() != expected {
            return Err(MeshError::VertexCount { expected, got: vertices.len() });
        }
        self.reach = check_vertices(vertices)?;
        self.vertices.copy_from_slice(vertices);
        self.tree.refit(vertices, &self.indices);
        Ok(())
    }
}
