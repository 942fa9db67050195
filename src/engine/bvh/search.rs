//! Proximity by a bounding volume hierarchy.

use super::prepared_mesh::PreparedMesh;
use crate::answer::{Contact, LinkProximity, MeshError, ProximityError, Work};
use crate::engine::{Engine, Proximity, any_triangle};
use crate::mesh::Mesh;
use crate::pair::PlacedRobot;
use crate::query::clearance::TubeMemory;
use crate::query::contacts::{ContactQuery, ContactSearch, LocalMinima};
use crate::query::motion::MotionMemory;
use crate::query::nearest::{
    ClearsMemory, ClearsSearch, PerLinkMemory, WarmStart, minimum_within, per_link,
};
use crate::robot::Chain;
use crate::search::hierarchy::{MeshSearch, Scratch};
use crate::threads::in_chunks;
use fearless_simd::Level;
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::shape::TriMesh;
use std::sync::Arc;

/// Proximity queries by a bounding volume hierarchy: the work per link grows with the logarithm of
/// the number of triangles.
///
/// The engine keeps the mesh and a hierarchy of its own, 16 children and 16 triangles wide, in
/// single precision; what rounding leaves in question is measured in double precision, so the
/// answers are those of [`Exhaustive`](crate::proximity::Exhaustive). Where single precision is too
/// coarse, because a triangle or the robot lies very far out, a second hierarchy in double
/// precision takes its place; it is built when first needed.
///
/// The engine remembers its last answers, which bound the next query: any robot and pose may
/// follow, and small motions are answered fastest. [`BvhSearch::forget`] drops them.
///
/// Some questions need more of the mesh than the hierarchy: it is built when the first of them is
/// asked, or all of it by [`prepare`](Self::prepare), so that no question has to wait for it.
///
/// A clone shares mesh and hierarchy and has a memory of its own, still empty: one for each thread
/// costs nothing. Where [`set_vertices`](Proximity::set_vertices) moves the mesh of one, the others
/// keep theirs.
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
///         scope.spawn(move || search.clears(robot, &Pose::rotation(Vector::X * f64::from(turn)), 1.0));
///     }
/// });
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct BvhSearch {
    level: Level,
    mesh: Arc<PreparedMesh>,
    memory: Memory,
    /// One for each share of a batch.
    batch: Vec<Memory>,
}

/// What one query leaves for the next.
#[derive(Clone, Default)]
pub(super) struct Memory {
    scratch: Scratch,
    answers: Remembered,
}

/// What the last answers say of the next, a field for each question.
#[derive(Clone, Default)]
pub(super) struct Remembered {
    pub per_link: PerLinkMemory,
    pub minimum: WarmStart,
    pub clears: ClearsMemory,
    pub contacts: LocalMinima,
    pub tube: TubeMemory,
    pub motion: MotionMemory,
}

impl Remembered {
    fn forget(&mut self) {
        self.per_link.forget();
        self.minimum.forget();
        self.clears.forget();
        self.tube.forget();
    }

    /// Forgets what only holds as long as the mesh is still.
    fn forget_distances(&mut self) {
        self.minimum.forget_distances();
        self.clears.forget_distances();
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
    /// An engine for `mesh`, whose vertices and triangles are copied.
    ///
    /// # Errors
    /// The mesh has no triangles, or a vertex is not finite or out of range.
    pub fn new(mesh: &TriMesh) -> Result<Self, MeshError> {
        Ok(Self::of(Mesh::new(mesh)?))
    }

    /// An engine for triangles, each given by the positions of its corners among the vertices; both
    /// are copied. It spares the hierarchy that a [`TriMesh`] builds for itself.
    ///
    /// # Errors
    /// There are no triangles, a vertex is not finite or out of range, or a triangle names one that
    /// is not there.
    ///
    /// ```
    /// use parry_continuum::Chain;
    /// use parry_continuum::parry::{math::{Pose, Vector}, shape::TriMesh};
    /// use parry_continuum::proximity::{BvhSearch, Proximity};
    ///
    /// let wall = [Vector::new(-9.0, -9.0, 3.0), Vector::new(9.0, -9.0, 3.0), Vector::new(0.0, 9.0, 3.0)];
    /// let mut search = BvhSearch::from_triangles(&wall, &[[0, 1, 2]])?;
    /// search.set_vertices(&wall.map(|corner| corner + Vector::Z))?;
    /// let robot = Chain::from_centreline(&[Vector::ZERO, Vector::X], &[0.5])?;
    /// let closest = search.minimum(&robot, &Pose::IDENTITY)?;
    /// // A proof against what the engine has now.
    /// let mesh = TriMesh::new(search.vertices().to_vec(), search.triangles().to_vec())?;
    /// let proof = closest.certify(&robot, &Pose::IDENTITY, &mesh)?;
    /// assert!(proof.lower <= 3.5 && 3.5 <= proof.upper);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn from_triangles(vertices: &[Vector], triangles: &[[u32; 3]]) -> Result<Self, MeshError> {
        Ok(Self::of(Mesh::from_triangles(vertices, triangles)?))
    }

    fn of(mesh: Mesh) -> Self {
        let level = Level::new();
        let mesh = Arc::new(PreparedMesh::new(level, mesh));
        Self { level, mesh, memory: Memory::default(), batch: Vec::new() }
    }

    /// Builds all that a question would build when it is first asked, so that none has to wait;
    /// clones share it. Call it after [`set_vertices`](Proximity::set_vertices) too: what
    /// depends on where the vertices are is built anew.
    ///
    /// | question | what it needs beside the hierarchy |
    /// |---|---|
    /// | [`clears`](Proximity::clears) | roughly which space lies on which side of the wall |
    /// | [`within`](Proximity::within) | which triangles share corners and edges |
    /// | [`side`](Self::side) | what each part of the mesh is from far away |
    /// | any, about a robot so far away that single precision does not resolve it | a second hierarchy, in double precision |
    ///
    /// ```
    /// use parry_continuum::{Chain, proximity::{BvhSearch, Proximity, Side}};
    /// use parry_continuum::parry::{math::Vector, shape::Ball};
    ///
    /// let (vertices, triangles) = Ball::new(10.0).to_trimesh(64, 32);
    /// let search = BvhSearch::from_triangles(&vertices, &triangles)?;
    /// search.prepare();
    /// assert_eq!(search.side(Vector::X), Side::Inside); // at once
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn prepare(&self) {
        self.mesh.prepare(self.level);
    }

    /// Forgets the last answers, so that the next query starts without bounds.
    pub fn forget(&mut self) {
        self.memory.answers.forget();
    }

    /// How much was computed since the engine was built, batches left out.
    pub fn work(&self) -> Work {
        self.memory.scratch.work
    }

    /// The answers about many robots, on all cores. `out` gets them in order; what it had is there
    /// to be used again.
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

    /// Whether a robot keeps more than `margin`, for one that is likely to: neither is it first
    /// asked about where it seems to pass through the wall, nor does what the last query proved
    /// count.
    pub(crate) fn clears_unless_crossing(&mut self, robot: PlacedRobot, margin: Real) -> bool {
        let (search, last) = self.context().search();
        ClearsSearch { search, sides: None, robot, memory: &mut last.clears }
            .cleared_by(margin)
            .is_some()
    }

    pub(super) fn prepared(&self) -> &PreparedMesh {
        &self.mesh
    }

    pub(super) fn context(&mut self) -> Context<'_> {
        Context { level: self.level, mesh: &self.mesh, memory: &mut self.memory }
    }
}

/// What a query asks through: the mesh, and what the last one left.
pub(super) struct Context<'a> {
    level: Level,
    pub mesh: &'a PreparedMesh,
    memory: &'a mut Memory,
}

impl<'a> Context<'a> {
    /// The search in the hierarchy, and what the last answers say.
    pub fn search(self) -> (MeshSearch<'a>, &'a mut Remembered) {
        let Memory { scratch, answers } = self.memory;
        (MeshSearch::new(self.level, &self.mesh.hierarchy, scratch), answers)
    }

    fn per_link(self, robot: PlacedRobot, out: &mut Vec<LinkProximity>) {
        let (search, last) = self.search();
        per_link(search, robot, &mut last.per_link, out);
    }

    fn nearest(self, robot: PlacedRobot, bound: Real) -> Option<LinkProximity> {
        let (search, last) = self.search();
        let (link, nearest) = minimum_within(search, robot, &mut last.minimum, bound)?;
        Some(robot.link(link).answer(link, &nearest))
    }

    fn clears(self, robot: PlacedRobot, margin: Real) -> bool {
        let sides = Some(self.mesh.sides());
        let (search, last) = self.search();
        ClearsSearch { search, sides, robot, memory: &mut last.clears }.clears(margin)
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
        // It spoke of the mesh as it was.
        self.memory.answers.forget_distances();
    }
}

impl Proximity for BvhSearch {}
