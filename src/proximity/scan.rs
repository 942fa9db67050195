//! Every triangle against every link: the loop of exhaustive search.

use super::coarse::CoarseLink;
use super::packed::{BLOCK, PackedLink};
use super::probe::Found;
use super::probe::Probe;
use super::soa::{self, SoaMesh};
use crate::distance::lanes::{Lane, Pack};
use crate::distance::{Closest, Convex, DiscSolver, Scalar};
use fearless_simd::{Level, dispatch};
use parry3d_f64::math::{Real, Vector};
use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};

/// How many blocks one link meets before the next takes its turn: their spheres stay in the fastest cache.
pub(super) const CHUNK: usize = 64;

/// One block in so many gives a first bound.
const STRIDE: usize = 16;

/// What one query asks of the mesh.
pub(super) struct Job<'a, E> {
    pub mesh: &'a SoaMesh<E>,
    pub vertices: &'a [Vector],
    pub indices: &'a [[u32; 3]],
    /// Each link, and how it looks in the precision of the search if that reaches so far.
    pub links: &'a [(Probe, Option<CoarseLink<E>>)],
    /// For each link, or once for all of them: what a triangle must be nearer than.
    pub bounds: &'a [SharedBound],
    /// Any triangle nearer than the bound will do.
    pub stop_at_first: bool,
    /// [`Probe::nearer_than_by`] with the route to the discs of flat caps.
    pub nearer_than: fn(&Probe, Real, [Vector; 3]) -> Option<Closest<f64>>,
}

/// A distance that only shrinks, seen by all threads; in the probe's units.
#[derive(Default)]
pub(super) struct SharedBound(AtomicU64);

impl SharedBound {
    pub(super) fn new(distance: Real) -> Self {
        Self(AtomicU64::new(distance.to_bits()))
    }

    fn get(&self) -> Real {
        Real::from_bits(self.0.load(Ordering::Relaxed))
    }

    /// Numbers that are not negative are ordered as their bits.
    fn shrink_to(&self, distance: Real) {
        self.0.fetch_min(distance.abs().to_bits(), Ordering::Relaxed);
    }
}

/// How much an exhaustive engine has computed since it was built.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Work {
    /// Pairs of link and triangle that were visited.
    pub pairs: u64,
    /// Pairs for which the distance between axis and triangle was computed, a pack at a time.
    pub axis_distances: u64,
    /// Pairs that were measured in double precision, with the disc of a flat cap where it decides.
    pub measured: u64,
}

impl std::ops::AddAssign for Work {
    fn add_assign(&mut self, other: Self) {
        self.pairs += other.pairs;
        self.axis_distances += other.axis_distances;
        self.measured += other.measured;
    }
}

/// What one thread has found.
#[derive(Default)]
pub(super) struct Findings {
    /// For each link, the nearest triangle of this thread, if it was nearer than the bound at its time.
    pub nearest: Vec<Option<Found>>,
    pub work: Work,
}

impl Findings {
    /// Takes over what another thread found.
    pub(super) fn merge(&mut self, other: &Findings) {
        self.work += other.work;
        for (mine, theirs) in self.nearest.iter_mut().zip(&other.nearest) {
            let nearer =
                |found: &Found| mine.is_none_or(|mine| found.closest.distance < mine.closest.distance);
            if let Some(found) = theirs.filter(nearer) {
                *mine = Some(found);
            }
        }
    }
}

/// The precisions of a scan, with what does not depend on the route to the discs: functions without parameters, which
/// are compiled in this crate and not again in each that uses an engine.
pub(super) trait Scan: Lane {
    /// [`Job::first_bounds`].
    fn first_bounds(level: Level, job: &Job<Self>);
    /// [`Job::scan`] with culling.
    fn scan(level: Level, job: &Job<Self>, chunk: usize, findings: &mut Findings);
    /// `soa::prepare`.
    fn prepare(level: Level, faces: &mut [Self], spheres: &mut [Self]);
}

macro_rules! scan {
    ($element:ty) => {
        impl Scan for $element {
            #[inline(never)]
            fn first_bounds(level: Level, job: &Job<Self>) {
                dispatch!(level, simd => job.first_bounds::<<Self as Lane>::Pack<_>>(simd));
            }

            #[inline(never)]
            fn scan(level: Level, job: &Job<Self>, chunk: usize, findings: &mut Findings) {
                dispatch!(level, simd => job.scan::<<Self as Lane>::Pack<_>, Convex, true>(simd, chunk, findings));
            }

            #[inline(never)]
            fn prepare(level: Level, faces: &mut [Self], spheres: &mut [Self]) {
                dispatch!(level, simd => soa::prepare::<<Self as Lane>::Pack<_>>(simd, faces, spheres));
            }
        }
    };
}

scan!(f32);
scan!(f64);

impl<E: Lane> Job<'_, E> {
    /// How many chunks there are.
    pub(super) fn chunks(&self) -> usize {
        self.mesh.blocks().div_ceil(CHUNK)
    }

    /// For each link, a bound from every so many of the spheres: without it, an order in which the triangles come
    /// nearer and nearer would have them all measured.
    #[inline(always)]
    pub(super) fn first_bounds<L: Pack<Element = E>>(&self, token: L::Token) {
        for (number, (_, link)) in self.links.iter().enumerate() {
            if let Some(link) = link {
                let packed = PackedLink::<L>::new(token, link);
                let mut reach = L::splat(token, E::round(Real::INFINITY));
                for block in (0..self.mesh.blocks()).step_by(STRIDE) {
                    for lane in (0..BLOCK).step_by(L::LANES) {
                        let (centre, radius) = self.mesh.spheres::<L>(token, block, lane);
                        reach = reach.min(packed.reach_of_spheres(centre, radius));
                    }
                }
                let mut lanes = [E::round(Real::INFINITY); BLOCK];
                reach.store(&mut lanes);
                let least = lanes.into_iter().fold(E::round(Real::INFINITY), Scalar::min);
                self.bounds[number.min(self.bounds.len() - 1)].shrink_to(link.bound_within(least));
            }
        }
    }

    /// All links against one chunk of the mesh. With `CULLING` cheap, exact bounds spare what they can; without it every
    /// pair costs its full distance, discs by the route `S` included.
    #[inline(always)]
    pub(super) fn scan<L: Pack<Element = E>, S: DiscSolver<E>, const CULLING: bool>(
        &self,
        token: L::Token,
        chunk: usize,
        findings: &mut Findings,
    ) {
        let blocks = chunk * CHUNK..self.mesh.blocks().min((chunk + 1) * CHUNK);
        for (number, (probe, link)) in self.links.iter().enumerate() {
            let shared = &self.bounds[number.min(self.bounds.len() - 1)];
            let bound = shared.get();
            if bound > 0.0 {
                let mut turn = Turn { job: self, probe, bound, found: None, work: &mut findings.work };
                match link {
                    Some(link) => turn.scan::<L, S, CULLING>(token, link, blocks.clone()),
                    None => turn.measure_all(blocks.clone()),
                }
                if let Some(found) = turn.found {
                    shared.shrink_to(if self.stop_at_first { 0.0 } else { found.closest.distance });
                    findings.nearest[number] = Some(found);
                }
            }
        }
    }
}

/// One link's turn with a chunk.
struct Turn<'a, E> {
    job: &'a Job<'a, E>,
    probe: &'a Probe,
    bound: Real,
    found: Option<Found>,
    work: &'a mut Work,
}

impl<E: Lane> Turn<'_, E> {
    #[inline(always)]
    fn scan<L: Pack<Element = E>, S: DiscSolver<E>, const CULLING: bool>(
        &mut self,
        token: L::Token,
        link: &CoarseLink<E>,
        blocks: Range<usize>,
    ) {
        let mesh = self.job.mesh;
        let packed = PackedLink::<L>::new(token, link);
        let mut limit = L::splat(token, link.axis_limit(self.bound));
        let radius = L::splat(token, link.radius);
        self.work.pairs += (blocks.len() * BLOCK) as u64;
        for block in blocks {
            for lane in (0..BLOCK).step_by(L::LANES) {
                if CULLING {
                    let (centre, radius) = mesh.spheres::<L>(token, block, lane);
                    if packed.meets_spheres(centre, radius, limit) == 0 {
                        continue;
                    }
                }
                self.work.axis_distances += L::LANES as u64;
                let face = mesh.faces::<L>(token, block, lane);
                let mut nearer = if CULLING {
                    packed.may_be_nearer(&face, limit).nearer
                } else {
                    L::bits((packed.distances::<S>(token, &face) + radius).lt(limit))
                };
                while nearer != 0 {
                    let triangle = block * BLOCK + lane + nearer.trailing_zeros() as usize;
                    nearer &= nearer - 1;
                    if self.measure(triangle) {
                        limit = L::splat(token, link.axis_limit(self.bound));
                    }
                }
            }
        }
    }

    /// The scan of a link that is too far out for the precision of the search.
    fn measure_all(&mut self, blocks: Range<usize>) {
        self.work.pairs += (blocks.len() * BLOCK) as u64;
        for triangle in blocks.start * BLOCK..blocks.end * BLOCK {
            self.measure(triangle);
        }
    }

    /// Measures one triangle in double precision. True if it is the nearest so far.
    #[inline(never)] // the same code whatever the instruction set
    fn measure(&mut self, triangle: usize) -> bool {
        let job = self.job;
        let Some(corners) = job.indices.get(triangle) else { return false };
        self.work.measured += 1;
        let vertices = corners.map(|index| job.vertices[index as usize]);
        let Some(closest) = (job.nearer_than)(self.probe, self.bound, vertices) else { return false };
        self.bound = closest.distance;
        self.found = Some(Found { triangle: triangle as u32, closest });
        true
    }
}
