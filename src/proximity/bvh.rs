//! Proximity by the mesh's bounding volume hierarchy.

use super::probe::{Probe, check_vertices, place};
use super::search::{Found, Until, search};
use super::{LinkProximity, MeshError, Proximity, ProximityError};
use crate::Chain;
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::shape::TriMesh;

/// Proximity queries by the mesh's bounding volume hierarchy: the work per link grows with the logarithm of
/// the number of triangles.
///
/// The engine keeps a copy of the mesh, and remembers the last answers: they bound the next query. Any robot
/// and pose may follow; small motions are answered fastest. [`BvhSearch::forget`] makes it cold again.
pub struct BvhSearch {
    mesh: TriMesh,
    /// The largest coordinate of the mesh.
    reach: Real,
    /// The closest triangle of each link at the last query, where there was one.
    last: Vec<u32>,
    probes: Vec<Probe>,
}

impl BvhSearch {
    /// An engine for `mesh`, whose vertices and hierarchy are copied.
    ///
    /// # Errors
    /// The mesh has no triangles, or a vertex is not finite or out of range.
    pub fn new(mesh: &TriMesh) -> Result<Self, MeshError> {
        if mesh.indices().is_empty() {
            return Err(MeshError::Empty);
        }
        let reach = check_vertices(mesh.vertices())?;
        Ok(Self { mesh: mesh.clone(), reach, last: Vec::new(), probes: Vec::new() })
    }

    /// Forgets the last answers, so that the next query starts without bounds.
    pub fn forget(&mut self) {
        self.last.clear();
    }

    /// The probe's answer, found with the best start that the last query and the link before offer.
    fn nearest(&self, probe: &Probe, seeds: [Option<u32>; 2]) -> Found {
        let mut best = self.measure(probe, seeds[0].or(seeds[1]).unwrap_or(0));
        if let Some(second) = seeds[1].filter(|&second| second != best.triangle) {
            let other = self.measure(probe, second);
            if other.closest.distance < best.closest.distance {
                best = other;
            }
        }
        match search(&self.mesh, probe, best.closest.distance, Until::Nearest) {
            Ok(Some(found)) => found,
            // Nothing is nearer than the start (every vertex was seen to be finite).
            Ok(None) | Err(_) => best,
        }
    }

    /// One triangle, whatever its distance.
    fn measure(&self, probe: &Probe, triangle: u32) -> Found {
        let vertices = self.mesh.triangle(triangle).vertices().to_owned();
        Found { triangle, closest: probe.closest(vertices) }
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
        let mut before = None;
        for (link, probe) in self.probes.iter().enumerate() {
            let found = self.nearest(probe, [before, self.last.get(link).copied()]);
            before = Some(found.triangle);
            out.push(probe.report(link, &found));
        }
        self.last.clear();
        self.last.extend(out.iter().map(|answer| answer.triangle));
        Ok(())
    }

    fn minimum(&mut self, robot: &Chain, pose: &Pose) -> Result<LinkProximity, ProximityError> {
        place(robot.links(), pose, self.reach, &mut self.probes)?;
        let start = self.last.first().copied().unwrap_or(0);
        let (mut link, mut found) = (0, self.measure(&self.probes[0], start));
        // The nearest of the last answers gives the bound that all links share.
        for (other, (probe, &triangle)) in self.probes.iter().zip(&self.last).enumerate().skip(1) {
            let again = self.measure(probe, triangle);
            if again.closest.distance < found.closest.distance {
                (link, found) = (other, again);
            }
        }
        for (other, probe) in self.probes.iter().enumerate() {
            if let Ok(Some(nearer)) = search(&self.mesh, probe, found.closest.distance, Until::Nearest) {
                (link, found) = (other, nearer);
            }
        }
        if let Some(last) = self.last.get_mut(link) {
            *last = found.triangle;
        }
        Ok(self.probes[link].report(link, &found))
    }

    fn clears(&mut self, robot: &Chain, pose: &Pose, margin: Real) -> Result<bool, ProximityError> {
        if margin.is_nan() || margin < 0.0 {
            return Err(ProximityError::BadMargin { margin });
        }
        place(robot.links(), pose, self.reach, &mut self.probes)?;
        Ok(self.probes.iter().all(|probe| {
            // The next number, because the search wants triangles strictly nearer than its bound.
            let bound = probe.scaled(margin).next_up();
            matches!(search(&self.mesh, probe, bound, Until::FirstWithinBound), Ok(None))
        }))
    }

    fn set_vertices(&mut self, vertices: &[Vector]) -> Result<(), MeshError> {
        let expected = self.mesh.vertices().len();
        if vertices.len() != expected {
            return Err(MeshError::VertexCount { expected, got: vertices.len() });
        }
        self.reach = check_vertices(vertices)?;
        self.mesh.set_vertices(vertices);
        Ok(())
    }
}
