//! Exhaustive proximity on the GPU.

use super::candidates::Candidate;
use super::device::Adapter;
use super::link::DeviceLink;
use super::measure::{least_distance, nearest_of, nearest_of_all};
use super::mesh::DeviceMesh;
use super::opened::Gpu;
use super::plan::Tuning;
use super::query::Query;
use super::shaders::CONVEX;
use super::{GpuError, Precision};
use crate::Chain;
use crate::proximity::{
    CoarseFrame, DeviceFailure, Found, LinkProximity, MeshError, Probe, Proximity, ProximityError,
    check_margin, check_moved, check_vertices, place,
};
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::shape::TriMesh;
use std::ops::Range;
use std::time::Duration;
use wgpu::ComputePipeline;

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
    vertices: Vec<Vector>,
    indices: Vec<[u32; 3]>,
    /// The largest coordinate of the mesh.
    reach: Real,
    frame: CoarseFrame,
    tuning: Tuning,
    /// None after a failure: what is left on the device then is not known, so that it is made anew.
    on_device: Option<DeviceMesh>,
    /// The kernel without culling, where that is wanted.
    every_pair: Option<ComputePipeline>,
    answered_on_cpu: u64,
    query: Query,
    /// The robot that is being placed.
    probes: Vec<Probe>,
    /// Every link of the query, and its place among `placed` unless it is too far out for the device.
    links: Vec<(Probe, Option<usize>)>,
    placed: Vec<DeviceLink>,
}

// A planner may own an engine on a thread of its own.
const _: () = {
    const fn is_send<T: Send>() {}
    is_send::<GpuExhaustive>();
};

impl std::fmt::Debug for GpuExhaustive {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("GpuExhaustive")
            .field("gpu", &self.gpu)
            .field("vertices", &self.vertices.len())
            .field("triangles", &self.indices.len())
            .field("answered_on_cpu", &self.answered_on_cpu)
            .finish_non_exhaustive()
    }
}

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
        Self::tuned(gpu, mesh, Tuning::default())
    }

    pub(super) fn tuned(gpu: &Gpu, mesh: &TriMesh, tuning: Tuning) -> Result<Self, GpuError> {
        if mesh.indices().is_empty() {
            return Err(MeshError::Empty.into());
        }
        let reach = check_vertices(mesh.vertices())?;
        let mut watch = gpu.0.device.failures.watch();
        let on_device = DeviceMesh::new(&gpu.0, mesh.vertices().len(), mesh.indices(), tuning.part);
        match watch.check() {
            Ok(()) => {}
            Err(DeviceFailure::OutOfMemory) => {
                let adapter = gpu.adapter().to_string();
                return Err(GpuError::MeshTooLarge { adapter, triangles: mesh.indices().len() });
            }
            Err(failure) => return Err(failure.into()),
        }
        Ok(Self {
            gpu: gpu.clone(),
            vertices: mesh.vertices().to_vec(),
            indices: mesh.indices().to_vec(),
            reach,
            frame: CoarseFrame::new(mesh.vertices()),
            tuning,
            on_device: Some(on_device),
            every_pair: None,
            answered_on_cpu: 0,
            query: Query::new(tuning, watch),
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
        self.compute_every_pair(CONVEX)
    }

    /// As `set_culling(false)`, by another route from a segment to a disc: WGSL with the function
    /// `segment_disc_from_centre(start: vec3<real>, end: vec3<real>, normal: vec3<real>, radius: real) -> Closest` for a
    /// disc around the origin with a unit normal. The answers are the same if what it finds is never too near.
    ///
    /// # Errors
    /// The driver does not compile the kernel for that.
    pub fn compute_every_pair(&mut self, route: &str) -> Result<(), GpuError> {
        self.every_pair = Some(self.gpu.0.every_pair(route)?);
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
    pub(super) fn on_device(&self) -> Option<&DeviceMesh> {
        self.on_device.as_ref()
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
            let placed = DeviceLink::new(probe, &self.frame, bound, self.gpu.precision());
            self.links.push((*probe, placed.is_some().then_some(self.placed.len())));
            self.placed.extend(placed);
        }
        Ok(())
    }

    /// Has the device find the candidates of all links.
    fn search(&mut self) -> Result<(), DeviceFailure> {
        if self.placed.is_empty() {
            return Ok(());
        }
        let gpu = &*self.gpu.0;
        let mut mesh = self
            .on_device
            .take()
            .unwrap_or_else(|| DeviceMesh::new(gpu, self.vertices.len(), &self.indices, self.tuning.part));
        mesh.update(gpu, &self.frame, &self.vertices);
        let nearest = self.every_pair.as_ref().unwrap_or(&gpu.nearest);
        self.query.run(gpu, &mesh, &self.placed, nearest)?;
        self.on_device = Some(mesh);
        Ok(())
    }

    /// What the device knows of a link: its candidates, if it could tell all that matter.
    fn candidates(&self, link: usize) -> Option<(&DeviceLink, &[Candidate])> {
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

    /// The nearest link and triangle of one robot among those of the query.
    fn least(&mut self, links: Range<usize>) -> LinkProximity {
        let first = links.start;
        // The likeliest link first: its distance rules out most others.
        let likeliest =
            links.clone().min_by(|&a, &b| self.at_least(a).total_cmp(&self.at_least(b))).unwrap_or(first);
        let mut best = (first, self.first_triangle(&self.links[first].0));
        for link in std::iter::once(likeliest).chain(links.filter(|&link| link != likeliest)) {
            let bound = best.1.closest.distance;
            if self.at_least(link) < bound
                && let Some(found) = self.nearest(link, bound)
            {
                best = (link, found);
            }
        }
        self.links[best.0].0.report(best.0 - first, &best.1)
    }

    /// Whether one robot among those of the query keeps its distance.
    fn keeps(&mut self, mut links: Range<usize>, margin: Real) -> bool {
        let bound = self.links[links.start].0.beyond(margin);
        links.all(|link| self.nearest(link, bound).is_none())
    }

    /// Places all robots; says where the links of each begin and end.
    fn place_all(
        &mut self,
        robots: &[(Chain, Pose)],
        margin: Option<Real>,
    ) -> Result<Vec<usize>, ProximityError> {
        self.clear();
        let mut ends = vec![0];
        for (robot, pose) in robots {
            self.place(robot, pose, margin)?;
            ends.push(self.links.len());
        }
        Ok(ends)
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
        Ok(self.least(0..self.links.len()))
    }

    fn clears(&mut self, robot: &Chain, pose: &Pose, margin: Real) -> Result<bool, ProximityError> {
        check_margin(margin)?;
        self.clear();
        self.place(robot, pose, Some(margin))?;
        self.search()?;
        Ok(self.keeps(0..self.links.len(), margin))
    }

    fn per_link_batch(
        &mut self,
        robots: &[(Chain, Pose)],
        out: &mut Vec<Vec<LinkProximity>>,
    ) -> Result<(), ProximityError> {
        let placed =
            self.place_all(robots, None).and_then(|ends| self.search().map(|()| ends).map_err(Into::into));
        let ends = match placed {
            Ok(ends) => ends,
            Err(error) => {
                out.clear();
                return Err(error);
            }
        };
        out.resize_with(robots.len(), Vec::new);
        for (ends, answers) in ends.windows(2).zip(out) {
            answers.clear();
            for link in ends[0]..ends[1] {
                answers.push(self.answer(link - ends[0], link));
            }
        }
        Ok(())
    }

    fn set_vertices(&mut self, vertices: &[Vector]) -> Result<(), MeshError> {
        self.reach = check_moved(vertices, self.vertices.len())?;
        self.vertices.copy_from_slice(vertices);
        self.frame = CoarseFrame::new(vertices);
        if let Some(mesh) = &mut self.on_device {
            mesh.outdate();
        }
        Ok(())
    }
}
