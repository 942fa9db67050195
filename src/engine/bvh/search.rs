//! The engine on a bounding volume hierarchy: its state, its clones, and its part of [`Engine`].
//!
//! # Definitions
//! - [`PreparedMesh`]: the mesh, its hierarchy and the structures of some queries. Clones share it.
//! - [`Memory`]: scratch and the warm start of the next query. Each clone has its own.
//! - [`Context`]: the two together, for one query.
//!
//! A batch has one [`Memory`] per chunk of robots and forgets its warm start at each call.

use super::prepared_mesh::PreparedMesh;
use crate::answer::{Contact, LinkProximity, MeshError, ProximityError, Work};
use crate::engine::{Engine, Proximity, any_triangle};
use crate::mesh::Mesh;
use crate::pair::PlacedRobot;
#[cfg(feature = "tubes")]
use crate::query::clearance::{LastPlace, TubeMemory};
use crate::query::contacts::{ContactMemory, ContactQuery, ContactSearch};
#[cfg(feature = "tubes")]
use crate::query::motion::MotionMemory;
use crate::query::nearest::{
    ClearsMemory, ClearsSearch, PerLinkMemory, WarmStart, minimum_within, per_link,
};
use crate::query::side::Surface;
use crate::robot::Chain;
use crate::search::hierarchy::{MeshSearch, Scratch};
use crate::threads::in_chunks;
use fearless_simd::Level;
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::shape::TriMesh;
use std::sync::Arc;

/// Proximity queries on a bounding volume hierarchy.
///
/// The work per link grows with the logarithm of the number of triangles.
///
/// The engine has its own hierarchy of the mesh, in single precision, with 16 children per node and
/// 16 triangles per leaf. It measures every candidate again in double precision, so the answers
/// equal the answers of [`Exhaustive`](crate::proximity::Exhaustive). If single precision is too
/// coarse, because a triangle or the robot lies very far out, a second hierarchy in double
/// precision replaces the first. The engine builds it at first use.
///
/// The last answers warm-start the next query. Any robot and pose may follow; small motions are
/// answered fastest. [`BvhSearch::forget`] drops the warm start.
///
/// Some queries need more than the hierarchy. The first such query builds it;
/// [`prepare`](Self::prepare) builds it all beforehand.
///
/// A clone shares mesh and hierarchy and starts with an empty memory, so one clone per thread costs
/// nothing. [`set_vertices`](Proximity::set_vertices) of one clone leaves the mesh of the others
/// unchanged.
///
/// ```
/// use parry_continuum::{Chain, proximity::{BvhSearch, Proximity}};
/// use parry_continuum::parry::{math::{Pose, Vector}, shape::{Ball, TriMesh}};
///
/// let (vertices, triangles) = Ball::new(10.0).to_trimesh(64, 32);
/// let search = BvhSearch::new(&TriMesh::new(vertices, triangles)?)?;
/// let robot = Chain::from_centreline(&[Vector::ZERO, Vector::new(0.0, 0.0, 5.0)], &[0.5])?;
/// std::thread::scope(|scope| {
///     for turn in 0..2 {
///         let (mut search, robot) = (search.clone(), &robot);
///         scope.spawn(move || {
///             search.clears(robot, &Pose::rotation(Vector::X * f64::from(turn)), 1.0)
///         });
///     }
/// });
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct BvhSearch {
    level: Level,
    mesh: Arc<PreparedMesh>,
    memory: Memory,
    /// One memory per chunk of a batch.
    batch: Vec<Memory>,
}

/// The state that one query leaves for the next.
#[derive(Clone, Default)]
pub(super) struct Memory {
    scratch: Scratch,
    answers: Remembered,
}

/// The memory of each kind of query: warm starts and scratch.
#[derive(Clone, Default)]
pub(super) struct Remembered {
    pub per_link: PerLinkMemory,
    pub minimum: WarmStart,
    pub clears: ClearsMemory,
    /// For the lids of openings.
    pub lids: ClearsMemory,
    pub contacts: ContactMemory,
    /// Where the next queries of other kinds begin.
    pub places: LastPlaces,
    #[cfg(feature = "tubes")]
    pub tube: TubeMemory,
    #[cfg(feature = "tubes")]
    pub motion: MotionMemory,
}

/// The places of the last answers, one for each kind of query that begins at one.
#[derive(Clone, Default)]
pub(super) struct LastPlaces {
    #[cfg(feature = "tubes")]
    pub tube: Option<LastPlace>,
}

impl Remembered {
    fn forget(&mut self) {
        self.per_link.forget();
        self.minimum.forget();
        self.clears.forget();
        self.lids.forget();
        self.places = LastPlaces::default();
    }

    /// Forgets what holds only while the mesh rests: cached distances, and the places of lids,
    /// whose tree is built anew.
    fn forget_distances(&mut self) {
        self.minimum.forget_distances();
        self.clears.forget_distances();
        self.lids.forget();
    }
}

impl Clone for BvhSearch {
    fn clone(&self) -> Self {
        Self {
            level: self.level,
            mesh: Arc::clone(&self.mesh),
            memory: Memory::default(),
            batch: Vec::new(),
        }
    }
}

impl std::fmt::Debug for BvhSearch {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("BvhSearch")
            .field("triangles", &self.mesh.hierarchy.mesh.len())
            .finish_non_exhaustive()
    }
}

impl BvhSearch {
    /// Builds an engine for `mesh`, whose vertices and triangles are copied.
    ///
    /// # Errors
    /// The mesh has no triangles, or a vertex is not finite or out of range.
    pub fn new(mesh: &TriMesh) -> Result<Self, MeshError> {
        Ok(Self::of(Mesh::new(mesh)?))
    }

    /// Builds an engine from vertices and triangles, which are copied.
    ///
    /// Each triangle is three indices into `vertices`. Unlike [`new`](Self::new) this needs no
    /// [`TriMesh`], whose constructor builds a hierarchy of its own.
    ///
    /// # Errors
    /// There are no triangles, a vertex is not finite or out of range, or an index has no vertex.
    ///
    /// ```
    /// use parry_continuum::Chain;
    /// use parry_continuum::parry::{math::{Pose, Vector}, shape::TriMesh};
    /// use parry_continuum::proximity::{BvhSearch, Proximity};
    ///
    /// let wall =
    ///     [Vector::new(-9.0, -9.0, 3.0), Vector::new(9.0, -9.0, 3.0), Vector::new(0.0, 9.0, 3.0)];
    /// let mut search = BvhSearch::from_triangles(&wall, &[[0, 1, 2]])?;
    /// search.set_vertices(&wall.map(|corner| corner + Vector::Z))?;
    /// let robot = Chain::from_centreline(&[Vector::ZERO, Vector::X], &[0.5])?;
    /// let closest = search.minimum(&robot, &Pose::IDENTITY)?;
    /// // A certificate for the mesh as the engine has it now.
    /// let mesh = TriMesh::new(search.vertices().to_vec(), search.triangles().to_vec())?;
    /// let proof = closest.certify(&robot, &Pose::IDENTITY, &mesh)?;
    /// assert!(proof.lower <= 3.5 && 3.5 <= proof.upper);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn from_triangles(vertices: &[Vector], triangles: &[[u32; 3]]) -> Result<Self, MeshError> {
        Ok(Self::of(Mesh::from_triangles(vertices, triangles)?))
    }

    pub(crate) fn of(mesh: Mesh) -> Self {
        let level = Level::new();
        let mesh = Arc::new(PreparedMesh::new(level, mesh));
        Self { level, mesh, memory: Memory::default(), batch: Vec::new() }
    }

    /// Builds every structure that a query would build at first use.
    ///
    /// Clones share the structures. Call it after [`set_vertices`](Proximity::set_vertices) too:
    /// structures that depend on the positions of the vertices are then built anew.
    ///
    /// | query | what it needs beside the hierarchy |
    /// |---|---|
    /// | [`clears`](Proximity::clears) | a coarse grid of the sides of the wall |
    /// | [`contacts_within`](Proximity::contacts_within) | which triangles share corners and edges |
    /// | [`side`](Self::side) | the far field of each node |
    /// | [`surface`](Self::surface), [`clears_inside`](Self::clears_inside) | the openings of the mesh, with their lids |
    /// | any, if single precision is too coarse | a second hierarchy, in double precision |
    ///
    /// ```
    /// use parry_continuum::{Chain, proximity::{BvhSearch, Proximity, Side}};
    /// use parry_continuum::parry::{math::Vector, shape::Ball};
    ///
    /// let (vertices, triangles) = Ball::new(10.0).to_trimesh(64, 32);
    /// let search = BvhSearch::from_triangles(&vertices, &triangles)?;
    /// search.prepare();
    /// assert_eq!(search.side(Vector::X), Side::Inside); // without a build
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn prepare(&self) {
        self.mesh.prepare(self.level);
    }

    /// Forgets the last answers: the next query starts without a warm start.
    pub fn forget(&mut self) {
        self.memory.answers.forget();
    }

    /// The work since the engine was built, batches excluded.
    pub fn work(&self) -> Work {
        self.memory.scratch.work
    }

    /// Answers many robots on all cores and writes the results to `out`, in order.
    ///
    /// `out` keeps its old elements, so that `answer` can reuse their memory.
    pub(super) fn batch<R: Sync, T: Send>(
        &mut self,
        robots: &[R],
        out: &mut Vec<Result<T, ProximityError>>,
        unanswered: impl Fn() -> T,
        answer: impl Fn(Context, &R, &mut Result<T, ProximityError>) + Sync + Send,
    ) {
        out.resize_with(robots.len(), || Ok(unanswered()));
        let (level, mesh) = (self.level, &*self.mesh);
        in_chunks(robots, out, &mut self.batch, |memory, robots, out| {
            memory.answers.forget();
            for (robot, out) in robots.iter().zip(out) {
                answer(Context { level, mesh, memory }, robot, out);
            }
        });
    }

    pub(super) fn prepared(&self) -> &PreparedMesh {
        &self.mesh
    }

    pub(super) fn surface_with_lids(&self) -> &Surface {
        self.mesh.surface(self.level)
    }

    pub(super) fn context(&mut self) -> Context<'_> {
        Context { level: self.level, mesh: &self.mesh, memory: &mut self.memory }
    }
}

/// A query's view of the engine: the mesh and the memory.
pub(super) struct Context<'a> {
    level: Level,
    pub mesh: &'a PreparedMesh,
    memory: &'a mut Memory,
}

impl<'a> Context<'a> {
    /// Returns the search in the hierarchy and the warm starts.
    pub fn search(self) -> (MeshSearch<'a>, &'a mut Remembered) {
        let Memory { scratch, answers } = self.memory;
        (MeshSearch::new(self.level, &self.mesh.hierarchy, scratch), answers)
    }

    pub fn per_link(self, robot: PlacedRobot, out: &mut Vec<LinkProximity>) {
        let (search, last) = self.search();
        per_link(search, robot, &mut last.per_link, out);
    }

    fn nearest(self, robot: PlacedRobot, bound: Real) -> Option<LinkProximity> {
        let (search, last) = self.search();
        let (link, nearest) = minimum_within(search, robot, &mut last.minimum, bound)?;
        Some(robot.link(link).answer(link, &nearest))
    }

    pub fn clears(self, robot: PlacedRobot, margin: Real) -> bool {
        let sides = Some(self.mesh.sides());
        let (search, last) = self.search();
        ClearsSearch { search, sides, robot, memory: &mut last.clears }.clears(margin)
    }

    /// Returns the openings of the mesh, with their lids.
    pub fn surface(&self) -> &'a Surface {
        self.mesh.surface(self.level)
    }

    /// Returns whether the robot touches the lid of an opening.
    pub fn touches_lid(self, robot: PlacedRobot) -> bool {
        let Some(lids) = &self.surface().lids else { return false };
        let Memory { scratch, answers } = self.memory;
        let search = MeshSearch::new(self.level, lids, scratch);
        !ClearsSearch { search, sides: None, robot, memory: &mut answers.lids }.clears(0.0)
    }

    /// Writes the distance of every link from the lids of openings to `out`; nothing without
    /// openings.
    pub fn per_link_of_lids(self, robot: PlacedRobot, out: &mut Vec<LinkProximity>) {
        out.clear();
        let Some(lids) = &self.surface().lids else { return };
        let search = MeshSearch::new(self.level, lids, &mut self.memory.scratch);
        per_link(search, robot, &mut PerLinkMemory::default(), out);
    }

    fn within(self, robot: PlacedRobot, query: ContactQuery, out: &mut Vec<Contact>) {
        let across = self.mesh.across();
        let (search, last) = self.search();
        ContactSearch { search, across }.within(robot, query, &mut last.contacts, out);
    }
}

impl Engine for BvhSearch {
    fn mesh(&self) -> &Mesh {
        &self.mesh.hierarchy.mesh
    }

    fn ask_per_link(
        &mut self,
        robot: PlacedRobot,
        out: &mut Vec<LinkProximity>,
    ) -> Result<(), ProximityError> {
        self.context().per_link(robot, out);
        Ok(())
    }

    fn ask_nearest(
        &mut self,
        robot: PlacedRobot,
        bound: Real,
    ) -> Result<Option<LinkProximity>, ProximityError> {
        Ok(self.context().nearest(robot, bound))
    }

    fn ask_clears(&mut self, robot: PlacedRobot, margin: Real) -> Result<bool, ProximityError> {
        Ok(self.context().clears(robot, margin))
    }

    fn ask_contacts(
        &mut self,
        robot: PlacedRobot,
        query: ContactQuery,
        out: &mut Vec<Contact>,
    ) -> Result<(), ProximityError> {
        self.context().within(robot, query, out);
        Ok(())
    }

    fn ask_per_link_batch(
        &mut self,
        robots: &[(&Chain, Pose)],
        out: &mut Vec<Result<Vec<LinkProximity>, ProximityError>>,
    ) -> Result<(), ProximityError> {
        self.batch(robots, out, Vec::new, |context, (robot, pose), out| {
            let mut links = std::mem::replace(out, Ok(Vec::new())).unwrap_or_default();
            *out = PlacedRobot::new(robot, pose).map(|robot| {
                context.per_link(robot, &mut links);
                links
            });
        });
        Ok(())
    }

    fn ask_minimum_batch(
        &mut self,
        robots: &[(&Chain, Pose)],
        out: &mut Vec<Result<LinkProximity, ProximityError>>,
    ) -> Result<(), ProximityError> {
        self.batch(robots, out, LinkProximity::placeholder, |context, (robot, pose), out| {
            let mesh = &context.mesh.hierarchy.mesh;
            *out = PlacedRobot::new(robot, pose).map(|robot| {
                let found = context.nearest(robot, Real::INFINITY);
                found.unwrap_or_else(|| any_triangle(mesh, &robot.link(0)))
            });
        });
        Ok(())
    }

    fn ask_clears_batch(
        &mut self,
        robots: &[(&Chain, Pose)],
        margin: Real,
        out: &mut Vec<Result<bool, ProximityError>>,
    ) -> Result<(), ProximityError> {
        self.batch(
            robots,
            out,
            || false,
            |context, (robot, pose), out| {
                *out = PlacedRobot::new(robot, pose).map(|robot| context.clears(robot, margin));
            },
        );
        Ok(())
    }

    fn move_vertices(&mut self, vertices: &[Vector]) {
        Arc::make_mut(&mut self.mesh).set_vertices(self.level, vertices);
        // The cached distances are about the old mesh.
        self.memory.answers.forget_distances();
    }
}

impl Proximity for BvhSearch {}
