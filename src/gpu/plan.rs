//! The division of a query's pairs into threads, rounds and submissions.
//!
//! # Definitions
//! - A **thread** takes `links_at_once` links and `triangles_at_once` triangles.
//! - A **block** is the triangles of one workgroup: `THREADS * triangles_at_once`.
//! - A **round** is the links whose bounds of all blocks are kept at once.
//! - A **submission** is the links whose candidates come back together.
//!
//! The answers do not depend on the division.

use super::layout::{BLOCK_BOUNDS, CAPACITY, MOST_LINKS, SLOT, THREADS};
use super::mesh::DeviceMesh;
use super::opened::Opened;

/// The most bytes of a number.
const NUMBER: u64 = 8;
/// Sizes that trade memory for parallel work.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tuning {
    /// The most triangles per part of the mesh.
    pub part: usize,
    /// The number of threads that keeps the largest GPUs busy.
    pub threads: u64,
    /// The most triangles per thread, unless a dispatch has too few workgroups for that.
    pub triangles_of_thread: u64,
    /// The most bytes for the bounds of all blocks in one round.
    pub round: u64,
    /// The most bytes that come back from one submission.
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

/// The division of a query.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Plan {
    /// Links per workgroup.
    pub links_at_once: u32,
    /// Triangles per thread.
    pub triangles_at_once: u32,
    /// Links per round.
    pub links_per_round: u32,
    /// Links per submission.
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

    /// The number of blocks of a part with `triangles` triangles.
    pub(super) fn blocks(&self, triangles: u32) -> u32 {
        triangles.div_ceil(THREADS * self.triangles_at_once)
    }
}
