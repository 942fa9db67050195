//! How the pairs of a query are dealt to threads, and what is done in one go.

use super::mesh::DeviceMesh;
use super::opened::Opened;

/// Threads of a workgroup.
const THREADS: u64 = 256;
/// Links of a workgroup at most; `MOST_LINKS` in query.wgsl.
const MOST_LINKS: u64 = 32;
/// Triangles of a thread, unless a dispatch cannot hold as many workgroups as that takes.
const MOST_TRIANGLES: u64 = 8;
/// As many threads keep the largest GPUs busy. (Few in unit tests, so that a thread takes several pairs.)
const ENOUGH_THREADS: u64 = if cfg!(test) { 1 << 12 } else { 1 << 19 };
/// Candidates of a link and part that come back; `CAPACITY` in query.wgsl.
pub(super) const CAPACITY: usize = 64;
/// Bytes for each candidate: a triangle's number, and a distance of at most 8.
const CANDIDATE: u64 = 12;
/// Bytes for the bounds of a block and a link.
pub(super) const BLOCK_BOUNDS: u64 = 8;
/// Bytes for the bounds of all blocks that are worth keeping for more links in one round. (Few in unit tests,
/// so that small queries take several rounds and submissions.)
const ROUND_BYTES: u64 = if cfg!(test) { 1 << 10 } else { 64 << 20 };
/// Bytes that come back from one submission.
const ANSWER_BYTES: u64 = if cfg!(test) { 100 << 10 } else { 64 << 20 };

/// The shape of a query.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Plan {
    /// Links that a workgroup takes.
    pub links_at_once: u32,
    /// Triangles that a thread takes.
    pub triangles_at_once: u32,
    /// Links of a round: the bounds of all their blocks are kept.
    pub links_per_round: u32,
    /// Links of a submission: all their candidates come back together.
    pub links_per_submission: usize,
}

impl Plan {
    pub(super) fn new(gpu: &Opened, mesh: &DeviceMesh, links: usize) -> Self {
        let limits = &gpu.device.limits;
        let dimension = u64::from(limits.max_compute_workgroups_per_dimension);
        let largest = gpu.device.largest_binding();
        let slot = CAPACITY as u64 * CANDIDATE * mesh.parts.len() as u64;
        let links_per_submission = (ANSWER_BYTES.min(largest) / slot).clamp(1, links as u64);

        let pairs_of_thread = (mesh.triangles() * links_per_submission).div_ceil(ENOUGH_THREADS).max(1);
        let groups = links_per_submission.div_ceil(pairs_of_thread.min(MOST_LINKS));
        let links_at_once = links_per_submission.div_ceil(groups);
        let largest_part = mesh.parts.iter().map(|part| u64::from(part.triangles)).max().unwrap_or(1);
        let triangles_at_once = pairs_of_thread
            .div_ceil(links_at_once)
            .clamp(1, MOST_TRIANGLES)
            .max(largest_part.div_ceil(THREADS * dimension));

        let block = THREADS * triangles_at_once;
        let blocks: u64 = mesh.parts.iter().map(|part| u64::from(part.triangles).div_ceil(block)).sum();
        let kept = ROUND_BYTES.min(largest) / (blocks * BLOCK_BOUNDS);
        Self {
            links_at_once: links_at_once as u32,
            triangles_at_once: triangles_at_once as u32,
            links_per_round: kept.min(dimension).clamp(1, links_per_submission) as u32,
            links_per_submission: links_per_submission as usize,
        }
    }

    /// Blocks of so many triangles.
    pub(super) fn blocks(&self, triangles: u32) -> u32 {
        triangles.div_ceil(THREADS as u32 * self.triangles_at_once)
    }
}
