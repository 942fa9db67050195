//! How the pairs of a query are dealt to threads, and what is done in one go.

use super::layout::{BLOCK_BOUNDS, CAPACITY, MOST_LINKS, SLOT, THREADS};
use super::mesh::DeviceMesh;
use super::opened::Opened;

/// Bytes of a number at most.
const NUMBER: u64 = 8;
/// What is large enough, and what too large: the answers do not depend on it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tuning {
    /// Triangles of a part of the mesh at most.
    pub part: usize,
    /// As many threads keep the largest GPUs busy.
    pub threads: u64,
    /// Triangles of a thread, unless a dispatch cannot hold as many workgroups as that takes.
    pub triangles_of_thread: u64,
    /// Bytes for the bounds of all blocks that are worth keeping for more links in one round.
    pub round: u64,
    /// Bytes that come back from one submission.
    pub answer: u64,
}

impl Default for Tuning {
    fn default() -> Self {
        Self {
            part: usize::MAX,
            threads: 1 << 19,
            triangles_of_thread: 8,
            round: 64 << 20,
            answer: 64 << 20,
        }
    }
}

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
    pub(super) fn new(gpu: &Opened, mesh: &DeviceMesh, links: usize, tuning: &Tuning) -> Self {
        let limits = gpu.device.limits();
        let dimension = u64::from(limits.max_compute_workgroups_per_dimension);
        let largest = gpu.device.largest_binding();
        let slot = (u64::from(SLOT) * 4 + u64::from(CAPACITY) * NUMBER) * mesh.parts.len() as u64;
        let links_per_submission = (tuning.answer.min(largest) / slot).clamp(1, links as u64);

        let pairs_of_thread =
            (mesh.triangles() * links_per_submission).div_ceil(tuning.threads).max(1);
        let groups = links_per_submission.div_ceil(pairs_of_thread.min(MOST_LINKS.into()));
        let links_at_once = links_per_submission.div_ceil(groups);
        let largest_part =
            mesh.parts.iter().map(|part| u64::from(part.triangles)).max().unwrap_or(1);
        let threads = u64::from(THREADS);
        let triangles_at_once = pairs_of_thread
            .div_ceil(links_at_once)
            .clamp(1, tuning.triangles_of_thread)
            .max(largest_part.div_ceil(threads * dimension));

        let block = threads * triangles_at_once;
        let blocks: u64 =
            mesh.parts.iter().map(|part| u64::from(part.triangles).div_ceil(block)).sum();
        let kept = tuning.round.min(largest) / (blocks * BLOCK_BOUNDS);
        Self {
            links_at_once: links_at_once as u32,
            triangles_at_once: triangles_at_once as u32,
            links_per_round: kept.min(dimension).clamp(1, links_per_submission) as u32,
            links_per_submission: links_per_submission as usize,
        }
    }

    /// Blocks of so many triangles.
    pub(super) fn blocks(&self, triangles: u32) -> u32 {
        triangles.div_ceil(THREADS * self.triangles_at_once)
    }
}
