//! The exhaustive engine on the GPU.

use super::link::DeviceLink;
use super::mesh::DeviceMesh;
use super::opened::Gpu;
use super::plan::Tuning;
use super::query::Query;
#[cfg(feature = "laboratory")]
use super::wgsl::CONVEX;
use super::{Adapter, GpuError, Precision};
use crate::answer::{Contact, LinkProximity, ProximityError};
use crate::engine::{Engine, Proximity, placed};
use crate::mesh::{Mesh, SearchFrame};
use crate::pair::{PlacedLink, PlacedRobot};
use crate::query::contacts::{ContactQuery, Wall, contacts_by_all_triangles};
use crate::robot::Chain;
use gpu_batch::wgpu::ComputePipeline;
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::shape::TriMesh;
use std::iter::once;
use std::ops::Range;
use std::time::Duration;

/// Proximity queries that visit every triangle, on the GPU.
///
/// The mesh is uploaded once. A query uploads the links and reads back, for each link, the few
/// triangles that rounding does not exclude. The CPU measures these candidates in double precision.
/// So the distances equal the distances of [`Exhaustive<f64>`](crate::proximity::Exhaustive) in
/// either precision of the search. A link with more than 64 candidates, for example a cylinder
/// along a flat wall, is measured against all triangles on the CPU;
/// [`GpuExhaustive::answered_on_cpu`] counts such links. Answers repeat exactly on one device.
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
///
/// Opening a GPU takes a moment. Engines for several meshes can share one:
///
/// ```no_run
/// use parry_continuum::gpu::{Gpu, GpuExhaustive, Precision};
/// use parry_continuum::parry::{math::{Pose, Vector}, shape::{Ball, TriMesh}};
/// use parry_continuum::{Chain, proximity::Proximity};
///
/// let gpu = Gpu::open(Precision::F32)?;
/// println!("{:?}", gpu.precision());
/// let (vertices, triangles) = Ball::new(10.0).to_trimesh(64, 32);
/// let mut lumen = GpuExhaustive::from_triangles(&gpu, &vertices, &triangles)?;
/// let mut vessel = GpuExhaustive::on(&gpu, &TriMesh::new(vertices, triangles)?)?;
/// let robot = Chain::from_centreline(&[Vector::ZERO, Vector::new(0.0, 0.0, 5.0)], &[0.5])?;
/// println!("{}", lumen.clears(&robot, &Pose::IDENTITY, 1.0)? && vessel.clears(&robot, &Pose::IDENTITY, 2.0)?);
/// println!("{} links were measured on the CPU", lumen.answered_on_cpu() + vessel.answered_on_cpu());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct GpuExhaustive {
    pub(super) gpu: Gpu,
    pub(super) mesh: Mesh,
    pub(super) frame: SearchFrame,
    pub(super) tuning: Tuning,
    /// `None` after a failure: the state of the device is then unknown, so the next query allocates
    /// it anew.
    pub(super) on_device: Option<DeviceMesh>,
    /// The kernel without culling, if it is selected.
    pub(super) every_pair: Option<ComputePipeline>,
    pub(super) answered_on_cpu: u64,
    pub(super) query: Query,
    /// Every link of the query, with its index in `device_links` unless it is too far out for the
    /// device.
    pub(super) links: Vec<(PlacedLink, Option<usize>)>,
    pub(super) device_links: Vec<DeviceLink>,
    /// The links of each robot.
    pub(super) robots: Vec<Result<Range<usize>, ProximityError>>,
}

// A planner may own an engine on its own thread.
const _: () = {
    const fn is_send<T: Send>() {}
    is_send::<GpuExhaustive>();
};

impl std::fmt::Debug for GpuExhaustive {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("GpuExhaustive")
            .field("gpu", &self.gpu)
            .field("triangles", &self.mesh.len())
            .field("answered_on_cpu", &self.answered_on_cpu)
            .finish_non_exhaustive()
    }
}

impl GpuExhaustive {
    /// Builds an engine for `mesh` on the fastest GPU of this machine, with this search precision.
    ///
    /// # Errors
    /// As [`Gpu::open`] and [`GpuExhaustive::on`].
    pub fn new(mesh: &TriMesh, precision: Precision) -> Result<Self, GpuError> {
        Self::on(&Gpu::open(precision)?, mesh)
    }

    /// Builds an engine for `mesh` on an open GPU.
    ///
    /// # Errors
    /// - The mesh has no triangles, or a vertex is not finite or out of range.
    /// - The mesh does not fit into the GPU's memory.
    /// - The GPU has failed.
    pub fn on(gpu: &Gpu, mesh: &TriMesh) -> Result<Self, GpuError> {
        Self::tuned(gpu, Mesh::new(mesh)?, Tuning::default())
    }

    /// Builds an engine for triangles, each given as three indices into `vertices`.
    ///
    /// # Errors
    /// As [`GpuExhaustive::on`]; or an index has no vertex.
    pub fn from_triangles(
        gpu: &Gpu,
        vertices: &[Vector],
        triangles: &[[u32; 3]],
    ) -> Result<Self, GpuError> {
        Self::tuned(gpu, Mesh::from_triangles(vertices, triangles)?, Tuning::default())
    }

    pub(super) fn tuned(gpu: &Gpu, mesh: Mesh, tuning: Tuning) -> Result<Self, GpuError> {
        let mut watch = gpu.0.device.watch();
        let on_device = DeviceMesh::new(&gpu.0, &mesh, tuning.part);
        gpu.check_upload(&mut watch, mesh.len())?;
        Ok(Self {
            gpu: gpu.clone(),
            frame: SearchFrame::new(&mesh),
            mesh,
            tuning,
            on_device: Some(on_device),
            every_pair: None,
            answered_on_cpu: 0,
            query: Query::new(tuning, watch),
            links: Vec::new(),
            device_links: Vec::new(),
            robots: Vec::new(),
        })
    }

    /// The GPU of this engine.
    pub fn adapter(&self) -> &Adapter {
        self.gpu.adapter()
    }

    /// Sets whether cheap, exact bounds may skip the narrow phase of a visited triangle (default:
    /// yes).
    ///
    /// Without them every pair of link and triangle costs its full distance, discs included. That
    /// is the work of the paper, for comparison with it.
    ///
    /// # Errors
    /// The driver does not compile the kernel.
    #[cfg(feature = "laboratory")]
    #[doc(hidden)]
    pub fn set_culling(&mut self, culling: bool) -> Result<(), GpuError> {
        if culling {
            self.every_pair = None;
            return Ok(());
        }
        self.compute_every_pair(CONVEX)
    }

    /// Like `set_culling(false)`, with another route from a segment to a disc.
    ///
    /// `route` is WGSL with the function `segment_disc_from_centre(start: vec3<real>, end:
    /// vec3<real>, normal: vec3<real>, radius: real) -> Closest` for a disc around the origin with
    /// a unit normal. The answers are the same if the route never returns a distance that is too
    /// small.
    ///
    /// # Errors
    /// The driver does not compile the kernel.
    #[cfg(feature = "laboratory")]
    #[doc(hidden)]
    pub fn compute_every_pair(&mut self, route: &str) -> Result<(), GpuError> {
        self.every_pair = Some(self.gpu.0.every_pair(route)?);
        Ok(())
    }

    /// The time that the GPU computed for the last query, without transfers and the CPU's share;
    /// `None` if the GPU keeps no time.
    pub fn device_time(&self) -> Option<Duration> {
        self.query.device_time
    }

    /// The number of links that the CPU measured against every triangle since the engine was built.
    /// Either too many triangles were equally near, or the link was too far out for the search
    /// precision.
    pub fn answered_on_cpu(&self) -> u64 {
        self.answered_on_cpu
    }

    #[cfg(test)]
    pub(super) fn on_device(&self) -> Option<&DeviceMesh> {
        self.on_device.as_ref()
    }
}

impl Engine for GpuExhaustive {
    fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    fn ask_per_link(
        &mut self,
        robot: PlacedRobot,
        out: &mut Vec<LinkProximity>,
    ) -> Result<(), ProximityError> {
        self.search(once(Ok(robot)), None)?;
        self.answers(0, out)
    }

    /// Searches all triangles, for any bound.
    fn ask_nearest(
        &mut self,
        robot: PlacedRobot,
        bound: Real,
    ) -> Result<Option<LinkProximity>, ProximityError> {
        self.search(once(Ok(robot)), None)?;
        let least = self.least(0)?;
        Ok((least.distance <= bound).then_some(least))
    }

    fn ask_clears(&mut self, robot: PlacedRobot, margin: Real) -> Result<bool, ProximityError> {
        self.search(once(Ok(robot)), Some(margin))?;
        self.is_clear(0, margin)
    }

    /// Runs on the CPU: the device finds the nearest triangles of a link, not all that are near.
    fn ask_contacts(
        &mut self,
        robot: PlacedRobot,
        asked: ContactQuery,
        out: &mut Vec<Contact>,
    ) -> Result<(), ProximityError> {
        contacts_by_all_triangles(Wall::of(&self.mesh), robot, asked, out);
        Ok(())
    }

    fn ask_per_link_batch(
        &mut self,
        robots: &[(&Chain, Pose)],
        out: &mut Vec<Result<Vec<LinkProximity>, ProximityError>>,
    ) -> Result<(), ProximityError> {
        self.search(placed(robots), None)?;
        out.resize_with(robots.len(), || Ok(Vec::new()));
        for (robot, out) in out.iter_mut().enumerate() {
            let mut links = std::mem::replace(out, Ok(Vec::new())).unwrap_or_default();
            links.clear();
            *out = self.answers(robot, &mut links).map(|()| links);
        }
        Ok(())
    }

    fn ask_minimum_batch(
        &mut self,
        robots: &[(&Chain, Pose)],
        out: &mut Vec<Result<LinkProximity, ProximityError>>,
    ) -> Result<(), ProximityError> {
        out.clear();
        self.search(placed(robots), None)?;
        out.extend((0..robots.len()).map(|robot| self.least(robot)));
        Ok(())
    }

    fn ask_clears_batch(
        &mut self,
        robots: &[(&Chain, Pose)],
        margin: Real,
        out: &mut Vec<Result<bool, ProximityError>>,
    ) -> Result<(), ProximityError> {
        self.search(placed(robots), Some(margin))?;
        out.extend((0..robots.len()).map(|robot| self.is_clear(robot, margin)));
        Ok(())
    }

    fn move_vertices(&mut self, vertices: &[Vector]) {
        self.mesh.set_vertices(vertices);
        self.frame = SearchFrame::new(&self.mesh);
        if let Some(mesh) = &mut self.on_device {
            mesh.invalidate();
        }
    }
}

impl Proximity for GpuExhaustive {}
