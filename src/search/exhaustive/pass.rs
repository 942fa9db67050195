//! One pass over all triangles for the links of one or more robots.
//!
//! # Algorithm
//! 1. **Place** the links. Single precision is used if it resolves a link, else double precision.
//! 2. **First bounds.** With culling, bound the nearest distance of each link by a sample of
//!    spheres.
//! 3. **Scan.** Every thread takes the next chunk of the mesh until none is left.
//! 4. **Merge** the findings of all threads.

use super::blocks::Blocks;
use super::scan::{Job, JobLink, Kernels, Scan, SharedBound, ThreadFindings, Visit};
use crate::answer::{LinkProximity, ProximityError, Work};
use crate::distance::Scalar;
use crate::mesh::Mesh;
use crate::pair::{Nearest, PlacedLink, PlacedRobot, SearchLink};
use crate::threads::{Lazy, each, threads};
use fearless_simd::Level;
use parry3d_f64::math::Real;
use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};

/// A mesh in the precision of the search.
#[derive(Clone)]
pub(crate) struct Triangles<T> {
    pub mesh: Mesh,
    blocks: Blocks<T>,
    /// For links that single precision does not resolve; filled on first use.
    double: Lazy<Blocks<f64>>,
}

impl<T: Kernels> Triangles<T> {
    pub(crate) fn new(level: Level, mesh: Mesh) -> Self {
        let blocks = Blocks::new(&mesh, |faces, spheres| T::prepare(level, faces, spheres));
        Self { mesh, blocks, double: Lazy::new() }
    }

    fn double(&self, level: Level) -> &Blocks<f64> {
        self.double.get_or_build(|| {
            Blocks::new(&self.mesh, |faces, spheres| f64::prepare(level, faces, spheres))
        })
    }

    /// Refills the blocks after the vertices have moved.
    pub(crate) fn refill(&mut self, level: Level) {
        self.blocks.refill(&self.mesh, |faces, spheres| T::prepare(level, faces, spheres));
        if let Some(double) = self.double.get_mut() {
            double.refill(&self.mesh, |faces, spheres| f64::prepare(level, faces, spheres));
        }
    }
}

/// What a pass looks for. Each number is a bound on the distance.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum PassGoal {
    /// The nearest triangle of every link.
    EachLink,
    /// The nearest triangle of all links of a robot together, within the bound.
    Least(Real),
    /// Any triangle within the bound, for each robot.
    Within(Real),
    /// Every triangle that may be within the bound, for each link.
    Every(Real),
}

impl PassGoal {
    fn bound(self) -> Real {
        match self {
            Self::EachLink => Real::INFINITY,
            Self::Least(bound) | Self::Within(bound) | Self::Every(bound) => bound,
        }
    }
}

/// The links of a pass and its findings; memory is reused by later passes.
pub(crate) struct Pass<T> {
    links: Vec<JobLink<T>>,
    /// Links that the precision `T` does not resolve.
    double: Vec<JobLink<f64>>,
    /// All links in the mesh's frame.
    placed: Vec<PlacedLink>,
    /// The links of each robot, or the error of a refused robot.
    robots: Vec<Result<Range<usize>, ProximityError>>,
    bounds: Vec<SharedBound>,
    /// The findings of each thread; the first one holds the merged findings.
    findings: Vec<ThreadFindings>,
    /// Whether pairs within the bound may have been dropped.
    is_full: bool,
}

impl<T> Default for Pass<T> {
    fn default() -> Self {
        Self {
            links: Vec::new(),
            double: Vec::new(),
            placed: Vec::new(),
            robots: Vec::new(),
            bounds: Vec::new(),
            findings: Vec::new(),
            is_full: false,
        }
    }
}

impl<T: Kernels> Pass<T> {
    /// Runs a pass for the given links of each robot. A refused robot finds nothing.
    pub(crate) fn run<'a>(
        &mut self,
        level: Level,
        visit: Visit<T>,
        triangles: &Triangles<T>,
        robots: impl Iterator<Item = Result<PlacedRobot<'a>, ProximityError>>,
        links: Range<usize>,
        aim: PassGoal,
    ) -> Work {
        let links = self.place(level, triangles, robots, links, aim);
        let Self { links: resolved, double, bounds, findings, robots, is_full, .. } = self;
        bounds.clear();
        bounds.resize_with(if aim == PassGoal::EachLink { links } else { robots.len() }, || {
            SharedBound::new(aim.bound())
        });
        findings.resize_with(threads_for(links * triangles.mesh.len()), ThreadFindings::default);
        for findings in &mut *findings {
            findings.work = Work::default();
            findings.within.clear();
            findings.nearest.clear();
            findings.nearest.resize(links, None);
        }
        let mesh = &triangles.mesh;
        let stop_at_first = matches!(aim, PassGoal::Within(_));
        // A single link keeps all its pairs; otherwise no pass could ever answer it.
        let most = if links > 1 { PAIRS_AT_ONCE / findings.len() } else { usize::MAX };
        let every = matches!(aim, PassGoal::Every(_)).then_some(most);
        let blocks = &triangles.blocks;
        let job = Job { mesh, blocks, links: resolved, bounds, stop_at_first, every };
        scan(level, &job, visit.is_culling, visit.scan, findings);
        if !double.is_empty() {
            let blocks = triangles.double(level);
            let job = Job { mesh, blocks, links: double, bounds, stop_at_first, every };
            scan(level, &job, visit.is_culling, visit.scan_double, findings);
        }
        *is_full = findings.iter().any(|findings| findings.within.len() >= most);
        let (first, others) = findings.split_at_mut(1);
        for other in others {
            first[0].merge(other);
        }
        first[0].work
    }

    /// Step 1: places the robots' links, sorted by the precision that resolves them, and counts
    /// them.
    fn place<'a>(
        &mut self,
        level: Level,
        triangles: &Triangles<T>,
        robots: impl Iterator<Item = Result<PlacedRobot<'a>, ProximityError>>,
        of_each: Range<usize>,
        aim: PassGoal,
    ) -> usize {
        let Self { links, double, placed, robots: ranges, .. } = self;
        links.clear();
        placed.clear();
        double.clear();
        ranges.clear();
        let frame = &triangles.blocks.frame;
        let is_double = T::UNIT_ROUNDOFF <= f64::UNIT_ROUNDOFF;
        let mut index = 0;
        for (number, robot) in robots.enumerate() {
            let first = index;
            let robot = match robot {
                Ok(robot) => robot,
                Err(error) => {
                    ranges.push(Err(error));
                    continue;
                }
            };
            for link in robot.placed_links().take(of_each.end).skip(of_each.start) {
                let bound = if aim == PassGoal::EachLink { index } else { number };
                let searched = SearchLink::new(&link, frame);
                if is_double
                    || searched.as_ref().is_some_and(|searched| searched.is_resolved(frame))
                {
                    links.push(JobLink { link, searched, index, bound });
                } else {
                    let searched = SearchLink::new(&link, &triangles.double(level).frame);
                    double.push(JobLink { link, searched, index, bound });
                }
                placed.push(link);
                index += 1;
            }
            ranges.push(Ok(first..index));
        }
        index
    }

    /// The result of the last pass for a link.
    fn found(&self, index: usize) -> Option<Nearest> {
        self.findings[0].nearest[index]
    }

    /// The indices of a robot's links, or the error of a refused robot.
    pub(crate) fn links_of(&self, robot: usize) -> Result<Range<usize>, ProximityError> {
        self.robots[robot].clone()
    }

    /// The first link of a robot that is not refused.
    pub(crate) fn first_link(&self, robot: usize) -> &PlacedLink {
        &self.placed[self.links_of(robot).map_or(0, |indices| indices.start)]
    }

    /// The nearest triangle of each link of a robot.
    pub(crate) fn answers(&self, robot: usize) -> impl Iterator<Item = LinkProximity> {
        let indices = self.links_of(robot).unwrap_or_default();
        // Without a bound some triangle is always the nearest.
        indices
            .enumerate()
            .filter_map(|(link, index)| Some(self.placed[index].answer(link, &self.found(index)?)))
    }

    /// The triangles that may be within the bound of the last pass, sorted by link, each pair once.
    ///
    /// None if pairs may have been dropped. A pass over fewer links has fewer pairs, and a single
    /// link always keeps all of its pairs.
    pub(crate) fn within(&mut self) -> Option<&[(u32, u32)]> {
        let within = &mut self.findings[0].within;
        within.sort_unstable();
        Some(&**within).filter(|_| !self.is_full)
    }

    /// Returns true if the pass found nothing for a robot.
    pub(crate) fn is_clear(&self, robot: usize) -> bool {
        self.links_of(robot).unwrap_or_default().all(|index| self.found(index).is_none())
    }
}

/// How many pairs of a link and a triangle within its bound a pass keeps, unless it has a single
/// link. Limits the memory.
const PAIRS_AT_ONCE: usize = 1 << 20;

/// The least number of pairs that is worth another thread.
const PAIRS_PER_THREAD: usize = 1 << 17;

/// The number of threads for this many pairs.
fn threads_for(pairs: usize) -> usize {
    threads().min(1 + pairs / PAIRS_PER_THREAD)
}

/// Step 3: every thread takes the next chunk until none is left.
fn scan<E: Kernels>(
    level: Level,
    job: &Job<E>,
    is_culling: bool,
    scan: Scan<E>,
    findings: &mut [ThreadFindings],
) {
    if is_culling && !job.stop_at_first && job.every.is_none() {
        E::first_bounds(level, job);
    }
    let next = AtomicUsize::new(0);
    each(findings, |_, findings| {
        loop {
            let chunk = next.fetch_add(1, Ordering::Relaxed);
            if chunk >= job.chunks() {
                break;
            }
            scan(level, job, chunk, findings);
        }
    });
}
