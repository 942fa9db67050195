//! Exhaustive proximity on the GPU.

use super::device::Adapter;
use super::link::PlacedLink;
use super::measure::{least_distance, nearest_of, nearest_of_all};
use super::mesh::DeviceMesh;
use super::opened::{Discs, Gpu};
use super::query::{Candidate, Query};
use super::{GpuError, Precision};
use crate::Chain;
use crate::proximity::{
    DeviceFailure, Found, LinkProximity, MeshError, Probe, Proximity, ProximityError, check_margin,
    check_moved, check_vertices, place,
};
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::shape::TriMesh;
use std::time::Duration;

/// Proximity queries that visit every triangle, on the GPU.
///
/// The mesh is uploaded once. A query sends the links and gets back, for each of them, the few triangles that
/// rounding leaves in question; those are measured here in double precision. So the distances are those of
/// [`Exhaustive<f64>`](crate::proximity::Exhaustive) whatever the precision of the search. A link with more than 64
/// such triangles, for example a cylinder that lies along a flat wall, is measured against all triangles on the CPU;
/// [`GpuExhaustive::answered_on_cpu`] counts such links. Answers are the same every time on one device.
///
/// ```no_run
/// use parry_continuum::gpu::{GpuExhaustive, Precision};
/// use parry_continuum::parry::{math::{Pose, Vector}, shape::{Ball, TriMesh}};
/// use parry_continuum::{Chain, proximity::Proximity};
///
/// let (vertices, triangles) = Ball::new(10.0).to_trimesh(64, 32);
/// let mut engine = GpuExhaustive::new(&TriMesh::new(vertices, triangles)?, Precision::F32)?;
/// println!("{}", engine.adapter());
/// let robot = Chain::from_centreline(&[Vector::ZERO, Vector::new(0.0, 0.0, 5.0)], &[0.5])?;
/// println!("{}", engine.minimum(&robot, &Pose::IDENTITY)?.distance);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct GpuExhaustive {
    gpu: Gpu,
    mesh: DeviceMesh,
    vertices: Vec<Vector>,
    indices: Vec<[u32; 3]>,
    /// The largest coordinate of the mesh.
    reach: Real,
    /// What every pair costs; None with culling.
    every_pair: Option<Discs>,
    answered_on_cpu: u64,
    query: Query,
    /// The robot that is being placed.
    probes: Vec<Probe>,
    /// Every link of the query, and its place among `placed` unless it is too far out for the device.
    links: Vec<(Probe, Option<usize>)>,
    placed: Vec<PlacedLink>,
}

// A planner may own an engine on a thread of its own.
const _: () = {
    const fn is_send<T: Send>() {}
    is_send::<GpuExhaustive>();
};

impl GpuExhaustive {
    /// An engine for `mesh` on the fastest GPU of this machine, searching in this precision.
    ///
    /// # Errors
    /// Those of [`Gpu::open`] and of [`GpuExhaustive::on`].
    pub fn new(mesh: &TriMesh, precision: Precision) -> Result<Self, GpuError> {
        Self::on(&Gpu::open(precision)?, mesh)
    }

    /// An engine for `mesh` on a GPU that is open already.
    ///
    /// # Errors
    /// The mesh has no triangles, or a vertex is not finite or out of range; the mesh does not fit into the GPU's
    /// memory; or the GPU has failed.
    pub fn on(gpu: &Gpu, mesh: &TriMesh) -> Result<Self, GpuError> {
        Self::in_parts(gpu, mesh, usize::MAX)
    }

    /// As [`GpuExhaustive::on`], with at most `most` triangles in a buffer.
    pub(super) fn in_parts(gpu: &Gpu, mesh: &TriMesh, most: usize) -> Result<Self, GpuError> {
        if mesh.indices().is_empty() {
            return Err(MeshError::Empty.into());
        }
        let reach = check_vertices(mesh.vertices())?;
        let device_mesh = match DeviceMesh::new(&gpu.0, mesh.vertices(), mesh.indices(), most) {
            Ok(mesh) => mesh,
            Err(DeviceFailure::OutOfMemory) => {
                let adapter = gpu.adapter().to_string();
                return Err(GpuError::MeshTooLarge { adapter, triangles: mesh.indices().len() });
            }
            Err(failure) => return Err(failure.into()),
        };
        Ok(Self {
            gpu: gpu.clone(),
            mesh: device_mesh,
            vertices: mesh.vertices().to_vec(),
            indices: mesh.indices().to_vec(),
            reach,
            every_pair: None,
            answered_on_cpu: 0,
            query: Query::default(),
            probes: Vec::new(),
            links: Vec::new(),
            placed: Vec::new(),
        })
    }

    /// Which GPU this is.
    pub fn adapter(&self) -> &Adapter {
        self.gpu.adapter()
    }

    /// Whether cheap, exact bounds may spare a visited triangle its narrow phase. They may unless told otherwise.
    ///
    /// Without them every pair of link and triangle costs its full distance, discs included: the work of the
    /// paper, for comparison with it.
    ///
    /// # Errors
    /// The driver does not compile the kernel for that.
    pub fn set_culling(&mut self, culling: bool) -> Result<(), GpuError> {
        if culling {
            self.every_pair = None;
            return Ok(());
        }
        self.compute_every_pair(Discs::Convex)
    }

    /// As `set_culling(false)`, with the discs by the paper's routes or by ours. The answers are the same.
    ///
    /// # Errors
    /// The driver does not compile the kernel for that.
    pub fn compute_every_pair(&mut self, discs: Discs) -> Result<(), GpuError> {
        self.gpu.0.every_pair(discs)?;
        self.every_pair = Some(discs);
        Ok(())
    }

    /// How long the GPU computed for the last query, without transfers and the CPU's share; `None` if it keeps no
    /// time.
    pub fn device_time(&self) -> Option<Duration> {
        self.query.device_time
    }

    /// How many links had to be measured against every triangle on the CPU since the engine was built: too many
    /// triangles were equally near, or the link lay too far out for the precision of the search.
    pub fn answered_on_cpu(&self) -> u64 {
        self.answered_on_cpu
    }

    #[cfg(test)]
    pub(super) fn mesh(&self) -> &DeviceMesh {
        &self.mesh
    }

    /// Makes ready for the links of new robots.
    fn clear(&mut self) {
        self.links.clear();
        self.placed.clear();
    }

    /// Adds a robot's links; only triangles within `margin` are of interest if there is one.
    fn place(&mut self, robot: &Chain, pose: &Pose, margin: Option<Real>) -> Result<(), ProximityError> {
        place(robot.links(), pose, self.reach, &mut self.probes)?;
        for probe in &self.probes {
            let bound = margin.map(|margin| probe.beyond(margin));
            let placed = PlacedLink::new(probe, &self.mesh.frame, bound, self.gpu.precision());
            self.links.push((*probe, placed.is_some().then_some(self.placed.len())));
            self.placed.extend(placed);
        }
        Ok(())
    }

    /// Has the device find the candidates of all links.
    fn search(&mut self) -> Result<(), DeviceFailure> {
        let gpu = &*self.gpu.0;
        // Compiled when culling was switched off.
        let every_pair = self.every_pair.and_then(|discs| gpu.every_pair(discs).ok());
        let nearest = every_pair.unwrap_or(&gpu.nearest);
        self.query.run(gpu, &self.mesh, &self.placed, nearest)
    }

    /// What the device knows of a link: its candidates, if it could tell all that matter.
    fn candidates(&self, link: usize) -> Option<(&PlacedLink, &[Candidate])> {
        let place = self.links[link].1?;
        let placed = &self.placed[place];
        let (candidates, too_many) = self.query.candidates(place);
        // Without a margin there is always one.
        let complete = !too_many && (placed.has_margin() || !candidates.is_empty());
        complete.then_some((placed, candidates))
    }

    /// The nearest triangle of a link among those strictly nearer than `bound`, which is in the probe's units.
    fn nearest(&mut self, link: usize, bound: Real) -> Option<Found> {
        let probe = &self.links[link].0;
        let Some((placed, candidates)) = self.candidates(link) else {
            let found = nearest_of_all(probe, bound, &self.vertices, &self.indices);
            self.answered_on_cpu += 1;
            return found;
        };
        // What the device computed errs, for the least of them and for any other.
        let limit = least_distance(candidates) + 2.0 * placed.error();
        let near = candidates.iter().filter(|candidate| candidate.distance <= limit);
        nearest_of(probe, near.map(|candidate| candidate.triangle), bound, &self.vertices, &self.indices)
    }

    /// The nearest triangle of a link. Some triangle is always the nearest.
    fn answer(&mut self, number: usize, link: usize) -> LinkProximity {
        let found = self.nearest(link, Real::INFINITY);
        let (probe, _) = &self.links[link];
        let found = found.unwrap_or_else(|| self.first_triangle(probe));
        probe.report(number, &found)
    }

    fn first_triangle(&self, probe: &Probe) -> Found {
        let corners = self.indices[0].map(|index| self.vertices[index as usize]);
        Found { triangle: 0, closest: probe.closest(corners) }
    }

    /// A lower bound on a link's distance, in the probe's units, by what the device computed.
    fn at_least(&self, link: usize) -> Real {
        self.candidates(link).map_or(0.0, |(placed, candidates)| placed.at_least(least_distance(candidates)))
    }
}

impl Proximity for GpuExhaustive {
    fn per_link(
        &mut self,
        robot: &Chain,
        pose: &Pose,
        out: &mut Vec<LinkProximity>,
    ) -> Result<(), ProximityError> {
        out.clear();
        self.clear();
        self.place(robot, pose, None)?;
        self.search()?;
        for link in 0..self.links.len() {
            let answer = self.answer(link, link);
            out.push(answer);
        }
        Ok(())
    }

    fn minimum(&mut self, robot: &Chain, pose: &Pose) -> Result<LinkProximity, ProximityError> {
        self.clear();
        self.place(robot, pose, None)?;
        self.search()?;
        // The likeliest link first: its distance rules out most others.
        let links = 0..self.links.len();
        let likeliest =
            links.clone().min_by(|&a, &b| self.at_least(a).total_cmp(&self.at_least(b))).unwrap_or(0);
        let mut best = (0, self.first_triangle(&self.links[0].0));
        for link in std::iter::once(likeliest).chain(links.filter(|&link| link != likeliest)) {
            let bound = best.1.closest.distance;
            if self.at_least(link) < bound
                && let Some(found) = self.nearest(link, bound)
            {
                best = (link, found);
            }
        }
        Ok(self.links[best.0].0.report(best.0, &best.1))
    }

    fn clears(&mut self, robot: &Chain, pose: &Pose, margin: Real) -> Result<bool, ProximityError> {
        check_margin(margin)?;
        self.clear();
        self.place(robot, pose, Some(margin))?;
        self.search()?;
        let bound = self.links[0].0.beyond(margin);
        Ok((0..self.links.len()).all(|link| self.nearest(link, bound).is_none()))
    }

    fn per_link_batch(
        &mut self,
        robots: &[(Chain, Pose)],
        out: &mut Vec<Vec<LinkProximity>>,
    ) -> Result<(), ProximityError> {
        self.clear();
        for (robot, pose) in robots {
            self.place(robot, pose, None)?;
        }
        self.search()?;
        out.resize_with(robots.len(), Vec::new);
        let mut first = 0;
        for ((robot, _), answers) in robots.iter().zip(out) {
            answers.clear();
            for link in 0..robot.links().len() {
                answers.push(self.answer(link, first + link));
            }
            first += robot.links().len();
        }
        Ok(())
    }

    fn set_vertices(&mut self, vertices: &[Vector]) -> Result<(), MeshError> {
        self.reach = check_moved(vertices, self.vertices.len())?;
        self.vertices.copy_from_slice(vertices);
        Ok(self.mesh.update(&self.gpu.0, vertices)?)
    }
}
