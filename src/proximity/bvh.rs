//! Proximity by a bounding volume hierarchy.

use super::descent::{Descent, Scratch, SearchMesh, Visits};
use super::placed::Placed;
use super::probe::Found;
use super::probe::{Probe, check_margin, check_moved, check_vertices};
use super::walk::Walk;
use super::{LinkProximity, MeshError, Proximity, ProximityError};
use crate::Chain;
use fearless_simd::{Level, dispatch};
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::shape::TriMesh;
#[cfg(feature = "parallel")]
use rayon::prelude::*;

/// Proximity queries by a bounding volume hierarchy: the work per link grows with the logarithm of the number of
/// triangles.
///
/// The engine keeps the mesh and a hierarchy of its own, 16 patches and 16 triangles wide, in single precision;
/// what rounding leaves in question is measured in double precision, so the answers are those of
/// [`Exhaustive`](super::Exhaustive). It remembers the last answers, which bound the next query: any robot and
/// pose may follow, and small motions are answered fastest. [`BvhSearch::forget`] makes it cold again.
pub struct BvhSearch {
    level: Level,
    /// The largest coordinate of the mesh.
    reach: Real,
    mesh: SearchMesh,
    memory: Memory,
    /// One for each thread that works on a batch.
    batch: Vec<Memory>,
}

/// What one query leaves for the next.
#[derive(Default)]
pub(super) struct Memory {
    pub scratch: Scratch,
    /// The closest triangle of each link at the last query, where there was one.
    pub last: Vec<u32>,
    /// The closest link and its triangle at the last query for the minimum.
    pub last_minimum: Option<(usize, u32)>,
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
        let level = Level::new();
        let mesh = SearchMesh::new(level, mesh.vertices(), mesh.indices());
        Ok(Self { level, reach, mesh, memory: Memory::default(), batch: Vec::new() })
    }

    /// Forgets the last answers, so that the next query starts without bounds.
    pub fn forget(&mut self) {
        self.memory.last.clear();
        self.memory.last_minimum = None;
    }

    /// How much was computed since the engine was built, batches left out.
    pub fn visits(&self) -> Visits {
        self.memory.scratch.visits
    }
}

/// The closest triangle of every link.
fn per_link(
    level: Level,
    mesh: &SearchMesh,
    placed: &Placed,
    memory: &mut Memory,
    out: &mut Vec<LinkProximity>,
) {
    let Memory { scratch, last, .. } = memory;
    let mut walk = Walk { descent: Descent { mesh, scratch }, placed };
    dispatch!(level, simd => walk.per_link(simd, last, out));
    last.clear();
    last.extend(out.iter().map(|answer| answer.triangle));
}

impl Proximity for BvhSearch {
    fn per_link(
        &mut self,
        robot: &Chain,
        pose: &Pose,
        out: &mut Vec<LinkProximity>,
    ) -> Result<(), ProximityError> {
        out.clear();
        let placed = Placed::new(robot, pose, self.reach)?;
        per_link(self.level, &self.mesh, &placed, &mut self.memory, out);
        Ok(())
    }

    fn minimum(&mut self, robot: &Chain, pose: &Pose) -> Result<LinkProximity, ProximityError> {
        let placed = Placed::new(robot, pose, self.reach)?;
        let Memory { scratch, last_minimum, .. } = &mut self.memory;
        let mut walk = Walk { descent: Descent { mesh: &self.mesh, scratch }, placed: &placed };
        let found = dispatch!(self.level, simd => walk.minimum(simd, *last_minimum));
        let (link, probe, found) = found.unwrap_or_else(|| {
            // Without a bound some triangle is always the nearest; this is any other.
            let probe: Probe = placed.probe(0);
            (0, probe, Found { triangle: 0, closest: probe.closest(self.mesh.corners(0)) })
        });
        *last_minimum = Some((link, found.triangle));
        Ok(probe.report(link, &found))
    }

    fn clears(&mut self, robot: &Chain, pose: &Pose, margin: Real) -> Result<bool, ProximityError> {
        check_margin(margin)?;
        let placed = Placed::new(robot, pose, self.reach)?;
        let descent = Descent { mesh: &self.mesh, scratch: &mut self.memory.scratch };
        let mut walk = Walk { descent, placed: &placed };
        Ok(dispatch!(self.level, simd => walk.clears(simd, margin)))
    }

    fn per_link_batch(
        &mut self,
        robots: &[(Chain, Pose)],
        out: &mut Vec<Vec<LinkProximity>>,
    ) -> Result<(), ProximityError> {
        out.resize_with(robots.len(), Vec::new);
        let (level, mesh, reach) = (self.level, &self.mesh, self.reach);
        let answer = |memory: &mut Memory, robots: &[(Chain, Pose)], out: &mut [Vec<LinkProximity>]| {
            memory.last.clear();
            for ((robot, pose), answers) in robots.iter().zip(out) {
                answers.clear();
                per_link(level, mesh, &Placed::new(robot, pose, reach)?, memory, answers);
            }
            Ok(())
        };
        #[cfg(feature = "parallel")]
        {
            // A few shares for each thread, because robots differ in the time they take.
            let share = robots.len().div_ceil(4 * rayon::current_num_threads()).max(1);
            self.batch.resize_with(robots.len().div_ceil(share), Memory::default);
            let shares = robots.par_chunks(share).zip(out.par_chunks_mut(share));
            shares.zip(&mut self.batch).try_for_each(|((robots, out), memory)| answer(memory, robots, out))
        }
        #[cfg(not(feature = "parallel"))]
        {
            self.batch.resize_with(1, Memory::default);
            answer(&mut self.batch[0], robots, out)
        }
    }

    fn set_vertices(&mut self, vertices: &[Vector]) -> Result<(), MeshError> {
        self.reach = check_moved(vertices, self.mesh.vertices.len())?;
        self.mesh.set_vertices(self.level, vertices);
        Ok(())
    }
}
