//! Proximity by looking at every triangle.

use super::blocks::Blocks;
use super::kernels::Kernels;
use super::scan::{Findings, Job, JobLink, SharedBound};
use crate::Chain;
use crate::distance::Scalar;
use crate::proximity::checks::check_margin;
use crate::proximity::mesh::Mesh;
use crate::proximity::placed::{Nearest, PlacedLink, PlacedRobot};
use crate::proximity::search_frame::SearchLink;
use crate::proximity::{LinkProximity, MeshError, Proximity, ProximityError, Work};
use fearless_simd::Level;
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::shape::TriMesh;
#[cfg(feature = "parallel")]
use rayon::prelude::*;
use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock};

/// Proximity queries that visit every triangle: the work grows with the number of triangles, and moving the
/// mesh leaves nothing to be built anew.
///
/// `T` is the precision of the search, `f64` or `f32`. What rounding leaves in question is measured again in
/// `f64`, so both return the double-precision answer, and `f32` is the faster. Triangles are taken 2 to 16 at a
/// time with the widest instructions of the machine, and (feature `parallel`) on all its cores. Where single precision
/// is too coarse, because a triangle or the robot lies very far out, the search is in double precision whatever `T`.
///
/// Every triangle is visited, but most need no more than a look at the sphere around them; see
/// [`Exhaustive::set_culling`].
///
/// A clone shares the mesh, until one of them moves it.
pub struct Exhaustive<T: SearchPrecision> {
    level: Level,
    triangles: Arc<Triangles<T>>,
    culling: bool,
    work: Work,
    scratch: Scratch<T>,
}

/// A precision in which [`Exhaustive`] can search: `f32` or `f64`.
#[allow(private_bounds)] // sealed: nobody else implements it
pub trait SearchPrecision: Kernels {}

impl SearchPrecision for f32 {}
impl SearchPrecision for f64 {}

/// A mesh in the precision of the search.
#[derive(Clone)]
struct Triangles<T> {
    mesh: Mesh,
    blocks: Blocks<T>,
    /// For links that single precision does not resolve, filled when the first of them comes.
    double: OnceLock<Blocks<f64>>,
}

impl<T: Kernels> Triangles<T> {
    fn double(&self, level: Level) -> &Blocks<f64> {
        self.double
            .get_or_init(|| Blocks::new(&self.mesh, |faces, spheres| f64::prepare(level, faces, spheres)))
    }

    fn refill(&mut self, level: Level) {
        self.blocks.refill(&self.mesh, |faces, spheres| T::prepare(level, faces, spheres));
        if let Some(double) = self.double.get_mut() {
            double.refill(&self.mesh, |faces, spheres| f64::prepare(level, faces, spheres));
        }
    }
}

/// Memory of the last query, used again.
struct Scratch<T> {
    links: Vec<JobLink<T>>,
    /// Links that the precision `T` does not resolve.
    double: Vec<JobLink<f64>>,
    /// The links of each robot.
    robots: Vec<Range<usize>>,
    bounds: Vec<SharedBound>,
    /// One for each thread.
    findings: Vec<Findings>,
}

impl<T> Default for Scratch<T> {
    fn default() -> Self {
        Self {
            links: Vec::new(),
            double: Vec::new(),
            robots: Vec::new(),
            bounds: Vec::new(),
            findings: Vec::new(),
        }
    }
}

/// What a scan looks for.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Aim {
    /// The nearest triangle of every link.
    EachLink,
    /// The nearest triangle of all links of a robot together.
    Least,
    /// Any triangle within the bound, for each robot.
    Any,
}

/// Fewer pairs than this are not worth a second thread.
#[cfg(feature = "parallel")]
const PAIRS_PER_THREAD: usize = 1 << 17;

impl<T: SearchPrecision> Clone for Exhaustive<T> {
    fn clone(&self) -> Self {
        Self {
            level: self.level,
            triangles: Arc::clone(&self.triangles),
            culling: self.culling,
            work: Work::default(),
            scratch: Scratch::default(),
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
    /// An engine for `mesh`, whose triangles are copied.
    ///
    /// # Errors
    /// The mesh has no triangles, or a vertex is not finite or out of range.
    pub fn new(mesh: &TriMesh) -> Result<Self, MeshError> {
        let (level, mesh) = (Level::new(), Mesh::new(mesh)?);
        let blocks = Blocks::new(&mesh, |faces, spheres| T::prepare(level, faces, spheres));
        let triangles = Arc::new(Triangles { mesh, blocks, double: OnceLock::new() });
        Ok(Self { level, triangles, culling: true, work: Work::default(), scratch: Scratch::default() })
    }

    /// Whether cheap, exact bounds may spare a visited triangle its narrow phase. They may unless told otherwise.
    ///
    /// Without them every pair of link and triangle costs its full distance, discs included: the work of the
    /// paper, for comparison with it.
    pub fn set_culling(&mut self, culling: bool) {
        self.culling = culling;
    }

    /// Uses another instruction set than the widest of this machine: for the comparison of instruction sets.
    #[doc(hidden)]
    pub fn set_level(&mut self, level: Level) {
        self.level = level;
    }

    /// How much was computed since the engine was built.
    pub fn work(&self) -> Work {
        self.work
    }

    /// Looks among the triangles at most `bound` away. The answers stand in `scratch.findings[0]`.
    fn scan<'a>(
        &mut self,
        robots: impl Iterator<Item = (&'a Chain, &'a Pose)>,
        aim: Aim,
        bound: Real,
    ) -> Result<(), ProximityError> {
        let links = self.place(robots, aim)?;
        let Self { level, culling, .. } = *self;
        let triangles = &*self.triangles;
        let Scratch { links: resolved, double, bounds, findings, robots } = &mut self.scratch;
        bounds.clear();
        bounds
            .resize_with(if aim == Aim::EachLink { links } else { robots.len() }, || SharedBound::new(bound));
        findings.resize_with(threads(links * triangles.mesh.len()), Findings::default);
        for findings in &mut *findings {
            findings.work = Work::default();
            findings.nearest.clear();
            findings.nearest.resize(links, None);
        }
        let (mesh, stop_at_first) = (&triangles.mesh, aim == Aim::Any);
        let job = Job { mesh, blocks: &triangles.blocks, links: resolved, bounds, stop_at_first };
        run(level, culling, &job, findings);
        if !double.is_empty() {
            let blocks = triangles.double(level);
            run(level, culling, &Job { mesh, blocks, links: double, bounds, stop_at_first }, findings);
        }
        let (first, others) = findings.split_at_mut(1);
        for other in others {
            first[0].merge(other);
        }
        self.work += first[0].work;
        Ok(())
    }

    /// Sorts the robots' links by the precision that resolves them, and counts them.
    fn place<'a>(
        &mut self,
        robots: impl Iterator<Item = (&'a Chain, &'a Pose)>,
        aim: Aim,
    ) -> Result<usize, ProximityError> {
        let Scratch { links, double, robots: ranges, .. } = &mut self.scratch;
        links.clear();
        double.clear();
        ranges.clear();
        let frame = &self.triangles.blocks.frame;
        let is_double = T::UNIT_ROUNDOFF <= f64::UNIT_ROUNDOFF;
        let mut place = 0;
        for (number, (robot, pose)) in robots.enumerate() {
            let first = place;
            for link in PlacedRobot::new(robot, pose)?.placed_links() {
                let bound = if aim == Aim::EachLink { place } else { number };
                let searched = SearchLink::new(&link, frame);
                if is_double || searched.as_ref().is_some_and(|searched| frame.resolves(searched)) {
                    links.push(JobLink { link, searched, place, bound });
                } else {
                    let searched = SearchLink::new(&link, &self.triangles.double(self.level).frame);
                    double.push(JobLink { link, searched, place, bound });
                }
                place += 1;
            }
            ranges.push(first..place);
        }
        Ok(place)
    }

    /// What [`Exhaustive::scan`] found for a link.
    fn found(&self, place: usize) -> Option<Nearest> {
        self.scratch.findings[0].nearest[place]
    }

    /// The nearest triangle of each link of a robot of the scan.
    fn answers(&self, robot: usize) -> impl Iterator<Item = LinkProximity> {
        let places = self.scratch.robots[robot].clone();
        // Without a bound some triangle is always the nearest.
        places.enumerate().filter_map(|(link, place)| Some(self.found(place)?.report(link)))
    }

    /// The nearest of a robot's links; of several the one with the lowest triangle, then the lowest link.
    fn least(&self, robot: &Chain, pose: &Pose, number: usize) -> LinkProximity {
        let order = |a: &LinkProximity, b: &LinkProximity| {
            a.distance.total_cmp(&b.distance).then(a.triangle.cmp(&b.triangle))
        };
        self.answers(number).min_by(order).unwrap_or_else(|| {
            // Without a bound some triangle is always the nearest; this is any other.
            let link = PlacedLink::new(&robot.links()[0], pose);
            link.measure(0, self.triangles.mesh.corners(0)).report(0)
        })
    }

    /// Whether nothing was found for a robot.
    fn is_clear(&self, robot: usize) -> bool {
        self.scratch.robots[robot].clone().all(|place| self.found(place).is_none())
    }
}

/// How many threads are worth while.
fn threads(pairs: usize) -> usize {
    #[cfg(feature = "parallel")]
    return rayon::current_num_threads().min(1 + pairs / PAIRS_PER_THREAD);
    #[cfg(not(feature = "parallel"))]
    return pairs.min(1).max(1);
}

/// Has every thread take the next chunk until there is none.
fn run<E: Kernels>(level: Level, culling: bool, job: &Job<E>, findings: &mut [Findings]) {
    if culling && !job.stop_at_first {
        E::first_bounds(level, job);
    }
    let next = AtomicUsize::new(0);
    let work = |findings: &mut Findings| {
        loop {
            let chunk = next.fetch_add(1, Ordering::Relaxed);
            if chunk >= job.chunks() {
                break;
            }
            if culling {
                E::scan(level, job, chunk, findings);
            } else {
                E::scan_every_pair(level, job, chunk, findings);
            }
        }
    };
    #[cfg(feature = "parallel")]
    if findings.len() > 1 {
        return findings.par_iter_mut().for_each(work);
    }
    findings.iter_mut().for_each(work);
}

impl<T: SearchPrecision> Proximity for Exhaustive<T> {
    fn per_link(
        &mut self,
        robot: &Chain,
        pose: &Pose,
        out: &mut Vec<LinkProximity>,
    ) -> Result<(), ProximityError> {
        out.clear();
        self.scan(std::iter::once((robot, pose)), Aim::EachLink, Real::INFINITY)?;
        out.extend(self.answers(0));
        Ok(())
    }

    fn minimum(&mut self, robot: &Chain, pose: &Pose) -> Result<LinkProximity, ProximityError> {
        self.scan(std::iter::once((robot, pose)), Aim::Least, Real::INFINITY)?;
        Ok(self.least(robot, pose, 0))
    }

    fn clears(&mut self, robot: &Chain, pose: &Pose, margin: Real) -> Result<bool, ProximityError> {
        check_margin(margin)?;
        self.scan(std::iter::once((robot, pose)), Aim::Any, margin)?;
        Ok(self.is_clear(0))
    }

    fn per_link_batch(
        &mut self,
        robots: &[(&Chain, Pose)],
        out: &mut Vec<Vec<LinkProximity>>,
    ) -> Result<(), ProximityError> {
        // All links of all robots meet a chunk of the mesh while it is in the cache.
        self.scan(pairs(robots), Aim::EachLink, Real::INFINITY).inspect_err(|_| out.clear())?;
        out.resize_with(robots.len(), Vec::new);
        for (robot, answers) in out.iter_mut().enumerate() {
            answers.clear();
            answers.extend(self.answers(robot));
        }
        Ok(())
    }

    fn minimum_batch(
        &mut self,
        robots: &[(&Chain, Pose)],
        out: &mut Vec<LinkProximity>,
    ) -> Result<(), ProximityError> {
        out.clear();
        self.scan(pairs(robots), Aim::Least, Real::INFINITY)?;
        out.extend(pairs(robots).enumerate().map(|(number, (robot, pose))| self.least(robot, pose, number)));
        Ok(())
    }

    fn clears_batch(
        &mut self,
        robots: &[(&Chain, Pose)],
        margin: Real,
        out: &mut Vec<bool>,
    ) -> Result<(), ProximityError> {
        out.clear();
        check_margin(margin)?;
        self.scan(pairs(robots), Aim::Any, margin)?;
        out.extend((0..robots.len()).map(|robot| self.is_clear(robot)));
        Ok(())
    }

    fn set_vertices(&mut self, vertices: &[Vector]) -> Result<(), MeshError> {
        self.triangles.mesh.check_moved(vertices)?;
        let triangles = Arc::make_mut(&mut self.triangles);
        triangles.mesh.set_vertices(vertices);
        triangles.refill(self.level);
        Ok(())
    }
}

/// The robots of a batch, one by one.
fn pairs<'a>(robots: &'a [(&Chain, Pose)]) -> impl Iterator<Item = (&'a Chain, &'a Pose)> {
    robots.iter().map(|(robot, pose)| (*robot, pose))
}
