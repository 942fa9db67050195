//! The engine that searches on the GPU.
//!
//! # The choice between CPU and device
//! A batch of at least [`MIN_LINKS`] links per core of the CPU runs on the device. The rest goes to
//! a [`BvhSearch`] on the CPU. After a move that search must be refitted first, so a large mesh is
//! then searched on the device however small the batch is.

use super::answer::{Answer, Clears, Measure, Minimum, PerLink, Within};
use super::batch::Batches;
use super::compiled::SearchKernels;
use super::device::{DeviceTree, Searched};
use super::kernels::Question;
use super::robots::{Packed, Robots};
use super::tree::{MOST_TRIANGLES, SearchTree};
use crate::answer::{Contact, LinkProximity, ProximityError};
use crate::engine::{BvhSearch, Engine, Proximity};
use crate::gpu::{Adapter, Gpu, GpuError, Precision};
use crate::mesh::{Mesh, SearchFrame};
use crate::pair::PlacedRobot;
use crate::query::contacts::{ContactCollector, ContactMemory, ContactQuery, Wall};
use crate::robot::Chain;
use crate::threads::threads;
use fearless_simd::Level;
use gpu_batch::DeviceFailure;
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::shape::TriMesh;
use std::time::Duration;

/// The least number of links per core of the CPU for which a batch runs on the device, for each
/// kind of question. Estimates: they were not measured with this engine. Contacts have no batch.
const MIN_LINKS: [usize; Question::KINDS] = [240, 480, 15_000, usize::MAX];
/// From this number of triangles on, a refit after a move takes longer on the CPU than on the
/// device.
const MANY_TRIANGLES: usize = 1 << 16;

/// Proximity queries on a bounding volume hierarchy, on the GPU.
///
/// The engine for batches, and for large meshes that move. The answers equal the answers of
/// [`BvhSearch`] bit for bit: the device finds the few triangles that may be nearest, in single
/// precision and within a proven bound on its rounding. The CPU measures these candidates in double
/// precision.
///
/// - **Batches.** [`minimum_batch`](Proximity::minimum_batch),
///   [`per_link_batch`](Proximity::per_link_batch) and
///   [`clears_batch`](Proximity::clears_batch) upload the points of the robots and read back the
///   candidates. The CPU measures one chunk of a batch while the device searches the next.
/// - **Small batches** and single queries run on the CPU, which is faster there: see
///   [`set_min_links`](Self::set_min_links).
/// - **Moving meshes.** [`set_vertices`](Proximity::set_vertices) keeps the vertices. The next
///   query uploads them, and the device refits its hierarchy. From 65,536 triangles on, every query
///   after a move runs on the device until [`prepare`](Self::prepare) has refitted the hierarchy of
///   the CPU.
/// - **Sections.** [`clears_sections_batch`](Self::clears_sections_batch) is about robots of
///   sections of constant curvature, whose points the device computes.
/// - **Contacts** ([`contacts_within`](Proximity::contacts_within)) run on the CPU while the mesh
///   rests. After a move of a large mesh the device finds the triangles within the margin.
/// - **Other queries.** For tubes, motions and sides [`cpu`](Self::cpu) returns the search on the
///   CPU.
///
/// Robots that single precision does not resolve are searched on the CPU. So are robots with a link
/// that has more than 2,048 candidates, with more than a million links, robots whose candidates
/// do not fit into the device's largest buffer, and robots for which the driver stops a long loop.
/// [`answered_on_cpu`](Self::answered_on_cpu) counts them.
///
/// ```no_run
/// use parry_continuum::gpu::GpuSearch;
/// use parry_continuum::parry::{math::{Pose, Vector}, shape::{Ball, TriMesh}};
/// use parry_continuum::{Chain, proximity::Proximity};
///
/// let (vertices, triangles) = Ball::new(10.0).to_trimesh(64, 32);
/// let mut search = GpuSearch::new(&TriMesh::new(vertices, triangles)?)?;
/// println!("{}", search.adapter());
/// let robot = Chain::from_centreline(&[Vector::ZERO, Vector::Z * 5.0], &[0.5])?;
/// let robots: Vec<_> =
///     (0..100_000).map(|k| (&robot, Pose::rotation(Vector::X * f64::from(k)))).collect();
/// let mut closest = Vec::new();
/// search.minimum_batch(&robots, &mut closest)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// Opening a GPU takes a moment. Engines for several meshes can share one:
///
/// ```no_run
/// use parry_continuum::gpu::{Gpu, GpuSearch, Precision};
/// use parry_continuum::parry::{math::{Pose, Vector}, shape::{Ball, TriMesh}};
/// use parry_continuum::{Chain, Tube, proximity::Proximity};
///
/// let gpu = Gpu::open(Precision::F32)?;
/// let (vertices, triangles) = Ball::new(10.0).to_trimesh(64, 32);
/// let mut lumen = GpuSearch::from_triangles(&gpu, &vertices, &triangles)?;
/// let mut vessel = GpuSearch::on(&gpu, &TriMesh::new(vertices, triangles)?)?;
/// lumen.set_min_links(Some(1000)); // batches of 1,000 links and more go to the GPU
/// lumen.prepare();
/// let points = [Vector::ZERO, Vector::Z * 5.0];
/// let robot = Chain::from_centreline(&points, &[0.5])?;
/// let mut clear = Vec::new();
/// lumen.clears_batch(&vec![(&robot, Pose::IDENTITY); 5000], 1.0, &mut clear)?;
/// println!("{:?} on the GPU, {} robots on the CPU", lumen.device_time(), lumen.answered_on_cpu());
/// // The search on the CPU has more queries.
/// let tube = Tube::from_samples(&points, &[0.5], None)?;
/// println!("{}", vessel.cpu().clearance(&tube, &Pose::IDENTITY, 0.01)?.lower);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct GpuSearch {
    gpu: Gpu,
    level: Level,
    mesh: Mesh,
    frame: SearchFrame,
    tree: SearchTree,
    /// `None` after a failure: the state of the device is then unknown, so the next query uploads
    /// the tree anew.
    on_device: Option<DeviceTree>,
    batches: Batches,
    /// The search on the CPU. Its mesh is stale after a move, until it is needed.
    cpu: BvhSearch,
    is_cpu_stale: bool,
    contact_memory: ContactMemory,
    min_links: Option<usize>,
    answered_on_cpu: u64,
    /// Kernels that count their work, if they are selected.
    counting: Option<SearchKernels>,
}

// A planner may own an engine on its own thread.
const _: () = {
    const fn is_send<T: Send>() {}
    is_send::<GpuSearch>();
};

impl std::fmt::Debug for GpuSearch {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("GpuSearch")
            .field("gpu", &self.gpu)
            .field("triangles", &self.mesh.len())
            .field("answered_on_cpu", &self.answered_on_cpu)
            .finish_non_exhaustive()
    }
}

impl GpuSearch {
    /// Builds an engine for `mesh` on the fastest GPU of this machine.
    ///
    /// # Errors
    /// As [`Gpu::open`] and [`GpuSearch::on`].
    pub fn new(mesh: &TriMesh) -> Result<Self, GpuError> {
        Self::on(&Gpu::open(Precision::F32)?, mesh)
    }

    /// Builds an engine for `mesh` on an open GPU of either precision.
    ///
    /// # Errors
    /// - The mesh has no triangles, or a vertex is not finite or out of range.
    /// - The mesh does not fit into the GPU's memory, or into its largest buffer.
    /// - The GPU has failed, or its driver does not compile a kernel.
    pub fn on(gpu: &Gpu, mesh: &TriMesh) -> Result<Self, GpuError> {
        Self::of(gpu, Mesh::new(mesh)?)
    }

    /// Builds an engine for triangles, each given as three indices into `vertices`.
    ///
    /// # Errors
    /// As [`GpuSearch::on`]; or an index has no vertex.
    pub fn from_triangles(
        gpu: &Gpu,
        vertices: &[Vector],
        triangles: &[[u32; 3]],
    ) -> Result<Self, GpuError> {
        Self::of(gpu, Mesh::from_triangles(vertices, triangles)?)
    }

    fn of(gpu: &Gpu, mesh: Mesh) -> Result<Self, GpuError> {
        let too_large = || gpu.too_large(mesh.len());
        // Before the tree is built, which takes seconds.
        if mesh.len() > MOST_TRIANGLES || !DeviceTree::has_room(&gpu.0, &mesh) {
            return Err(too_large());
        }
        let kernels = gpu.0.search()?;
        let frame = SearchFrame::new(&mesh);
        let tree = SearchTree::new(&frame, &mesh);
        let mut watch = gpu.0.device.watch();
        let on_device = DeviceTree::new(&gpu.0, kernels, &mesh, &tree).ok_or_else(too_large)?;
        gpu.check_upload(&mut watch, mesh.len())?;
        Ok(Self {
            gpu: gpu.clone(),
            level: Level::new(),
            cpu: BvhSearch::of(mesh.clone()),
            mesh,
            frame,
            tree,
            on_device: Some(on_device),
            batches: Batches::new(watch),
            is_cpu_stale: false,
            contact_memory: ContactMemory::default(),
            min_links: None,
            answered_on_cpu: 0,
            counting: None,
        })
    }

    /// The GPU of this engine.
    pub fn adapter(&self) -> &Adapter {
        self.gpu.adapter()
    }

    /// Sets from how many links on a batch goes to the device; `None` restores the default.
    ///
    /// With 0 all queries run on the device, with [`usize::MAX`] on the CPU. The answers are the
    /// same. The default depends on the question and on the number of cores.
    pub fn set_min_links(&mut self, links: Option<usize>) {
        self.min_links = links;
    }

    /// Builds every structure that a first query on the CPU would build, and refits the hierarchy
    /// of the CPU after a move.
    pub fn prepare(&mut self) {
        self.refitted().prepare();
    }

    /// Returns the search on the CPU for the mesh as it is now, for the questions that
    /// [`Proximity`] does not have. It shares its hierarchy with this engine.
    pub fn cpu(&mut self) -> BvhSearch {
        self.refitted().clone()
    }

    /// The number of robots that were meant for the device but searched on the CPU, since the
    /// engine was built.
    pub fn answered_on_cpu(&self) -> u64 {
        self.answered_on_cpu
    }

    /// The time that the device searched for the last batch on it, without transfers; `None` if it
    /// keeps no time.
    pub fn device_time(&self) -> Option<Duration> {
        self.batches.device_time
    }

    /// Has the kernels count their work.
    ///
    /// # Errors
    /// The driver does not compile a kernel.
    #[cfg(feature = "laboratory")]
    #[doc(hidden)]
    pub fn count_work(&mut self) -> Result<(), GpuError> {
        self.counting = Some(SearchKernels::new(&self.gpu.0.device, true)?);
        self.batches.forget();
        Ok(())
    }

    /// The nodes and leaves that the first pass of the last batch visited, and the links.
    #[cfg(feature = "laboratory")]
    #[doc(hidden)]
    pub fn work(&self) -> [u64; 3] {
        self.batches.work
    }

    /// Has batches run with these kernels.
    #[cfg(test)]
    pub(in crate::gpu) fn set_kernels(&mut self, kernels: SearchKernels) {
        self.counting = Some(kernels);
        self.batches.forget();
    }

    /// Whether the CPU has not refitted its hierarchy since the last move.
    #[cfg(test)]
    pub(in crate::gpu) fn is_cpu_stale(&self) -> bool {
        self.is_cpu_stale
    }

    /// The search on the CPU, refitted if the mesh has moved.
    pub(super) fn refitted(&mut self) -> &mut BvhSearch {
        if std::mem::take(&mut self.is_cpu_stale) {
            Engine::move_vertices(&mut self.cpu, self.mesh.vertices());
        }
        &mut self.cpu
    }

    fn is_for_device(&self, robots: Robots, question: Question) -> bool {
        self.are_enough(robots, MIN_LINKS[question.kind()])
    }

    /// Whether robots have enough links for the device, by default at least `per_core` for every
    /// core.
    pub(super) fn are_enough(&self, robots: impl Packed, per_core: usize) -> bool {
        let min = match self.min_links {
            Some(links) => links,
            None if self.is_cpu_stale && self.mesh.len() >= MANY_TRIANGLES => 0,
            None => per_core.saturating_mul(threads()),
        };
        let mut links = 0_usize;
        min == 0
            || (0..robots.len()).any(|robot| {
                links = links.saturating_add(robots.links(robot));
                links >= min
            })
    }

    /// Answers all robots on the device except the robots in [`Batches::for_cpu`].
    ///
    /// # Errors
    /// The device has failed.
    pub(super) fn search<A: Answer>(
        &mut self,
        robots: impl Packed,
        answer: &A,
        out: &mut [Result<A::Value, ProximityError>],
    ) -> Result<(), ProximityError> {
        let Self { gpu, level, mesh, frame, tree, on_device, batches, counting, .. } = self;
        let gpu = &*gpu.0;
        let kernels = match &*counting {
            Some(kernels) => kernels,
            // They were compiled when the engine was built.
            None => gpu.search().map_err(|_| DeviceFailure::Refused)?,
        };
        // After a failure all of the device's memory is allocated anew.
        let uploaded = on_device.take().or_else(|| {
            batches.forget();
            DeviceTree::new(gpu, kernels, mesh, tree)
        });
        let mut uploaded = uploaded.ok_or(DeviceFailure::OutOfMemory)?;
        uploaded.update(gpu, kernels, frame, mesh);
        let searched = Searched { gpu, kernels, tree: &uploaded, frame };
        batches.run(searched, robots, answer, Measure { level: *level, mesh }, out)?;
        *on_device = Some(uploaded);
        self.answered_on_cpu += self.batches.for_cpu.len() as u64;
        Ok(())
    }

    /// The robots of the last batch that the CPU must search for.
    pub(super) fn take_for_cpu(&mut self) -> Vec<usize> {
        std::mem::take(&mut self.batches.for_cpu)
    }

    /// Answers a batch on the device, and on the CPU the robots that remain, or all if the batch is
    /// not for the device.
    ///
    /// # Errors
    /// The device has failed.
    fn search_batch<A: Answer>(
        &mut self,
        robots: &[(&Chain, Pose)],
        answer: &A,
        out: &mut Vec<Result<A::Value, ProximityError>>,
        on_cpu: impl Fn(
            &mut BvhSearch,
            &[(&Chain, Pose)],
            &mut Vec<Result<A::Value, ProximityError>>,
        ) -> Result<(), ProximityError>,
    ) -> Result<(), ProximityError> {
        if !self.is_for_device(Robots::Batch(robots), answer.question()) {
            return on_cpu(self.refitted(), robots, out);
        }
        out.resize_with(robots.len(), || Ok(answer.placeholder()));
        self.search(Robots::Batch(robots), answer, out)?;
        let for_cpu = self.take_for_cpu();
        if for_cpu.is_empty() {
            return Ok(());
        }
        let some: Vec<_> = for_cpu.iter().map(|&robot| robots[robot]).collect();
        let mut answers = Vec::new();
        on_cpu(self.refitted(), &some, &mut answers)?;
        for_cpu.into_iter().zip(answers).for_each(|(robot, answer)| out[robot] = answer);
        Ok(())
    }

    /// Answers one robot on the device. `None` if the question is not for the device, or if the CPU
    /// must search for the robot.
    ///
    /// # Errors
    /// The device has failed.
    fn search_one<A: Answer>(
        &mut self,
        robot: &PlacedRobot,
        answer: &A,
    ) -> Result<Option<A::Value>, ProximityError> {
        if !self.is_for_device(Robots::One(robot), answer.question()) {
            return Ok(None);
        }
        let mut out = [Ok(answer.placeholder())];
        self.search(Robots::One(robot), answer, &mut out)?;
        let [out] = out;
        if self.batches.for_cpu.is_empty() { out.map(Some) } else { Ok(None) }
    }
}

impl Engine for GpuSearch {
    fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    fn ask_per_link(
        &mut self,
        robot: PlacedRobot,
        out: &mut Vec<LinkProximity>,
    ) -> Result<(), ProximityError> {
        match self.search_one(&robot, &PerLink(Robots::One(&robot)))? {
            Some(answers) => {
                *out = answers;
                Ok(())
            }
            None => self.refitted().ask_per_link(robot, out),
        }
    }

    fn ask_nearest(
        &mut self,
        robot: PlacedRobot,
        bound: Real,
    ) -> Result<Option<LinkProximity>, ProximityError> {
        match self.search_one(&robot, &Minimum(Robots::One(&robot)))? {
            Some(least) => Ok((least.distance <= bound).then_some(least)),
            None => self.refitted().ask_nearest(robot, bound),
        }
    }

    fn ask_clears(&mut self, robot: PlacedRobot, margin: Real) -> Result<bool, ProximityError> {
        match self.search_one(&robot, &Clears { robots: Robots::One(&robot), margin })? {
            Some(clears) => Ok(clears),
            None => self.refitted().ask_clears(robot, margin),
        }
    }

    /// The device finds the triangles within the margin. The CPU finds the contacts among them.
    fn ask_contacts(
        &mut self,
        robot: PlacedRobot,
        query: ContactQuery,
        out: &mut Vec<Contact>,
    ) -> Result<(), ProximityError> {
        let Some(candidates) = self.search_one(&robot, &Within { margin: query.margin })? else {
            return self.refitted().ask_contacts(robot, query, out);
        };
        let Self { level, mesh, contact_memory, .. } = self;
        let mut contacts =
            ContactCollector::new(*level, Wall::of(mesh), robot, query, contact_memory, out);
        for of_link in candidates.chunk_by(|one, other| one.link == other.link) {
            let triangles = of_link.iter().map(|candidate| candidate.triangle);
            contacts.add(of_link[0].link as usize, |_, found| found.add_unclassified(triangles));
        }
        contacts.finish();
        Ok(())
    }

    fn ask_per_link_batch(
        &mut self,
        robots: &[(&Chain, Pose)],
        out: &mut Vec<Result<Vec<LinkProximity>, ProximityError>>,
    ) -> Result<(), ProximityError> {
        let answer = PerLink(Robots::Batch(robots));
        self.search_batch(robots, &answer, out, BvhSearch::ask_per_link_batch)
    }

    fn ask_minimum_batch(
        &mut self,
        robots: &[(&Chain, Pose)],
        out: &mut Vec<Result<LinkProximity, ProximityError>>,
    ) -> Result<(), ProximityError> {
        let answer = Minimum(Robots::Batch(robots));
        self.search_batch(robots, &answer, out, BvhSearch::ask_minimum_batch)
    }

    fn ask_clears_batch(
        &mut self,
        robots: &[(&Chain, Pose)],
        margin: Real,
        out: &mut Vec<Result<bool, ProximityError>>,
    ) -> Result<(), ProximityError> {
        let answer = Clears { robots: Robots::Batch(robots), margin };
        self.search_batch(robots, &answer, out, |cpu, robots, out| {
            cpu.ask_clears_batch(robots, margin, out)
        })
    }

    fn move_vertices(&mut self, vertices: &[Vector]) {
        self.mesh.set_vertices(vertices);
        self.frame = SearchFrame::new(&self.mesh);
        self.is_cpu_stale = true;
        if let Some(tree) = &mut self.on_device {
            tree.invalidate();
        }
    }
}

impl Proximity for GpuSearch {}
