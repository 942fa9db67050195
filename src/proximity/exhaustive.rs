//! Proximity by looking at every triangle, as the paper does on parallel hardware.

use super::coarse::CoarseLink;
use super::probe::Found;
use super::probe::{Probe, check_margin, check_moved, check_vertices, place};
use super::scan::{Findings, Job, Scan, SharedBound, Work};
use super::soa::SoaMesh;
use super::{LinkProximity, MeshError, Proximity, ProximityError};
use crate::Chain;
use crate::distance::{Convex, DiscSolver};
use fearless_simd::{Level, dispatch};
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::shape::TriMesh;
#[cfg(feature = "parallel")]
use rayon::prelude::*;
use std::marker::PhantomData;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Proximity queries that visit every triangle: the work grows with the number of triangles, and moving the
/// mesh leaves nothing to be built anew.
///
/// `T` is the precision of the search, `f64` or `f32`. What rounding leaves in question is measured again in
/// `f64`, so both return the double-precision answer, and `f32` is the faster. Triangles are taken 2 to 16 at a
/// time with the widest instructions of the machine, and (feature `parallel`) on all its cores.
///
/// Every triangle is visited, but most need no more than a look at the sphere around them; see
/// [`Exhaustive::set_culling`].
///
/// `S` is the route to the discs of flat caps, one of [`distance`](crate::distance) or
/// [`roots`](crate::roots). All but the default are there to be compared with it: they compute one disc at a time, and the
/// answers are no more exact than the route.
pub struct Exhaustive<T: Precision, S = Convex> {
    level: Level,
    vertices: Vec<Vector>,
    indices: Vec<[u32; 3]>,
    /// The largest coordinate of the mesh.
    reach: Real,
    mesh: SoaMesh<T>,
    culling: bool,
    work: Work,
    scratch: Scratch<T>,
    solver: PhantomData<fn() -> S>,
}

/// A precision in which [`Exhaustive`] can search: `f32` or `f64`.
#[allow(private_bounds)] // sealed: nobody else implements it
pub trait Precision: Scan {}

impl Precision for f32 {}
impl Precision for f64 {}

/// Memory of the last query, used again.
struct Scratch<T> {
    probes: Vec<Probe>,
    links: Vec<(Probe, Option<CoarseLink<T>>)>,
    bounds: Vec<SharedBound>,
    /// One for each thread.
    findings: Vec<Findings>,
}

/// What a scan looks for.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Aim {
    /// The nearest triangle of every link.
    EachLink,
    /// The nearest triangle of all links together.
    Least,
    /// Any triangle nearer than the bound.
    Any,
}

/// Fewer pairs than this are not worth a second thread.
#[cfg(feature = "parallel")]
const PAIRS_PER_THREAD: usize = 1 << 17;

impl<T: Precision> Exhaustive<T> {
    /// An engine for `mesh`, whose triangles are copied.
    ///
    /// # Errors
    /// The mesh has no triangles, or a vertex is not finite or out of range.
    pub fn new(mesh: &TriMesh) -> Result<Self, MeshError> {
        Self::with_solver(mesh)
    }
}

impl<T: Precision, S: DiscSolver<T> + DiscSolver<f64>> Exhaustive<T, S> {
    /// As [`Exhaustive::new`], for a route to the discs other than the default.
    ///
    /// # Errors
    /// As [`Exhaustive::new`].
    pub fn with_solver(mesh: &TriMesh) -> Result<Self, MeshError> {
        if mesh.indices().is_empty() {
            return Err(MeshError::Empty);
        }
        let reach = check_vertices(mesh.vertices())?;
        let level = Level::new();
        Ok(Self {
            level,
            vertices: mesh.vertices().to_vec(),
            indices: mesh.indices().to_vec(),
            reach,
            mesh: SoaMesh::new(level, mesh.vertices(), mesh.indices()),
            culling: true,
            work: Work::default(),
            scratch: Scratch {
                probes: Vec::new(),
                links: Vec::new(),
                bounds: Vec::new(),
                findings: Vec::new(),
            },
            solver: PhantomData,
        })
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

    /// Makes probes of a robot's links and appends them to `scratch.links`.
    fn place(&mut self, robot: &Chain, pose: &Pose) -> Result<(), ProximityError> {
        place(robot.links(), pose, self.reach, &mut self.scratch.probes)?;
        for probe in &self.scratch.probes {
            self.scratch.links.push((*probe, CoarseLink::new(probe, &self.mesh.frame)));
        }
        Ok(())
    }

    /// Looks among the triangles strictly nearer than `bound` to a link of `scratch.links`. The answers stand in
    /// `scratch.findings[0]`.
    fn scan(&mut self, bound: Real, aim: Aim) {
        let together = aim != Aim::EachLink;
        let Scratch { links, bounds, findings, .. } = &mut self.scratch;
        bounds.clear();
        bounds.resize_with(if together { 1 } else { links.len() }, || SharedBound::new(bound));
        let job = Job {
            mesh: &self.mesh,
            vertices: &self.vertices,
            indices: &self.indices,
            links,
            bounds,
            stop_at_first: aim == Aim::Any,
            nearer_than: Probe::nearer_than_by::<S>,
        };
        #[cfg(feature = "parallel")]
        let threads =
            rayon::current_num_threads().min(1 + links.len() * self.indices.len() / PAIRS_PER_THREAD);
        #[cfg(not(feature = "parallel"))]
        let threads = 1;
        findings.resize_with(threads, Findings::default);

        let (level, culling, next) = (self.level, self.culling, AtomicUsize::new(0));
        if culling && aim != Aim::Any {
            T::first_bounds(level, &job);
        }
        let run = |findings: &mut Findings| {
            findings.work = Work::default();
            findings.nearest.clear();
            findings.nearest.resize(job.links.len(), None);
            loop {
                let chunk = next.fetch_add(1, Ordering::Relaxed);
                if chunk >= job.chunks() {
                    break;
                }
                if culling {
                    T::scan(level, &job, chunk, findings);
                } else {
                    dispatch!(level, simd => job.scan::<T::Pack<_>, S, false>(simd, chunk, findings));
                }
            }
        };
        #[cfg(feature = "parallel")]
        if threads > 1 {
            findings.par_iter_mut().for_each(run);
        } else {
            findings.iter_mut().for_each(run);
        }
        #[cfg(not(feature = "parallel"))]
        findings.iter_mut().for_each(run);

        let (first, others) = findings.split_at_mut(1);
        for other in others {
            first[0].merge(other);
        }
        self.work += first[0].work;
    }

    /// What [`Exhaustive::scan`] found for a link.
    fn found(&self, link: usize) -> Option<Found> {
        self.scratch.findings[0].nearest[link]
    }
}

impl<T: Precision, S: DiscSolver<T> + DiscSolver<f64>> Proximity for Exhaustive<T, S> {
    fn per_link(
        &mut self,
        robot: &Chain,
        pose: &Pose,
        out: &mut Vec<LinkProximity>,
    ) -> Result<(), ProximityError> {
        out.clear();
        self.scratch.links.clear();
        self.place(robot, pose)?;
        self.scan(Real::INFINITY, Aim::EachLink);
        // Without a bound some triangle is always the nearest.
        let answer = |(link, (probe, _)): (usize, &(Probe, _))| Some(probe.report(link, &self.found(link)?));
        out.extend(self.scratch.links.iter().enumerate().filter_map(answer));
        Ok(())
    }

    fn minimum(&mut self, robot: &Chain, pose: &Pose) -> Result<LinkProximity, ProximityError> {
        self.scratch.links.clear();
        self.place(robot, pose)?;
        self.scan(Real::INFINITY, Aim::Least);
        // Without a bound some triangle is always the nearest; this is any other.
        let probe = &self.scratch.links[0].0;
        let corners = self.indices[0].map(|index| self.vertices[index as usize]);
        let mut best = (0, Found { triangle: 0, closest: probe.closest_by::<S>(corners) });
        for link in 0..self.scratch.links.len() {
            if let Some(found) = self.found(link)
                && found.closest.distance < best.1.closest.distance
            {
                best = (link, found);
            }
        }
        Ok(self.scratch.links[best.0].0.report(best.0, &best.1))
    }

    fn clears(&mut self, robot: &Chain, pose: &Pose, margin: Real) -> Result<bool, ProximityError> {
        check_margin(margin)?;
        self.scratch.links.clear();
        self.place(robot, pose)?;
        let bound = self.scratch.links[0].0.beyond(margin);
        self.scan(bound, Aim::Any);
        Ok((0..self.scratch.links.len()).all(|link| self.found(link).is_none()))
    }

    fn per_link_batch(
        &mut self,
        robots: &[(Chain, Pose)],
        out: &mut Vec<Vec<LinkProximity>>,
    ) -> Result<(), ProximityError> {
        // All links of all robots meet a chunk of the mesh while it is in the cache.
        self.scratch.links.clear();
        for (robot, pose) in robots {
            self.place(robot, pose)?;
        }
        self.scan(Real::INFINITY, Aim::EachLink);
        out.resize_with(robots.len(), Vec::new);
        let mut first = 0;
        for ((robot, _), answers) in robots.iter().zip(out) {
            let links = robot.links().len();
            let answer = |link: usize| {
                Some(self.scratch.links[first + link].0.report(link, &self.found(first + link)?))
            };
            answers.clear();
            answers.extend((0..links).filter_map(answer));
            first += links;
        }
        Ok(())
    }

    fn set_vertices(&mut self, vertices: &[Vector]) -> Result<(), MeshError> {
        self.reach = check_moved(vertices, self.vertices.len())?;
        self.vertices.copy_from_slice(vertices);
        self.mesh.update(self.level, vertices, &self.indices);
        Ok(())
    }
}
