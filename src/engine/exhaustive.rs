//! The exhaustive engine: visits every triangle. The reference for what each query means.
//!
//! # Definitions
//! The robot's links k = 0, 1, .. and the mesh's triangles i = 0, 1, .. are in one frame.
//! - `d(k, i)`: the distance of link k from triangle i, measured in `f64`; 0 if they have a point
//!   in common.
//! - Tuples are compared by their first entries, ties by the next ones.
//!
//! | query | answer | a pass finds |
//! |---|---|---|
//! | `per_link` | for each k the least `(d(k, i), i)` | [`PassGoal::EachLink`] |
//! | `minimum` | the least `(d(k, i), i, k)` | [`PassGoal::Least`] of infinity |
//! | `minimum_within` | the minimum if `d(k, i) <= bound`, otherwise `None` | [`PassGoal::Least`] |
//! | `clears` | whether `d(k, i) > margin` for all k and i | [`PassGoal::Within`] |
//! | `contacts_within` | for each k the local minima along the wall with `d(k, i) <= margin` | [`PassGoal::Every`] |
//!
//! `query/contacts/local_minima.rs` defines a local minimum. `definitions.rs` has each row as a
//! plain loop, and compares the engines with these loops; `contacts_within` only for robots that
//! touch nothing, and without a prominence. The queries of [`BvhSearch`](super::BvhSearch) alone
//! follow from the same distance:
//! - `side` of a point: the sum of the solid angles of all triangles, which `definitions.rs` has
//!   too.
//! - `clearance` of a tube: the least distance of the tube from a triangle. `clears_tube`: whether
//!   this distance exceeds the margin.
//! - `clearance_of_motion`: the least clearance over all times from 0 to 1. `clears_motion`:
//!   whether it exceeds the margin. `time_of_contact`: the first time at which the clearance is
//!   at most the margin.
//!
//! # Algorithm
//! Each query is one [`Pass`] over the blocks of triangles, with a [`PassGoal`]. A pass skips a
//! pair only if a bound proves that `d(k, i)` exceeds the goal's bound or the best distance so far.
//! A batch runs one pass per group of robots, so that a chunk of the mesh serves all their links
//! from the cache.

use super::proximity::{Engine, Proximity, any_triangle, placed};
use crate::answer::{Contact, LinkProximity, MeshError, ProximityError, Work};
use crate::mesh::Mesh;
use crate::pair::PlacedRobot;
use crate::query::contacts::{ContactCollector, ContactMemory, ContactQuery, Wall};
use crate::robot::Chain;
use crate::search::exhaustive::{Kernels, Pass, PassGoal, Triangles, Visit};
use fearless_simd::Level;
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::shape::TriMesh;
use std::iter::once;
use std::sync::Arc;

/// Proximity queries that visit every triangle.
///
/// The work grows with the number of triangles. After the mesh has moved, nothing is built again.
///
/// `T` is the precision of the search, `f64` or `f32`. The engine measures every candidate again in
/// `f64`, so both return the double-precision answer; `f32` is the faster. The kernels take 2 to 16
/// triangles at a time with the widest instructions of the machine, and (feature `parallel`) on all
/// its cores. If single precision is too coarse, because a triangle or the robot lies very far out,
/// the search runs in double precision for any `T`.
///
/// For most triangles a test of their bounding sphere is enough.
///
/// A clone shares the mesh until one of the two moves it.
///
/// ```
/// use parry_continuum::{Chain, proximity::{BvhSearch, Exhaustive, Proximity}};
/// use parry_continuum::parry::{math::{Pose, Vector}, shape::Ball};
///
/// let (vertices, triangles) = Ball::new(10.0).to_trimesh(64, 32);
/// let mut all = Exhaustive::<f32>::from_triangles(&vertices, &triangles)?;
/// let mut search = BvhSearch::from_triangles(&vertices, &triangles)?;
/// let robot = Chain::from_centreline(&[Vector::ZERO, Vector::new(0.0, 0.0, 5.0)], &[0.5])?;
/// let closest = all.minimum(&robot, &Pose::IDENTITY)?;
/// assert_eq!(closest, search.minimum(&robot, &Pose::IDENTITY)?);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Exhaustive<T: SearchPrecision> {
    level: Level,
    triangles: Arc<Triangles<T>>,
    visit: Visit<T>,
    work: Work,
    pass: Pass<T>,
    contact_memory: ContactMemory,
}

/// A precision in which [`Exhaustive`] can search: `f32` or `f64`.
#[allow(private_bounds)] // sealed: nobody else implements it
pub trait SearchPrecision: Kernels {}

impl SearchPrecision for f32 {}
impl SearchPrecision for f64 {}

impl<T: SearchPrecision> Clone for Exhaustive<T> {
    fn clone(&self) -> Self {
        Self {
            level: self.level,
            triangles: Arc::clone(&self.triangles),
            visit: self.visit,
            work: Work::default(),
            pass: Pass::default(),
            contact_memory: ContactMemory::default(),
        }
    }
}

impl<T: SearchPrecision> std::fmt::Debug for Exhaustive<T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let triangles = self.triangles.mesh.len();
        f.debug_struct("Exhaustive").field("triangles", &triangles).finish_non_exhaustive()
    }
}

impl<T: SearchPrecision> Exhaustive<T> {
    /// Builds an engine for `mesh`, whose triangles are copied.
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
    pub fn from_triangles(vertices: &[Vector], triangles: &[[u32; 3]]) -> Result<Self, MeshError> {
        Ok(Self::of(Mesh::from_triangles(vertices, triangles)?))
    }

    fn of(mesh: Mesh) -> Self {
        let level = Level::new();
        Self {
            level,
            triangles: Arc::new(Triangles::new(level, mesh)),
            visit: Visit::culled(),
            work: Work::default(),
            pass: Pass::default(),
            contact_memory: ContactMemory::default(),
        }
    }

    /// Sets whether cheap, exact bounds may skip the narrow phase of a visited triangle (default:
    /// yes).
    ///
    /// Without them every pair of link and triangle costs its full distance, discs included. That
    /// is the work of the paper, for comparison with it.
    #[cfg(feature = "laboratory")]
    #[doc(hidden)]
    pub fn set_culling(&mut self, culling: bool) {
        self.visit = if culling { Visit::culled() } else { Visit::every_pair() };
    }

    /// Sets the instruction set, to compare it with the widest of this machine.
    #[cfg(feature = "laboratory")]
    #[doc(hidden)]
    pub fn set_level(&mut self, level: Level) {
        self.level = level;
    }

    /// The work since the engine was built.
    pub fn work(&self) -> Work {
        self.work
    }

    /// Runs one pass for all links of the robots.
    fn run<'a>(
        &mut self,
        robots: impl Iterator<Item = Result<PlacedRobot<'a>, ProximityError>>,
        aim: PassGoal,
    ) {
        self.work +=
            self.pass.run(self.level, self.visit, &self.triangles, robots, 0..usize::MAX, aim);
    }

    /// Answers many robots, in groups of [`count_at_once`].
    ///
    /// All links of a group visit a chunk of the mesh while the chunk is in the cache. `answer`
    /// gets the index of each accepted robot within its pass.
    fn run_batch<A>(
        &mut self,
        robots: &[(&Chain, Pose)],
        aim: PassGoal,
        out: &mut [Result<A, ProximityError>],
        mut answer: impl FnMut(&Self, usize, &mut Result<A, ProximityError>),
    ) {
        let (mut robots, mut out) = (robots, out);
        while !robots.is_empty() {
            let count = count_at_once(robots);
            let (together, others) = robots.split_at(count);
            let (answers, later) = out.split_at_mut(count);
            self.run(placed(together), aim);
            for (number, out) in answers.iter_mut().enumerate() {
                match self.pass.links_of(number) {
                    Ok(_) => answer(self, number, out),
                    Err(error) => *out = Err(error),
                }
            }
            (robots, out) = (others, later);
        }
    }

    /// The least (distance, triangle, link) of a robot. Of equal ones `min_by` returns the first,
    /// which has the lowest link.
    fn least(&self, number: usize) -> Option<LinkProximity> {
        let order = |a: &LinkProximity, b: &LinkProximity| {
            a.distance.total_cmp(&b.distance).then(a.witness.triangle.cmp(&b.witness.triangle))
        };
        self.pass.answers(number).min_by(order)
    }
}

/// The most links of a batch in one pass, except for a single robot with more links. Each thread
/// keeps its findings per link, so the limit bounds memory.
const LINKS_AT_ONCE: usize = 1 << 12;

/// The number of leading robots that share the next pass, at least one.
fn count_at_once(robots: &[(&Chain, Pose)]) -> usize {
    let mut links = 0;
    let fits = |robot: &Chain| {
        links += robot.links().len();
        links <= LINKS_AT_ONCE
    };
    robots.iter().map(|(robot, _)| *robot).map(fits).take_while(|fits| *fits).count().max(1)
}

impl<T: SearchPrecision> Engine for Exhaustive<T> {
    fn mesh(&self) -> &Mesh {
        &self.triangles.mesh
    }

    fn ask_per_link(
        &mut self,
        robot: PlacedRobot,
        out: &mut Vec<LinkProximity>,
    ) -> Result<(), ProximityError> {
        self.run(once(Ok(robot)), PassGoal::EachLink);
        out.extend(self.pass.answers(0));
        Ok(())
    }

    fn ask_nearest(
        &mut self,
        robot: PlacedRobot,
        bound: Real,
    ) -> Result<Option<LinkProximity>, ProximityError> {
        self.run(once(Ok(robot)), PassGoal::Least(bound));
        Ok(self.least(0))
    }

    fn ask_clears(&mut self, robot: PlacedRobot, margin: Real) -> Result<bool, ProximityError> {
        self.run(once(Ok(robot)), PassGoal::Within(margin));
        Ok(self.pass.is_clear(0))
    }

    fn ask_contacts(
        &mut self,
        robot: PlacedRobot,
        query: ContactQuery,
        out: &mut Vec<Contact>,
    ) -> Result<(), ProximityError> {
        // Takes links together as long as a pass can keep all their pairs within the margin.
        let Self {
            level,
            visit,
            ref triangles,
            ref mut pass,
            ref mut contact_memory,
            ref mut work,
            ..
        } = *self;
        let mut contacts = ContactCollector::new(
            level,
            Wall::of(&triangles.mesh),
            robot,
            query,
            contact_memory,
            out,
        );
        let (links, mut first, mut count) = (robot.links().len(), 0, robot.links().len());
        while first < links {
            let end = first + count;
            *work += pass.run(
                level,
                visit,
                triangles,
                once(Ok(robot)),
                first..end,
                PassGoal::Every(query.margin),
            );
            let Some(within) = pass.within() else {
                count = count.div_ceil(2);
                continue;
            };
            for pairs in within.chunk_by(|one, other| one.0 == other.0) {
                let triangles = pairs.iter().map(|pair| pair.1);
                contacts
                    .add(first + pairs[0].0 as usize, |_, found| found.add_unclassified(triangles));
            }
            first = end;
        }
        work.measured += contacts.finish();
        Ok(())
    }

    fn ask_per_link_batch(
        &mut self,
        robots: &[(&Chain, Pose)],
        out: &mut Vec<Result<Vec<LinkProximity>, ProximityError>>,
    ) -> Result<(), ProximityError> {
        out.resize_with(robots.len(), || Ok(Vec::new()));
        self.run_batch(robots, PassGoal::EachLink, out, |engine, number, out| {
            let mut links = std::mem::replace(out, Ok(Vec::new())).unwrap_or_default();
            links.clear();
            links.extend(engine.pass.answers(number));
            *out = Ok(links);
        });
        Ok(())
    }

    fn ask_minimum_batch(
        &mut self,
        robots: &[(&Chain, Pose)],
        out: &mut Vec<Result<LinkProximity, ProximityError>>,
    ) -> Result<(), ProximityError> {
        out.resize_with(robots.len(), || Ok(LinkProximity::placeholder()));
        self.run_batch(robots, PassGoal::Least(Real::INFINITY), out, |engine, number, out| {
            let least = engine.least(number);
            *out = Ok(least
                .unwrap_or_else(|| any_triangle(engine.mesh(), engine.pass.first_link(number))));
        });
        Ok(())
    }

    fn ask_clears_batch(
        &mut self,
        robots: &[(&Chain, Pose)],
        margin: Real,
        out: &mut Vec<Result<bool, ProximityError>>,
    ) -> Result<(), ProximityError> {
        out.resize_with(robots.len(), || Ok(false));
        self.run_batch(robots, PassGoal::Within(margin), out, |engine, number, out| {
            *out = Ok(engine.pass.is_clear(number));
        });
        Ok(())
    }

    fn move_vertices(&mut self, vertices: &[Vector]) {
        let triangles = Arc::make_mut(&mut self.triangles);
        triangles.mesh.set_vertices(vertices);
        triangles.refill(self.level);
    }
}

impl<T: SearchPrecision> Proximity for Exhaustive<T> {}
