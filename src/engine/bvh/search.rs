//! Proximity by a bounding volume hierarchy.

use crate::Chain;
use crate::answer::{Contact, LinkProximity, MeshError, ProximityError, Work};
use crate::engine::{HasMesh, Proximity};
use crate::mesh::Mesh;
use crate::pair::{PlacedRobot, check_bound, check_margin};
use crate::query::clearance::TubeMemory;
use crate::query::contacts::LocalMinima;
use crate::query::motion::MotionMemory;
use crate::query::nearest::memory::KeptDistances;
use crate::query::nearest::{FewEach, MinimumSearch, OfLink, RobotSearch};
use crate::search::hierarchy::{Hierarchy, MeshSearch, Scratch};
use crate::threads::in_shares;
use fearless_simd::Level;
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::shape::TriMesh;
use std::sync::Arc;

/// Proximity queries by a bounding volume hierarchy: the work per link grows with the logarithm of the number of
/// triangles.
///
/// The engine keeps the mesh and a hierarchy of its own, 16 children and 16 triangles wide, in single precision;
/// what rounding leaves in question is measured in double precision, so the answers are those of
/// [`Exhaustive`](crate::proximity::Exhaustive). Where single precision is too coarse, because a triangle or the robot
/// lies very far out, a second hierarchy in double precision takes its place; it is built when first needed.
///
/// The engine remembers its last answers, which bound the next query: any robot and pose may follow, and small motions
/// are answered fastest. [`BvhSearch::forget`] drops them.
///
/// Once some tens of robots did not keep away from the mesh, as is common for a planner, the engine notes roughly which
/// space lies on which side of the wall, so that [`clears`](Proximity::clears) looks first where a robot passes through it.
/// That takes milliseconds once, 30 for a million triangles, and at most 300 kB.
///
/// A clone shares mesh and hierarchy and has a memory of its own, still empty: one for each thread costs nothing. Where
/// [`set_vertices`](Proximity::set_vertices) moves the mesh of one, the others keep theirs.
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
    hierarchy: Arc<Hierarchy>,
    memory: Memory,
    /// One for each share of a batch.
    batch: Vec<Memory>,
}

/// What one query leaves for the next.
#[derive(Clone, Default)]
pub(crate) struct Memory {
    pub scratch: Scratch,
    pub tube: TubeMemory,
    pub motion: MotionMemory,
    minima: LocalMinima,
    few: FewEach,
    /// The closest triangle of each link at the last query.
    last: Vec<u32>,
    /// The closest link and its triangle at the last query for the minimum.
    last_minimum: Option<(usize, u32)>,
    /// What the links kept when it was last asked for the minimum, and whether they keep away.
    kept_by_minimum: KeptDistances,
    kept_by_clears: KeptDistances,
}

impl Memory {
    pub(crate) fn forget(&mut self) {
        self.forget_distances();
        self.tube.forget();
        self.scratch.forget();
        self.last.clear();
        self.last_minimum = None;
    }

    /// Forgets what only holds as long as the mesh is still.
    fn forget_distances(&mut self) {
        self.kept_by_minimum.forget();
        self.kept_by_clears.forget();
    }
}

impl Clone for BvhSearch {
    fn clone(&self) -> Self {
        Self {
            level: self.level,
            hierarchy: Arc::clone(&self.hierarchy),
            memory: Memory::default(),
            batch: Vec::new(),
        }
    }
}

impl std::fmt::Debug for BvhSearch {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("BvhSearch").field("triangles", &self.hierarchy.mesh.len()).finish_non_exhaustive()
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

    /// An engine for triangles, each given by the positions of its corners among the vertices; both are copied. It spares
    /// the hierarchy that a [`TriMesh`] builds for itself.
    ///
    /// # Errors
    /// There are no triangles, a vertex is not finite or out of range, or a triangle names one that is not there.
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
        let hierarchy = Arc::new(Hierarchy::new(level, mesh));
        Self { level, hierarchy, memory: Memory::default(), batch: Vec::new() }
    }

    /// Forgets the last answers, so that the next query starts without bounds.
    pub fn forget(&mut self) {
        self.memory.forget();
    }

    /// How much was computed since the engine was built, batches left out.
    pub fn work(&self) -> Work {
        self.memory.scratch.work
    }

    /// The answers about many robots, on all cores.
    ///
    /// # Errors
    /// Those of the first robot that has one; `out` is then empty.
    pub(crate) fn batch<R: Sync, T: Send>(
        &mut self,
        robots: &[R],
        out: &mut Vec<T>,
        unanswered: impl Fn() -> T,
        answer: impl Fn(Context, &R, &mut T) -> Result<(), ProximityError> + Sync + Send,
    ) -> Result<(), ProximityError> {
        out.resize_with(robots.len(), unanswered);
        let (level, hierarchy) = (self.level, &*self.hierarchy);
        let result = in_shares(robots, out, &mut self.batch, |memory, robots, out| {
            memory.forget();
            let mut pairs = robots.iter().zip(out);
            pairs.try_for_each(|(robot, out)| answer(Context { level, hierarchy, memory }, robot, out))
        });
        result.inspect_err(|_| out.clear())
    }

    pub(crate) fn hierarchy(&self) -> &Hierarchy {
        &self.hierarchy
    }

    pub(crate) fn context(&mut self) -> Context<'_> {
        Context { level: self.level, hierarchy: &self.hierarchy, memory: &mut self.memory }
    }

    fn query<'a>(&'a mut self, robot: &'a Chain, pose: &'a Pose) -> Result<Query<'a>, ProximityError> {
        Query::new(self.context(), robot, pose)
    }
}

/// What a query asks through: the mesh, and what the last one left.
pub(crate) struct Context<'a> {
    pub level: Level,
    pub hierarchy: &'a Hierarchy,
    pub memory: &'a mut Memory,
}

/// One robot asked about.
struct Query<'a> {
    context: Context<'a>,
    robot: PlacedRobot<'a>,
}

impl<'a> Query<'a> {
    fn new(context: Context<'a>, robot: &'a Chain, pose: &'a Pose) -> Result<Self, ProximityError> {
        Ok(Self { context, robot: PlacedRobot::new(robot, pose)? })
    }

    fn per_link(&mut self, out: &mut Vec<LinkProximity>) {
        out.clear();
        let Context { level, hierarchy, ref mut memory } = self.context;
        let Memory { scratch, few, last, .. } = &mut **memory;
        let search = MeshSearch { level, hierarchy, scratch };
        RobotSearch { search, robot: self.robot }.per_link(last, few, out);
        last.clear();
        last.extend(out.iter().map(|answer| answer.triangle));
    }

    fn minimum(&mut self) -> LinkProximity {
        let found = self.nearest_link(Real::INFINITY);
        let (link, nearest) = found.unwrap_or_else(|| {
            let first = self.robot.link(0);
            (0, self.search().search.any(&first))
        });
        nearest.report(link)
    }

    fn minimum_within(&mut self, bound: Real) -> Option<LinkProximity> {
        self.nearest_link(bound).map(|(link, nearest)| nearest.report(link))
    }

    fn nearest_link(&mut self, bound: Real) -> Option<OfLink> {
        let Context { level, hierarchy, ref mut memory } = self.context;
        let Memory { scratch, last_minimum, kept_by_minimum, .. } = &mut **memory;
        let search = MeshSearch { level, hierarchy, scratch };
        let found = MinimumSearch::within(bound, search, self.robot, kept_by_minimum).nearest(*last_minimum);
        if let Some((link, nearest)) = found {
            *last_minimum = Some((link, nearest.triangle));
        }
        found
    }

    fn clears(&mut self, margin: Real) -> bool {
        let (robot, reach) = (self.robot, self.context.hierarchy.reach);
        let kept = &mut self.context.memory.kept_by_clears;
        if kept.all_keep(robot, margin) {
            return true;
        }
        if let Some(wider) = kept.wider(robot, margin, Real::INFINITY, reach) {
            let known = self.search().clears(margin + wider);
            let kept = &mut self.context.memory.kept_by_clears;
            if let Some(known) = known {
                kept.keep_all(robot, margin + wider, known, reach);
                return true;
            }
            kept.miss();
        }
        self.search().clears(margin).is_some()
    }

    fn within(&mut self, margin: Real, out: &mut Vec<Contact>) {
        let Context { level, hierarchy, ref mut memory } = self.context;
        let Memory { scratch, minima, .. } = &mut **memory;
        let search = MeshSearch { level, hierarchy, scratch };
        RobotSearch { search, robot: self.robot }.within(margin, minima, out);
    }

    fn search(&mut self) -> RobotSearch<'_> {
        let Context { level, hierarchy, ref mut memory } = self.context;
        RobotSearch {
            search: MeshSearch { level, hierarchy, scratch: &mut memory.scratch },
            robot: self.robot,
        }
    }
}

impl HasMesh for BvhSearch {
    fn mesh(&self) -> &Mesh {
        &self.hierarchy.mesh
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
        self.query(robot, pose)?.per_link(out);
        Ok(())
    }

    fn minimum(&mut self, robot: &Chain, pose: &Pose) -> Result<LinkProximity, ProximityError> {
        Ok(self.query(robot, pose)?.minimum())
    }

    fn minimum_within(
        &mut self,
        robot: &Chain,
        pose: &Pose,
        bound: Real,
    ) -> Result<Option<LinkProximity>, ProximityError> {
        check_bound(bound)?;
        let mut query = self.query(robot, pose)?;
        Ok(if bound < 0.0 { None } else { query.minimum_within(bound) })
    }

    fn clears(&mut self, robot: &Chain, pose: &Pose, margin: Real) -> Result<bool, ProximityError> {
        check_margin(margin)?;
        Ok(self.query(robot, pose)?.clears(margin))
    }

    fn within(
        &mut self,
        robot: &Chain,
        pose: &Pose,
        margin: Real,
        out: &mut Vec<Contact>,
    ) -> Result<(), ProximityError> {
        out.clear();
        check_margin(margin)?;
        self.query(robot, pose)?.within(margin, out);
        Ok(())
    }

    fn per_link_batch(
        &mut self,
        robots: &[(&Chain, Pose)],
        out: &mut Vec<Vec<LinkProximity>>,
    ) -> Result<(), ProximityError> {
        self.batch(robots, out, Vec::new, |context, (robot, pose), out| {
            Query::new(context, robot, pose)?.per_link(out);
            Ok(())
        })
    }

    fn minimum_batch(
        &mut self,
        robots: &[(&Chain, Pose)],
        out: &mut Vec<LinkProximity>,
    ) -> Result<(), ProximityError> {
        self.batch(robots, out, LinkProximity::unanswered, |context, (robot, pose), out| {
            *out = Query::new(context, robot, pose)?.minimum();
            Ok(())
        })
    }

    fn clears_batch(
        &mut self,
        robots: &[(&Chain, Pose)],
        margin: Real,
        out: &mut Vec<bool>,
    ) -> Result<(), ProximityError> {
        out.clear();
        check_margin(margin)?;
        self.batch(
            robots,
            out,
            || false,
            |context, (robot, pose), out| {
                *out = Query::new(context, robot, pose)?.clears(margin);
                Ok(())
            },
        )
    }

    fn set_vertices(&mut self, vertices: &[Vector]) -> Result<(), MeshError> {
        self.hierarchy.mesh.check_moved(vertices)?;
        let hierarchy = Arc::make_mut(&mut self.hierarchy);
        hierarchy.mesh.set_vertices(vertices);
        hierarchy.refit(self.level);
        // It spoke of the mesh as it was.
        self.memory.forget_distances();
        Ok(())
    }
}
