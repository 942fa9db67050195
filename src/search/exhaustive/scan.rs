//! The loop of exhaustive search: every link against every triangle.
//!
//! [`Kernels`] has the loop for each precision, as functions without type parameters. So they are
//! compiled for every instruction set in this crate, and not again in each crate that uses an
//! engine.

use super::blocks::{Blocks, prepare};
use crate::answer::Work;
use crate::distance::lanes::{Lane, Pack};
use crate::distance::{Scalar, dispatch};
use crate::mesh::{BLOCK, Mesh};
use crate::pair::{Best, LinkLanes, Nearest, PlacedLink, SearchLink};
use fearless_simd::Level;
use parry3d_f64::math::Real;
use std::ops::Range;
use std::sync::atomic::{AtomicU32, AtomicU64, Ordering};

/// Blocks of a chunk. Each link meets a whole chunk before the next link does, so that the spheres
/// stay in the fastest cache.
const CHUNK: usize = 64;

/// One block in `STRIDE` gives a first bound.
const STRIDE: usize = 16;

/// A query to the mesh, shared by all threads.
pub(crate) struct Job<'a, E> {
    pub mesh: &'a Mesh,
    pub blocks: &'a Blocks<E>,
    pub links: &'a [JobLink<E>],
    pub bounds: &'a [SharedBound],
    /// Whether any triangle within the bound answers the query.
    pub stop_at_first: bool,
    /// If every triangle that may be within the bound is wanted: the most pairs that one thread
    /// keeps.
    pub every: Option<usize>,
}

/// A link of a job.
pub(crate) struct JobLink<E> {
    pub link: PlacedLink,
    /// The link in the precision of the search; none if it is too far out.
    pub searched: Option<SearchLink<E>>,
    /// The index of the link in the findings.
    pub index: usize,
    /// The index of its bound. Links whose common nearest triangle is wanted share one.
    pub bound: usize,
}

/// The shared upper bound on the distance of a wanted triangle; 0 stops the scan. It never grows.
///
/// Numbers that are not negative are ordered as their bits. One is added to the bits, so that 0 is
/// free for the stop.
pub(crate) struct SharedBound {
    distance: AtomicU64,
    /// The lowest triangle that touches. Of the triangles that touch, only those up to this one are
    /// wanted; this one itself may win with a lower link.
    touching: AtomicU32,
}

impl SharedBound {
    pub(crate) fn new(distance: Real) -> Self {
        let distance = AtomicU64::new(distance.abs().to_bits() + 1);
        Self { distance, touching: AtomicU32::new(u32::MAX) }
    }

    fn get(&self) -> Option<Real> {
        self.distance.load(Ordering::Relaxed).checked_sub(1).map(Real::from_bits)
    }

    fn lower_to(&self, distance: Real) {
        self.distance.fetch_min(distance.abs().to_bits() + 1, Ordering::Relaxed);
    }

    fn touching(&self) -> u32 {
        self.touching.load(Ordering::Relaxed)
    }

    /// Records that a triangle touches.
    fn touch(&self, triangle: u32) {
        self.touching.fetch_min(triangle, Ordering::Relaxed);
        self.lower_to(0.0);
    }

    fn end(&self) {
        self.distance.store(0, Ordering::Relaxed);
    }
}

/// The findings of one thread.
#[derive(Default)]
pub(crate) struct ThreadFindings {
    /// For each link the nearest triangle of this thread, if it was within the bound at that time.
    pub nearest: Vec<Option<Nearest>>,
    /// If every triangle is wanted: pairs of a link's index and a triangle that may be within the
    /// bound.
    pub within: Vec<(u32, u32)>,
    pub work: Work,
}

impl ThreadFindings {
    /// Merges the findings of another thread into this one.
    pub(crate) fn merge(&mut self, other: &ThreadFindings) {
        self.work += other.work;
        self.within.extend(&other.within);
        for (mine, theirs) in self.nearest.iter_mut().zip(&other.nearest) {
            let mut best = Best::resume(Real::INFINITY, *mine);
            if theirs.is_some_and(|theirs| best.take(theirs)) {
                *mine = *theirs;
            }
        }
    }
}

impl<E: Lane> Job<'_, E> {
    /// The number of chunks.
    pub(crate) fn chunks(&self) -> usize {
        self.blocks.len().div_ceil(CHUNK)
    }

    /// Lowers the bound of each link by a sample of the spheres. Without this step, triangles in
    /// the order of falling distance would all be measured.
    #[inline(always)]
    pub(crate) fn first_bounds<L: Pack<Element = E>>(&self, token: L::Token) {
        for link in self.links {
            let Some(searched) = &link.searched else { continue };
            let lanes = LinkLanes::<L>::new(token, searched);
            let mut reach = L::splat(token, E::round(Real::INFINITY));
            for block in (0..self.blocks.len()).step_by(STRIDE) {
                for lane in (0..BLOCK).step_by(L::LANES) {
                    let (centre, radius) = self.blocks.spheres::<L>(token, block, lane);
                    reach = reach.min(lanes.reach_of_spheres(centre, radius));
                }
            }
            let mut reaches = [E::round(Real::INFINITY); BLOCK];
            reach.store(&mut reaches);
            let least = reaches.into_iter().fold(E::round(Real::INFINITY), Scalar::min);
            self.bounds[link.bound].lower_to(searched.bound_within(least));
        }
    }

    /// Scans one chunk of the mesh for all links. With `CULLING` exact lower bounds skip most pairs.
    /// Otherwise every pair costs its full distance, discs included.
    #[inline(always)]
    pub(crate) fn scan<L: Pack<Element = E>, const CULLING: bool>(
        &self,
        token: L::Token,
        chunk: usize,
        findings: &mut ThreadFindings,
    ) {
        let blocks = chunk * CHUNK..self.blocks.len().min((chunk + 1) * CHUNK);
        for link in self.links {
            let shared = &self.bounds[link.bound];
            let Some(bound) = shared.get() else { continue };
            let touching = shared.touching();
            if blocks.start * BLOCK > touching as usize {
                continue;
            }
            let best = Best::resume(bound, findings.nearest[link.index]);
            let best = best.touching_below(touching.saturating_add(1));
            let ThreadFindings { within, work, .. } = &mut *findings;
            let mut scan =
                LinkScan { job: self, link: &link.link, index: link.index, best, within, work };
            match &link.searched {
                Some(searched) => scan.run::<L, CULLING>(token, searched, blocks.clone()),
                None => scan.measure_all(blocks.clone()),
            }
            let best = scan.best;
            findings.nearest[link.index] = best.nearest();
            if self.stop_at_first && best.nearest().is_some() {
                shared.end();
            } else if let Some(nearest) = best.nearest().filter(|nearest| nearest.distance <= 0.0) {
                shared.touch(nearest.triangle);
            } else {
                shared.lower_to(best.bound());
            }
        }
    }
}

/// The scan of one chunk for one link.
struct LinkScan<'a, E> {
    job: &'a Job<'a, E>,
    link: &'a PlacedLink,
    index: usize,
    best: Best,
    within: &'a mut Vec<(u32, u32)>,
    work: &'a mut Work,
}

impl<E: Lane> LinkScan<'_, E> {
    /// Measures the triangles that may improve the best so far.
    #[inline(always)]
    fn run<L: Pack<Element = E>, const CULLING: bool>(
        &mut self,
        token: L::Token,
        searched: &SearchLink<E>,
        blocks: Range<usize>,
    ) {
        let triangles = self.job.blocks;
        let lanes = LinkLanes::<L>::new(token, searched);
        let mut limit = L::splat(token, searched.axis_limit(self.best.bound()));
        let radius = L::splat(token, searched.radius);
        self.work.visited += (blocks.len() * BLOCK) as u64;
        for block in blocks {
            for lane in (0..BLOCK).step_by(L::LANES) {
                if CULLING {
                    let (centre, radius) = triangles.spheres::<L>(token, block, lane);
                    if lanes.meets_spheres(centre, radius, limit) == 0 {
                        continue;
                    }
                }
                self.work.axis_distances += L::LANES as u64;
                let face = triangles.faces::<L>(token, block, lane);
                let mut nearer = if CULLING {
                    lanes.may_be_nearer(&face, limit).nearer
                } else {
                    L::bits((lanes.distances(&face) + radius).lt(limit))
                };
                while nearer != 0 {
                    let triangle = block * BLOCK + lane + nearer.trailing_zeros() as usize;
                    nearer &= nearer - 1;
                    if self.measure(triangle) {
                        limit = L::splat(token, searched.axis_limit(self.best.bound()));
                    }
                }
            }
        }
    }

    /// Measures every triangle, for a link that is too far out for the precision of the search.
    fn measure_all(&mut self, blocks: Range<usize>) {
        self.work.visited += (blocks.len() * BLOCK) as u64;
        for triangle in blocks.start * BLOCK..blocks.end * BLOCK {
            self.measure(triangle);
        }
    }

    /// Measures one triangle in double precision, or keeps it if every triangle is wanted. Returns
    /// true if it is the nearest so far.
    #[inline(never)] // the same code on every instruction set
    fn measure(&mut self, triangle: usize) -> bool {
        if triangle >= self.job.mesh.len().min(self.best.triangle_limit() as usize) {
            return false;
        }
        if let Some(most) = self.job.every {
            if self.within.len() < most {
                self.within.push((self.index as u32, triangle as u32));
            }
            return false;
        }
        self.work.measured += 1;
        self.best.measure(self.link, triangle as u32, self.job.mesh.corners(triangle as u32))
    }
}

/// A loop over one chunk.
pub(super) type Scan<E> = fn(Level, &Job<E>, usize, &mut ThreadFindings);

/// How a pass visits the pairs of a chunk: its loops in the precision of the search, and in double
/// precision.
#[derive(Clone, Copy)]
pub(crate) struct Visit<T> {
    pub scan: Scan<T>,
    pub scan_double: Scan<f64>,
    /// Whether bounds skip pairs, so that a first bound helps.
    pub is_culling: bool,
}

impl<T: Kernels> Visit<T> {
    /// Exact lower bounds skip most pairs.
    pub(crate) fn culled() -> Self {
        Self { scan: T::scan, scan_double: f64::scan, is_culling: true }
    }

    /// Every pair costs its full distance.
    #[cfg(feature = "laboratory")]
    pub(crate) fn every_pair() -> Self {
        let (scan, scan_double) = (T::scan_every_pair, f64::scan_every_pair);
        Self { scan, scan_double, is_culling: false }
    }
}

/// A precision with its loops.
pub(crate) trait Kernels: Lane {
    /// [`prepare`].
    fn prepare(level: Level, faces: &mut [Self], spheres: &mut [Self]);
    /// [`Job::first_bounds`].
    fn first_bounds(level: Level, job: &Job<Self>);
    /// [`Job::scan`] with culling.
    fn scan(level: Level, job: &Job<Self>, chunk: usize, findings: &mut ThreadFindings);
    /// [`Job::scan`] without culling.
    #[cfg(feature = "laboratory")]
    fn scan_every_pair(level: Level, job: &Job<Self>, chunk: usize, findings: &mut ThreadFindings);
}

macro_rules! kernels {
    ($element:ty) => {
        impl Kernels for $element {
            #[inline(never)]
            fn prepare(level: Level, faces: &mut [Self], spheres: &mut [Self]) {
                dispatch!(level, simd => prepare::<<Self as Lane>::Pack<_>>(simd, faces, spheres));
            }

            #[inline(never)]
            fn first_bounds(level: Level, job: &Job<Self>) {
                dispatch!(level, simd => job.first_bounds::<<Self as Lane>::Pack<_>>(simd));
            }

            #[inline(never)]
            fn scan(level: Level, job: &Job<Self>, chunk: usize, findings: &mut ThreadFindings) {
                dispatch!(level, simd => {
                    job.scan::<<Self as Lane>::Pack<_>, true>(simd, chunk, findings)
                });
            }

            #[cfg(feature = "laboratory")]
            #[inline(never)]
            fn scan_every_pair(
                level: Level,
                job: &Job<Self>,
                chunk: usize,
                findings: &mut ThreadFindings,
            ) {
                dispatch!(level, simd => {
                    job.scan::<<Self as Lane>::Pack<_>, false>(simd, chunk, findings)
                });
            }
        }
    };
}

kernels!(f32);
kernels!(f64);
